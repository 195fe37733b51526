// The optics from above, with gap and pixels much enlarged; every ray is traced through the glass.
#include <cmath>
#include <functional>
#include <string>

#include "tests/optics/figures/figures.h"
#include "tests/viewer/mask_display.h"

namespace prismesh::optics {

namespace {

using viewer::Eyes;
using viewer::MaskDisplay;
using viewer::Point;

constexpr int kOpticsWidth = 1280, kOpticsHeight = 970;
constexpr double kScale = 1.1, kDepthScale = 0.58;  ///< picture pixels per mm, along the panel and away from it

/// Pixels and gap are a hundred times too large relative to the distances, so that both are visible.
MaskDisplay enlarged() {
  MaskDisplay display;
  display.panel.columns = 26;
  display.panel.rows = 1;
  display.panel.pitch_mm = 16;
  display.design_distance_mm = 560;
  display.design_separation_mm = 150;
  return display;
}

struct Scene {
  const char* title;
  const char* words;
  Point between;
  double mask_mm = 0;
  bool phase_map = false;
};

/// One of the four drawings, at its position in the picture.
class Drawing {
 public:
  Drawing(Canvas& canvas, Spot2 corner, const Scene& scene)
      : canvas_(canvas), corner_(corner), scene_(scene), display_(enlarged()), eyes_(viewer::eyes_around(scene.between, 150)) {}

  void draw() {
    canvas_.text({corner_.x + 30, corner_.y + 34}, scene_.title, manner::kTitle, manner::kText);
    canvas_.text({corner_.x + 30, corner_.y + 60}, scene_.words, manner::kSmall, manner::kQuiet);
    draw_panel();
    draw_rays(eyes_.left, true);
    draw_rays(eyes_.right, false);
    draw_mask();
    draw_misses(eyes_.left, true);
    draw_misses(eyes_.right, false);
    draw_eye(eyes_.left, manner::kLeft, "left");
    draw_eye(eyes_.right, manner::kRight, "right");
  }

 private:
  double half_width() const { return 0.5 * display_.panel.width_mm(); }
  Spot2 place(double x, double z) const {
    return {corner_.x + 320 + kScale * x, corner_.y + 112 + kDepthScale * (z + display_.glass_mm())};
  }

  /// Whether a third of a pixel belongs to the left eye: the eye nearer to the middle of a window there.
  bool is_left(int stripe) const {
    const double u = (stripe + 0.5) / 3 * display_.panel.pitch_mm - half_width();
    if (!scene_.phase_map) return stripe / 3 % 2 == 0;
    const auto off = [&](const Point& eye) {
      const double element = viewer::element_at(display_, eye, scene_.mask_mm, u, 0);
      return std::abs(element - std::round(element));
    };
    return off(eyes_.left) < off(eyes_.right);
  }

  void draw_panel() {
    const double height = 16, pitch = kScale * display_.panel.pitch_mm;
    const Spot2 left = place(-half_width(), -display_.glass_mm());
    const Spot2 front = place(-half_width(), 0);
    canvas_.box({left.x, left.y, 2 * kScale * half_width(), front.y - left.y}, manner::kGlass);
    for (int stripe = 0; stripe < 3 * display_.panel.columns; ++stripe)
      canvas_.box({left.x + stripe * pitch / 3, left.y - height, pitch / 3, height},
                  is_left(stripe) ? manner::kLeftPale : manner::kRightPale);
    for (int column = 0; column <= display_.panel.columns; ++column)
      canvas_.line({left.x + column * pitch, left.y - height}, {left.x + column * pitch, left.y}, 1.2, manner::kMask);
    canvas_.text({left.x - 8, left.y - 2}, "panel", manner::kSmall, manner::kQuiet, Align::right);
    canvas_.text({left.x - 8, 0.5 * (left.y + front.y) + 5}, "glass", manner::kSmall, manner::kQuiet, Align::right);
    canvas_.text({left.x - 8, front.y + 5}, "mask", manner::kSmall, manner::kQuiet, Align::right);
  }

