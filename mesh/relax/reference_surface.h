// The surface that a mesh represents, as it was when the mesh was last shaped: smooth between nodes, sharp at features. It is constant:
// relaxing and repairing move the mesh over it. docs/relaxing.md says how it is interpolated and how far it is from known surfaces.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/relax/freedom.h"

namespace prismesh::mesh::relax {

/// A point on the surface.
struct OnSurface {
  ShellIndex shell;            ///< of the surface's model
  Vec3 point = Vec3::Zero();   ///< on the smooth surface
  Vec3 normal = Vec3::Zero();  ///< unit, of the smooth surface; on the side of the shell's normal
  double distance = 0;         ///< from the given point
  double size = 0;             ///< mean length of the reference's edges about it
};

/// A point on a feature line, between the ends of a feature edge of the surface's model.
struct OnLine {
  NodeIndex from;
  NodeIndex to;
  Vec3 point = Vec3::Zero();    ///< on the smooth curve
  Vec3 tangent = Vec3::Zero();  ///< unit, from `from` to `to`
  double distance = 0;          ///< from the given point
  double size = 0;              ///< as in OnSurface
};

/// Computes local fits when they are first used: construction costs next to nothing, the first query at a node some 5 us, a later one below
/// 1 us. Thread-safe; the results are the same bits whatever the order of queries. Interpolation: weighted averaging of fitting
/// [Jiao 2012].
class ReferenceSurface {
 public:
  /// Makes the surface of `shells` of a model with adjacency, with as much of their neighbours as is needed. Features are edges sharper
  /// than `feature_angle` (degrees), free edges and junctions: nothing is smoothed across them. Borders between parts are feature lines
  /// too, but the surface may be smooth across them.
  ReferenceSurface(const Model& model, const ShellSet& shells, double feature_angle);
  ~ReferenceSurface();
  ReferenceSurface(ReferenceSurface&&) noexcept;
  ReferenceSurface& operator=(ReferenceSurface&&) noexcept;

  /// The nearest point of the surface. `toward`: a normal; shells whose normal is more than 60 degrees off it are skipped, so that a node
  /// isn't put on another sheet that meets its own. Nothing if there is no point within `radius`.
  std::optional<OnSurface> project(const Vec3& point, double radius, const std::optional<Vec3>& toward = std::nullopt) const;
  /// The nearest point on the feature lines, which are smooth curves through their nodes but keep corners. Nothing if there is none within
  /// `radius`.
  std::optional<Vec3> project_on_line(const Vec3& point, double radius) const;
  /// The same with its feature edge. Cost: the shells within `radius`, so keep it small.
  std::optional<OnLine> find_line(const Vec3& point, double radius) const;

  /// The nearest point that a descent from a shell finds over smooth edges only: it stays on the shell's sheet. `from`: any shell of the
  /// model.
  OnSurface follow(ShellIndex from, const Vec3& point) const;
  /// The nearest point that a walk along a feature line finds, from one of its edges and not beyond corners.
  OnLine follow_line(NodeIndex from, NodeIndex to, const Vec3& point) const;

  /// The other ends of the feature edges at a node, ascending; at most three.
  std::vector<NodeIndex> lines_at(NodeIndex node) const;

  /// The freedom of a node of the surface's model. Quick inside a sheet.
  Freedom freedom_at(NodeIndex node) const;

  const Model& model() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prismesh::mesh::relax
