#include "mesh/batch/plan.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/nearest_name.h"

#include <toml++/toml.h>

namespace prismesh::mesh::batch {

namespace {

namespace fs = std::filesystem;
using Known = std::vector<std::string_view>;

constexpr std::size_t kMaxSamples = kMaxVariants;
constexpr double kMaxValue = 1e15;

bool is_name(std::string_view text) {
  if (text.empty() || (text[0] >= '0' && text[0] <= '9')) return false;
  for (const char c : text)
    if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_')) return false;
  return true;
}

class PlanReader {
 public:
  PlanReader(fs::path file, Plan& plan)
      : file_(std::move(file)), folder_(fs::absolute(file_).lexically_normal().parent_path()), plan_(plan) {}

  Result<void> read(const toml::table& root) {
    const Known known = {"name",     "decks",       "scripts",     "plan",     "samples", "seed",  "repair",      "penetrations",
                         "pictures", "length_unit", "target_size", "criteria", "output",  "slurm", "max_minutes", "parameters"};
    if (auto done = check_keys(root, known, "a plan"); !done) return done;
    plan_.name = file_.stem().string();
    if (auto done = texts(root); !done) return done;
    if (auto done = files(root, "decks", plan_.decks, "a deck"); !done) return done;
    if (auto done = files(root, "scripts", plan_.scripts, "a script of edits"); !done) return done;
    if (auto done = switches(root); !done) return done;
    if (auto done = judging(root); !done) return done;
    if (const toml::node* slurm = root.get("slurm"))
      if (auto done = read_slurm(*slurm); !done) return done;
    if (auto done = sampling(root); !done) return done;
    if (const toml::node* parameters = root.get("parameters"))
      if (auto done = read_parameters(*parameters); !done) return done;
    return check_size(root);
  }

 private:
  tl::unexpected<Error> error(const toml::node& at, std::string message) const {
    return fail(file_.string(), static_cast<long>(at.source().begin.line), std::move(message));
  }

  Result<void> check_keys(const toml::table& table, const Known& known, const std::string& owner) const {
    for (const auto& [key, node] : table) {
      if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
      return error(node, owner + " has no \"" + std::string(key.str()) + "\"; the nearest known is \"" +
                             std::string(nearest_name(key.str(), known)) + "\"");
    }
    return {};
  }

  fs::path resolved(const std::string& path) const { return (folder_ / path).lexically_normal(); }

  Result<void> text(const toml::table& root, const char* key, std::optional<std::string>& value) const {
    const toml::node* node = root.get(key);
    if (node == nullptr) return {};
    value = node->value<std::string>();
    if (!node->is_string() || !value || value->empty()) return error(*node, std::string(key) + " must be a text in quotes");
    return {};
  }

  Result<void> texts(const toml::table& root) {
    std::optional<std::string> name, output;
    if (auto done = text(root, "name", name); !done) return done;
    if (auto done = text(root, "output", output); !done) return done;
    if (name) plan_.name = *name;
    plan_.output = resolved(output.value_or(file_.stem().string() + ".results"));
    return {};
  }

  Result<void> files(const toml::table& root, const char* key, std::vector<fs::path>& paths, const std::string& what) const {
    const toml::node* node = root.get(key);
    if (node == nullptr) return fail(file_.string(), std::string(key) + " is missing: the plan names no " + what.substr(2));
    const toml::array* list = node->as_array();
    if (list == nullptr || list->empty())
      return error(*node, std::string(key) + " must be a list of files, like [\"" + what.substr(2) + "\"]");
    for (const toml::node& each : *list) {
      const auto path = each.value<std::string>();
      if (!each.is_string() || path->empty()) return error(each, std::string(key) + " must be a list of files");
      fs::path file = resolved(*path);
      std::error_code failed;
      if (!fs::is_regular_file(file, failed)) return error(each, "there is no file " + file.string() + ", which the plan names as " + what);
      if (std::find(paths.begin(), paths.end(), file) != paths.end()) return error(each, "names " + file.string() + " twice");
      paths.push_back(std::move(file));
    }
    return {};
  }

  template <class Value>
  Result<void> word(const toml::table& root, const char* key, const std::vector<std::pair<std::string_view, Value>>& words,
                    Value& value) const {
    const toml::node* node = root.get(key);
    if (node == nullptr) return {};
    const auto given = node->value<std::string>();
    std::string list;
    for (const auto& [name, meant] : words) {
      if (node->is_string() && given == name) return value = meant, Result<void>();
      list += (list.empty() ? "" : ", ") + std::string(name);
    }
    return error(*node, std::string(key) + " must be one of " + list);
  }

  Result<void> boolean(const toml::table& root, const char* key, bool& value) const {
    const toml::node* node = root.get(key);
    if (node == nullptr) return {};
    if (!node->is_boolean()) return error(*node, std::string(key) + " must be true or false");
    value = *node->value<bool>();
    return {};
  }

