// The part of a scene that is drawn now, so that a large scene can be drawn in pieces. A scene is a sequence of elements (shells, lines,
// nodes, ..), each passed in the same order every time; those inside the span are drawn.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>

namespace prismesh::kiosk::render {

class DrawSpan {
 public:
  /// Elements [from, to) of the scene; the whole scene if nothing is said.
  explicit DrawSpan(std::size_t from = 0, std::size_t to = std::numeric_limits<std::size_t>::max()) : from_(from), to_(to) {}

  struct Part {
    std::size_t first = 0, count = 0;
  };
  /// Passes the next `count` elements. Returns those of them to draw, counted from the first of them.
  Part take(std::size_t count) {
    const std::size_t begin = std::clamp(from_, at_, at_ + count) - at_, end = std::clamp(to_, at_, at_ + count) - at_;
    at_ += count;
    return {begin, end > begin ? end - begin : 0};
  }
  /// Passes a draw that isn't divided and costs about as much as `cost` elements (at least 1). Returns whether to make it.
  bool takes(std::size_t cost = 1) {
    const bool inside = at_ >= from_ && at_ < to_;
    at_ += std::max<std::size_t>(cost, 1);
    return inside;
  }
  /// Whether elements beyond the span have been passed.
  bool leaves_some() const { return at_ > to_; }

 private:
  std::size_t from_, to_;
  std::size_t at_ = 0;
};

}  // namespace prismesh::kiosk::render
