// The surface that a mesh stands for, as it was when it was last shaped: smooth between its nodes, sharp at its features. Frozen: relaxing
// and repairing move the mesh over it, never it. docs/relaxing.md says how it is interpolated and how far it is from known surfaces.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/relax/freedom.h"

namespace prismesh::mesh::relax {

/// A place on the surface.
struct OnSurface {
  ShellIndex shell;            ///< of the model the surface was made of
  Vec3 point = Vec3::Zero();   ///< on the smooth surface
  Vec3 normal = Vec3::Zero();  ///< unit, of the smooth surface; its sign is the shell's
  double distance = 0;         ///< from the point asked for
  double size = 0;             ///< mean length of the reference's edges about it
};

/// A place on a feature line: between two nodes that a feature edge joins, of the model the surface was made of.
struct OnLine {
  NodeIndex from;
  NodeIndex to;
  Vec3 point = Vec3::Zero();    ///< on the smooth curve
  Vec3 tangent = Vec3::Zero();  ///< unit, from `from` to `to`
  double distance = 0;          ///< from the point asked for
  double size = 0;              ///< as of OnSurface
};

/// Nothing is worked out before it is asked for, and then once: making one costs next to nothing, asking first costs some 5 us a node,
/// asking again below 1 us. May be asked by several threads at once; the answers are the same bits whoever asked what before.
class ReferenceSurface {
 public:
  /// The surface about `shells` of a model with adjacency: they and what is needed of their neighbours. Features are edges sharper than
  /// `feature_angle` (degrees), free edges and junctions: the surface has a kink there, and nothing is smoothed across them. Borders
  /// between parts are feature lines too, but a surface that is smooth there stays smooth.
  ReferenceSurface(const Model& model, const ShellSet& shells, double feature_angle);
  ~ReferenceSurface();
  ReferenceSurface(ReferenceSurface&&) noexcept;
  ReferenceSurface& operator=(ReferenceSurface&&) noexcept;

  /// The nearest place. `toward`: a normal; shells whose plane leans more than 60 degrees off the one square to it aren't taken, so that
  /// a node of one sheet doesn't land on the one that it meets. Nothing if there is none within `radius`.
  std::optional<OnSurface> project(const Vec3& point, double radius, const std::optional<Vec3>& toward = std::nullopt) const;
  /// The nearest place on the feature lines (smooth curves through their nodes, corners kept). Nothing if there is none within `radius`.
  std::optional<Vec3> project_on_line(const Vec3& point, double radius) const;
  /// The same with its feature edge. Costs the shells within `radius`, which is best kept small.
  std::optional<OnLine> find_line(const Vec3& point, double radius) const;

  /// The nearest place that a walk from a shell leads to, over smooth edges only: it stays on its sheet. Any shell of the model.
  OnSurface follow(ShellIndex from, const Vec3& point) const;
  /// The nearest place that a walk along a feature line leads to, from one of its edges and not beyond corners.
  OnLine follow_line(NodeIndex from, NodeIndex to, const Vec3& point) const;

  /// The other ends of the feature edges at a node, ascending; of more than three only three.
  std::vector<NodeIndex> lines_at(NodeIndex node) const;

  /// The freedom of a node of the model that it was made of. Quick inside a sheet.
  Freedom freedom_at(NodeIndex node) const;

  const Model& model() const;  ///< that it was made of

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace prismesh::mesh::relax
