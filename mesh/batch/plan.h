// A plan of a study: decks, scripts of edits, and parameters that the scripts name. docs/batch.md lists the keys of its file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "mesh/document/judging.h"

namespace prismesh::mesh::batch {

/// A number, or a text such as an expression of parts.
using ParameterValue = std::variant<double, std::string>;
/// As scripts get it: a number with the fewest digits that read back as the same, or the text.
std::string words(const ParameterValue& value);

/// What a parameter can be: one of some values, or any number of a range.
struct Parameter {
  std::string name;
  std::vector<ParameterValue> values;  ///< empty: the range counts
  double from = 0, to = 0;
};

enum class Sampling : std::uint8_t {
  full,             ///< all combinations
  latin_hypercube,  ///< as many samples as asked for; each has a stratum of each parameter for itself
  sobol,            ///< the first points of Sobol's sequence
};

enum class RepairScope : std::uint8_t { none, damaged, all };

struct SlurmWish {
  std::vector<std::string> options;  ///< given to sbatch as they are
  std::size_t max_at_once = 0;       ///< tasks that run at the same time; 0: no limit
  std::size_t max_tasks = 1000;      ///< of the array; Slurm's own limit is MaxArraySize
};

struct Plan {
  std::string name;
  std::vector<std::filesystem::path> decks, scripts;  ///< absolute; each deck is edited by each script
  Sampling sampling = Sampling::full;
  std::size_t samples = 0;            ///< unless `full`
  std::uint64_t seed = 1;             ///< of latin_hypercube
  std::vector<Parameter> parameters;  ///< ascending by name
  RepairScope repair = RepairScope::damaged;
  bool penetrations = true;  ///< are searched
  bool pictures = true;
  std::optional<LengthUnit> length_unit;
  std::optional<document::TargetSize> target_size;
  std::optional<std::string> criteria;  ///< built in, or an absolute path
  std::filesystem::path output;         ///< a folder, absolute
  double max_minutes = 60;              ///< that a variant may take on this machine; Slurm has limits of its own
  SlurmWish slurm;
};

inline constexpr std::size_t kMaxVariants = 1'000'000;
inline constexpr std::size_t kMaxSobolParameters = 10;

/// Parses the text of a plan; `file` names it in errors, and paths are relative to its folder. Errors, with file and line: text that isn't
/// TOML, an unknown key (with the nearest known one), a value of the wrong type, nothing to do, a parameter without values, a range without
/// levels in a full plan, more than kMaxVariants variants.
Result<Plan> parse_plan(std::string_view text, const std::filesystem::path& file);

/// How many sets of values the parameters get, and how many variants there are: a set for each deck and script.
std::size_t sample_count(const Plan& plan);
std::size_t variant_count(const Plan& plan);

}  // namespace prismesh::mesh::batch
