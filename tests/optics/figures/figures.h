// The figures of docs/display. All content is computed, by ray tracing or by weaving and viewing; nothing is drawn by hand.
#pragma once

#include "tests/optics/figures/canvas.h"
#include "tests/optics/figures/stage.h"

namespace prismesh::optics {

inline constexpr const char* kFigureFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

/// The style that all figures share.
namespace manner {
inline constexpr Ink kAbove = ink(0xECEDEE), kBelow = ink(0xDDDFE1), kText = ink(0x2A2E33), kQuiet = ink(0x5F656B);
inline constexpr Ink kLeft = ink(0x0072B2), kRight = ink(0xE08A00), kLeftPale = ink(0x7FBCE6), kRightPale = ink(0xF3C77A);
inline constexpr Ink kFail = ink(0xB5271D), kGlass = ink(0xBFD4DC, 0.55F), kMask = ink(0x3A3F45), kFrame = ink(0x8A9097);
inline constexpr double kTitle = 24, kLabel = 18, kSmall = 15;
}  // namespace manner

/// Panel, mask and two eyes: at the design distance, to the side, and nearer with fixed columns and with a phase map.
Result<viewer::LightImage> optics_figure();
/// Two eyes' images and the woven picture, down to the stripes of a pixel.
Result<viewer::LightImage> interlacing_figure(Stage& stage);
/// Thin lines as one eye sees them, with a stencil and drawn at half width.
Result<viewer::LightImage> lines_figure(Stage& stage);
/// What each eye sees through the mask, at the correct position and at wrong ones.
Result<viewer::LightImage> seen_figure(Stage& stage);
/// The worst phase error over head positions, with moving the mask alone and with a phase map.
Result<viewer::LightImage> volume_figure(Stage& stage);

}  // namespace prismesh::optics
