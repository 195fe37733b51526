// Adds and removes nodes and shells. The cost follows the change, not the model: arrays in chunks are appended to, and a removed entity
// keeps its entry, so that indices never change their meaning.
#pragma once

#include <array>
#include <cstdint>
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

/// What was added to and removed from a model since its deck was opened.
struct TopologyChange {
  std::size_t deck_nodes = 0;  ///< nodes from this index on were added
  std::size_t deck_shells = 0;
  ChunkedArray<NodeOrigin> node_origins;   ///< of the added nodes
  ChunkedArray<ShellIndex> shell_parents;  ///< of the added shells; may be added or removed ones
  std::vector<NodeIndex> removed_nodes;    ///< in the order of their removal, added ones too
  std::vector<ShellIndex> removed_shells;
  std::vector<ShellIndex> reshaped_shells;  ///< of the deck, whose nodes were set; each may be listed more than once
};

/// This function and those below drop the adjacency: build or update it after the last change.
/// Preconditions, here and below: the indices are those of nodes and shells that exist; a new id was never used in the model, and fits
/// the deck (mesh/deck/editing/new_ids.h).
NodeIndex add_node(Model& model, std::int64_t id, const Vec3& position, const NodeOrigin& origin);

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

  bool empty() const {
    return added_nodes.empty() && removed_nodes.empty() && added_shells.empty() && removed_shells.empty() && reshaped_shells.empty();
  }
};
Changes changes_between(const Model& before, const Model& after);

}  // namespace prismesh::mesh
