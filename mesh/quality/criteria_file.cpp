// Reads criteria from TOML. Only this source includes toml++, which is slow to compile.
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "base/nearest_name.h"
#include "mesh/quality/criteria.h"

#include <toml++/toml.h>

namespace prismesh::mesh::quality {

namespace {

using Names = std::vector<std::string_view>;

constexpr double kMaxNumber = 1e30;
constexpr float kMaxTriangles = 1e6F;  ///< about a node

/// A limit's key in the file, and where its value is stored.
struct LimitTarget {
  std::string_view key;
  float* limit;
};

class CriteriaReader {
 public:
  CriteriaReader(std::string file, Criteria& criteria) : file_(std::move(file)), criteria_(criteria) {}

  Result<void> read(const toml::table& root) {
    if (auto known = check_keys(root, {"name", "metrics", "triangles", "time_step"}, "a criteria file"); !known) return known;
    if (const toml::node* name = root.get("name")) {
      const auto text = name->value<std::string>();
      if (!text) return error(*name, "name must be a string");
      criteria_.name = *text;
    }
    if (const toml::node* metrics = root.get("metrics"))
      if (auto done = read_metrics(*metrics); !done) return done;
    if (const toml::node* triangles = root.get("triangles"))
      if (auto done = read_triangles(*triangles); !done) return done;
    if (const toml::node* step = root.get("time_step"))
      if (auto done = read_time_step(*step); !done) return done;
    return {};
  }

 private:
  tl::unexpected<Error> error(const toml::node& at, std::string message) const {
    return fail(file_, static_cast<long>(at.source().begin.line), std::move(message));
  }

  Result<void> check_keys(const toml::table& table, const Names& known, const std::string& owner) const {
    for (const auto& [key, node] : table) {
      if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
      return error(node, owner + " has no \"" + std::string(key.str()) + "\"; the nearest known is \"" +
                             std::string(nearest_name(key.str(), known)) + "\"");
    }
    return {};
  }

  Result<const toml::table*> table_of(const toml::node& node, const std::string& what) const {
    if (const toml::table* table = node.as_table()) return table;
    return error(node, what + " must be a table, like [" + what + "]");
  }

  Result<void> read_limits(const toml::table& table, const std::vector<LimitTarget>& targets, const std::string& what) const {
    for (const LimitTarget& target : targets) {
      const toml::node* node = table.get(target.key);
      if (node == nullptr) continue;
      const std::optional<double> value = node->is_number() ? node->value<double>() : std::nullopt;
      if (!value || !(std::abs(*value) <= kMaxNumber)) return error(*node, what + ": " + std::string(target.key) + " must be a number");
      *target.limit = static_cast<float>(*value);
    }
    return {};
  }

  Result<void> read_metrics(const toml::node& node) {
    const auto table = table_of(node, "metrics");
    if (!table) return fail(table.error());
    Names known;
    for (int m = 0; m < kMetricCount; ++m) known.push_back(name(static_cast<Metric>(m)));
    if (auto checked = check_keys(**table, known, "the list of metrics"); !checked) return checked;
    for (int m = 0; m < kMetricCount; ++m)
      if (const toml::node* metric = (*table)->get(known[m]))
        if (auto done = read_metric(*metric, m); !done) return done;
    return {};
  }

  Result<void> read_metric(const toml::node& node, int metric) {
    const std::string what = "metrics." + std::string(name(static_cast<Metric>(metric)));
    const auto table = table_of(node, what);
    if (!table) return fail(table.error());
    Names known = {"warn_below", "warn_above", "fail_below", "fail_above", "quad", "triangle"};
    const bool by_thickness = metric == int(Metric::min_length);
    if (by_thickness) known.insert(known.end(), {"warn_below_thicknesses", "fail_below_thicknesses"});
    if (auto checked = check_keys(**table, known, what); !checked) return checked;

    Threshold both;
    if (auto done = read_threshold(**table, both, what); !done) return done;
    criteria_.quad[metric] = criteria_.triangle[metric] = both;
    if (by_thickness) {
      const std::vector<LimitTarget> targets = {{"warn_below_thicknesses", &criteria_.warn_min_length_thicknesses},
                                                {"fail_below_thicknesses", &criteria_.fail_min_length_thicknesses}};
      if (auto done = read_limits(**table, targets, what); !done) return done;
    }
    if (auto done = read_shape(**table, "quad", criteria_.quad[metric], what); !done) return done;
    return read_shape(**table, "triangle", criteria_.triangle[metric], what);
  }

