// Criteria: what makes an element warn or fail. Thresholds come from a data file; lengths are relative to the target size.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "mesh/model/index.h"
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

/// Where a part's target size comes from.
enum class SizeFrom : std::uint8_t {
  part,   ///< the median edge of the part
  deck,   ///< the median edge of the deck
  given,  ///< the user
};
std::string_view name(SizeFrom from);  ///< "part", "deck", "given"

/// What the shells of a part are judged by.
struct PartCriteria {
  double target_size = 1;                    ///< deck's length unit
  std::shared_ptr<const Criteria> criteria;  ///< null: the deck's
  SizeFrom size_from = SizeFrom::part;
};

/// What the shells of each part are judged by. Parts that are judged alike share an entry.
struct CriteriaByPart {
  std::vector<PartCriteria> distinct;
  std::vector<std::uint32_t> of_part;  ///< by PartIndex: index into `distinct`

  const PartCriteria& of(PartIndex part) const { return distinct[of_part[part.value]]; }
};

/// Criteria with the target size that their lengths are fractions of.
struct SizedCriteria {
  const Criteria& criteria;
  double target_size = 1;                   ///< deck's length unit
  const CriteriaByPart* by_part = nullptr;  ///< what parts are judged by; null: all shells by the two above

  /// What the shells of a part are judged by, without `by_part`. An invalid part: of shells that belong to none.
  SizedCriteria of(PartIndex part) const {
    if (by_part == nullptr || part.value >= by_part->of_part.size()) return {criteria, target_size};
    const PartCriteria& its = by_part->of(part);
    return {its.criteria ? *its.criteria : criteria, its.target_size};
  }
};

/// Reads a TOML criteria file, or takes the built-in criteria of that name ("default", "strict"; a file of such a name is ./strict).
/// Criteria without a name get that of their file. Errors: file, line and, for an unknown metric, the nearest known one.
Result<Criteria> load_criteria(const std::filesystem::path& path);
/// The text that load_criteria reads. Errors: the disk's; more than kMaxCriteriaBytes.
Result<std::string> criteria_text(const std::filesystem::path& path);
inline constexpr std::size_t kMaxCriteriaBytes = std::size_t{1} << 20;
/// The same from text; `file` names it in errors.
Result<Criteria> parse_criteria(std::string_view text, const std::string& file);
/// The names of the built-in criteria, the default first.
std::vector<std::string_view> built_in_criteria();
/// The criteria files in a folder, ascending by name: files *.toml that parse_criteria takes. Without those in folders below and settings
/// files of decks; max kMaxListedCriteria.
std::vector<std::filesystem::path> criteria_files_in(const std::filesystem::path& folder);
inline constexpr std::size_t kMaxListedCriteria = 50;
/// Whether load_criteria takes this for the name of built-in criteria rather than for a file.
bool is_built_in_criteria(const std::filesystem::path& name);
/// The criteria built in: the same text as mesh/quality/criteria/default.toml, compiled into the program.
const Criteria& default_criteria();

}  // namespace prismesh::mesh::quality
