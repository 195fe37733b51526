// Finds the pairs of shells that are too close to each other.
#pragma once

#include <vector>

#include "mesh/contact/contact_thickness.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::contact {

/// Depths up to this share of the mean of both thicknesses don't count, nor do gaps up to it: decks have rounded coordinates and
/// thicknesses, and flat flanges that touch are exactly a thickness apart.
inline constexpr double kMinDepthShare = 0.01;
/// A shell faces a direction within 60 degrees of its normal: the cosine.
inline constexpr double kMinCosOfFacing = 0.5;
/// Shells whose planes differ by more than 30 degrees stand on each other: the cosine.
inline constexpr double kMaxCosOfStanding = 0.86602540378443865;
/// Shells with a shorter path over their sheet than this many times their least distance are neighbours.
inline constexpr double kMinPathInLeastDistances = 4;

/// Two shells that are too close. Their least distance is the mean of their thicknesses, and the gap.
struct CloseShells {
  ShellIndex a, b;                                ///< a < b
  double distance = 0;                            ///< of the middle surfaces
  double depth = 0;                               ///< least distance less distance
  Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();  ///< the nearest points
  bool stand = false;                             ///< their planes differ by more than 30 degrees
  bool touch_at_edge = false;                     ///< a free edge of one lies on the other: a T-junction or a seam
};

/// Returns all pairs of shells without a common node that are too close, ascending, on all cores; the same whatever their number. A quad
/// counts as its two triangles. Left out: shells without a thickness or an area, triangles with a corner that isn't finite; pairs beside
/// each other, of which neither faces the other and the planes are alike, as at a seam; neighbours in a sheet. Shells that cross are too
/// close, too. The distance is that of points and triangles both ways and of edges, in doubles from the corners' differences: right to some
/// 1e-15 of the shells' size, but for triangles whose height is below 1e-8 of their length. `among`: only pairs of these shells (ascending;
/// null: of all); costs these alone. Preconditions: the model has its adjacency; the tree is that of the model; the gap is finite, at
/// least 0.
std::vector<CloseShells> find_close_shells(const Model& model, const spatial::BoxTree& tree, const ContactThickness& thickness, double gap,
                                           const ShellSet* among = nullptr);

}  // namespace prismesh::mesh::contact
