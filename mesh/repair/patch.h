// A part of a model that can be changed and restored: the shells of a scope and some rings about them, with a connectivity of its own that
// follows every change. An edge may have any number of shells. Costs what it holds; the model stays as it is.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/model/topology_change.h"
#include "mesh/quality/shell_properties.h"
#include "mesh/quality/shell_state.h"
#include "mesh/relax/freedom.h"
#include "mesh/repair/restructuring.h"
#include "mesh/repair/rules.h"

namespace prismesh::mesh::repair {

using LocalNode = Index<struct LocalNodeTag>;
using LocalShell = Index<struct LocalShellTag>;
using Corners = std::array<LocalNode, 4>;  ///< in the shell's order; a triangle repeats its third

inline int corner_count(const Corners& corners) { return corners[3] == corners[2] ? 3 : 4; }
inline Corners triangle(LocalNode a, LocalNode b, LocalNode c) { return {a, b, c, c}; }

/// The other end of an edge that must stay an edge: free, crease, junction, between parts, or at the patch's rim.
struct LineEnd {
  LocalNode node;
  std::uint8_t shells = 0;  ///< number of shells at the edge, which must not change
  bool is_rim = false;      ///< shells outside of the patch may have the edge: it can't be changed
};

struct PatchNode {
  Vec3 position = Vec3::Zero();
  NodeIndex model;                  ///< invalid: a new node
  std::array<LocalNode, 4> parent;  ///< of a new node; valid ones first
  std::array<double, 4> weight{};   ///< of each parent
  std::vector<LocalShell> shells;   ///< ascending
  std::vector<LineEnd> lines;       ///< ascending by node
  relax::Freedom freedom = relax::Freedom::surface;
  std::uint8_t rules = 0;  ///< NodeRule bits
  bool is_whole = true;    ///< all its shells are in the patch; shells at other nodes aren't changed
  bool is_alive = true;
  bool is_off_surface = false;  ///< moved along the surface's normal by an operation
};

struct PatchShell {
  Corners corners;
  ShellIndex model;   ///< invalid: a new one
  ShellIndex parent;  ///< of the model: the shell itself, or the one that a new shell comes from
  PartIndex part;
  quality::ShellProperties properties;
  std::uint8_t rules = 0;  ///< ShellRule bits
  bool is_alive = true;
  float composite = 1;
  quality::ShellState state;
};

/// The kept changes of a patch, as changes of its model.
struct PatchResult {
  Restructuring change;
  std::vector<ShellIndex> shell_index;  ///< that each live shell gets, by local shell
  std::vector<NodeIndex> node_index;    ///< the same for nodes
};

class Patch {
 public:
  /// Takes the shells of `scope` and `rings` rings about them. `feature_angle` in degrees. `model` and `rules` must outlive it.
  Patch(const Model& model, const ShellSet& scope, int rings, const Rules& rules, double feature_angle);

  std::size_t node_count() const { return nodes_.size(); }
  std::size_t shell_count() const { return shells_.size(); }
  const PatchNode& node(LocalNode node) const { return nodes_[node.value]; }
  const PatchShell& shell(LocalShell shell) const { return shells_[shell.value]; }
  const Vec3& position(LocalNode node) const { return nodes_[node.value].position; }
  LocalNode find(NodeIndex node) const;  ///< invalid: not in the patch
  LocalShell find(ShellIndex shell) const;
  const Model& model() const { return *model_; }

  /// The line that an edge is on, as seen from `a`; null: the edge is inside a sheet.
  const LineEnd* line(LocalNode a, LocalNode b) const;
  /// The live shells with an edge between two nodes, ascending.
  std::vector<LocalShell> shells_at(LocalNode a, LocalNode b) const;
  /// Whether two shells may be divided anew together.
  bool may_exchange(LocalShell a, LocalShell b) const;
  /// Whether a new node may be put between two nodes.
  bool may_divide(LocalNode a, LocalNode b) const;

  // A change starts with `begin` and ends with `keep` or `take_back`, which restores the patch.
  void begin();
  void keep();
  void take_back();

  LocalNode add_node(const Vec3& position, std::span<const LocalNode> parents, std::span<const double> weights, relax::Freedom freedom);
  LocalShell add_shell(const Corners& corners, LocalShell like);
  void set_corners(LocalShell shell, const Corners& corners);
  void remove_shell(LocalShell shell);
  void remove_node(LocalNode node);  ///< one that no shell has any more
  void move(LocalNode node, const Vec3& position, bool off_surface = false);
  void set_judged(LocalShell shell, float composite, quality::ShellState state);
  /// The edge a-b, a line, becomes a-middle-b.
  void divide_line(LocalNode a, LocalNode b, LocalNode middle);
  /// The lines a-middle and middle-b, of one kind, become a-b.
  void join_lines(LocalNode a, LocalNode middle, LocalNode b);

  /// The change since `begin`: live shells that are new, have other corners or moved ones; and the shells before, as they were.
  std::vector<LocalShell> changed_shells() const;
  const std::vector<std::pair<LocalShell, PatchShell>>& old_shells() const { return old_shells_; }
  std::vector<LocalNode> changed_nodes() const;
  /// Where a node was at `begin`.
  const Vec3& old_position(LocalNode node) const;
  bool is_new_since_begin(LocalShell shell) const { return shell.value >= shells_at_begin_; }

  /// All kept changes, as changes of the model.
  PatchResult result() const;
  /// The patch as a small model with adjacency: its node i is the patch's node i, its shells the live ones in order (`shells_of_model`).
  Model as_model(std::vector<LocalShell>& shells_of_model) const;

 private:
  PatchNode& own(LocalNode node);
  PatchShell& own(LocalShell shell);
  void load_nodes(const NodeSet& nodes, const Rules& rules, double feature_angle);
  void load_shells(const ShellSet& shells, const Rules& rules);
  void load_lines(double feature_angle);
  void link(LocalShell shell);
  void unlink(LocalShell shell);

  const Model* model_;
  const Rules* rules_;
  std::vector<PatchNode> nodes_;
  std::vector<PatchShell> shells_;
  NodeSet model_nodes_;    ///< of the first nodes_, ascending
  ShellSet model_shells_;  ///< of the first shells_, ascending

  std::vector<std::pair<LocalNode, PatchNode>> old_nodes_;
  std::vector<std::pair<LocalShell, PatchShell>> old_shells_;
  std::vector<std::uint32_t> node_saved_, shell_saved_;  ///< number of the change in which each was saved
  std::vector<std::uint32_t> node_place_;                ///< index of each in old_nodes_
  std::uint32_t change_ = 0;
  std::size_t nodes_at_begin_ = 0, shells_at_begin_ = 0;
};

}  // namespace prismesh::mesh::repair
