// Interlacing, from the whole picture to the stripes of a pixel.
#include <algorithm>
#include <cmath>
#include <string>

#include "tests/optics/figures/figures.h"

namespace prismesh::optics {

namespace {

using viewer::LightImage;
using viewer::Owner;

constexpr int kInterlacingWidth = 1280, kInterlacingHeight = 950;

/// The position of a magnified part in its picture.
struct Part {
  int x = 0, y = 0, columns = 0, rows = 0;
  std::array<int, 4> array() const { return {x, y, columns, rows}; }
};

/// A part of a panel's picture, each pixel as its three stripes, with a bar above that shows the owner of each stripe.
void draw_stripes(Canvas& canvas, Spot2 at, const LightImage& woven, const viewer::Owners& owners, const Part& part, double step) {
  const double stripe = step / 3, bar = 14;
  for (int x = 0; x < 3 * part.columns; ++x) {
    const Owner owner = owners.at(part.y, 3 * part.x + x);
    canvas.box({at.x + x * stripe, at.y, stripe, bar}, owner == Owner::left ? manner::kLeft : manner::kRight);
  }
  for (int y = 0; y < part.rows; ++y)
    for (int x = 0; x < 3 * part.columns; ++x) {
      const float value = viewer::srgb_from_linear(woven.at(part.x + x / 3, part.y + y)[static_cast<std::size_t>(x % 3)]);
      Ink shine = ink(0x000000);
      (x % 3 == 0 ? shine.red : x % 3 == 1 ? shine.green : shine.blue) = value;
      canvas.box({at.x + x * stripe + 0.04 * step, at.y + bar + 4 + y * step + 0.04 * step, stripe - 0.08 * step, 0.92 * step}, shine);
    }
}

/// The picture at its own size, cropped, with a mark around the part that is magnified below it.
void draw_overview(Canvas& canvas, const Frame& frame, const LightImage& image, const Part& part, const Ink& colour) {
  const std::array<int, 4> crop{(image.width - static_cast<int>(frame.width)) / 2, (image.height - static_cast<int>(frame.height)) / 2,
                                static_cast<int>(frame.width), static_cast<int>(frame.height)};
  canvas.pixels({frame.x, frame.y}, image, crop, 1, 1);
  canvas.outline({frame.x + part.x - crop[0], frame.y + part.y - crop[1], 1.0 * part.columns, 1.0 * part.rows}, 2, ink(0xFFFFFF));
  canvas.outline(frame, 2, colour);
}

struct Column {
  const char* title;
  const char* words;
  const LightImage* image;
  Ink colour;
};

}  // namespace

Result<LightImage> interlacing_figure(Stage& stage) {
  Result<Canvas> canvas = Canvas::create(kInterlacingWidth, kInterlacingHeight, kFigureFont);
  if (!canvas) return fail(canvas.error());
  canvas->ground(manner::kAbove, manner::kBelow);
  const viewer::Panel panel{.columns = 640, .rows = 400};
  stage.show(test::make_crash_box());
  const auto picture = stage.fitted("prism-mask", {0, 0, 650}, panel);
  if (!picture) return fail(picture.error());
  const auto left = stage.draw_as("mono-left", *picture, panel), right = stage.draw_as("mono-right", *picture, panel);
  const auto woven = stage.draw(*picture, panel);
  const auto owners = stage.owners(*picture, panel);
  // The windows are shifted by a third of a pixel against the columns.
  kiosk::render::Picture moved = *picture;
  moved.mask_mm = 0.1;
  const auto moved_woven = stage.draw(moved, panel);
  const auto moved_owners = stage.owners(moved, panel);
  for (const auto* drawn : {&left, &right, &woven, &moved_woven})
    if (!*drawn) return fail(drawn->error());
  if (!owners) return fail(owners.error());
  if (!moved_owners) return fail(moved_owners.error());

  const Part part{389, 232, 32, 18};
  const Column columns[] = {{"1  The left eye's image", "as an ordinary screen would show it", &*left, manner::kLeft},
                            {"2  The right eye's image", "from 63 mm farther right", &*right, manner::kRight},
                            {"3  Woven", "columns of the two images in turn", &*woven, manner::kMask}};
  const double step = 12;
  for (int i = 0; i < 3; ++i) {
    const double x = 30 + 415.0 * i;
    canvas->text({x, 40}, columns[i].title, manner::kTitle, manner::kText);
    canvas->text({x, 66}, columns[i].words, manner::kSmall, manner::kQuiet);
    draw_overview(*canvas, {x, 82, 390, 230}, *columns[i].image, part, columns[i].colour);
    canvas->pixels({x + 3, 332}, *columns[i].image, part.array(), step, step);
    canvas->outline({x + 3, 332, step * part.columns, step * part.rows}, 2, columns[i].colour);
  }
  const Part few{396, 238, 12, 5};
  const struct {
    const char* title;
    const char* words;
    const LightImage* image;
    const viewer::Owners* owners;
  } close[] = {{"4  Its stripes", "the bar says whose: blue the left eye's, orange the right eye's", &*woven, &*owners},
               {"5  The same place, the mask 0.1 mm farther right", "the border between the eyes falls between a pixel's stripes",
                &*moved_woven, &*moved_owners}};
  for (int i = 0; i < 2; ++i) {
    const double x = 30 + 620.0 * i;
    canvas->text({x, 612}, close[i].title, manner::kTitle, manner::kText);
    canvas->text({x, 638}, close[i].words, manner::kSmall, manner::kQuiet);
    draw_stripes(*canvas, {x, 656}, *close[i].image, *close[i].owners, few, 48);
  }
  return canvas->picture();
}

}  // namespace prismesh::optics
