#include "mesh/quality/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <Eigen/Geometry>

#include "base/parallel_for.h"
#include "mesh/model/adjacency.h"
#include "mesh/quality/judging.h"
#include "mesh/quality/mass.h"
#include "mesh/quality/time_step.h"

namespace prismesh::mesh::quality {

namespace {

constexpr std::size_t kGrain = kChunkSize;  // so that a range of shells is a chunk of states

/// Metrics whose small values are the bad ones.
bool low_is_worse(int metric) {
  switch (static_cast<Metric>(metric)) {
    case Metric::jacobian:
    case Metric::min_angle_quad:
    case Metric::min_angle_tri:
    case Metric::min_length: return true;
    default: return false;
  }
}

void tally(Counts& counts, Grade grade, std::ptrdiff_t by) {
  std::size_t& count = grade == Grade::fail ? counts.fail : grade == Grade::warn ? counts.warn : counts.ok;
  count += static_cast<std::size_t>(by);
}

/// Measures and judges shells `shell_of(i)`, i in [0, count); `sink(i, state, values, lane)`.
template <class ShellOf, class Sink>
void judge_shells(const Model& model, const Limits& limits, std::size_t count, const ShellOf& shell_of, const Sink& sink) {
  measure_in_batches(
      count, [&](std::size_t i, const Vec3*(&corner)[4]) { return corners_of(model, shell_of(i), corner); },
      [&](const ShellBatch& batch, const BatchValues& values) {
        ShellState states[kLanes];
        float thickness[kLanes] = {};
        if (limits.needs_thickness())
          for (std::size_t lane = 0; lane < batch.count; ++lane) thickness[lane] = thickness_of(model, shell_of(batch.slot[lane]));
        judge_lanes(values, batch.count, limits, limits.needs_thickness() ? thickness : nullptr, states);
        for (std::size_t lane = 0; lane < batch.count; ++lane) sink(batch.slot[lane], states[lane], values, lane);
      });
}

/// Figures of one range of shells; ranges are added in order, so sums don't depend on the number of threads.
struct Partial {
  Report report;
  std::array<double, kMetricCount> sum{};
  std::size_t triangles = 0;
  double mass = 0;
  Vec3 moment = Vec3::Zero();
  bool has_mass = false;
  double added_mass = 0;

  void add_metric(int m, float value, ShellIndex shell, ShellState state) {
    if (std::isnan(value)) return;
    MetricSummary& s = report.metrics[m];
    const bool worse = s.measured == 0 || (low_is_worse(m) ? value < s.min : value > s.max);
    if (worse) s.worst = shell;
    s.min = s.measured == 0 ? value : std::min<double>(s.min, value);
    s.max = s.measured == 0 ? value : std::max<double>(s.max, value);
    ++s.measured;
    sum[m] += value;
    const bool failed = (state.fail >> m & 1) != 0;
    s.fail += failed;
    s.warn += !failed && (state.warn >> m & 1) != 0;
  }

  void add(const Partial& next) {
    report.elements += next.report.elements;
    report.counts.ok += next.report.counts.ok;
    report.counts.warn += next.report.counts.warn;
    report.counts.fail += next.report.counts.fail;
    triangles += next.triangles;
    for (int m = 0; m < kMetricCount; ++m) add_summary(m, next);
    mass += next.mass;
    moment += next.moment;
    has_mass = has_mass || next.has_mass;
    added_mass += next.added_mass;
    if (next.report.time_step && (!report.time_step || next.report.time_step->seconds < report.time_step->seconds))
      report.time_step = next.report.time_step;
  }

 private:
  void add_summary(int m, const Partial& next) {
    MetricSummary& s = report.metrics[m];
    const MetricSummary& n = next.report.metrics[m];
    sum[m] += next.sum[m];
    if (n.measured == 0) return;
    if (s.measured == 0) {
      s = n;
      return;
    }
    if (low_is_worse(m) ? n.min < s.min : n.max > s.max) s.worst = n.worst;
    s.min = std::min(s.min, n.min);
    s.max = std::max(s.max, n.max);
    s.measured += n.measured;
    s.warn += n.warn;
    s.fail += n.fail;
  }
};

/// Mass and time step of one shell.
void weigh(const Model& model, const TimeStepControl& control, std::size_t shell, Partial& partial) {
  const PartIndex part_index = model.shell_parts[shell];
  if (!part_index.valid()) return;
  const Part& part = (*model.parts)[part_index.value];
  const ShellNodes& nodes = model.shell_nodes[shell];
  std::array<Vec3, 4> p;
  for (std::size_t c = 0; c < 4; ++c) p[c] = model.position(nodes.node[c]);
  const Weight weight = weigh_shell(model, ShellIndex(shell));
  partial.mass += weight.mass;
  partial.moment += weight.moment;
  partial.has_mass = partial.has_mass || weight.shells > 0;
  const std::optional<double> step =
      shell_time_step(part, std::span(p.data(), static_cast<std::size_t>(nodes.corners())), control.shell_option);
  if (!step) return;
  const double wanted = std::abs(control.mass_scaled);
  if (wanted > 0 && *step<wanted&& * step> 0) partial.added_mass += weight.mass * ((wanted / *step) * (wanted / *step) - 1.0);
  const double seconds = control.scale * *step;
  if (!partial.report.time_step || seconds < partial.report.time_step->seconds) partial.report.time_step = {seconds, ShellIndex(shell)};
}

/// The measuring order inside a range is by shape; of equal extremes the one that comes first in the model shall count, so the
/// figures are gathered in the shells' order.
Partial figures_of_range(const Model& model, const Limits& limits, const TimeStepControl& control, std::size_t begin, std::size_t end,
                         const ShellSet* shells) {
  const auto shell_of = [&](std::size_t i) { return shells != nullptr ? (*shells)[begin + i].value : begin + i; };
  std::vector<Values> values(end - begin);
  std::vector<ShellState> states(end - begin);
  judge_shells(model, limits, end - begin, shell_of, [&](std::size_t i, ShellState state, const BatchValues& batch, std::size_t lane) {
    values[i] = batch.at(lane);
    states[i] = state;
  });
  Partial partial;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t shell = shell_of(i);
    ++partial.report.elements;
    partial.triangles += model.shell_nodes[shell].is_triangle();
    tally(partial.report.counts, states[i].grade(), 1);
    for (int m = 0; m < kMetricCount; ++m) partial.add_metric(m, values[i][m], ShellIndex(shell), states[i]);
    weigh(model, control, shell, partial);
  }
  return partial;
}

/// Length with two significant digits.
double rounded_to_two_digits(double value) {
  // through text: powers of ten are exact there
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", value);
  return std::strtod(text, nullptr);
}

}  // namespace

