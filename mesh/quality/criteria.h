// What counts as a bad element: thresholds from a data file, lengths relative to the target size.
#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "base/error.h"
#include "mesh/quality/metrics.h"

namespace prismesh::mesh::quality {

enum class Grade : std::uint8_t { ok, warn, fail };

/// A value outside [warn_low, warn_high] is a warning, outside [fail_low, fail_high] a failure. Length metrics are in
/// fractions of the target size.
struct Threshold {
  float warn_low = -std::numeric_limits<float>::infinity();
  float warn_high = std::numeric_limits<float>::infinity();
  float fail_low = -std::numeric_limits<float>::infinity();
  float fail_high = std::numeric_limits<float>::infinity();
};

struct Criteria {
  std::string name;
  std::array<Threshold, kMetricCount> quad;      ///< indexed by Metric
  std::array<Threshold, kMetricCount> triangle;  ///< the same, where a file sets triangles apart
  /// Least min_length as a multiple of the shell's thickness, where that is more than the fraction of the target size says.
  float warn_min_length_thicknesses = 0;
  float fail_min_length_thicknesses = 0;
  double warn_triangles_percent = 100;  ///< of the elements of a model or part
  double fail_triangles_percent = 100;
};

/// Reads a TOML criteria file. Errors name the line and, for an unknown metric, the nearest known one.
Result<Criteria> load_criteria(const std::filesystem::path& path);
/// The same from text; `file` names it in errors.
Result<Criteria> parse_criteria(std::string_view text, const std::string& file);
/// The criteria built in: the same text as mesh/quality/criteria/default.toml, compiled into the program.
const Criteria& default_criteria();

/// What makes a shell no shell: always a failure, whatever the criteria. The bit in ShellState.
enum class Defect : std::uint8_t {
  not_finite = 15,     ///< a coordinate is no finite number
  repeated_node = 14,  ///< one node at two corners (other than a triangle's last), or two corners at one place
  no_area = 13,        ///< zero area, or folded onto itself
};

/// Which metrics of a shell are not ok; bit m is Metric m, the highest ones are defects. fail is a subset of warn.
struct ShellState {
  std::uint16_t warn = 0;
  std::uint16_t fail = 0;
  Grade grade() const { return fail != 0 ? Grade::fail : warn != 0 ? Grade::warn : Grade::ok; }
  bool operator==(const ShellState&) const = default;
};

/// Judges one shell's values. `thickness` (deck's length unit) counts where the criteria look at it; 0 if unknown.
ShellState judge(const Values& values, const Criteria& criteria, double target_size, double thickness = 0);

/// Measures and judges shells given by points, for a drag: corner >= 0 is moving[corner], < 0 is fixed[~corner]; a triangle
/// repeats its third. `thickness` has one entry a shell, or is empty if unknown. `out` has one entry a shell.
void judge_points(std::span<const Vec3> moving, std::span<const Vec3> fixed, std::span<const std::array<std::int32_t, 4>> corners,
                  std::span<const float> thickness, const Criteria& criteria, double target_size, std::span<ShellState> out);

}  // namespace prismesh::mesh::quality
