// Lays a strip of hexahedra between the two sheets of a flange. Rules: docs/bonds.md.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/connections/flange.h"
#include "mesh/connections/weld_spots.h"
#include "mesh/model/model.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::connections {

/// Lengths are in the deck's unit.
struct BondShape {
  double width = 0;          ///< across the flange, above 0
  double length = 0;         ///< of a hexahedron along the flange, about; above 0
  double end_distance = 0;   ///< of the strip from the ends of a flange that isn't closed; less than half its length
  double gap = 0;            ///< as FlangeOptions
  bool from_middle = false;  ///< corners lie on the middle surfaces instead of the sheets' faces
};

/// A corner of hexahedra.
struct BondCorner {
  SheetAtSpot sheet;          ///< the place on its middle surface
  Vec3 point = Vec3::Zero();  ///< half a thickness towards the other sheet, or the same place
};

enum class NoBond : std::uint8_t {
  off_sheets,   ///< a corner doesn't lie between the two sheets
  no_room,      ///< the sheets' faces touch or go through each other
  turned_over,  ///< a corner of the hexahedron would have no positive volume
};
/// A hexahedron that isn't made.
struct BondLeft {
  Vec3 at = Vec3::Zero();
  NoBond why = NoBond::off_sheets;
};

struct BondStrip {
  std::vector<BondCorner> corners;  ///< those that hexahedra use
  /// Indices into `corners`: four on one sheet, counterclockwise as seen from the other one, then those opposite to them.
  std::vector<std::array<std::uint32_t, 8>> solids;
  std::vector<BondLeft> left;
  double thinnest = 0;  ///< the least distance of opposite corners, and the greatest
  double thickest = 0;
};

/// `tree`: of the model, with the shells of the flange's sheets only. Precondition: the flange has two sheets and a length.
BondStrip lay_strip(const Model& model, const spatial::BoxTree& tree, const Flange& flange, const BondShape& shape);

/// Turns the hexahedra over: those on the one sheet and those on the other change places, and each stays right-handed.
void turn_over(BondStrip& strip);

/// The least of the volumes that the three edges at each corner of a hexahedron span: above 0 if it is right-handed and not folded.
double least_corner_volume(const std::array<Vec3, 8>& corners);

}  // namespace prismesh::mesh::connections
