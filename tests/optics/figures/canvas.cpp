#include "tests/optics/figures/canvas.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <span>

#include <stb_truetype.h>

#include "base/file.h"

namespace prismesh::optics {

namespace {

/// Removes and returns the next character of valid UTF-8 text.
int next_character(std::string_view& text) {
  const auto lead = static_cast<unsigned char>(text[0]);
  const std::size_t length = lead < 0x80 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
  int character = length == 1 ? lead : lead & (0x7F >> length);
  for (std::size_t i = 1; i < length && i < text.size(); ++i) character = character << 6 | (static_cast<unsigned char>(text[i]) & 0x3F);
  text.remove_prefix(std::min(length, text.size()));
  return character;
}

stbtt_fontinfo font_of(const std::string& bytes) {
  stbtt_fontinfo font{};
  stbtt_InitFont(&font, reinterpret_cast<const unsigned char*>(bytes.data()), 0);
  return font;
}

double advance(const stbtt_fontinfo& font, int character, int next, float scale) {
  int width = 0, bearing = 0;
  stbtt_GetCodepointHMetrics(&font, character, &width, &bearing);
  return scale * static_cast<float>(width + (next != 0 ? stbtt_GetCodepointKernAdvance(&font, character, next) : 0));
}

}  // namespace

Result<Canvas> Canvas::create(int width, int height, const std::filesystem::path& font) {
  const Result<FileBytes> file = read_file(font);
  if (!file) return fail(file.error());
  Canvas canvas;
  canvas.font_bytes_ = file->text();
  stbtt_fontinfo info{};
  if (stbtt_InitFont(&info, reinterpret_cast<const unsigned char*>(canvas.font_bytes_.data()), 0) == 0)
    return fail(font.string(), "is no TrueType font");
  canvas.width_ = width * kFine;
  canvas.height_ = height * kFine;
  canvas.samples_.resize(static_cast<std::size_t>(canvas.width_) * static_cast<std::size_t>(canvas.height_));
  return canvas;
}

void Canvas::blend(int x, int y, const Ink& ink, float share) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
  std::array<float, 3>& at = samples_[static_cast<std::size_t>(y) * width_ + x];
  const float cover = share * ink.cover;
  at = {at[0] + cover * (ink.red - at[0]), at[1] + cover * (ink.green - at[1]), at[2] + cover * (ink.blue - at[2])};
}

void Canvas::ground(const Ink& above, const Ink& below) {
  for (int y = 0; y < height_; ++y) {
    const float t = static_cast<float>(y) / static_cast<float>(height_);
    const Ink mixed{above.red + t * (below.red - above.red), above.green + t * (below.green - above.green),
                    above.blue + t * (below.blue - above.blue)};
    for (int x = 0; x < width_; ++x) blend(x, y, mixed, 1);
  }
}

/// Corners in samples; fills by the even-odd rule.
void Canvas::fine_polygon(const std::vector<Spot2>& corners, const Ink& ink) {
  if (corners.empty()) return;
  const auto [low, high] = std::minmax_element(corners.begin(), corners.end(), [](const Spot2& a, const Spot2& b) { return a.y < b.y; });
  const int first = std::max(0, static_cast<int>(std::floor(low->y))), last = std::min(height_ - 1, static_cast<int>(std::ceil(high->y)));
  std::vector<double> crossings;
  for (int y = first; y <= last; ++y) {
    const double middle = y + 0.5;
    crossings.clear();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Spot2 &a = corners[i], &b = corners[(i + 1) % corners.size()];
      if ((a.y <= middle) != (b.y <= middle)) crossings.push_back(a.x + (middle - a.y) / (b.y - a.y) * (b.x - a.x));
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
      for (int x = std::max(0, static_cast<int>(std::ceil(crossings[i] - 0.5))); x < width_ && x + 0.5 < crossings[i + 1]; ++x)
        blend(x, y, ink, 1);
  }
}

void Canvas::polygon(const std::vector<Spot2>& corners, const Ink& ink) {
  std::vector<Spot2> fine;
  fine.reserve(corners.size());
  for (const Spot2& corner : corners) fine.push_back({corner.x * kFine, corner.y * kFine});
  fine_polygon(fine, ink);
}

void Canvas::box(const Frame& f, const Ink& ink) {
  polygon({{f.x, f.y}, {f.x + f.width, f.y}, {f.x + f.width, f.y + f.height}, {f.x, f.y + f.height}}, ink);
}

void Canvas::outline(const Frame& f, double width, const Ink& ink) {
  box({f.x - width, f.y - width, f.width + 2 * width, width}, ink);
  box({f.x - width, f.y + f.height, f.width + 2 * width, width}, ink);
  box({f.x - width, f.y, width, f.height}, ink);
  box({f.x + f.width, f.y, width, f.height}, ink);
}

