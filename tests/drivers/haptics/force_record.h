// The record of a haptic loop as plain numbers, for the checker.
#pragma once

#include <array>
#include <cstdint>

namespace prismesh::test {

/// One of the forces that the loop asked for.
struct RecordedPart {
  double newton[3] = {};
  std::int64_t from_ns = 0;  ///< 0: doesn't age
  bool damping = false;
};

/// One tick: what went in, and the force that was sent.
struct RecordedTick {
  std::int64_t now_ns = 0;
  double position_mm[3] = {};
  std::int64_t measured_ns = 0;
  bool ready = false;
  bool io_error = false;
  std::uint32_t lost_replies = 0;
  bool rearm = false;
  std::array<RecordedPart, 6> parts;
  std::uint32_t part_count = 0;
  double force_newton[3] = {};
  std::int64_t valid_until_ns = 0;
};

}  // namespace prismesh::test
