// The handle of a selection: where its arrow stands before anyone pulls it, and how far the pointer pulls it.
#pragma once

#include <cstdint>
#include <optional>

#include "kiosk/input/gestures.h"
#include "kiosk/render/model_source.h"
#include "kiosk/render/picture.h"
#include "kiosk/stereo/pointer.h"

namespace prismesh::kiosk::tools::shaping {

using mesh::Vec3;

/// The node by which a selection is taken, deck coordinates.
struct Anchor {
  mesh::NodeIndex node;
  std::int64_t id = 0;
  Vec3 at = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  ///< unit; the sense of the first shell at the node
  bool operator==(const Anchor&) const = default;
};

/// The anchor of the model's selection: `preferred` if it is selected, else the selected node nearest to the selection's centre.
/// Nothing if no node is selected. Costs a pass over the marks, and over the shells' nodes for the normal.
std::optional<Anchor> anchor_of_selection(const render::ModelSource& model, std::optional<mesh::NodeIndex> preferred);

/// Which part of a handle a pixel is on: the ring about its foot, its arrow, the disk, or (picture) none of them. An arrow that points at
/// the viewer stands in the ring and goes first. A handle with an axis has the ball and its circle only.
input::Under part_of_handle(const stereo::Aim& aim, const render::Handle& handle, const input::Pixel& pixel);
inline constexpr double kRingRadiusPixels = render::kHandleRingPixels;

/// The arrow's direction: along the normal, on the viewer's side of the surface, so that the model never hides it.
Vec3 arrow_direction(const stereo::Aim& aim, const Anchor& anchor);

/// An axis to turn about, deck coordinates.
struct Axis {
  Vec3 point = Vec3::Zero();
  Vec3 direction = Vec3::UnitZ();  ///< unit
  bool operator==(const Axis&) const = default;
};

/// Where the ball of an axis stands: at the grab, unless that is so near to the axis that nobody could turn it; then beside it, as seen
/// from here, as far as the arrow is long.
Vec3 ball_place(const stereo::Aim& aim, const Axis& axis, const Vec3& at);

/// How far a handle has been pulled, in the deck's length unit and degrees: what an edit of the handle's kind takes.
using Pull = mesh::document::Displacement;

/// A part of a handle, where and how it is taken.
struct HandleGrab {
  input::Under handle = input::Under::lift_handle;
  Vec3 at = Vec3::Zero();                     ///< the handle's foot, deck coordinates
  Vec3 direction = Vec3::UnitZ();             ///< of the arrow, unit
  std::optional<Axis> axis{};                 ///< needed by the turning handle only
  input::Pixel pixel = input::Pixel::Zero();  ///< of the pointer
};

/// One pull, from taking the handle to letting it go. The view may change meanwhile (see `hold`).
class HandlePull {
 public:
  HandlePull(const HandleGrab& grab, const stereo::Aim& aim);
  /// Where the pointer brings it; `before` is where it was, so that a turn may go round more than once.
  Pull at(const stereo::Aim& aim, const input::Pixel& pixel, const Pull& before = {}) const;
  /// The view has changed: from now on this pixel means this pull.
  void hold(const stereo::Aim& aim, const input::Pixel& pixel, const Pull& pull);
  /// Where a pull has brought the handle's foot.
  Vec3 foot(const Pull& pull) const;
  /// The lift as the hand sees it: positive where the arrow points.
  double along_arrow(const Pull& pull) const { return sense_ * pull.distance; }
  /// The lift that takes it so far along the arrow.
  double lift_of(double along_arrow) const { return sense_ * along_arrow; }
  /// The grab and the unit normal that the model server works with; the normal's sense may differ from the arrow's.
  void set_axis(const stereo::Aim& aim, const Vec3& at, const Vec3& normal);

  input::Under handle() const { return handle_; }
  const Vec3& start() const { return start_; }
  const Vec3& direction() const { return direction_; }
  const std::optional<Axis>& axis() const { return axis_; }

 private:
  /// What the pointer points at, in the way this handle reads it, without regard to where it was taken.
  Pull raw(const stereo::Aim& aim, const input::Pixel& pixel) const;
  Vec3 on_disk(const stereo::Aim& aim, const input::Pixel& pixel) const;
  double along(const stereo::Aim& aim, const input::Pixel& pixel) const;
  double degrees(const stereo::Aim& aim, const input::Pixel& pixel) const;

  input::Under handle_;
  Vec3 start_;
  Vec3 direction_;
  std::optional<Axis> axis_;
  input::Pixel taken_;
  double sense_ = 1;       ///< of the normal against the arrow
  bool upward_ = false;    ///< the arrow points at the viewer since the pixel was last held
  bool sideways_ = false;  ///< the disk or the circle is seen from its edge
  Pull when_taken_;        ///< raw
  Pull held_;              ///< the pull that it stood for
};

}  // namespace prismesh::kiosk::tools::shaping
