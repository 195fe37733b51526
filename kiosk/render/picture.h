// Data of a picture: all that it depends on except the model, the field's values and the preview.
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
  field,        ///< by the field's values (Picture::field); has no name
};
inline constexpr std::array<std::string_view, 3> kColourModeNames{"parts", "quality", "part-states"};
/// The mode of a name in kColourModeNames.
std::optional<ColourMode> colour_mode_from(std::string_view name);

/// The handle to drag: an arrow along the normal, a disk perpendicular to it about its foot (slides), a ring about the foot in the screen's
/// plane (moves), or, if an axis was picked, the axis and an arc about it that turns. Its size on the screen is constant. White; the active
/// part is green and the others are hidden.
struct Handle {
  enum class Use : std::uint8_t { idle, arrow, disk, ring, arc };
  /// The axis of a rotation. A circle about it goes through `at`, where a ball can be grabbed. The arc on the circle runs from the grabbed
  /// point's first position to `at`.
  struct Turn {
    Vec3 point = Vec3::Zero();  ///< on the axis, deck coordinates
    Vec3 axis = Vec3::UnitZ();  ///< unit
    double degrees = 0;         ///< current angle, right-handed about the axis
    bool operator==(const Turn&) const = default;
  };
  Vec3 at = Vec3::Zero();  ///< current position of the grabbed point, deck coordinates
  Vec3 direction = Vec3::UnitZ();
  Use use = Use::idle;
  std::optional<Turn> turn{};  ///< if set, arrow, disk and ring are hidden
  bool operator==(const Handle&) const = default;
};
/// The haptic pen as it stands in the model: tip, shaft, and what it touches. White; the tip is green while it touches or holds something.
struct Pen {
  Vec3 tip = Vec3::Zero();                   ///< deck coordinates
  Vec3 shaft = Vec3::UnitZ();                ///< from the tip to the hand, deck coordinates, unit
  bool busy = false;                         ///< it touches or holds something
  std::vector<std::array<Vec3, 2>> shell{};  ///< edges of the touched shell, deck coordinates
  std::optional<Vec3> node{};                ///< that would be taken
  bool operator==(const Pen&) const = default;
};
// Sizes on the screen in pixels, for drawing and picking; the arrow's length is stereo::kHandleLengthPixels.
inline constexpr double kHandleRingPixels = 12;  ///< the ring's radius
inline constexpr double kHandleDiskPixels = 36;  ///< the disk's radius, in the plane perpendicular to `direction`
inline constexpr double kHandleBallPixels = 8;   ///< radius of the ball at `at` on the circle about an axis

/// One eye's image while it is drawn: its framebuffer is bound, its viewport set, blending and depth test are off.
struct EyeImage {
  std::optional<stereo::Eye> eye;  ///< empty: the picture from between the eyes
  int width = 0;                   ///< of the image, pixels
  int height = 0;
  int picture_width = 0;  ///< of the whole picture, display pixels
  int picture_height = 0;
  /// Maps points of the picture (pixels from the upper left corner) to normalised coordinates of the image, y up. An image that is
  /// distributed over columns is narrower than the picture, shifted, and sheared if the mask leans.
  stereo::ImageMap from_picture = stereo::ImageMap::Zero();
};

/// A rectangle in display pixels from the upper left corner.
struct PixelRect {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// Position of a picture on the panel, in pixels from the panel's upper left corner. All 0: it covers the panel.
struct PanelPlace {
  int x = 0, y = 0;
  int width = 0, height = 0;  ///< of the panel
  bool operator==(const PanelPlace&) const = default;
};

enum class Pane : std::uint8_t { model, other };
/// Two views in a picture: the model, and beside it the one given to Renderer::set_other, seen from the same side. The border is at
/// the same place for both eyes, and each view is shifted from it by the same distance.
struct TwoViews {
  bool model_on_right = true;
  double shift = 0.25;  ///< of each view from the border, as a share of the picture's width
  double border = 0.5;  ///< from the picture's left edge, as a share of its width
  bool operator==(const TwoViews&) const = default;

  double shift_mm(bool right, double screen_width_mm) const { return (right ? shift : -shift) * screen_width_mm; }
};

/// All that a picture depends on except the model, the field's values and the preview.
struct Picture {
  stereo::View view;
  stereo::Profile profile;
  Vec3 between_eyes_mm = Vec3(0, 0, 650);
  Vec3 toward_right = Vec3::UnitX();  ///< from the left eye to the right one
  double eye_separation_mm = stereo::kMeanEyeSeparationMm;
  /// 1: each eye's own perspective; 0: both see the picture from between them (mono). Between the two while one changes to the other.
  double depth_share = 1;
  std::optional<double> mask_mm;  ///< position of a movable mask when this picture lights up; empty: the ideal one for these eyes
  PanelPlace panel;               ///< the picture on the display's panel; eyes and mask are relative to the panel's centre
  ColourMode colour = ColourMode::parts;
  std::array<FieldLook, 2> field{};  ///< by Pane
  std::optional<TwoViews> two_views;
  bool element_edges = true;
  bool outlines = true;    ///< free edges and creases
  bool thickness = false;  ///< shells are plates with the thickness of their part
  bool quality_glyphs = true;
  bool damaged_only = false;               ///< glyphs and part states only of what the document's edits made worse
  std::optional<mesh::ShellIndex> marked;  ///< the shell that the view went to: a frame is drawn around it
  std::optional<Vec3> marked_point;        ///< the node that the view went to, deck coordinates: a ball with a ring
  bool selected_nodes = true;
  bool moving = false;  ///< the view turns or something is dragged: drawn without multisampling, which is faster for large models
  /// Stands for a picture at rest that is drawn in pieces: a moving one if the model has levels of detail, else with the scene of the last
  /// picture.
  bool waiting = false;
  std::optional<Handle> handle;
  std::optional<Handle> cut_handle;  ///< the plane that cuts the model: its arrow, and the outline of the plane
  std::optional<Pen> pen;
  std::vector<std::array<Vec3, 2>> followed_edges;  ///< free edges that move as far as the handle, deck coordinates: drawn green
  std::vector<std::array<Vec3, 2>> halfway_line;    ///< where a pull falls to half, deck coordinates: drawn white
  std::vector<std::vector<Vec3>> measures;          ///< ways from node to node, deck coordinates
  std::optional<PixelRect> rubber_band;
  std::vector<Eigen::Vector2d> lasso;  ///< display pixels; drawn closed
  bool shadows = false;                ///< of the dragged or selected shells, on planes beside the model
  /// Draws panels, cursor and all else in the screen's plane. Called once for each eye's image, after the scene and before weaving. May
  /// change any OpenGL state. After Renderer::draw nothing more may be drawn into the target.
  std::function<void(const EyeImage&)> overlay;
};
/// The panel that a picture of width x height pixels lies on.
drivers::display::PanelArea panel_area(const PanelPlace& place, int width, int height);

/// The pointer's aim in a picture of width x height pixels: the viewpoint of the pointer eye's image.
stereo::Aim aim_for(const Picture& picture, int width, int height);

}  // namespace prismesh::kiosk::render
