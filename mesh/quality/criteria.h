// What counts as a bad element: thresholds from a data file, lengths relative to the target size.
#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "base/error.h"
#include "mesh/model/model.h"
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
  /// The time step wanted, in the deck's time unit; 0: none. The length that it takes in a shell's material is the least min_length
  /// of that shell, in place of the fraction of the target size, where the material is known.
  double warn_time_step = 0;
  double fail_time_step = 0;
  double time_step_scale = 0.9;         ///< TSSFAC of the deck: not from the file, set by whoever knows the deck
  double warn_triangles_percent = 100;  ///< of the elements of a model or part
  double fail_triangles_percent = 100;
  double warn_triangles_at_node = 4;  ///< more about one node are a cluster (mesh/quality/structure.h)
};

/// Reads a TOML criteria file, or takes the built-in criteria of that name ("default", "strict"; a file of such a name is ./strict). Errors
/// name the line and, for an unknown metric, the nearest known one.
Result<Criteria> load_criteria(const std::filesystem::path& path);
/// The same from text; `file` names it in errors.
Result<Criteria> parse_criteria(std::string_view text, const std::string& file);
/// The criteria built in: the same text as mesh/quality/criteria/default.toml, compiled into the program.
const Criteria& default_criteria();

/// What of a shell besides its corners the criteria may look at; 0 where unknown.
struct Sheet {
  float thickness = 0;   ///< deck's length unit
  float wave_speed = 0;  ///< of the material, deck's units; 0 also where it doesn't limit the time step

  Sheet() = default;
  Sheet(double its_thickness, double its_wave_speed = 0)
      : thickness(static_cast<float>(its_thickness)), wave_speed(static_cast<float>(its_wave_speed)) {}
};
/// Of a model's shell: thickness of its own card, else of its section.
Sheet sheet_of(const Model& model, ShellIndex shell);

/// What makes a shell no shell: always a failure, whatever the criteria. The bit in ShellState. Shells with a defect have states and a
/// composite, but count in no metric's figures.
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
  bool is_removed() const { return (warn & kGone) != 0; }  ///< it counts for nothing
  bool has(Defect defect) const { return (fail >> int(defect) & 1) != 0; }
  bool has_defect() const { return (fail & kDefectBits) != 0; }
  /// A removed shell is ok.
  Grade grade() const { return fail != 0 ? Grade::fail : (warn & ~kGone) != 0 ? Grade::warn : Grade::ok; }
  bool operator==(const ShellState&) const = default;
};

/// Judges one shell's values as measure() gives them. `sheet` counts where the criteria look at it.
ShellState judge(const Values& values, const Criteria& criteria, double target_size, const Sheet& sheet = {});

/// Measures and judges shells given by points, for a drag or a trial: corner >= 0 is moving[corner], < 0 is fixed[~corner]; a triangle
/// repeats its third. `sheets` has one entry a shell, or is empty if unknown. `out` has one entry a shell, `composites`
/// (mesh/quality/composite.h) too or none.
void judge_points(std::span<const Vec3> moving, std::span<const Vec3> fixed, std::span<const std::array<std::int32_t, 4>> corners,
                  std::span<const Sheet> sheets, const Criteria& criteria, double target_size, std::span<ShellState> out,
                  std::span<float> composites = {});

}  // namespace prismesh::mesh::quality
