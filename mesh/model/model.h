// The finite-element model as plain arrays. A Model is a value: copying it shares every chunk (see chunked_array.h).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "mesh/model/chunked_array.h"
#include "mesh/model/element_class.h"
#include "mesh/model/id_index.h"
#include "mesh/model/index.h"

namespace prismesh::mesh {

using Vec3 = Eigen::Vector3d;

struct Adjacency;       // mesh/model/adjacency.h
struct TopologyChange;  // mesh/model/topology_change.h

/// Corner nodes of a shell in the deck's order; a triangle repeats its third node.
struct ShellNodes {
  std::array<NodeIndex, 4> node;

  bool is_triangle() const { return node[3] == node[2]; }
  int corners() const { return is_triangle() ? 3 : 4; }
  bool operator==(const ShellNodes&) const = default;
};

/// Mid-side nodes of an 8-node (or 6-node) shell. They are kept and shown; metrics use the corners.
struct MidsideNodes {
  ShellIndex shell;
  std::array<NodeIndex, 4> node;  ///< between corner i and i+1; invalid where the element has none
};

/// All elements of one class other than shells: the nodes of element e are nodes[first_node[e] .. first_node[e+1]).
struct ElementBlock {
  std::vector<std::int64_t> id;
  std::vector<PartIndex> part;  ///< invalid where the card names no part
  std::vector<std::uint32_t> first_node{0};
  std::vector<NodeIndex> nodes;

  std::size_t size() const { return id.size(); }
};

/// A part with values of its section and material; absent values are unknown, not zero.
struct Part {
  std::int64_t id = 0;
  std::string name;
  bool defined = false;  ///< false: elements use the id, no *PART defines it
  std::optional<std::int64_t> section;
  std::optional<std::int64_t> material;
  std::optional<double> thickness;       ///< shell thickness of the section (mean of the corners), deck's length unit
  std::optional<double> density;         ///< deck's units
  std::optional<double> youngs_modulus;  ///< deck's units
  std::optional<double> poissons_ratio;
  bool limits_time_step = true;  ///< false for rigid and null materials
};

/// The deck's time step control: *CONTROL_TIMESTEP.
struct TimeStepControl {
  double scale = 0.9;      ///< TSSFAC
  int shell_option = 0;    ///< ISDO
  double mass_scaled = 0;  ///< DT2MS; < 0: mass is added
};

/// Why a node must not be moved; bits of Model::node_holds.
enum NodeHold : std::uint8_t {
  kHeldByParameter = 1,  ///< its coordinates are given by &parameters
  kHeldByInclude = 2,    ///< it is in an include that is transformed or used twice
  kHeldByMissing = 4,    ///< an element at it is left out, since another of the element's nodes isn't defined
  kHeldByFrame = 8,      ///< it defines a coordinate system that other nodes use, or its own system can't be computed
  kHeldByMaking = 16,    ///< it has no card: a card that generates many nodes made it (replication, generation)
  kHeldByRepeat = 32,    ///< it has two cards: its id is defined again
  kRemoved = 128,        ///< it was removed; its entry stays so that indices never change
};
/// Why a node with one of these bits can't be moved, as a predicate: "has coordinates given by a parameter".
std::string_view why_held(std::uint8_t hold);

/// Nodes, shells, other elements and parts, in the deck's order. Nodes that elements name but no card defines are not in the
/// arrays; an element with such a node is left out of the arrays. Removed nodes and shells keep their entries, but their ids are no longer
/// in the index (mesh/model/topology_change.h).
struct Model {
  ChunkedArray<std::int64_t> node_ids;
  ChunkedArray<Vec3> positions;           ///< deck's length unit
  ChunkedArray<std::uint8_t> node_holds;  ///< NodeHold bits
  ChunkedArray<std::int64_t> shell_ids;
  ChunkedArray<ShellNodes> shell_nodes;
  ChunkedArray<PartIndex> shell_parts;
  ChunkedArray<float> shell_thickness;                       ///< of the element's own card; 0 where the section's counts
  std::shared_ptr<const std::vector<MidsideNodes>> midside;  ///< ascending by shell; never null after loading
  std::array<std::shared_ptr<const ElementBlock>, kElementClassCount> elements;  ///< [shell] stays null; others never
  std::shared_ptr<const std::vector<Part>> parts;                                ///< ascending by id
  std::shared_ptr<const IdIndex> node_index;                                     ///< deck's id -> NodeIndex value
  std::shared_ptr<const IdIndex> shell_index;
  /// Shells whose id an earlier shell has, ascending by id: a quad and a triangle where the format numbers them apart. They aren't in
  /// shell_index. Null: none.
  std::shared_ptr<const std::vector<ShellIndex>> second_shells;
  std::shared_ptr<const Adjacency>
      adjacency;  ///< of the shells; built by build_adjacency; null after a topology change until it is built again
  std::shared_ptr<const TopologyChange> topology_change;  ///< what was added and removed since the deck was opened; null: nothing

  std::size_t node_count() const { return positions.size(); }
  std::size_t shell_count() const { return shell_nodes.size(); }
  const Vec3& position(NodeIndex node) const { return positions[node.value]; }
  const ShellNodes& shell(ShellIndex shell) const { return shell_nodes[shell.value]; }
  bool is_removed(NodeIndex node) const { return topology_change && (node_holds[node.value] & kRemoved) != 0; }
  bool is_removed(ShellIndex shell) const { return !shell_nodes[shell.value].node[0].valid(); }

  NodeIndex find_node(std::int64_t id) const { return NodeIndex(node_index->find(id)); }
  ShellIndex find_shell(std::int64_t id) const { return ShellIndex(shell_index->find(id)); }
  PartIndex find_part(std::int64_t id) const;
};

/// Returns the nodes of both models whose positions differ, ascending; added and removed nodes don't count. Cost: what differs, since
/// shared chunks are skipped.
std::vector<NodeIndex> moved_nodes(const Model& a, const Model& b);
/// The longest way of these nodes of both; 0 if there are none.
double largest_move(const Model& a, const Model& b, std::span<const NodeIndex> nodes);

}  // namespace prismesh::mesh
