#include "kiosk/tools/shaping/shaping_options.h"

#include <algorithm>

namespace prismesh::kiosk::tools::shaping {

using input::Under;
using mesh::Vec3;

Vec3 unit(DeckAxis axis) {
  switch (axis) {
    case DeckAxis::x: return Vec3::UnitX();
    case DeckAxis::y: return Vec3::UnitY();
    case DeckAxis::z: return Vec3::UnitZ();
    case DeckAxis::none: break;
  }
  return Vec3::Zero();
}

void turn_rigid(ShapingOptions& options) {
  const bool was_rigid = is_rigid(options);
  if (!was_rigid) options.before_rigid = options.profile;
  options.profile = was_rigid ? options.before_rigid : mesh::shape::Profile::constant;
}

DeckAxis next(DeckAxis axis) { return static_cast<DeckAxis>((static_cast<int>(axis) + 1) % 4); }

ShapingOptions for_another_deck(ShapingOptions options) {
  if (std::find(kDeckAxisNames.begin(), kDeckAxisNames.end(), options.along.what) == kDeckAxisNames.end()) options.along = {};
  options.max_move.reset();
  options.symmetry_place.reset();
  return options;
}

std::string_view name_of(mesh::shape::FreeEnds ends) {
  switch (ends) {
    case mesh::shape::FreeEnds::rigid: return "follow whole";
    case mesh::shape::FreeEnds::weighted: return "follow by distance";
    case mesh::shape::FreeEnds::held: break;
  }
  return "hold";
}

mesh::shape::FreeEnds next(mesh::shape::FreeEnds ends) { return static_cast<mesh::shape::FreeEnds>((static_cast<int>(ends) + 2) % 3); }

mesh::document::Shaping shaping_of(const ShapingOptions& options, const ShapedHandle& shaped) {
  mesh::document::Shaping shaping;
  shaping.grab = shaped.grab;
  shaping.weights.falloff.profile = options.profile;
  shaping.weights.falloff.flat = options.flat;
  if (!options.along.in_all()) shaping.weights.falloff.along = options.along.direction;
  shaping.weights.free_ends = options.free_ends;
  shaping.weights.origin = options.origin;
  shaping.weights.across_welds = options.across_welds;
  shaping.max_move = options.max_move;
  if (options.keep_apart) shaping.contact = mesh::document::ContactRule::keep_apart;
  if (options.symmetry != DeckAxis::none) {
    const Vec3 normal = unit(options.symmetry);
    shaping.symmetry = mesh::document::Symmetry{normal * options.symmetry_place.value_or(shaped.middle.dot(normal)), normal};
  }
  return shaping;
}

mesh::document::Edit edit_of(const ShapedHandle& shaped, const ShapingOptions& options, const Pull& displacement) {
  const mesh::document::Shaping shaping = shaping_of(options, shaped);
  if (shaped.handle == Under::turn_handle && shaped.axis)
    return mesh::document::Rotate{shaped.axis->point, shaped.axis->direction, displacement.degrees, shaping};
  if (shaped.handle == Under::slide_handle) return mesh::document::Slide{displacement.by, shaping};
  if (shaped.handle == Under::move_handle) return mesh::document::Translate{displacement.by, shaping};
  return mesh::document::Lift{displacement.distance, options.each_normal, shaping};
}

std::string_view name_of(Under handle) {
  switch (handle) {
    case Under::slide_handle: return "Slide";
    case Under::move_handle: return "Move";
    case Under::turn_handle: return "Turn";
    default: return "Lift";
  }
}

}  // namespace prismesh::kiosk::tools::shaping
