// Whether a region is separated without harm. Private to mesh/contact.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "mesh/contact/penetrations.h"
#include "mesh/contact/separation.h"
#include "mesh/contact/shell_crossings.h"
#include "mesh/quality/report.h"

namespace prismesh::mesh::contact {

/// What crosses and what is too close.
struct FoundContacts {
  std::vector<ShellCrossing> crossings;
  std::vector<Penetration> penetrations;
};
/// `among`: null: of the whole model.
FoundContacts find_contacts(const SeparationInput& input, const SeparationWish& wish, const Model& model, const spatial::BoxTree& tree,
                            const ShellSet* among = nullptr);

/// A pair of shells that cross or are too close.
struct Contact {
  bool crosses = false;
  double depth = 0;           ///< of pairs that don't cross, with the gap
  double mean_thickness = 0;  ///< likewise
};
using Contacts = std::map<std::pair<ShellIndex, ShellIndex>, Contact>;  ///< the lower index first
Contacts by_pair(const FoundContacts& found, double gap);

/// The model as it becomes, with what follows from it.
struct SeparatedModel {
  Model model;
  spatial::BoxTree tree;
  ChunkedArray<quality::ShellState> states;
  Contacts contacts;
  double reach = 0;  ///< shells farther apart aren't too close, wherever they are
};

/// The sides of the region, which must be clear of each other afterwards.
struct SidesToClear {
  const ShellSet& upper;
  const ShellSet& lower;
};

/// Why a change can't be made.
struct Harm {
  std::string why;               ///< a sentence; empty: it does none
  bool to_shells = false;        ///< a gentler change may do none
  bool by_surroundings = false;  ///< of the sides: a steeper change, which moves less of them, may do none
  Contacts at_moved;             ///< if it does none: of the shells that changed, as they are afterwards
};
/// Compares the shells at `moved` and what is near them. `after` has the changed model, and the tree and the states of `before`, which are
/// brought up to date. Costs what is near, not the model.
Harm harm_of(const SeparationInput& input, const SeparationWish& wish, const SeparatedModel& before, SeparatedModel& after,
             const NodeSet& moved, const SidesToClear& sides);

/// The pairs that cross or are too close in `after` and were less so in `before`; ascending.
std::vector<std::pair<ShellIndex, ShellIndex>> worse_pairs(const Contacts& before, const Contacts& after, double gap);

}  // namespace prismesh::mesh::contact
