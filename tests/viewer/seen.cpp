#include "tests/viewer/seen.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace prismesh::viewer {

namespace {

/// Light of one row of the panel as a function of position; integrates in constant time.
class RowLight {
 public:
  RowLight(const Panel& panel, const Colour* row) : panel_(panel), row_(row) {
    for (int channel = 0; channel < 3; ++channel) {
      const int stripe = panel.stripes == Stripes::bgr ? 2 - channel : channel;
      const double width = panel.stripes == Stripes::none ? 1 : 1.0 / 3, from = panel.stripes == Stripes::none ? 0 : stripe * width;
      begin_[channel] = from + 0.5 * panel.black_share * width;
      width_[channel] = (1 - panel.black_share) * width;
    }
    sums_.resize(static_cast<std::size_t>(panel.columns) + 1);
    for (int i = 0; i < panel.columns; ++i)
      for (int channel = 0; channel < 3; ++channel)
        sums_[static_cast<std::size_t>(i) + 1][channel] = sums_[static_cast<std::size_t>(i)][channel] + row[i][channel];
  }

  /// Mean light between two positions, in pixels from the panel's left border. Beyond the borders it is dark.
  Colour between(double from, double to) const {
    Colour mean{};
    for (int channel = 0; channel < 3; ++channel)
      mean[channel] = static_cast<float>((up_to(to, channel) - up_to(from, channel)) / (to - from));
    return mean;
  }

 private:
  double up_to(double place, int channel) const {
    if (place <= 0) return 0;
    if (place >= panel_.columns) return sums_.back()[channel];
    const auto pixel = static_cast<std::size_t>(place);
    const double share = std::clamp((place - static_cast<double>(pixel) - begin_[channel]) / width_[channel], 0.0, 1.0);
    return sums_[pixel][channel] + share * row_[pixel][channel];
  }
  const Panel& panel_;
  const Colour* row_;
  double begin_[3] = {}, width_[3] = {};
  std::vector<std::array<double, 3>> sums_;
};

double pixels_from_left(const Panel& panel, double u_mm) { return u_mm / panel.pitch_mm + 0.5 * panel.columns; }

/// The elements whose windows are on the panel, `margin_mm` from its border, in every row.
void find_elements(const MaskDisplay& display, const Point& eye, double mask_mm, double margin_mm, Seen& seen) {
  const double side = 0.5 * display.panel.width_mm() - margin_mm;
  double low = -1e9, high = 1e9;
  for (const int row : {0, display.panel.rows / 2, display.panel.rows - 1}) {
    const double v = display.panel.row_height_mm(row);
    low = std::max(low, element_at(display, eye, mask_mm, -side, v));
    high = std::min(high, element_at(display, eye, mask_mm, side, v));
  }
  seen.first_element = static_cast<int>(std::ceil(low));
  seen.elements = std::max(0, static_cast<int>(std::floor(high)) - seen.first_element + 1);
}

Colour mixed(const RowLight& row, double at, double half_width, double half_period, double leak) {
  Colour light = row.between(at - half_width, at + half_width);
  if (leak <= 0) return light;
  const Colour left = row.between(at - half_period - half_width, at - half_period + half_width);
  const Colour right = row.between(at + half_period - half_width, at + half_period + half_width);
  for (std::size_t c = 0; c < 3; ++c) light[c] += static_cast<float>(0.5 * leak) * (left[c] + right[c]);
  return light;
}

}  // namespace

LightImage Seen::image() const {
  LightImage picture(elements, rows);
  picture.pixels = light;
  return picture;
}

