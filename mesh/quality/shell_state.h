// Which metrics of a shell are not ok, and which defects it has.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace prismesh::mesh::quality {

enum class Grade : std::uint8_t { ok, warn, fail };

/// Defects that make a shell invalid: always a failure, whatever the criteria. The value is the bit in ShellState. Shells with a defect
/// have a state and a composite, but don't count in any metric's figures.
enum class Defect : std::uint8_t {
  not_finite = 15,     ///< a coordinate is no finite number (or an edge is longer than 10^38)
  repeated_node = 14,  ///< one node at two corners (other than a triangle's last), or two corners at one place
  no_area = 13,        ///< zero area, or folded onto itself: two corners turned in
};
inline constexpr std::array kDefects = {Defect::not_finite, Defect::repeated_node, Defect::no_area};
inline constexpr std::size_t kDefectCount = kDefects.size();
std::string_view name(Defect defect);  ///< as in the command line's JSON

/// Which metrics of a shell are not ok; bit m is Metric m, the highest ones are defects. fail is a subset of warn.
struct ShellState {
  static constexpr std::uint16_t kGone = 1 << 12;  ///< in `warn`: the shell was removed
  static constexpr std::uint16_t kDefectBits = 1 << int(Defect::not_finite) | 1 << int(Defect::repeated_node) | 1 << int(Defect::no_area);

  std::uint16_t warn = 0;
  std::uint16_t fail = 0;
  static ShellState removed() { return {kGone, 0}; }
  bool is_removed() const { return (warn & kGone) != 0; }  ///< it counts nowhere
  bool has(Defect defect) const { return (fail >> int(defect) & 1) != 0; }
  bool has_defect() const { return (fail & kDefectBits) != 0; }
  /// A removed shell is ok.
  Grade grade() const { return fail != 0 ? Grade::fail : (warn & ~kGone) != 0 ? Grade::warn : Grade::ok; }
  bool operator==(const ShellState&) const = default;
};

}  // namespace prismesh::mesh::quality