  Result<void> read_shape(const toml::table& metric, const char* shape, Threshold& threshold, const std::string& metric_name) const {
    const toml::node* node = metric.get(shape);
    if (node == nullptr) return {};
    const std::string what = metric_name + "." + shape;
    const auto table = table_of(*node, what);
    if (!table) return fail(table.error());
    if (auto checked = check_keys(**table, {"warn_below", "warn_above", "fail_below", "fail_above"}, what); !checked) return checked;
    return read_threshold(**table, threshold, what);
  }

  Result<void> read_threshold(const toml::table& table, Threshold& threshold, const std::string& what) const {
    const std::vector<LimitTarget> targets = {{"warn_below", &threshold.warn_low},
                                              {"warn_above", &threshold.warn_high},
                                              {"fail_below", &threshold.fail_low},
                                              {"fail_above", &threshold.fail_high}};
    if (auto done = read_limits(table, targets, what); !done) return done;
    if (const toml::node* warn = table.get("warn_below"); warn != nullptr && threshold.warn_low < threshold.fail_low)
      return error(*warn, what + ": warn_below lies beyond fail_below: a shell would fail before it warns");
    if (const toml::node* warn = table.get("warn_above"); warn != nullptr && threshold.warn_high > threshold.fail_high)
      return error(*warn, what + ": warn_above lies beyond fail_above: a shell would fail before it warns");
    return {};
  }

  Result<void> read_triangles(const toml::node& node) {
    const auto table = table_of(node, "triangles");
    if (!table) return fail(table.error());
    if (auto checked = check_keys(**table, {"warn_above", "fail_above", "warn_above_at_node"}, "triangles"); !checked) return checked;
    float warn = 100, failed = 100;
    float at_node = static_cast<float>(criteria_.warn_triangles_at_node);
    if (auto done = read_limits(**table, {{"warn_above", &warn}, {"fail_above", &failed}, {"warn_above_at_node", &at_node}}, "triangles");
        !done)
      return done;
    if (!(at_node >= 0 && at_node <= kMaxTriangles))
      return error(*(*table)->get("warn_above_at_node"), "triangles: warn_above_at_node must be from 0 to 1000000");
    if (const toml::node* given = (*table)->get("warn_above"); given != nullptr && warn > failed)
      return error(*given, "triangles: warn_above lies beyond fail_above: a part would fail before it warns");
    criteria_.warn_triangles_percent = warn;
    criteria_.fail_triangles_percent = failed;
    criteria_.warn_triangles_at_node = at_node;
    return {};
  }

  Result<void> read_time_step(const toml::node& node) {
    const auto table = table_of(node, "time_step");
    if (!table) return fail(table.error());
    if (auto checked = check_keys(**table, {"wanted", "warn_below"}, "time_step"); !checked) return checked;
    const toml::node* wanted = (*table)->get("wanted");
    if (wanted == nullptr)
      return error(node, "time_step needs \"wanted\": the time step that no shell may go below, in the deck's time unit");
    float fails = 0, warns = 0;
    if (auto done = read_limits(**table, {{"wanted", &fails}, {"warn_below", &warns}}, "time_step"); !done) return done;
    if (!(fails > 0)) return error(*wanted, "time_step: wanted must be above 0");
    const toml::node* warn = (*table)->get("warn_below");
    if (warn != nullptr && warns < fails)
      return error(*warn, "time_step: warn_below lies below wanted: a shell would fail before it warns");
    criteria_.fail_time_step = fails;
    criteria_.warn_time_step = warns;
    return {};
  }

  std::string file_;
  Criteria& criteria_;
};

}  // namespace

Result<Criteria> parse_criteria(std::string_view text, const std::string& file) {
  Criteria criteria;
  try {
    if (auto done = CriteriaReader(file, criteria).read(toml::parse(text, file)); !done) return fail(done.error());
  } catch (const toml::parse_error& error) {
    return fail(file, static_cast<long>(error.source().begin.line), "not TOML: " + std::string(error.description()));
  }
  return criteria;
}

}  // namespace prismesh::mesh::quality
