// Flanges: bands along which sheets run parallel at a small distance. Found by mesh/connections/find_flanges.h.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "mesh/model/in_sight.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::connections {

/// Planes of neighbouring sheets differ by no more. In degrees.
inline constexpr double kMaxAngleOfFlange = 15;
/// A sharper edge within a sheet ends a flange. In degrees.
inline constexpr double kMaxCreaseOfFlange = 30;
/// Flanges of body parts are 12 to 25 mm wide at 0.6 to 2.5 mm; wider than this is a patch or a plate on a plate.
inline constexpr double kMaxWidthInThicknesses = 40;
/// A flange is at least this many times as long as wide; what is shorter is the foot of a bracket.
inline constexpr double kMinLengthInWidths = 1.5;
/// And as long as this many shells: what is shorter is where meshes of two flanges don't end alike.
inline constexpr double kMinLengthInShells = 3;
/// Sheets that go through each other along more of a band's length cross there.
inline constexpr double kMaxCrossingShare = 0.25;

/// Lengths are in the deck's unit.
struct FlangeOptions {
  /// Sheets are neighbours up to this share of the mean of their thicknesses. 1 would be faces that touch; the rest is room for decks whose
  /// flanges aren't drawn at their thickness.
  double thickness_factor = 2;
  double gap = 0;  ///< and farther by this. Where a thickness isn't known it counts as 0, so that a gap must be given.
  /// Wider bands are no flanges; absent: 40 times the mean of all their thicknesses and gap (kMaxWidthInThicknesses).
  std::optional<double> max_width;
  OutOfSight out_of_sight{};
};

struct Flange {
  std::vector<PartIndex> parts;  ///< one a sheet, from one face of the stack to the other; folds of a part have it several times
  ShellSet shells;               ///< of all sheets
  NodeSet nodes;
  std::vector<Vec3> middle;                ///< along the band; closed: its last point is its first
  std::array<std::vector<Vec3>, 2> sides;  ///< the band's edges, a point of each for each of `middle`
  bool closed = false;
  double length = 0;  ///< of `middle`
  double mean_width = 0;
  double min_width = 0;
  double distance = 0;  ///< mean, of the middle surfaces of neighbouring sheets

  std::size_t sheets() const { return parts.size(); }
  /// Half way along the band.
  const Vec3& centre() const { return middle[middle.size() / 2]; }
};

struct Flanges {
  std::vector<Flange> all;                   ///< the longest first
  std::vector<PartIndex> without_thickness;  ///< parts with a visible shell whose thickness isn't known, ascending
};

}  // namespace prismesh::mesh::connections
