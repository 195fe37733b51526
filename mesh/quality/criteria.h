// What counts as a bad element: thresholds from a data file, lengths relative to the target size.
#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <string>

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
  std::array<Threshold, kMetricCount> thresholds;  ///< indexed by Metric
  double warn_triangles_percent = 100;
  double fail_triangles_percent = 100;
};

/// Reads a TOML criteria file. Errors name the line and, for an unknown metric, the nearest known one.
Result<Criteria> load_criteria(const std::filesystem::path& path);
/// The criteria built in: the same text as mesh/quality/criteria/default.toml, compiled into the program.
const Criteria& default_criteria();

/// Which metrics of a shell are not ok; bit m is Metric m. fail is a subset of warn.
struct ShellState {
  std::uint16_t warn = 0;
  std::uint16_t fail = 0;
  Grade grade() const { return fail != 0 ? Grade::fail : warn != 0 ? Grade::warn : Grade::ok; }
  bool operator==(const ShellState&) const = default;
};

ShellState judge(const Values& values, const Criteria& criteria, double target_size);

}  // namespace prismesh::mesh::quality