  Result<void> whole(const toml::table& table, const char* key, std::size_t least, std::size_t most, std::size_t& value) const {
    const toml::node* node = table.get(key);
    if (node == nullptr) return {};
    const auto given = node->value<std::int64_t>();
    if (!node->is_integer() || *given < static_cast<std::int64_t>(least) || *given > static_cast<std::int64_t>(most))
      return error(*node, std::string(key) + " must be a whole number from " + std::to_string(least) + " to " + std::to_string(most));
    value = static_cast<std::size_t>(*given);
    return {};
  }

  Result<double> number(const toml::node& node, const std::string& what) const {
    // a whole number beyond 2^53 is no double to toml++
    const std::optional<std::int64_t> whole = node.is_integer() ? node.value<std::int64_t>() : std::nullopt;
    const std::optional<double> value = whole ? static_cast<double>(*whole) : node.value<double>();
    if (!node.is_number() || !value || std::isnan(*value)) return error(node, what + " must be a number");
    if (std::abs(*value) > kMaxValue) return error(node, what + " must be a number from -1e15 to 1e15");
    return *value;
  }

  Result<void> switches(const toml::table& root) {
    if (auto done = boolean(root, "penetrations", plan_.penetrations); !done) return done;
    if (auto done = boolean(root, "pictures", plan_.pictures); !done) return done;
    if (const toml::node* minutes = root.get("max_minutes")) {
      const Result<double> value = number(*minutes, "max_minutes");
      if (!value) return fail(value.error());
      if (!(*value > 0)) return error(*minutes, "max_minutes must be above 0");
      plan_.max_minutes = *value;
    }
    return word<RepairScope>(root, "repair", {{"none", RepairScope::none}, {"damaged", RepairScope::damaged}, {"all", RepairScope::all}},
                             plan_.repair);
  }

  Result<void> judging(const toml::table& root) {
    if (const toml::node* unit = root.get("length_unit")) {
      const auto given = unit->value<std::string>();
      if (unit->is_string()) plan_.length_unit = length_unit_from(*given);
      if (!plan_.length_unit) return error(*unit, "length_unit must be mm, m or in");
    }
    if (const toml::node* size = root.get("target_size")) {
      if (size->is_number()) {
        const Result<double> value = number(*size, "target_size");
        if (!value) return fail(value.error());
        plan_.target_size = *value;
      } else if (size->value<std::string>() == "part" || size->value<std::string>() == "deck")
        plan_.target_size = *size->value<std::string>() == "part" ? document::SizeGuess::part : document::SizeGuess::deck;
      const double* length = plan_.target_size ? std::get_if<double>(&*plan_.target_size) : nullptr;
      if (!plan_.target_size || (length != nullptr && !(*length > 0 && *length <= kMaxValue)))
        return error(*size, "target_size must be a number above 0, \"part\" or \"deck\"");
    }
    if (auto done = text(root, "criteria", plan_.criteria); !done) return done;
    if (plan_.criteria && !quality::is_built_in_criteria(*plan_.criteria)) {
      const fs::path file = resolved(*plan_.criteria);
      std::error_code failed;
      if (!fs::is_regular_file(file, failed)) return error(*root.get("criteria"), "there is no file of criteria " + file.string());
      plan_.criteria = file.string();
    }
    return {};
  }

  Result<void> read_slurm(const toml::node& node) {
    const toml::table* table = node.as_table();
    if (table == nullptr) return error(node, "slurm must be a table, like [slurm]");
    if (auto done = check_keys(*table, {"options", "max_at_once", "max_tasks"}, "slurm"); !done) return done;
    if (auto done = whole(*table, "max_at_once", 1, 1'000'000, plan_.slurm.max_at_once); !done) return done;
    if (auto done = whole(*table, "max_tasks", 1, 1'000'000, plan_.slurm.max_tasks); !done) return done;
    const toml::node* options = table->get("options");
    if (options == nullptr) return {};
    const toml::array* list = options->as_array();
    if (list == nullptr) return error(*options, "options must be a list of texts, like [\"--partition=long\"]");
    for (const toml::node& each : *list) {
      const auto option = each.value<std::string>();
      if (!each.is_string() || !option->starts_with("--"))
        return error(each, "options are those of sbatch in their long form, like \"--partition=long\"");
      plan_.slurm.options.push_back(*option);
    }
    return {};
  }

