// Adds and removes nodes and shells, and adds other elements and parts. The cost follows the change, not the model: arrays in chunks are
// appended to, and a removed entity keeps its entry, so that indices never change their meaning. Elements other than shells and parts are
// few beside the shells: their arrays are copied when something is added.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "mesh/model/chunked_array.h"
#include "mesh/model/model.h"

namespace prismesh::mesh {

/// The origin of an added node: one to four other nodes (the ends of an edge, the corners of a face), which may have been added themselves,
/// with weights above 0 whose sum is 1.
struct NodeOrigin {
  std::array<NodeIndex, 4> parent;  ///< the used ones first, then invalid ones
  std::array<double, 4> weight{};

  int count() const {
    int used = 0;
    while (used < 4 && parent[static_cast<std::size_t>(used)].valid()) ++used;
    return used;
  }
  bool operator==(const NodeOrigin&) const = default;
};
NodeOrigin edge_origin(NodeIndex a, NodeIndex b, double weight_of_b = 0.5);
/// The centre of a shell: all corners have the same weight.
NodeOrigin centre_origin(const ShellNodes& shell);

/// Which sets an added node joins that lies between no others.
inline constexpr std::uint32_t kJoinsNone = 0;
inline constexpr std::uint32_t kJoinsCommon = 1;  ///< it is used as the nodes of its origin are: those that name all of these
inline constexpr std::uint32_t kJoinsTies = 2;    ///< these, and those that name the first of its origin and tie nodes to a sheet

/// An added node that lies between no others: an end of a weld. Its origin are the nodes that its card follows.
struct PlacedNode {
  NodeIndex node;
  std::uint32_t joins = kJoinsNone;
  bool operator==(const PlacedNode&) const = default;
};

/// An added element without an example: its card stands in a block of its own.
inline constexpr std::uint32_t kNoExample = std::numeric_limits<std::uint32_t>::max();

/// An added part, with the text of the cards that define it and what it uses (section, material, contact, ...).
struct AddedPart {
  std::string cards;  ///< whole lines that end with '\n'
  bool operator==(const AddedPart&) const = default;
};

/// What was added to and removed from a model since its deck was opened.
struct TopologyChange {
  std::size_t deck_nodes = 0;  ///< nodes from this index on were added
  std::size_t deck_shells = 0;
  std::array<std::size_t, kElementClassCount> deck_elements{};  ///< by class; [shell] stays 0
  std::size_t deck_parts = 0;
  ChunkedArray<NodeOrigin> node_origins;   ///< of the added nodes
  std::vector<PlacedNode> placed_nodes;    ///< ascending; those of the added nodes that lie between no others
  ChunkedArray<ShellIndex> shell_parents;  ///< of the added shells; may be added or removed ones
  std::vector<NodeIndex> removed_nodes;    ///< in the order of their removal, added ones too
  std::vector<ShellIndex> removed_shells;
  std::vector<ShellIndex> reshaped_shells;  ///< of the deck, whose nodes were set; each may be listed more than once
  /// Of the added elements of each class: the deck's element whose card theirs is like and follows, or kNoExample.
  std::array<std::vector<std::uint32_t>, kElementClassCount> element_examples;
  std::vector<AddedPart> added_parts;
};

/// This function and those below drop the adjacency: build or update it after the last change.
/// Preconditions, here and below: the indices are those of nodes and shells that exist; a new id was never used in the model, and fits
/// the deck (mesh/deck/editing/new_ids.h).
NodeIndex add_node(Model& model, std::int64_t id, const Vec3& position, const NodeOrigin& origin);

/// Adds a node that lies between no others. `joins`: as PlacedNode.
NodeIndex add_placed_node(Model& model, std::int64_t id, const Vec3& position, const NodeOrigin& origin, std::uint32_t joins);

/// Adds an element that is no shell; returns its index in its class. `example`: an element of the deck of this class, or kNoExample.
std::uint32_t add_element(Model& model, ElementClass element_class, std::int64_t id, PartIndex part, std::span<const NodeIndex> nodes,
                          std::uint32_t example);

/// Adds a part. Precondition: its id is above all others.
PartIndex add_part(Model& model, Part part, AddedPart added);

/// `nodes`: a triangle repeats its third node. Part and thickness are the parent's.
ShellIndex add_shell(Model& model, std::int64_t id, const ShellNodes& nodes, ShellIndex parent);

void set_shell_nodes(Model& model, ShellIndex shell, const ShellNodes& nodes);

void remove_shell(Model& model, ShellIndex shell);

/// Doesn't check whether something still uses the node: the edit must know, and saving refuses it (deck::can_save).
void remove_node(Model& model, NodeIndex node);

/// Counts the nodes and shells that exist.
std::size_t live_nodes(const Model& model);
std::size_t live_shells(const Model& model);

bool is_added(const Model& model, NodeIndex node);
bool is_added(const Model& model, ShellIndex shell);
/// Null if the node isn't one of TopologyChange::placed_nodes.
const PlacedNode* placed_node(const Model& model, NodeIndex node);
/// Of an added node.
const NodeOrigin& origin_of(const Model& model, NodeIndex node);
/// The deck's shell that a shell descends from; itself if it is one of the deck's.
ShellIndex deck_ancestor(const Model& model, ShellIndex shell);

/// The differences between two models, of which `after` was made from `before` by any number of edits. Reshaped shells are in both, with
/// different corners. Each list ascends.
struct Changes {
  std::vector<NodeIndex> added_nodes;
  std::vector<NodeIndex> removed_nodes;
  std::vector<ShellIndex> added_shells;
  std::vector<ShellIndex> removed_shells;
  std::vector<ShellIndex> reshaped_shells;
  std::array<std::vector<std::uint32_t>, kElementClassCount> added_elements;  ///< by class, indices into Model::elements
  std::vector<PartIndex> added_parts;

  bool empty() const {
    return added_nodes.empty() && removed_nodes.empty() && added_shells.empty() && removed_shells.empty() && reshaped_shells.empty() &&
           other_elements() == 0 && added_parts.empty();
  }
  /// Added elements that are no shells.
  std::size_t other_elements() const {
    std::size_t count = 0;
    for (const std::vector<std::uint32_t>& of_class : added_elements) count += of_class.size();
    return count;
  }
};
Changes changes_between(const Model& before, const Model& after);

}  // namespace prismesh::mesh
