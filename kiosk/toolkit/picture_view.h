// How the picture is looked at: size, display, eyes, view and colours. Plain data that the tools share.
#pragma once

#include <optional>

#include "kiosk/display/window.h"
#include "kiosk/render/picture.h"
#include "kiosk/stereo/tracked_eyes.h"
#include "kiosk/toolkit/depth.h"
#include "kiosk/toolkit/eyes_facts.h"
#include "kiosk/toolkit/view_glide.h"

namespace prismesh::kiosk::toolkit {

/// How large a model is in each of two views, against the one view.
inline constexpr double kTwoViewsSize = 0.5;

struct PictureView {
  display::PixelSize size{1, 1};
  render::PixelRect room{};  ///< what panels leave of the picture; empty: all of it
  stereo::Profile profile;
  stereo::SeenFrom seen;
  render::PanelPlace panel;
  std::optional<EyesFacts> eyes;
  stereo::View view;
  DepthFit depth;
  ViewGlide glide;
  bool steered = false;    ///< a SpaceMouse moves the view at this time
  bool two_views = false;  ///< the picture has two views side by side
  render::ColourMode colour = render::ColourMode::parts;
  bool shadows = false;
  bool thickness = false;  ///< shells are drawn as plates
};

}  // namespace prismesh::kiosk::toolkit
