// The surface that a mesh stands for, as it was when it was last shaped: smooth between its nodes, sharp at its features. Frozen: relaxing
// and repairing move the mesh over it, never it. docs/relaxing.md says how it is interpolated and how far it is from known surfaces.
#pragma once

#include <memory>
#include <optional>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::relax {

/// A place on the surface.
struct OnSurface {
  ShellIndex shell;            ///< of the model the surface was made of
  Vec3 point = Vec3::Zero();   ///< on the smooth surface
  Vec3 normal = Vec3::Zero();  ///< unit, of the smooth surface; its sign is the shell's
  double distance = 0;         ///< from the point asked for
};

class ReferenceSurface {
 public:
  /// The surface about `shells` of a model with adjacency: they and what is needed of their neighbours. Features are edges sharper than
  /// `feature_angle` (degrees), free edges and junctions: the surface has a kink there, and nothing is smoothed across them.
  ReferenceSurface(const Model& model, const ShellSet& shells, double feature_angle);
  ~ReferenceSurface();
  ReferenceSurface(ReferenceSurface&&) noexcept;
  ReferenceSurface& operator=(ReferenceSurface&&) noexcept;

  /// The nearest place. `toward`: a normal; shells whose normal is more than 90 degrees off it (either sign) aren't taken, so that a node
  /// of one sheet doesn't land on the one beside it. Nothing if there is none within `radius`.
  std::optional<OnSurface> project(const Vec3& point, double radius, const std::optional<Vec3>& toward = std::nullopt) const;
  /// The nearest place on the feature lines (smooth curves through their nodes, corners kept). Nothing if there is none within `radius`.
  std::optional<Vec3> project_on_line(const Vec3& point, double radius) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace prismesh::mesh::relax
