#include "mesh/document/quality_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "base/nearest_name.h"
#include "base/parallel_for.h"
#include "mesh/document/clusters.h"
#include "mesh/document/damage.h"
#include "mesh/model/topology_change.h"
#include "mesh/quality/composite.h"
#include "mesh/quality/limits.h"
#include "mesh/quality/measure.h"
#include "mesh/quality/shell_properties.h"

namespace prismesh::mesh::document {

namespace {

using quality::Defect;
using quality::kMetricCount;
using quality::Metric;
using quality::ShellProperties;
using quality::ShellState;
using quality::Threshold;
using quality::Values;

constexpr std::size_t kGrain = kChunkSize;
constexpr std::size_t kBars = 24;
constexpr int kStateBits = 16;
constexpr double kTail = 0.002;  ///< share of the shells at either end that doesn't widen the histogram's range

constexpr int kCluster = kStateBits;  ///< instead of a metric or a defect's bit
constexpr const char* kClusterName = "triangle_clusters";

std::array<double, 3> place_of(const Vec3& at) {
  return at.allFinite() ? std::array<double, 3>{at.x(), at.y(), at.z()} : std::array<double, 3>{};
}

bool has(std::uint16_t bits, int bit) { return (bits >> bit & 1) != 0; }

Result<int> metric_named(const std::string& wanted) {
  std::vector<std::string_view> known;
  for (int m = 0; m < kMetricCount; ++m) {
    known.push_back(quality::name(static_cast<Metric>(m)));
    if (known.back() == wanted) return m;
  }
  return fail("", "there is no metric \"" + wanted + "\"; the nearest is \"" + std::string(nearest_name(wanted, known)) + "\"");
}

/// The shells that are counted: all of the model, or the damaged ones.
class Shells {
 public:
  Shells(const Document& document, bool damaged) : model_(document.current().model) {
    if (damaged) {
      listed_ = true;
      list_ = damaged_shells(document);
    } else if (model_.topology_change) {
      listed_ = true;
      for (std::size_t s = 0; s < model_.shell_count(); ++s)
        if (!model_.is_removed(ShellIndex(s))) list_.push_back(ShellIndex(s));
    }
  }
  std::size_t size() const { return listed_ ? list_.size() : model_.shell_count(); }
  std::size_t operator[](std::size_t i) const { return listed_ ? list_[i].value : i; }
  ShellSet range(std::size_t begin, std::size_t end) const {
    ShellSet shells;
    for (std::size_t i = begin; i < end; ++i) shells.emplace_back((*this)[i]);
    return shells;
  }

 private:
  const Model& model_;
  bool listed_ = false;
  ShellSet list_;
};

/// Distance of a value beyond its limits, without unit: 0 at the warn limit, 1 at the fail limit, growing linearly. A metric with only one
/// limit is scaled by that limit's magnitude.
double severity(double value, const Threshold& limit) {
  const auto beyond = [](double v, double warn, double failing) {
    if (!std::isfinite(warn) && !std::isfinite(failing)) return 0.0;
    if (!std::isfinite(failing)) return v > warn ? 0.5 : 0.0;
    if (!std::isfinite(warn) || !(failing > warn)) warn = failing - std::max(std::abs(failing), 1e-30);
    return std::max(0.0, (v - warn) / (failing - warn));
  };
  return std::max(beyond(value, limit.warn_high, limit.fail_high), beyond(-value, -limit.warn_low, -limit.fail_low));
}

struct Wrong {
  std::size_t shell = 0;
  int metric = -1;  ///< a metric, a defect's bit, or kCluster
  float value = 0;
  double severity = 0;
  bool fails = false;
  NodeIndex node{};  ///< of a cluster of triangles
};
bool worse(const Wrong& a, const Wrong& b) {
  if (a.fails != b.fails) return a.fails;
  if (a.severity != b.severity) return a.severity > b.severity;
  return a.shell != b.shell ? a.shell < b.shell : a.node < b.node;
}

/// A degenerate shell fails by its defects only; its metrics have no meaning.
ShellState without_metrics(ShellState state) {
  if (!state.has_defect()) return state;
  const auto defects = static_cast<std::uint16_t>(state.fail & ShellState::kDefectBits);
  return {defects, defects};
}

/// NaN for a shell that is in no bar.
float value_for_bars(ShellState state, const Values& values, int metric) {
  return state.has_defect() ? std::numeric_limits<float>::quiet_NaN() : values[static_cast<std::size_t>(metric)];
}

struct PartSum {
  std::uint64_t shells = 0, warn = 0, fail = 0;
  double sum = 0;
  double least = 1;
};

/// Figures of a range of shells. Ranges are added in order, so that sums don't depend on the number of threads.
struct Figures {
  std::array<std::uint64_t, kStateBits> warn{}, fail{};
  std::vector<Wrong> wrong;
  std::map<std::uint32_t, PartSum> parts;

