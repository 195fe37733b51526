// A small rasteriser for the documentation's figures: lines, polygons, text and magnified pixels; it always gives the same bytes.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "tests/viewer/light.h"

namespace prismesh::optics {

/// sRGB, 0..1, and coverage.
struct Ink {
  float red = 0, green = 0, blue = 0, cover = 1;
};
/// 0xRRGGBB.
constexpr Ink ink(std::uint32_t rgb, float cover = 1) {
  return {static_cast<float>(rgb >> 16 & 255) / 255, static_cast<float>(rgb >> 8 & 255) / 255, static_cast<float>(rgb & 255) / 255, cover};
}

/// In pixels of the picture, from the upper left corner, y down.
struct Spot2 {
  double x = 0, y = 0;
};
struct Frame {
  double x = 0, y = 0, width = 0, height = 0;
};

enum class Align : unsigned char { left, centre, right };

class Canvas {
 public:
  /// `font`: a TrueType file. Errors: the font can't be read.
  static Result<Canvas> create(int width, int height, const std::filesystem::path& font);

  /// Fills the picture with a gradient from one grey at the top to another at the bottom.
  void ground(const Ink& above, const Ink& below);
  void polygon(const std::vector<Spot2>& corners, const Ink& ink);
  void box(const Frame& frame, const Ink& ink);
  void outline(const Frame& frame, double width, const Ink& ink);
  /// `dash` > 0: length of strokes and gaps.
  void line(Spot2 from, Spot2 to, double width, const Ink& ink, double dash = 0);
  void arrow(Spot2 from, Spot2 to, double width, const Ink& ink);
  void disc(Spot2 middle, double radius, const Ink& ink);
  /// `at`: on the baseline. UTF-8. Returns the width.
  double text(Spot2 at, std::string_view words, double size, const Ink& ink, Align align = Align::left);
  double text_width(std::string_view words, double size) const;
  /// Draws a part of a picture with its upper left corner at `at`, each pixel as a box of `step` x `step_y` pixels.
  void pixels(Spot2 at, const viewer::LightImage& image, const std::array<int, 4>& x_y_width_height, double step, double step_y);

  viewer::LightImage picture() const;

 private:
  static constexpr int kFine = 3;  ///< samples along each side of a pixel
  void blend(int x, int y, const Ink& ink, float share);
  void fine_polygon(const std::vector<Spot2>& corners, const Ink& ink);

  int width_ = 0, height_ = 0;  ///< in samples
  std::vector<std::array<float, 3>> samples_;
  std::string font_bytes_;
};

}  // namespace prismesh::optics
