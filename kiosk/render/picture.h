// A picture: all that it depends on but the model, the field and the preview.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "drivers/display/phase_map.h"
#include "kiosk/render/field_colours.h"
#include "kiosk/stereo/pointer.h"
#include "kiosk/stereo/profile.h"
#include "kiosk/stereo/view.h"
#include "mesh/model/model.h"

namespace prismesh::kiosk::render {

using mesh::Vec3;

enum class ColourMode : std::uint8_t {
  parts,
  quality,
  part_states,  ///< each part by the share of its shells that fails, or else warns
  field,        ///< by what Picture::field says; not among the names
};
inline constexpr std::array<std::string_view, 3> kColourModeNames{"parts", "quality", "part-states"};
std::optional<ColourMode> colour_mode_from(std::string_view name);

/// What is dragged: an arrow along the normal, a disk across it about its foot (slides), a ring about the foot in the screen's plane
/// (moves), or, where an axis was picked, the axis and an arc about it that turns. Of the same size on the screen wherever it is. White;
/// the part in use is green, the others go.
struct Handle {
  enum class Use : std::uint8_t { idle, arrow, disk, ring, arc };
  /// The axis of a rotation. A circle about it goes through `at`, where a ball is to be grabbed; the arc on it runs from where the grab
  /// was before the turn to `at`.
  struct Turn {
    Vec3 point = Vec3::Zero();  ///< on the axis, deck coordinates
    Vec3 axis = Vec3::UnitZ();  ///< unit
    double degrees = 0;         ///< turned so far, right-handed about the axis
    bool operator==(const Turn&) const = default;
  };
  Vec3 at = Vec3::Zero();  ///< deck coordinates: where the grab is now
  Vec3 direction = Vec3::UnitZ();
  Use use = Use::idle;
  std::optional<Turn> turn{};  ///< then arrow, disk and ring aren't there
  bool operator==(const Handle&) const = default;
};
// Sizes on the screen in pixels, for what finds out which part the pointer is on; the arrow's is stereo::kHandleLengthPixels.
inline constexpr double kHandleRingPixels = 12;  ///< the ring's radius
inline constexpr double kHandleDiskPixels = 36;  ///< the disk's radius, in the plane across `direction`
inline constexpr double kHandleBallPixels = 8;   ///< radius of the ball at `at` on the circle about an axis

/// One eye's image while it is being drawn: its framebuffer is bound, its viewport set, blending and depth test off.
struct EyeImage {
  std::optional<stereo::Eye> eye;  ///< empty: the picture from between the eyes
  int width = 0;                   ///< of the image, pixels
  int height = 0;
  int picture_width = 0;  ///< of the whole picture, display pixels
  int picture_height = 0;
  /// Where a place of the picture (pixels from the upper left corner) lies in the image: normalised coordinates, y up. Images that are
  /// dealt out to columns are narrower than the picture, shifted, and sheared where the mask leans.
  stereo::ImageMap from_picture = stereo::ImageMap::Zero();
};

/// A rectangle in display pixels from the upper left corner.
struct PixelRect {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// Where a picture lies on the panel: pixels from the panel's upper left corner. All 0: it covers the panel.
struct PanelPlace {
  int x = 0, y = 0;
  int width = 0, height = 0;  ///< of the panel
  bool operator==(const PanelPlace&) const = default;
};

enum class Pane : std::uint8_t { model, other };
/// Two views in a picture: the model, and beside it another that set_other gave, seen from the same side. The picture is cut in the middle,
/// in both eyes' images alike, and each view stands aside by the same way.
struct TwoViews {
  bool model_on_right = true;
  double shift = 0.25;  ///< of each view from the middle, as a share of the picture's width
  bool operator==(const TwoViews&) const = default;

  double shift_mm(bool right, double screen_width_mm) const { return (right ? shift : -shift) * screen_width_mm; }
};

/// All that a picture depends on, but for the model and the preview.
struct Picture {
  stereo::View view;
  stereo::Profile profile;
  Vec3 between_eyes_mm = Vec3(0, 0, 650);
  Vec3 toward_right = Vec3::UnitX();  ///< from the left eye to the right one
  double eye_separation_mm = stereo::kMeanEyeSeparationMm;
  /// 1: each eye's own perspective; 0: both see the picture from between them (mono); in between while the one turns into the other.
  double depth_share = 1;
  std::optional<double> mask_mm;  ///< where a movable mask will be when this lights up; empty: where it should be for these eyes
  PanelPlace panel;               ///< where the picture lies on the display's panel: eyes and mask count from the panel's centre
  ColourMode colour = ColourMode::parts;
  std::array<FieldLook, 2> field{};  ///< by Pane
  std::optional<TwoViews> two_views;
  bool element_edges = true;
  bool outlines = true;  ///< free edges and creases
  bool quality_glyphs = true;
  bool damaged_only = false;               ///< glyphs only of what the document's edits made worse
  std::optional<mesh::ShellIndex> marked;  ///< the shell that is looked at: a frame about it
  bool selected_nodes = true;
  bool moving = false;  ///< the view is being turned or something dragged: drawn without multisampling, so that large models keep up
  std::optional<Handle> handle;
  std::optional<PixelRect> rubber_band;
  std::vector<Eigen::Vector2d> lasso;  ///< display pixels; drawn closed
  bool shadows = false;                ///< the dragged surface's shadow on the planes beside the model (the paper's suggestion)
  /// Panels, cursor and all else that lies in the screen's plane: called once per eye image, after the scene and before weaving.
  /// Nothing may be drawn into the target after `draw`. May change any GL state.
  std::function<void(const EyeImage&)> overlay;
};
/// The panel that a picture of width x height pixels lies on.
drivers::display::PanelArea panel_area(const PanelPlace& place, int width, int height);

/// What the pointer aims with in a picture of width x height pixels: its pointer eye, from where that eye's picture is drawn.
stereo::Aim aim_for(const Picture& picture, int width, int height);

}  // namespace prismesh::kiosk::render