Result<Viewpoint> Viewpoint::at(const MaskDisplay& display, const Point& eye, double mask_mm, const Sharpness& sharpness) {
  if (const Result<void> checked = display.check(); !checked) return fail(checked.error());
  if (!(eye.z > 1)) return fail("eye", "must be more than 1 mm before the screen");
  if (!(sharpness.window_pixels > 0.01 && sharpness.window_pixels < 20 && sharpness.leak >= 0 && sharpness.leak < 1))
    return fail("window", "must be from 0.01 to 20 pixels wide, and its leak from 0 to less than 1");
  Viewpoint view;
  view.panel_ = display.panel;
  view.sharpness_ = sharpness;
  view.period_pixels_ = display.element_pitch_mm() * (eye.z + display.air_gap_mm()) / eye.z / display.panel.pitch_mm;
  Seen& places = view.places_;
  places.rows = display.panel.rows;
  places.window_mm = sharpness.window_pixels * display.panel.pitch_mm;
  find_elements(display, eye, mask_mm, 0.5 * places.window_mm, places);
  places.light.resize(static_cast<std::size_t>(places.elements) * places.rows);
  places.place_mm.resize(places.light.size());
  for (int y = 0; y < places.rows; ++y) {
    const double v = display.panel.row_height_mm(y);
    for (int i = 0; i < places.elements; ++i)
      places.place_mm[places.index(i, y)] = static_cast<float>(window_of(display, eye, mask_mm, places.first_element + i, v).u_mm);
  }
  return view;
}

Result<Seen> Viewpoint::look(const LightImage& picture) const {
  if (picture.width != panel_.columns || picture.height != panel_.rows)
    return fail("picture", "is " + std::to_string(picture.width) + "x" + std::to_string(picture.height) + ", but the panel has " +
                               std::to_string(panel_.columns) + "x" + std::to_string(panel_.rows) + " pixels");
  Seen seen = places_;
  for (int y = 0; y < seen.rows; ++y) {
    const RowLight row(panel_, &picture.pixels[static_cast<std::size_t>(y) * picture.width]);
    for (int i = 0; i < seen.elements; ++i)
      seen.light[seen.index(i, y)] = mixed(row, pixels_from_left(panel_, seen.place_mm[seen.index(i, y)]), 0.5 * sharpness_.window_pixels,
                                           0.5 * period_pixels_, sharpness_.leak);
  }
  return seen;
}

Result<Seen> look(const MaskDisplay& display, const LightImage& picture, const Point& eye, double mask_mm, const Sharpness& sharpness) {
  const Result<Viewpoint> view = Viewpoint::at(display, eye, mask_mm, sharpness);
  return view ? view->look(picture) : fail(view.error());
}

Seen ordinary(const MaskDisplay& display, const LightImage& picture, const Seen& places) {
  Panel plain = display.panel;
  plain.stripes = Stripes::none;
  plain.black_share = 0;
  Seen seen = places;
  seen.window_mm = 2 * plain.pitch_mm;
  for (int y = 0; y < seen.rows; ++y) {
    const RowLight row(plain, &picture.pixels[static_cast<std::size_t>(y) * picture.width]);
    for (int i = 0; i < seen.elements; ++i) {
      const double at = pixels_from_left(plain, seen.place_mm[seen.index(i, y)]);
      seen.light[seen.index(i, y)] = row.between(at - 1, at + 1);
    }
  }
  return seen;
}

LightImage on_grid(const MaskDisplay& display, const Seen& seen, int columns) {
  LightImage image(columns, seen.rows);
  if (seen.elements == 0) return image;
  for (int y = 0; y < seen.rows; ++y) {
    const float* places = &seen.place_mm[seen.index(0, y)];
    for (int x = 0; x < columns; ++x) {
      const double u = ((x + 0.5) / columns - 0.5) * display.panel.width_mm();
      const auto after = static_cast<int>(std::upper_bound(places, places + seen.elements, static_cast<float>(u)) - places);
      const int left = std::clamp(after - 1, 0, seen.elements - 1), right = std::min(after, seen.elements - 1);
      const double span = places[right] - places[left];
      const auto share = static_cast<float>(span > 0 ? (u - places[left]) / span : 0);
      for (std::size_t c = 0; c < 3; ++c) image.at(x, y)[c] = (1 - share) * seen.at(left, y)[c] + share * seen.at(right, y)[c];
    }
  }
  return image;
}