  void for_each_window(const Point& eye, const std::function<void(double x_mm, double u_mm)>& act) const {
    for (int element = -16; element <= 16; ++element) {
      const viewer::Window window = viewer::window_of(display_, eye, scene_.mask_mm, element, 0);
      if (std::abs(window.u_mm) < half_width() - 0.5 * display_.panel.pitch_mm && std::abs(window.x_mm) < half_width())
        act(window.x_mm, window.u_mm);
    }
  }

  void draw_rays(const Point& eye, bool left) {
    Ink colour = left ? manner::kLeft : manner::kRight;
    colour.cover = 0.6F;
    for_each_window(eye, [&](double x, double u) {
      canvas_.line(place(eye.x, eye.z), place(x, 0), 1.3, colour);
      canvas_.line(place(x, 0), place(u, -display_.glass_mm()), 1.3, colour);
    });
  }

  /// The mask: closed between its elements.
  void draw_mask() {
    const double open = 0.16 * display_.element_pitch_mm();
    double from = -half_width();
    for (int element = -20; element <= 20; ++element) {
      const double x = display_.element_x_mm(element, scene_.mask_mm, 0);
      if (x - open < from || x + open > half_width()) continue;
      canvas_.line(place(from, 0), place(x - open, 0), 4, manner::kMask);
      from = x + open;
    }
    canvas_.line(place(from, 0), place(half_width(), 0), 4, manner::kMask);
  }

  /// Marks windows whose middle is more than a quarter of a pixel from the middle of the eye's own stripes.
  void draw_misses(const Point& eye, bool left) {
    if (scene_.phase_map) return;
    for_each_window(eye, [&](double, double u) {
      const double column = (u + half_width()) / display_.panel.pitch_mm - 0.5;
      const double own = 2 * std::round(0.5 * (column - (left ? 0 : 1))) + (left ? 0 : 1);
      if (std::abs(column - own) < 0.25) return;
      const Spot2 at = place(u, -display_.glass_mm());
      const double y = at.y - 28, r = 5;
      canvas_.line({at.x - r, y - r}, {at.x + r, y + r}, 2.6, manner::kFail);
      canvas_.line({at.x - r, y + r}, {at.x + r, y - r}, 2.6, manner::kFail);
    });
  }

  void draw_eye(const Point& eye, const Ink& colour, const char* name) {
    const Spot2 at = place(eye.x, eye.z);
    canvas_.disc({at.x, at.y + 8}, 15, ink(0xFFFFFF));
    canvas_.disc({at.x, at.y + 3}, 9, colour);
    canvas_.disc({at.x, at.y}, 4.5, manner::kText);
    canvas_.text({at.x + (name[0] == 'l' ? -24 : 24), at.y + 14}, name, manner::kLabel, manner::kText,
                 name[0] == 'l' ? Align::right : Align::left);
  }

  Canvas& canvas_;
  Spot2 corner_;
  Scene scene_;
  MaskDisplay display_;
  Eyes eyes_;
};

}  // namespace

Result<viewer::LightImage> optics_figure() {
  Result<Canvas> canvas = Canvas::create(kOpticsWidth, kOpticsHeight, kFigureFont);
  if (!canvas) return fail(canvas.error());
  canvas->ground(manner::kAbove, manner::kBelow);
  const MaskDisplay display = enlarged();
  const Point aside{75, 0, display.design_distance_mm}, near{0, 0, 350};
  const Scene scenes[] = {
      {"1  At the design distance", "through one opening each eye sees a column of its own", {0, 0, display.design_distance_mm}, 0},
      {"2  The head moves, the mask follows", "half an eye separation aside: the mask moves by a quarter of its pitch", aside,
       display.ideal_mask_mm(aside)},
      {"3  Nearer, with fixed columns", "the windows spread: toward the sides they miss (×) the eye's own columns", near, 0},
      {"4  Nearer, with a phase map", "each third of a pixel goes to the eye that looks at it", near, 0, true}};
  for (int i = 0; i < 4; ++i) Drawing(*canvas, {640.0 * (i % 2), 530.0 * (i / 2)}, scenes[i]).draw();
  canvas->line({640, 30}, {640, kOpticsHeight - 30}, 1, manner::kFrame);
  canvas->line({30, 530}, {kOpticsWidth - 30, 530}, 1, manner::kFrame);
  return canvas->picture();
}

}  // namespace prismesh::optics