ChunkedArray<ShellState> judge_model(const Model& model, const Criteria& criteria, double target_size) {
  ChunkedArray<ShellState> states(model.shell_count());
  const Limits limits = limits_for(criteria, target_size);
  parallel_for(model.shell_count(), kGrain, [&](std::size_t begin, std::size_t end) {
    const std::span<ShellState> out = states.own_chunk(begin / kGrain);
    judge_shells(
        model, limits, end - begin, [&](std::size_t i) { return begin + i; },
        [&](std::size_t i, ShellState state, const BatchValues&, std::size_t) { out[i] = state; });
  });
  return states;
}

void rejudge(const Model& model, const Criteria& criteria, double target_size, const ShellSet& shells, ChunkedArray<ShellState>& states,
             Counts& counts) {
  const Limits limits = limits_for(criteria, target_size);
  std::vector<ShellState> fresh(shells.size());
  parallel_for(shells.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    judge_shells(
        model, limits, end - begin, [&](std::size_t i) { return shells[begin + i].value; },
        [&](std::size_t i, ShellState state, const BatchValues&, std::size_t) { fresh[begin + i] = state; });
  });
  for (std::size_t i = 0; i < shells.size(); ++i) {
    const ShellState old = states[shells[i].value];
    if (old == fresh[i]) continue;  // an unchanged chunk stays shared
    tally(counts, old.grade(), -1);
    tally(counts, fresh[i].grade(), 1);
    states.set(shells[i].value, fresh[i]);
  }
}

Counts count(const ChunkedArray<ShellState>& states) {
  Counts counts;
  for (std::size_t c = 0; c < states.chunk_count(); ++c)
    for (const ShellState state : states.chunk(c)) tally(counts, state.grade(), 1);
  return counts;
}

Report report(const Model& model, const Criteria& criteria, double target_size, const TimeStepControl& control, const ShellSet* shells) {
  const Limits limits = limits_for(criteria, target_size);
  const std::size_t elements = shells != nullptr ? shells->size() : model.shell_count();
  std::vector<Partial> partials((elements + kGrain - 1) / kGrain);
  parallel_for(elements, kGrain, [&](std::size_t begin, std::size_t end) {
    partials[begin / kGrain] = figures_of_range(model, limits, control, begin, end, shells);
  });
  Partial all;
  for (const Partial& partial : partials) all.add(partial);

  Report& report = all.report;
  for (int m = 0; m < kMetricCount; ++m)
    if (report.metrics[m].measured > 0) report.metrics[m].mean = all.sum[m] / static_cast<double>(report.metrics[m].measured);
  if (report.elements > 0) report.triangles_percent = 100.0 * static_cast<double>(all.triangles) / static_cast<double>(report.elements);
  if (all.has_mass) report.mass = all.mass;
  if (all.mass > 0) report.centre_of_gravity = all.moment / all.mass;
  if (control.mass_scaled != 0) report.added_mass = all.added_mass;
  return report;
}

double guess_target_size(const Model& model) {
  const Adjacency& adjacency = *model.adjacency;
  std::vector<float> lengths(adjacency.edge_count());
  parallel_for(model.node_count(), 65536, [&](std::size_t begin, std::size_t end) {
    for (std::size_t low = begin; low < end; ++low)
      for (std::size_t e = adjacency.edge_first[low]; e < adjacency.edge_first[low + 1]; ++e)
        lengths[e] = static_cast<float>((model.position(adjacency.edge_high[e]) - model.positions[low]).norm());
  });
  if (lengths.empty()) return 1.0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle > 0 ? rounded_to_two_digits(*middle) : 1.0;
}

}  // namespace prismesh::mesh::quality