namespace {
double difference_of(const std::vector<Colour>& a, const std::vector<Colour>& b) {
  double sum = 0;
  const std::size_t count = std::min(a.size(), b.size());
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < 3; ++c) sum += std::abs(level(a[i][c]) - level(b[i][c]));
  return count == 0 ? 0 : sum / (3.0 * static_cast<double>(count));
}
float grey(const Colour& colour) { return (colour[0] + colour[1] + colour[2]) / 3; }
}  // namespace

double mean_difference(const Seen& a, const Seen& b) { return difference_of(a.light, b.light); }
double mean_difference(const LightImage& a, const LightImage& b) { return difference_of(a.pixels, b.pixels); }

double share_of_other(const Seen& seen, const Seen& own, const Seen& other) {
  // With e = own and d = other - own, seen = (a + b) e + b d: two unknowns, well separated where the pictures differ.
  double ee = 0, ed = 0, dd = 0, se = 0, sd = 0;
  for (int y = 0; y < seen.rows; ++y)
    for (int x = 1; x < seen.elements; ++x) {
      const auto slope = [&](const Seen& picture) { return grey(picture.at(x, y)) - grey(picture.at(x - 1, y)); };
      const double s = slope(seen), e = slope(own), d = slope(other) - e;
      ee += e * e, ed += e * d, dd += d * d, se += s * e, sd += s * d;
    }
  const double determinant = ee * dd - ed * ed;
  return determinant > 1e-9 * ee * dd && dd > 0 ? (sd * ee - se * ed) / determinant : 0;
}

namespace {
/// Calls `piece(cells)` for each set of connected (8 neighbours) elements and rows that differ by more than `levels`; `cells` are indices.
template <class Piece>
void for_each_piece(const Seen& seen, const Seen& ground, double levels, const Piece& piece) {
  std::vector<char> ink(seen.light.size());
  for (std::size_t i = 0; i < ink.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) ink[i] |= std::abs(level(seen.light[i][c]) - level(ground.light[i][c])) > levels;
  std::vector<std::size_t> cells;
  for (std::size_t start = 0; start < ink.size(); ++start) {
    if (ink[start] == 0) continue;
    ink[start] = 0;
    cells.assign(1, start);
    for (std::size_t next = 0; next < cells.size(); ++next) {
      const int x = static_cast<int>(cells[next]) % seen.elements, y = static_cast<int>(cells[next]) / seen.elements;
      for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, seen.rows - 1); ++ny)
        for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, seen.elements - 1); ++nx)
          if (char& cell = ink[seen.index(nx, ny)]; cell != 0) {
            cell = 0;
            cells.push_back(seen.index(nx, ny));
          }
    }
    piece(cells);
  }
}
}  // namespace

Spot spot_in(const Seen& seen, const Seen& ground, double levels) {
  Spot strongest;
  for_each_piece(seen, ground, levels, [&](const std::vector<std::size_t>& cells) {
    Spot spot;
    for (const std::size_t cell : cells) {
      const double weight = std::abs(grey(seen.light[cell]) - grey(ground.light[cell]));
      const int row = static_cast<int>(cell) / seen.elements, element = static_cast<int>(cell) % seen.elements;
      spot.element += weight * (seen.first_element + element);
      spot.row += weight * (row + 0.5);
      spot.light += weight;
    }
    if (spot.light > strongest.light) strongest = spot;
  });
  if (strongest.light > 0) strongest.element /= strongest.light, strongest.row /= strongest.light;
  return strongest;
}

int pieces_in(const Seen& seen, const Seen& ground, double levels) {
  int found = 0;
  for_each_piece(seen, ground, levels, [&](const std::vector<std::size_t>&) { ++found; });
  return found;
}

}  // namespace prismesh::viewer