  void count(ShellState state) {
    if (state.warn == 0) return;
    for (int bit = 0; bit < kStateBits; ++bit) {
      const bool fails = has(state.fail, bit);
      fail[static_cast<std::size_t>(bit)] += fails;
      warn[static_cast<std::size_t>(bit)] += !fails && has(state.warn, bit);
    }
  }

  void add(Figures&& next) {
    for (std::size_t bit = 0; bit < warn.size(); ++bit) {
      warn[bit] += next.warn[bit];
      fail[bit] += next.fail[bit];
    }
    wrong.insert(wrong.end(), next.wrong.begin(), next.wrong.end());
    for (const auto& [part, sum] : next.parts) {
      PartSum& all = parts[part];
      all.shells += sum.shells;
      all.warn += sum.warn;
      all.fail += sum.fail;
      all.sum += sum.sum;
      all.least = std::min(all.least, sum.least);
    }
  }
};

class Gathering {
 public:
  Gathering(const Document& document, const QualityQuestion& request, int metric)
      : document_(document),
        generation_(document.current()),
        shells_(document, request.damaged),
        metric_(metric),
        damaged_(request.damaged) {
    if (metric_ >= 0) values_.resize(shells_.size());
  }

  QualityFigures figures() {
    std::vector<Figures> ranges((shells_.size() + kGrain - 1) / kGrain);
    parallel_for(shells_.size(), kGrain,
                 [&](std::size_t begin, std::size_t end) { ranges[begin / kGrain] = figures_of_range(begin, end); });
    Figures all;
    for (Figures& range : ranges) all.add(std::move(range));
    add_clusters(all);
    QualityFigures quality;
    quality.generation = generation_.number;
    add_metrics(all, quality);
    add_errors(all, quality);
    add_parts(all, quality);
    if (metric_ >= 0) add_bars(quality);
    return quality;
  }

 private:
  Figures figures_of_range(std::size_t begin, std::size_t end) {
    const ShellSet shells = shells_.range(begin, end);
    std::vector<Values> values(shells.size());
    std::vector<float> composites(shells.size());
    quality::composites(generation_.model, shells, judged_by(document_), composites, values);
    Figures figures;
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t shell = shells[i - begin].value;
      const ShellState state = without_metrics(generation_.quality[shell]);
      const Values& measured = values[i - begin];
      figures.count(state);
      if (metric_ >= 0) values_[i] = value_for_bars(state, measured, metric_);
      if (const Wrong wrong = worst_of(shell, state, measured); wrong.metric >= 0) figures.wrong.push_back(wrong);
      PartSum& part = figures.parts[generation_.model.shell_parts[shell].value];
      const double whole = composites[i - begin];
      ++part.shells;
      part.warn += state.grade() == quality::Grade::warn;
      part.fail += state.grade() == quality::Grade::fail;
      part.sum += whole;
      part.least = std::min(part.least, whole);
    }
    return figures;
  }

  /// Of the requested metric, or of all.
  Wrong worst_of(std::size_t shell, ShellState state, const Values& values) const {
    Wrong worst;
    if (state.warn == 0) return worst;
    for (const Defect defect : quality::kDefects)
      if (metric_ < 0 && state.has(defect)) worst = {shell, static_cast<int>(defect), 0, std::numeric_limits<double>::infinity(), true};
    const bool triangle = generation_.model.shell_nodes[shell].is_triangle();
    const ShellProperties sheet = quality::properties_of(generation_.model, ShellIndex(shell));
    for (int m = 0; m < kMetricCount; ++m) {
      if (!has(state.warn, m) || (metric_ >= 0 && m != metric_)) continue;
      const auto at = static_cast<std::size_t>(m);
      const Wrong candidate{shell, m, values[at], severity(values[at], threshold_of(m, triangle, sheet)), has(state.fail, m)};
      if (worst.metric < 0 || worse(candidate, worst)) worst = candidate;
    }
    return worst;
  }

