// What each eye sees through the mask: at the correct position, and a quarter and half a period off.
#include "tests/optics/figures/figures.h"

namespace prismesh::optics {

namespace {
using viewer::LightImage;
constexpr int kSeenWidth = 1280, kSeenHeight = 800;
}  // namespace

Result<LightImage> seen_figure(Stage& stage) {
  Result<Canvas> canvas = Canvas::create(kSeenWidth, kSeenHeight, kFigureFont);
  if (!canvas) return fail(canvas.error());
  canvas->ground(manner::kAbove, manner::kBelow);
  const viewer::MaskDisplay display = station_display(640, 400);
  stage.show(test::make_crash_box());
  const mesh::Vec3 head(40, 20, 600);
  const auto picture = stage.fitted("prism-mask", head, display.panel);
  if (!picture) return fail(picture.error());
  const auto woven = stage.draw(*picture, display.panel);
  if (!woven) return fail(woven.error());
  const viewer::Eyes eyes = eyes_of(*picture);
  const double right_place = display.ideal_mask_mm({head.x(), head.y(), head.z()}), period = display.element_pitch_mm();
  const struct {
    const char* title;
    const char* words;
    bool left;
    double periods;  ///< unknown error of the mask's position; NaN: the panel itself
  } tiles[] = {{"1  On the panel", "both eyes' columns in turn", true, -1},
               {"2  The left eye", "sees its own columns only", true, 0},
               {"3  The right eye", "sees the others", false, 0},
               {"4  The mask a tenth of a period off", "a ghost appears: the left eye", true, 0.1},
               {"5  A quarter off", "both pictures, and colour fringes: the left eye", true, 0.25},
               {"6  Half a period off", "the left eye sees the right eye's picture", true, 0.5}};
  for (int i = 0; i < 6; ++i) {
    const double x = 30 + 415.0 * (i % 3), y = 390.0 * (i / 3);
    canvas->text({x, y + 40}, tiles[i].title, manner::kTitle, manner::kText);
    canvas->text({x, y + 66}, tiles[i].words, manner::kSmall, manner::kQuiet);
    LightImage shown = *woven;
    if (tiles[i].periods >= 0) {
      const auto seen = viewer::look(display, *woven, tiles[i].left ? eyes.left : eyes.right, right_place + tiles[i].periods * period);
      if (!seen) return fail(seen.error());
      shown = viewer::on_grid(display, *seen, display.panel.columns);
    }
    canvas->pixels({x, y + 84}, shown, {125, 60, 390, 280}, 1, 1);
    canvas->outline({x, y + 84, 390, 280}, 2, i == 0 ? manner::kMask : tiles[i].left ? manner::kLeft : manner::kRight);
  }
  return canvas->picture();
}

}  // namespace prismesh::optics
