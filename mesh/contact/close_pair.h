// Measures how close one shell is to others. Private to mesh/contact.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "mesh/contact/closeness.h"
#include "mesh/contact/contact_thickness.h"
#include "mesh/contact/triangle_crossing.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::contact {

/// The triangles of a shell that have an area, from an origin near it: so the result doesn't depend on where the model is.
struct OwnTriangles {
  std::array<Triangle, 2> at;
  std::array<Vec3, 2> normal;  ///< of length 1
  std::size_t count = 0;
};

/// One shell beside others. Model and thickness must outlive it. Precondition: the model has its adjacency.
class CloseTo {
 public:
  CloseTo(const Model& model, const ContactThickness& thickness, double gap, ShellIndex shell)
      : model_(model), thickness_(thickness), gap_(gap), shell_(shell) {}

  /// The distance at which the shell and another one are too close.
  double reach(ShellIndex other) const { return (1 - kMinDepthShare) * mean_thickness(other) + gap_; }
  /// Measures another shell; nothing if it isn't too close, or lies beside. Precondition: both have a thickness and no common node.
  std::optional<CloseShells> pair(ShellIndex other) { return pair(other, mean_thickness(other), reach(other)); }
  /// Of the pairs from `first` on, which are of this shell: leaves out its neighbours in its sheet. The others become ascending.
  void leave_out_neighbours(std::vector<CloseShells>& found, std::size_t first) const;

 private:
  double mean_thickness(ShellIndex other) const { return thickness_.between(shell_, other); }
  std::optional<CloseShells> pair(ShellIndex other, double mean_thickness, double reach);

  const Model& model_;
  const ContactThickness& thickness_;
  double gap_;
  ShellIndex shell_;
  Vec3 origin_ = Vec3::Zero();
  std::optional<OwnTriangles> own_;  ///< made when first needed
};

}  // namespace prismesh::mesh::contact