  /// Clusters aren't judged by a metric: they count when all are asked for.
  void add_clusters(Figures& all) {
    if (metric_ >= 0) return;
    const double allowed = generation_.judging->criteria.criteria->warn_triangles_at_node;
    const std::vector<std::uint8_t> made = damaged_ ? made_worse(*document_.opened, generation_) : std::vector<std::uint8_t>();
    for (std::size_t i = 0; i < generation_.clusters->size(); ++i) {
      if (damaged_ && made[i] == 0) continue;
      const quality::TriangleCluster& cluster = (*generation_.clusters)[i];
      const auto triangles = static_cast<double>(cluster.triangles);
      all.wrong.push_back({cluster.shell.value, kCluster, static_cast<float>(triangles), (triangles - allowed) / std::max(allowed, 1.0),
                           false, cluster.node});
      ++clusters_;
    }
  }

  void add_metrics(const Figures& all, QualityFigures& quality) const {
    for (int m = 0; m < kMetricCount; ++m)
      quality.metrics.push_back({std::string(quality::name(static_cast<Metric>(m))), unit(m), all.warn[static_cast<std::size_t>(m)],
                                 all.fail[static_cast<std::size_t>(m)]});
    for (const Defect defect : quality::kDefects)
      quality.metrics.push_back({std::string(name(defect)), "", 0, all.fail[static_cast<std::size_t>(defect)]});
    quality.metrics.push_back({kClusterName, "", clusters_, 0});
  }

  void add_errors(Figures& all, QualityFigures& quality) const {
    quality.error_count = all.wrong.size();
    const auto most = static_cast<std::ptrdiff_t>(std::min(all.wrong.size(), kMaxQualityErrors));
    std::partial_sort(all.wrong.begin(), all.wrong.begin() + most, all.wrong.end(), worse);
    all.wrong.resize(static_cast<std::size_t>(most));
    for (const Wrong& wrong : all.wrong) {
      QualityError error;
      error.shell = generation_.model.shell_ids[wrong.shell];
      error.fail = wrong.fails;
      if (wrong.node.valid()) {
        error.metric = kClusterName;
        error.value = wrong.value;
        error.node = generation_.model.node_ids[wrong.node.value];
        error.at = place_of(generation_.model.position(wrong.node));
        quality.errors.push_back(std::move(error));
        continue;
      }
      if (wrong.metric < kMetricCount) {
        error.metric = quality::name(static_cast<Metric>(wrong.metric));
        error.unit = unit(wrong.metric);
        if (std::isfinite(wrong.value)) error.value = wrong.value;
      } else {
        error.metric = name(static_cast<Defect>(wrong.metric));
      }
      error.at = centre(wrong.shell);
      quality.errors.push_back(std::move(error));
    }
  }

  void add_parts(const Figures& all, QualityFigures& quality) const {
    for (const auto& [index, sum] : all.parts) {
      if (!PartIndex(index).valid()) continue;
      const quality::PartCriteria& judged = generation_.judging->by_part.of(PartIndex(index));
      quality.parts.push_back({(*generation_.model.parts)[index].id, sum.shells, sum.warn, sum.fail,
                               sum.sum / static_cast<double>(sum.shells), sum.least, judged.target_size, judged.size_from,
                               sized(*generation_.judging).of(PartIndex(index)).criteria.name});
    }
  }

