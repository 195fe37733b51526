// What a simulated hand does, from a text file: for demonstrations and tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "base/error.h"
#include "drivers/haptic_pen/simulated_pen.h"

namespace prismesh::drivers::haptic_pen {

/// Lines of: seconds since the start, the place that the hand goes to (x y z, mm), the buttons (0 to 3, a bit each), how far it trembles
/// (mm), and `holds` or `free`. Between two lines the hand goes straight from one place to the next; buttons, trembling and grip are those
/// of the line before. After the last line the hand stays. '#' begins a comment.
class HandScript {
 public:
  /// Errors: a line that can't be read, a time that doesn't rise, a place more than 60 mm from the middle, no line; with its line.
  static Result<HandScript> parse(std::string_view text, const std::string& file);
  /// The hand at a time. Doesn't allocate; quick for times that rise.
  SimulatedHand at(double seconds) const;
  double seconds() const { return lines_.back().seconds; }  ///< of the last line

 private:
  struct Line {
    double seconds = 0;
    Eigen::Vector3d place_mm = Eigen::Vector3d::Zero();
    std::uint32_t buttons = 0;
    double tremble_mm = 0;
    bool holds = true;
  };
  std::vector<Line> lines_;
};

}  // namespace prismesh::drivers::haptic_pen
