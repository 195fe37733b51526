// The worst phase error over head positions.
#include <algorithm>
#include <cmath>
#include <string>

#include "tests/optics/figures/figures.h"

namespace prismesh::optics {

namespace {

using viewer::LightImage;

constexpr int kVolumeWidth = 1280, kVolumeHeight = 800;
constexpr int kSide = 240, kNear = 420, kFar = 920, kStep = 20;  ///< mm
constexpr double kLimit = 0.25;                                  ///< pixels

/// Green for small errors, through sand to red, with a step at the limit.
Ink colour_of(double pixels) {
  const auto mix = [](const Ink& a, const Ink& b, double t) {
    const auto f = static_cast<float>(std::clamp(t, 0.0, 1.0));
    return Ink{a.red + f * (b.red - a.red), a.green + f * (b.green - a.green), a.blue + f * (b.blue - a.blue)};
  };
  if (pixels <= kLimit) return mix(ink(0xD3E6EE), ink(0x6FA8C4), pixels / kLimit);
  return mix(ink(0xE7B98F), ink(0x9E3B2C), (pixels - kLimit) / 0.5);
}

struct Map {
  const char* title;
  const char* words;
  bool phase_map;
};

Result<double> worst(Stage& stage, const viewer::MaskDisplay& display, const kiosk::render::Picture& base, const Map& map,
                     const mesh::Vec3& head, const viewer::Owners& fixed) {
  kiosk::render::Picture picture = base;
  picture.between_eyes_mm = head;
  const viewer::Point between{head.x(), head.y(), head.z()};
  if (!map.phase_map) return viewer::phase_summary(display, fixed, eyes_of(picture), display.ideal_mask_mm(between), {1}).worst_pixels;
  const auto owners = stage.owners(picture, display.panel);
  if (!owners) return fail(owners.error());
  return viewer::phase_summary(display, *owners, eyes_of(picture), display.ideal_mask_mm(between), {1}).worst_pixels;
}

void draw_axes(Canvas& canvas, const Frame& frame) {
  for (int x = -200; x <= 200; x += 100) {
    const double at = frame.x + frame.width * (x + kSide) / (2.0 * kSide);
    canvas.line({at, frame.y + frame.height}, {at, frame.y + frame.height + 6}, 1.5, manner::kFrame);
    canvas.text({at, frame.y + frame.height + 24}, std::to_string(x), manner::kSmall, manner::kQuiet, Align::centre);
  }
  for (int distance = 500; distance <= 900; distance += 100) {
    const double at = frame.y + frame.height * (distance - kNear) / (kFar - kNear);
    canvas.line({frame.x - 6, at}, {frame.x, at}, 1.5, manner::kFrame);
    canvas.text({frame.x - 10, at + 5}, std::to_string(distance), manner::kSmall, manner::kQuiet, Align::right);
  }
  canvas.text({frame.x + 0.5 * frame.width, frame.y + frame.height + 48}, "head aside of the middle, mm", manner::kSmall, manner::kQuiet,
              Align::centre);
  canvas.text({frame.x, frame.y - 10}, "distance, mm", manner::kSmall, manner::kQuiet);
}

void draw_scale(Canvas& canvas, Spot2 at) {
  constexpr int kCells = 75;
  for (int i = 0; i < kCells; ++i) canvas.box({at.x + 4.0 * i, at.y, 4, 14}, colour_of((i + 0.5) / 100));
  for (const double value : {0.0, 0.25, 0.5, 0.75}) {
    std::string words = std::to_string(value).substr(0, 4);
    canvas.text({at.x + 400 * value, at.y + 32}, words, manner::kSmall, manner::kQuiet, Align::centre);
  }
  canvas.text({at.x + 324, at.y + 13}, "pixels, worst over the width of the panel", manner::kSmall, manner::kQuiet);
}

}  // namespace

Result<LightImage> volume_figure(Stage& stage) {
  Result<Canvas> canvas = Canvas::create(kVolumeWidth, kVolumeHeight, kFigureFont);
  if (!canvas) return fail(canvas.error());
  canvas->ground(manner::kAbove, manner::kBelow);
  const viewer::MaskDisplay display = station_display(1280, 3);
  stage.show({});
  const auto base = stage.fitted("prism-mask", {0, 0, 650}, display.panel);
  const auto columns = stage.fitted("prism-mask-columns", {0, 0, 650}, display.panel);
  if (!base || !columns) return fail(base ? columns.error() : base.error());
  const auto fixed = stage.owners(*columns, display.panel);
  if (!fixed) return fail(fixed.error());
  const Map maps[] = {{"1  The mask's shift alone", "even and odd columns are fixed; the mask follows the head", false},
                      {"2  With a phase map", "each stripe goes to the eye that looks at it", true}};
  for (int i = 0; i < 2; ++i) {
    const Frame frame{90 + 620.0 * i, 116, 520, 540};
    canvas->text({frame.x - 60, 40}, maps[i].title, manner::kTitle, manner::kText);
    canvas->text({frame.x - 60, 66}, maps[i].words, manner::kSmall, manner::kQuiet);
    const double cell_x = frame.width * kStep / (2 * kSide), cell_y = frame.height * kStep / (kFar - kNear);
    for (int x = -kSide; x < kSide; x += kStep)
      for (int distance = kNear; distance < kFar; distance += kStep) {
        const mesh::Vec3 head(x + 0.5 * kStep, 0, distance + 0.5 * kStep);
        const auto found = worst(stage, display, *base, maps[i], head, *fixed);
        if (!found) return fail(found.error());
        canvas->box({frame.x + cell_x * (x + kSide) / kStep, frame.y + cell_y * (distance - kNear) / kStep, cell_x, cell_y},
                    colour_of(*found));
      }
    canvas->outline(frame, 1.5, manner::kFrame);
    draw_axes(*canvas, frame);
  }
  draw_scale(*canvas, {90, 740});
  return canvas->picture();
}

}  // namespace prismesh::optics