  void add_bars(QualityFigures& quality) const {
    quality.metric = quality::name(static_cast<Metric>(metric_));
    std::vector<float> sorted;
    for (const float value : values_)
      if (!std::isnan(value)) sorted.push_back(value);
    if (sorted.empty()) return;
    const auto nth = [&](std::size_t n) {
      std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(n), sorted.end());
      return static_cast<double>(sorted[n]);
    };
    const auto tail = static_cast<std::size_t>(kTail * static_cast<double>(sorted.size()));
    const double least = nth(0), most = nth(sorted.size() - 1);
    double low = nth(tail), high = nth(sorted.size() - 1 - tail);
    // The range includes the limits that shells exceed, but one extreme value must not squeeze all others into one bar.
    const Threshold limit = threshold_of(metric_, quality::is_of_triangles(static_cast<Metric>(metric_)));
    const double reach = 0.25;
    if (std::isfinite(limit.fail_high)) high = std::min(std::max(high, limit.fail_high * (1 + reach)), most);
    if (std::isfinite(limit.fail_low)) low = std::max(std::min(low, limit.fail_low * (1 - reach)), least);
    if (!(high > low)) high = low + std::max(1e-6, std::abs(low) * 1e-3);
    quality.bars.resize(kBars);
    for (std::size_t b = 0; b < kBars; ++b) {
      quality.bars[b].from = low + (high - low) * static_cast<double>(b) / kBars;
      quality.bars[b].to = low + (high - low) * static_cast<double>(b + 1) / kBars;
    }
    quality.bars.front().open_below = least < low;
    quality.bars.back().open_above = true;
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const double value = values_[i];
      if (std::isnan(value)) continue;
      const double share = std::clamp((value - low) / (high - low), 0.0, 1.0);
      auto b = std::min(static_cast<std::size_t>(share * kBars), kBars - 1);
      // Compares with the bar's ends as sent to the client, so that find_shells with them gives as many shells as the bar counts.
      while (b > 0 && value < quality.bars[b].from) --b;
      while (b + 1 < kBars && value >= quality.bars[b].to) ++b;
      const ShellState state = generation_.quality[shells_[i]];
      QualityBar& bar = quality.bars[b];
      ++(has(state.fail, metric_) ? bar.fail : has(state.warn, metric_) ? bar.warn : bar.ok);
    }
  }

  /// Limits for this target size; without a sheet, thickness and material count as unknown.
  Threshold threshold_of(int metric, bool triangle, const ShellProperties& sheet = {}) const {
    return quality::threshold_of(judged_by(document_), static_cast<Metric>(metric), triangle, sheet);
  }

  std::string unit(int metric) const {
    return std::string(quality::unit_of(static_cast<Metric>(metric), name(document_.settings.length_unit)));
  }

  std::array<double, 3> centre(std::size_t shell) const {
    const ShellNodes& nodes = generation_.model.shell_nodes[shell];
    Vec3 sum = Vec3::Zero();
    for (int corner = 0; corner < nodes.corners(); ++corner)
      sum += generation_.model.position(nodes.node[static_cast<std::size_t>(corner)]) / nodes.corners();
    return place_of(sum);
  }

  const Document& document_;
  const Generation& generation_;
  Shells shells_;
  int metric_ = -1;
  bool damaged_ = false;
  std::uint64_t clusters_ = 0;
  std::vector<float> values_;
};

}  // namespace

Result<QualityFigures> quality_figures(const Document& document, const QualityQuestion& request) {
  int metric = -1;
  if (!request.metric.empty()) {
    const Result<int> named = metric_named(request.metric);
    if (!named) return fail(named.error());
    metric = *named;
  }
  return Gathering(document, request, metric).figures();
}

Result<ShellsFound> find_shells(const Document& document, const ShellsWanted& request) {
  const Result<int> metric = metric_named(request.metric);
  if (!metric) return fail(metric.error());
  const Generation& generation = document.current();
  const Shells shells(document, request.damaged);
  std::vector<float> values(shells.size());
  parallel_for(shells.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<Values> measured(end - begin);
    quality::measure_shells(generation.model, shells.range(begin, end), measured);
    for (std::size_t i = begin; i < end; ++i) values[i] = value_for_bars(generation.quality[shells[i]], measured[i - begin], *metric);
  });
  std::vector<std::int64_t> ids;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double value = values[i];
    if (std::isnan(value) || (request.from && value < *request.from) || (request.to && !(value < *request.to))) continue;
    ids.push_back(generation.model.shell_ids[shells[i]]);
  }
  ShellsFound found;
  found.shells = ids.size();
  if (!ids.empty()) found.expr = select::to_expression(std::move(ids));
  return found;
}

}  // namespace prismesh::mesh::document
