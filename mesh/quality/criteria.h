// Criteria: what makes an element warn or fail. Thresholds come from a data file; lengths are relative to the target size.
#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>

#include "base/error.h"
#include "mesh/quality/metrics.h"

namespace prismesh::mesh::quality {

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
  std::array<Threshold, kMetricCount> triangle;  ///< indexed by Metric; as `quad` unless the file sets triangles apart
  /// Limit of min_length as a multiple of the shell's thickness; the larger of it and the fraction of the target size counts.
  float warn_min_length_thicknesses = 0;
  float fail_min_length_thicknesses = 0;
  /// The time step wanted, in the deck's time unit; 0: none. Where a shell's material is known, the length that the step needs in it is the
  /// limit of min_length, in place of the fraction of the target size.
  double warn_time_step = 0;
  double fail_time_step = 0;
  double time_step_scale = 0.9;         ///< TSSFAC of the deck; not from the criteria file
  double warn_triangles_percent = 100;  ///< of the elements of a model or part
  double fail_triangles_percent = 100;
  double warn_triangles_at_node = 4;  ///< max triangles about a node; more are a cluster (mesh/quality/structure.h)
};

/// Criteria with the target size that their lengths are fractions of.
struct SizedCriteria {
  const Criteria& criteria;
  double target_size = 1;  ///< deck's length unit
};

/// Reads a TOML criteria file, or takes the built-in criteria of that name ("default", "strict"; a file of such a name is ./strict).
/// Errors: file, line and, for an unknown metric, the nearest known one.
Result<Criteria> load_criteria(const std::filesystem::path& path);
/// The same from text; `file` names it in errors.
Result<Criteria> parse_criteria(std::string_view text, const std::string& file);
/// Whether load_criteria takes this for the name of built-in criteria rather than for a file.
bool is_built_in_criteria(const std::filesystem::path& name);
/// The criteria built in: the same text as mesh/quality/criteria/default.toml, compiled into the program.
const Criteria& default_criteria();

}  // namespace prismesh::mesh::quality
