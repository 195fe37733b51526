// Adding and removing nodes and shells. Everything costs what changes, not what the model has: arrays in chunks are appended to, and what
// is removed keeps its entry, so that no index ever means something else.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/model/chunked_array.h"
#include "mesh/model/model.h"

namespace prismesh::mesh {

/// Where an added node comes from: between one and four other nodes (the ends of an edge, the corners of a face), which may have been added
/// themselves, with weights above 0 that sum to 1.
struct NodeOrigin {
  std::array<NodeIndex, 4> parent;  ///< those in use first, then invalid ones
  std::array<double, 4> weight{};

  int count() const {
    int used = 0;
    while (used < 4 && parent[static_cast<std::size_t>(used)].valid()) ++used;
    return used;
  }
  bool operator==(const NodeOrigin&) const = default;
};
NodeOrigin edge_origin(NodeIndex a, NodeIndex b, double weight_of_b = 0.5);
/// The centre of a shell, each corner counting the same.
NodeOrigin centre_origin(const ShellNodes& shell);

/// What a model has more and less than the deck it was opened from.
struct TopologyChange {
  std::size_t deck_nodes = 0;  ///< nodes from this index on were added
  std::size_t deck_shells = 0;
  ChunkedArray<NodeOrigin> node_origins;   ///< of the added nodes
  ChunkedArray<ShellIndex> shell_parents;  ///< of the added shells; may be added or removed ones
  std::vector<NodeIndex> removed_nodes;    ///< in the order of their removal, added ones too
  std::vector<ShellIndex> removed_shells;
  std::vector<ShellIndex> reshaped_shells;  ///< of the deck, whose nodes were set; each may be listed more than once
};

/// Every function drops the adjacency: whoever has finished an edit builds it again or brings it up to date.
/// Preconditions, here and below: indices are those of nodes and shells that aren't removed; an id was never one of the model's, and
/// fits the deck (mesh/deck/editing/new_ids.h).
NodeIndex add_node(Model& model, std::int64_t id, const Vec3& position, const NodeOrigin& origin);

/// `nodes`: a triangle repeats its third. Part and thickness are the parent's.
ShellIndex add_shell(Model& model, std::int64_t id, const ShellNodes& nodes, ShellIndex parent);

void set_shell_nodes(Model& model, ShellIndex shell, const ShellNodes& nodes);

void remove_shell(Model& model, ShellIndex shell);

/// Whether something still uses the node is for the edit to know and for saving to refuse (deck::can_save).
void remove_node(Model& model, NodeIndex node);

/// Nodes and shells that are there.
std::size_t live_nodes(const Model& model);
std::size_t live_shells(const Model& model);

bool is_added(const Model& model, NodeIndex node);
bool is_added(const Model& model, ShellIndex shell);
/// Of an added node.
const NodeOrigin& origin_of(const Model& model, NodeIndex node);
/// The shell of the deck from which a shell descends; itself if it is one of the deck's.
ShellIndex deck_ancestor(const Model& model, ShellIndex shell);

/// What `after` has that `before` hasn't, the other way, and shells in both with different corners; each ascending. `after` is made from
/// `before` by any number of edits.
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
