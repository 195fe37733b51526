// Thin lines as one eye sees them.
#include <cmath>
#include <string>

#include "tests/optics/figures/figures.h"
#include "tests/optics/thin_line.h"

namespace prismesh::optics {

namespace {

using viewer::LightImage;

constexpr int kLinesWidth = 1280, kLinesHeight = 920;

}  // namespace

Result<LightImage> lines_figure(Stage& stage) {
  Result<Canvas> canvas = Canvas::create(kLinesWidth, kLinesHeight, kFigureFont);
  if (!canvas) return fail(canvas.error());
  canvas->ground(manner::kAbove, manner::kBelow);
  const viewer::MaskDisplay display = station_display(512, 256);
  const auto view = viewer::Viewpoint::at(display, viewer::eyes_around({0, 0, 650}).left, 0);
  if (!view) return fail(view.error());
  const ThinLine line;
  constexpr float kGrey = 0.4F;
  const viewer::Colour grey{viewer::linear_from_srgb(kGrey), viewer::linear_from_srgb(kGrey), viewer::linear_from_srgb(kGrey)};
  stage.show({});
  constexpr double kSlopes[] = {20, 40, 55, 70};
  const struct {
    const char* profile;
    const char* title;
    const char* words;
  } ways[] = {{"prism-mask-stencil", "1  Full-size images, every other column dropped", "what a stencil leaves of a thin line for one eye"},
              {"prism-mask", "2  Images of half the width, woven", "the same lines for the same eye: each is one piece"}};
  constexpr int kElements = 24, kRows = 54;  // of a tile: an element is two pixels wide
  constexpr double kStep = 6, kTop = 84;
  for (int way = 0; way < 2; ++way) {
    const double y = 440.0 * way;
    canvas->text({30, y + 40}, ways[way].title, manner::kTitle, manner::kText);
    canvas->text({30, y + 66}, ways[way].words, manner::kSmall, manner::kQuiet);
    for (int i = 0; i < 4; ++i) {
      auto picture = stage.fitted(ways[way].profile, {0, 0, 650}, display.panel);
      if (!picture) return fail(picture.error());
      picture->overlay = [&](const kiosk::render::EyeImage&) {
        line.draw(kSlopes[i], {0.7, 0.4}, {display.panel.columns, display.panel.rows}, kGrey);
      };
      const auto drawn = stage.draw(*picture, display.panel);
      if (!drawn) return fail(drawn.error());
      const auto seen = view->look(*drawn), ground = view->look(LightImage(display.panel.columns, display.panel.rows, grey));
      if (!seen || !ground) return fail(seen ? ground.error() : seen.error());
      const double x = 30 + 309.0 * i;
      const int pieces = viewer::pieces_in(*seen, *ground, 60);
      // In both cases the tile is centred: on the line if it is whole, on the panel if the line is broken.
      const double element = pieces == 1 ? viewer::spot_in(*seen, *ground, 60).element : 0;
      const int middle = static_cast<int>(std::lround(element)) - seen->first_element;
      canvas->pixels({x, y + kTop}, seen->image(), {middle - kElements / 2, (display.panel.rows - kRows) / 2, kElements, kRows}, 2 * kStep,
                     kStep);
      canvas->outline({x, y + kTop, 2 * kStep * kElements, kStep * kRows}, 1.5, manner::kFrame);
      const std::string words =
          std::to_string(std::lround(kSlopes[i])) + "°: " + std::to_string(pieces) + (pieces == 1 ? " piece" : " pieces");
      canvas->text({x + kStep * kElements, y + kTop + kStep * kRows + 24}, words, manner::kLabel,
                   pieces == 1 ? manner::kText : manner::kFail, Align::centre);
    }
  }
  return canvas->picture();
}

}  // namespace prismesh::optics
