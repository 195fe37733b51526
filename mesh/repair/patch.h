// A piece of a model that can be changed and changed back: the shells of a scope and some rings about them, with connectivity of their own
// that follows every change and takes any number of shells an edge. Costs what it holds; the model stays as it is.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/model/topology_change.h"
#include "mesh/quality/sheet.h"
#include "mesh/quality/shell_state.h"
#include "mesh/relax/freedom.h"
#include "mesh/repair/restructuring.h"
#include "mesh/repair/rules.h"

namespace prismesh::mesh::repair {

using LocalNode = Index<struct LocalNodeTag>;
using LocalShell = Index<struct LocalShellTag>;
using Corners = std::array<LocalNode, 4>;  ///< in a shell's order; a triangle repeats its third

inline int corner_count(const Corners& corners) { return corners[3] == corners[2] ? 3 : 4; }
inline Corners triangle(LocalNode a, LocalNode b, LocalNode c) { return {a, b, c, c}; }

/// A neighbour along an edge that has to stay an edge: free, crease, junction, between parts, or at the patch's rim.
struct LineEnd {
  LocalNode node;
  std::uint8_t shells = 0;  ///< how many the edge has, and keeps
  bool is_rim = false;      ///< shells outside of the patch may have it: nothing can be done to it
};

struct PatchNode {
  Vec3 position = Vec3::Zero();
  NodeIndex model;                  ///< invalid: a new one
  std::array<LocalNode, 4> parent;  ///< of a new one; those in use first
  std::array<double, 4> weight{};   ///< of each parent
  std::vector<LocalShell> shells;   ///< ascending
  std::vector<LineEnd> lines;       ///< ascending by node
  relax::Freedom freedom = relax::Freedom::surface;
  std::uint8_t rules = 0;  ///< NodeRule bits
  bool is_whole = true;    ///< all its shells are in the patch; of others nothing is changed
  bool is_alive = true;
  bool is_off_surface = false;  ///< moved along the normal on purpose
};

struct PatchShell {
  Corners corners;
  ShellIndex model;   ///< invalid: a new one
  ShellIndex parent;  ///< of the model: itself, or what a new one comes from
  PartIndex part;
  quality::Sheet sheet;
  std::uint8_t rules = 0;  ///< ShellRule bits
  bool is_alive = true;
  float composite = 1;
  quality::ShellState state;
};

class Patch {
 public:
  /// Shells of `scope` and `rings` about them.
  Patch(const Model& model, const ShellSet& scope, int rings, const Rules& rules, double feature_angle);

  std::size_t node_count() const { return nodes_.size(); }
  std::size_t shell_count() const { return shells_.size(); }
  const PatchNode& node(LocalNode node) const { return nodes_[node.value]; }
  const PatchShell& shell(LocalShell shell) const { return shells_[shell.value]; }
  const Vec3& position(LocalNode node) const { return nodes_[node.value].position; }
  LocalNode find(NodeIndex node) const;  ///< invalid: not in the patch
  LocalShell find(ShellIndex shell) const;
  const Model& model() const { return *model_; }

  /// The line that an edge is part of; null: it is inside a sheet.
  const LineEnd* line(LocalNode a, LocalNode b) const;
  /// The live shells with an edge between two nodes, ascending.
  std::vector<LocalShell> shells_at(LocalNode a, LocalNode b) const;
  bool may_divide(LocalNode a, LocalNode b) const;

  // Changes since `begin` are kept by `keep` or taken back by `take_back`.
  void begin();
  void keep();
  void take_back();

  LocalNode add_node(const Vec3& position, std::span<const LocalNode> parents, std::span<const double> weights, relax::Freedom freedom);
  LocalShell add_shell(const Corners& corners, LocalShell like);
  void set_corners(LocalShell shell, const Corners& corners);
  void remove_shell(LocalShell shell);
  void remove_node(LocalNode node);  ///< of no shell any more
  void move(LocalNode node, const Vec3& position, bool off_surface = false);
  void set_judged(LocalShell shell, float composite, quality::ShellState state);
  /// The edge a-b, a line, becomes a-middle-b.
  void divide_line(LocalNode a, LocalNode b, LocalNode middle);
  /// The lines a-middle and middle-b, of one kind, become a-b.
  void join_lines(LocalNode a, LocalNode middle, LocalNode b);

  /// What has been changed since `begin`: live shells that are new, have other corners or corners elsewhere; and those that were there
  /// before, as they were.
  std::vector<LocalShell> changed_shells() const;
  const std::vector<std::pair<LocalShell, PatchShell>>& old_shells() const { return old_shells_; }
  std::vector<LocalNode> changed_nodes() const;
  /// Where a node was at `begin`.
  const Vec3& old_position(LocalNode node) const;
  bool is_new_since_begin(LocalShell shell) const { return shell.value >= shells_at_begin_; }

  /// The net result. `index_of`: if given, the index that each live shell gets, by local shell.
  Restructuring result(std::vector<ShellIndex>* index_of = nullptr) const;
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
  std::vector<std::uint32_t> node_saved_, shell_saved_;  ///< the change in which it was saved
  std::vector<std::uint32_t> node_place_;                ///< in old_nodes_
  std::uint32_t change_ = 0;
  std::size_t nodes_at_begin_ = 0, shells_at_begin_ = 0;
};

}  // namespace prismesh::mesh::repair
