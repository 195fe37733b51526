#include "tests/viewer/mask_display.h"

#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace prismesh::viewer {

namespace {

Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Point along(const Point& from, double t, const Point& direction) {
  return {from.x + t * direction.x, from.y + t * direction.y, from.z + t * direction.z};
}
double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Lateral distance of the refracted ray in the glass, per millimetre of lateral distance between eye and mask.
double magnification(const MaskDisplay& display, double dx, double dy, double distance) {
  const double aside = dx * dx + dy * dy;
  return display.glass_mm() / std::sqrt(display.index * display.index * (aside + distance * distance) - aside);
}

}  // namespace

Eyes eyes_around(const Point& between, double separation_mm, const Point& toward_right) {
  const double half = 0.5 * separation_mm / std::sqrt(dot(toward_right, toward_right));
  return {along(between, -half, toward_right), along(between, half, toward_right)};
}

double MaskDisplay::air_gap_mm() const { return panel.pitch_mm * design_distance_mm / design_separation_mm * glass_scale; }
double MaskDisplay::glass_mm() const { return index * air_gap_mm(); }

double MaskDisplay::element_pitch_mm() const {
  const double designed_gap = panel.pitch_mm * design_distance_mm / design_separation_mm;
  return 2 * panel.pitch_mm * design_distance_mm / (design_distance_mm + designed_gap) * pitch_scale;
}

double MaskDisplay::reference_mm() const {
  // Column c begins at (c - columns / 2) pitches; c is the even number nearest to columns / 2.
  const double middle = 0.5 * panel.columns, edge_mm = (2 * std::floor(0.5 * middle + 0.5) - middle) * panel.pitch_mm;
  return edge_mm * element_pitch_mm() / pitch_scale / (2 * panel.pitch_mm);  // the pitch is smaller than two pixels by this factor
}

double MaskDisplay::element_x_mm(double element, double mask_mm, double y_mm) const {
  return element * element_pitch_mm() + reference_mm() + offset_mm + mask_mm + lean * y_mm;
}

double MaskDisplay::ideal_mask_mm(const Point& between) const {
  const double share = air_gap_mm() / (between.z + air_gap_mm());
  return (between.x - lean * between.y) * share - offset_mm;
}

Result<void> MaskDisplay::check() const {
  struct Limit {
    const char* name;
    double value, low, high;
  };
  const std::array<Limit, 10> limits{{{"columns", static_cast<double>(panel.columns), 4, 32768},
                                      {"rows", static_cast<double>(panel.rows), 1, 32768},
                                      {"the pixel pitch", panel.pitch_mm, 0.01, 10},
                                      {"the black share of a stripe", panel.black_share, 0, 0.9},
                                      {"the design distance", design_distance_mm, 50, 20000},
                                      {"the design eye separation", design_separation_mm, 20, 200},
                                      {"the refractive index", index, 1, 3},
                                      {"the lean", lean, -2, 2},
                                      {"the pitch scale", pitch_scale, 0.5, 2},
                                      {"the glass scale", glass_scale, 0.2, 5}}};
  for (const Limit& limit : limits)
    if (!(limit.value >= limit.low && limit.value <= limit.high))
      return fail("display", std::string(limit.name) + " is " + std::to_string(limit.value) + ", but must be from " +
                                 std::to_string(limit.low) + " to " + std::to_string(limit.high));
  return {};
}

PanelPlace seen_through(const MaskDisplay& display, const Point& eye, double x_mm, double y_mm) {
  const double dx = x_mm - eye.x, dy = y_mm - eye.y;
  const double more = magnification(display, dx, dy, eye.z);
  return {x_mm + dx * more, y_mm + dy * more};
}

Window window_of(const MaskDisplay& display, const Point& eye, double mask_mm, double element, double v_mm) {
  // The height of the mask's point isn't known, only the panel's: each step reduces the error by a factor of about gap / distance.
  Window window{0, 0, v_mm};
  for (int step = 0; step < 8; ++step) {
    window.x_mm = display.element_x_mm(element, mask_mm, window.y_mm);
    const double more = magnification(display, window.x_mm - eye.x, window.y_mm - eye.y, eye.z);
    const double y_mm = (v_mm + more * eye.y) / (1 + more);
    const bool settled = std::abs(y_mm - window.y_mm) < 1e-9;
    window.y_mm = y_mm;
    if (settled) break;
  }
  window.x_mm = display.element_x_mm(element, mask_mm, window.y_mm);
  window.u_mm = seen_through(display, eye, window.x_mm, window.y_mm).u_mm;
  return window;
}

double element_at(const MaskDisplay& display, const Point& eye, double mask_mm, double u_mm, double v_mm) {
  const double pitch = display.element_pitch_mm();
  const double spacing = pitch * (eye.z + display.air_gap_mm()) / eye.z;
  double element = 0;
  for (int step = 0; step < 20; ++step) {
    const double off = u_mm - window_of(display, eye, mask_mm, element, v_mm).u_mm;
    element += off / spacing;
    if (std::abs(off) < 1e-9) break;
  }
  return element;
}

Point triangulated(const Eyes& eyes, const Window& left, const Window& right) {
  const Point from_left = Point{left.x_mm, left.y_mm, 0} - eyes.left, from_right = Point{right.x_mm, right.y_mm, 0} - eyes.right;
  const Point apart = eyes.right - eyes.left;
  const double a = dot(from_left, from_left), b = dot(from_left, from_right), c = dot(from_right, from_right);
  const double d = dot(from_left, apart), e = dot(from_right, apart), determinant = a * c - b * b;
  const Point on_left = along(eyes.left, (c * d - b * e) / determinant, from_left);
  const Point on_right = along(eyes.right, (b * d - a * e) / determinant, from_right);
  return {0.5 * (on_left.x + on_right.x), 0.5 * (on_left.y + on_right.y), 0.5 * (on_left.z + on_right.z)};
}

}  // namespace prismesh::viewer