  Result<void> sampling(const toml::table& root) {
    if (auto done = word<Sampling>(root, "plan",
                                   {{"full", Sampling::full}, {"latin-hypercube", Sampling::latin_hypercube}, {"sobol", Sampling::sobol}},
                                   plan_.sampling);
        !done)
      return done;
    const bool is_full = plan_.sampling == Sampling::full;
    if (is_full && root.get("samples") != nullptr)
      return error(*root.get("samples"), "samples are for latin-hypercube and sobol; a full plan has all combinations");
    if (!is_full && root.get("samples") == nullptr)
      return error(*root.get("plan"), "this plan needs samples: how many sets of values the parameters get");
    if (auto done = whole(root, "samples", 1, kMaxSamples, plan_.samples); !done) return done;
    std::size_t seed = plan_.seed;
    if (auto done = whole(root, "seed", 0, std::size_t{1} << 53, seed); !done) return done;
    plan_.seed = seed;
    return {};
  }

  Result<void> read_values(const toml::node& node, Parameter& parameter) const {
    const toml::array* list = node.as_array();
    if (list == nullptr || list->empty())
      return error(node, "the parameter " + parameter.name + " has no values: write them as a list, like [2, 4, 6]");
    for (const toml::node& each : *list) {
      if (each.is_string()) {
        parameter.values.emplace_back(*each.value<std::string>());
        continue;
      }
      const Result<double> value = number(each, "a value of " + parameter.name);
      if (!value)
        return each.is_number() ? fail(value.error()) : error(each, "a value of " + parameter.name + " must be a number or a text");
      parameter.values.emplace_back(*value);
    }
    return {};
  }

  Result<void> read_range(const toml::table& table, Parameter& parameter) const {
    for (const auto& [key, end] : {std::pair("from", &parameter.from), std::pair("to", &parameter.to)}) {
      const toml::node* node = table.get(key);
      if (node == nullptr)
        return error(table, "the parameter " + parameter.name + " has no values: it needs values = [..], or from and to");
      const Result<double> value = number(*node, parameter.name + "." + key);
      if (!value) return fail(value.error());
      *end = *value;
    }
    std::size_t levels = 0;
    if (auto done = whole(table, "levels", 2, 100'000, levels); !done) return done;
    if (levels == 0 && plan_.sampling == Sampling::full)
      return error(table, "the parameter " + parameter.name + " needs levels: how many values a full plan takes from its range");
    for (std::size_t level = 0; level < levels; ++level)
      parameter.values.emplace_back(parameter.from +
                                    (parameter.to - parameter.from) * static_cast<double>(level) / static_cast<double>(levels - 1));
    return {};
  }

  Result<void> read_parameters(const toml::node& node) {
    const toml::table* table = node.as_table();
    if (table == nullptr) return error(node, "parameters must be a table, like [parameters]");
    for (const auto& [key, each] : *table) {
      Parameter parameter;
      parameter.name = std::string(key.str());
      if (!is_name(parameter.name)) return error(each, "\"" + parameter.name + "\" is no name of a parameter: use letters, digits and _");
      if (const toml::table* range = each.as_table()) {
        if (auto done = check_keys(*range, {"values", "from", "to", "levels"}, "a parameter"); !done) return done;
        const toml::node* values = range->get("values");
        if (values != nullptr && range->size() > 1) return error(each, "the parameter " + parameter.name + " has both values and a range");
        auto done = values != nullptr ? read_values(*values, parameter) : read_range(*range, parameter);
        if (!done) return done;
      } else if (auto done = read_values(each, parameter); !done) {
        return done;
      }
      plan_.parameters.push_back(std::move(parameter));
    }
    if (plan_.sampling == Sampling::sobol && plan_.parameters.size() > kMaxSobolParameters)
      return error(node, "a sobol plan takes up to " + std::to_string(kMaxSobolParameters) + " parameters; latin-hypercube takes more");
    return {};
  }

  Result<void> check_size(const toml::table& root) const {
    if (plan_.sampling != Sampling::full && plan_.parameters.empty()) return error(*root.get("plan"), "this plan has no parameters");
    if (variant_count(plan_) > kMaxVariants)
      return fail(file_.string(), "the plan has more than " + std::to_string(kMaxVariants) + " variants");
    return {};
  }

  fs::path file_, folder_;
  Plan& plan_;
};

}  // namespace

std::string words(const ParameterValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, std::get<double>(value)).ptr;
  return {digits, end};
}

Result<Plan> parse_plan(std::string_view text, const fs::path& file) {
  Plan plan;
  try {
    if (auto done = PlanReader(file, plan).read(toml::parse(text, file.string())); !done) return fail(done.error());
  } catch (const toml::parse_error& problem) {
    return fail(file.string(), static_cast<long>(problem.source().begin.line), "not TOML: " + std::string(problem.description()));
  }
  return plan;
}

std::size_t sample_count(const Plan& plan) {
  if (plan.sampling != Sampling::full) return plan.samples;
  std::size_t count = 1;
  for (const Parameter& parameter : plan.parameters) count = std::min(count * parameter.values.size(), 2 * kMaxVariants);
  return count;
}

std::size_t variant_count(const Plan& plan) { return sample_count(plan) * plan.decks.size() * plan.scripts.size(); }

}  // namespace prismesh::mesh::batch
