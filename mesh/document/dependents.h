// What hangs on nodes without sharing them: welds that merely lie on shells, and cards that join nodes. Rules: docs/connections.md.
// Private to mesh/document.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mesh/deck/deck.h"
#include "mesh/document/document.h"

namespace prismesh::mesh::document {

struct Motion;

/// Found once, when a deck is opened; by index, so it holds for all generations.
struct Dependents {
  /// A node that lies on a sheet without being a corner of it.
  struct Rest {
    NodeIndex node;
    ShellIndex shell;              ///< the nearest, when the deck was opened
    double reach = 0;              ///< farther than this from the sheet it doesn't lie on it
    bool tied = false;             ///< a node of a sheet of its own that a contact ties: it isn't carried along
    ElementClass element_class{};  ///< not tied: the element it belongs to
    std::uint32_t of = 0;          ///< that element's index, or the number of the contact's card among the referrers
  };
  std::vector<Rest> rests;                    ///< ascending by node
  std::vector<std::uint32_t> rests_by_shell;  ///< indices into rests, ascending by shell

  /// A card that joins nodes: a rigid body, a weld, a joint, an equation.
  struct Join {
    std::uint32_t referrer = 0;
    NodeSet nodes;
  };
  struct Joined {
    NodeIndex node;
    std::uint32_t join = 0;
    auto operator<=>(const Joined&) const = default;
  };
  std::vector<Join> joins;
  std::vector<Joined> joined;  ///< ascending
};

/// `uses` as in Attached. Costs the model where there is something that may lie on it.
struct Attached;
Dependents find_dependents(const deck::Deck& deck, const Model& model, const Attached& attached);

/// Lets the nodes of welds that lie on shells with moving corners follow these, unless they move already, are held or belong to a locked
/// part. `acted_on`: the nodes the edit names; those carried aren't unreached any more. Costs the shells that touch moving nodes.
void add_welded(const Generation& generation, const NodeSet& acted_on, Motion& motion);

/// What an edit did to what hangs on the nodes it moved. `moved` ascending.
void report_hanging(const Generation& before, const Generation& after, const NodeSet& moved, EditReport& report);

/// Shells that the edit turned over: the normal by more than 90 degrees (beyond what `turn` says of a rotation), or a corner that now
/// bends inwards so far that its Jacobian is no longer greater than 0. `shells` are those that touch moved nodes.
std::vector<ShellIndex> inverted_shells(const Model& before, const Model& after, const ShellSet& shells, const Motion& motion,
                                        double degrees);

}  // namespace prismesh::mesh::document
