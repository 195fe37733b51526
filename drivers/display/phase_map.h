// Assigns the positions of a picture to eyes: maps, for the whole picture, the number (with fraction) of the mask element through which
// each eye sees a position. An eye's number is an integer in the middle of its window. A pixel shows the eye whose number is nearer to an
// integer.
#pragma once

#include <array>
#include <vector>

#include "drivers/display/optics.h"

namespace prismesh::drivers::display {

/// A picture's area on a panel, in pixels. Positions in the picture are measured from its upper left corner.
struct PanelArea {
  int x = 0, y = 0;  ///< the picture's upper left corner on the panel
  int width = 1, height = 1;
  int panel_columns = 1, panel_rows = 1;
  bool operator==(const PanelArea&) const = default;

  double u_mm(double pixel_x, double pitch_mm) const { return (x + pixel_x - 0.5 * panel_columns) * pitch_mm; }
  double v_mm(double pixel_y, double pitch_mm) const { return (0.5 * panel_rows - y - pixel_y) * pitch_mm; }
};

/// The numbers of both eyes at the nodes of a coarse grid. Interpolating linearly between nodes is accurate to about 1e-4.
struct PhaseMap {
  static constexpr int kStep = 32;  ///< pixels between nodes
  int columns = 0, rows = 0;        ///< number of nodes: at x = kStep * column from the left, y = kStep * row from the *lower* edge
  std::array<int, 2> first{};       ///< per eye (left, right): offset subtracted from its numbers, so that the min. number is in 0..1
  std::array<int, 2> windows{};     ///< per eye: number of windows in the picture, from `first` on
  std::vector<std::array<float, 2>> numbers;  ///< left and right eye, row by row
};

/// Computes the numbers through a mask for eyes relative to the panel's centre. Cost: two evaluations per node, about 0.5 ms for 1920 x
/// 1080.
PhaseMap phase_map(const MaskOptics& optics, const EyePair& eyes_mm, double mask_mm, const PanelArea& area);

/// Numbers that are linear over the picture: number = by_x * x + by_y * y + at_origin, with x and y in pixels from the upper left corner.
struct LinearNumbers {
  double by_x = 0, by_y = 0, at_origin = 0;
  double at(double x, double y) const { return by_x * x + by_y * y + at_origin; }
};
PhaseMap phase_map(const std::array<LinearNumbers, 2>& numbers, int width, int height);

/// Interpolates the numbers (left, right; minus `first`) at a position of the picture.
std::array<double, 2> numbers_at(const PhaseMap& map, int height, double x, double y);

}  // namespace prismesh::drivers::display
