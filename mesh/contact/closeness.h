// Two shells that are too close, and what decides it.
#pragma once

#include "mesh/model/model.h"

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

}  // namespace prismesh::mesh::contact
