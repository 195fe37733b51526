// How pulls fade out and what goes with them: what the hand sets beside the pull itself. Plain data, and how it becomes an edit.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "kiosk/input/gestures.h"
#include "kiosk/tools/shaping/handle.h"
#include "mesh/document/edit.h"

namespace prismesh::kiosk::tools::shaping {

/// None, or one of the deck's axes.
enum class DeckAxis : std::uint8_t { none, x, y, z };
inline constexpr std::array<std::string_view, 4> kDeckAxisNames{"none", "x", "y", "z"};
mesh::Vec3 unit(DeckAxis axis);  ///< zero for none
DeckAxis next(DeckAxis axis);

/// The direction along which alone a pull falls off.
struct FalloffDirection {
  std::string what = "all ways";              ///< for a person: "x", "two nodes", "view's right"
  mesh::Vec3 direction = mesh::Vec3::Zero();  ///< a unit vector in the deck's axes; zero: in all directions
  bool in_all() const { return direction.isZero(); }
  bool operator==(const FalloffDirection&) const = default;
};

/// What free edges do, in words: "follow whole", "follow by distance", "hold".
std::string_view name_of(mesh::shape::FreeEnds ends);
mesh::shape::FreeEnds next(mesh::shape::FreeEnds ends);

struct ShapingOptions {
  mesh::shape::Profile profile = mesh::shape::Profile::smooth;
  mesh::shape::Profile before_rigid = mesh::shape::Profile::smooth;  ///< the profile that comes back after a rigid pull
  double flat = 0;                                                   ///< 0..1
  FalloffDirection along;
  mesh::shape::FreeEnds free_ends = mesh::shape::FreeEnds::rigid;
  mesh::shape::Origin origin = mesh::shape::Origin::grab;
  bool across_welds = false;
  bool each_normal = false;  ///< of a lift
  bool keep_apart = false;   ///< pulls stop before they make shells touch
  std::optional<double> max_move;
  DeckAxis symmetry = DeckAxis::none;    ///< the plane's normal
  std::optional<double> symmetry_place;  ///< where the plane cuts that axis; empty: at the middle of the selection when the edit begins
  bool operator==(const ShapingOptions&) const = default;
};
/// All selected nodes move alike.
inline bool is_rigid(const ShapingOptions& options) { return options.profile == mesh::shape::Profile::constant; }
/// Makes pulls rigid, or gives them the last falloff back.
void turn_rigid(ShapingOptions& options);
inline constexpr double kFlatStep = 0.1;

/// What is left of the options when another deck is opened: nothing that was picked on the old one or is a length or a place in it.
ShapingOptions for_another_deck(ShapingOptions options);

/// A part of the handle, and what it pulls.
struct ShapedHandle {
  input::Under handle = input::Under::lift_handle;
  std::int64_t grab = 0;                   ///< id of the handle's node
  mesh::Vec3 middle = mesh::Vec3::Zero();  ///< of the selection, for a mirror without a place of its own
  std::optional<Axis> axis{};              ///< of the turning handle
};

/// How its edits fall off, and their limits and mirror.
mesh::document::Shaping shaping_of(const ShapingOptions& options, const ShapedHandle& shaped);

/// The edit that a part of the handle makes at a displacement.
mesh::document::Edit edit_of(const ShapedHandle& shaped, const ShapingOptions& options, const Pull& displacement);

/// "Lift", "Slide", "Move", "Turn".
std::string_view name_of(input::Under handle);

}  // namespace prismesh::kiosk::tools::shaping