void Canvas::line(Spot2 from, Spot2 to, double width, const Ink& ink, double dash) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  if (length <= 0) return;
  const Spot2 along{(to.x - from.x) / length, (to.y - from.y) / length}, aside{-0.5 * width * along.y, 0.5 * width * along.x};
  const double stroke = dash > 0 ? dash : length;
  for (double begin = 0; begin < length; begin += 2 * stroke) {
    const double end = std::min(length, begin + stroke);
    const Spot2 a{from.x + begin * along.x, from.y + begin * along.y}, b{from.x + end * along.x, from.y + end * along.y};
    polygon(
        {{a.x + aside.x, a.y + aside.y}, {b.x + aside.x, b.y + aside.y}, {b.x - aside.x, b.y - aside.y}, {a.x - aside.x, a.y - aside.y}},
        ink);
  }
}

void Canvas::arrow(Spot2 from, Spot2 to, double width, const Ink& ink) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  if (length <= 0) return;
  const Spot2 along{(to.x - from.x) / length, (to.y - from.y) / length};
  const double head = std::min(length, 5 * width);
  const Spot2 neck{to.x - head * along.x, to.y - head * along.y};
  line(from, neck, width, ink);
  polygon(
      {to, {neck.x - 0.5 * head * along.y, neck.y + 0.5 * head * along.x}, {neck.x + 0.5 * head * along.y, neck.y - 0.5 * head * along.x}},
      ink);
}

void Canvas::disc(Spot2 middle, double radius, const Ink& ink) {
  constexpr int kCorners = 64;
  std::vector<Spot2> corners;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners;
    corners.push_back({middle.x + radius * std::cos(angle), middle.y + radius * std::sin(angle)});
  }
  polygon(corners, ink);
}

double Canvas::text_width(std::string_view words, double size) const {
  const stbtt_fontinfo font = font_of(font_bytes_);
  const float scale = stbtt_ScaleForPixelHeight(&font, static_cast<float>(size));
  double width = 0;
  while (!words.empty()) {
    const int character = next_character(words);
    std::string_view rest = words;
    width += advance(font, character, rest.empty() ? 0 : next_character(rest), scale);
  }
  return width;
}

double Canvas::text(Spot2 at, std::string_view words, double size, const Ink& ink, Align align) {
  const stbtt_fontinfo font = font_of(font_bytes_);
  const float scale = stbtt_ScaleForPixelHeight(&font, static_cast<float>(size * kFine));
  const double width = text_width(words, size);
  double x = kFine * (at.x - (align == Align::right ? width : align == Align::centre ? 0.5 * width : 0));
  const int baseline = static_cast<int>(std::lround(kFine * at.y));
  while (!words.empty()) {
    const int character = next_character(words);
    const auto whole = static_cast<int>(std::floor(x));
    int wide = 0, high = 0, left = 0, top = 0;
    const std::unique_ptr<unsigned char, decltype(&std::free)> glyph(
        stbtt_GetCodepointBitmapSubpixel(&font, scale, scale, static_cast<float>(x - whole), 0, character, &wide, &high, &left, &top),
        &std::free);
    for (int j = 0; j < high; ++j)
      for (int i = 0; i < wide; ++i) blend(whole + left + i, baseline + top + j, ink, static_cast<float>(glyph.get()[j * wide + i]) / 255);
    std::string_view rest = words;
    x += advance(font, character, rest.empty() ? 0 : next_character(rest), scale);
  }
  return width;
}

void Canvas::pixels(Spot2 at, const viewer::LightImage& image, const std::array<int, 4>& part, double step, double step_y) {
  const auto [x0, y0, width, height] = part;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const viewer::Colour& light = image.at(x0 + x, y0 + y);
      box({at.x + x * step, at.y + y * step_y, step, step_y},
          {viewer::srgb_from_linear(light[0]), viewer::srgb_from_linear(light[1]), viewer::srgb_from_linear(light[2])});
    }
}

viewer::LightImage Canvas::picture() const {
  // Averages sRGB values, as screens do for texts and thin lines.
  viewer::LightImage image(width_ / kFine, height_ / kFine);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        float sum = 0;
        for (int j = 0; j < kFine; ++j)
          for (int i = 0; i < kFine; ++i) sum += samples_[static_cast<std::size_t>(y * kFine + j) * width_ + x * kFine + i][c];
        image.at(x, y)[c] = viewer::linear_from_srgb(sum / (kFine * kFine));
      }
  return image;
}

}  // namespace prismesh::optics
