#include "mesh/quality/report.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "base/parallel_for.h"
#include "mesh/quality/judge_lanes.h"
#include "mesh/quality/shell_batch.h"
#include "mesh/quality/time_step.h"

namespace prismesh::mesh::quality {

namespace {

constexpr std::size_t kReportGrain = kChunkSize;  // so that a range of shells is a chunk of states

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

void add_state(Counts& counts, ShellState state, std::ptrdiff_t by) {
  if (state.is_removed()) return;
  const Grade grade = state.grade();
  std::size_t& count = grade == Grade::fail ? counts.fail : grade == Grade::warn ? counts.warn : counts.ok;
  count += static_cast<std::size_t>(by);
}

/// Measures and judges shells `shell_of(i)`, i in [0, count), without removed ones; `sink(batch, values, states, properties)`.
template <class ShellOf, class Sink>
void judge_batches(const Model& model, const LimitsByPart& limits, std::size_t count, const ShellOf& shell_of, const Sink& sink) {
  measure_in_batches(
      count, [&](std::size_t i, const Vec3*(&corner)[4]) { return corners_of(model, shell_of(i), corner); },
      [&](const ShellBatch& batch, const BatchValues& values) {
        ShellState states[kLanes];
        ShellProperties buffer[kLanes];
        const ShellProperties* properties = batch_properties(model, limits, batch, shell_of, buffer);
        judge_lanes(values, batch.count, limits, properties, states);
        sink(batch, values, states, properties);
      });
}

/// Only the states, into out[i].
template <class ShellOf>
void judge_shells(const Model& model, const LimitsByPart& limits, std::size_t count, const ShellOf& shell_of, std::span<ShellState> out) {
  judge_batches(model, limits, count, shell_of,
                [&](const ShellBatch& batch, const BatchValues&, const ShellState* states, const ShellProperties*) {
                  for (std::size_t lane = 0; lane < batch.count; ++lane) out[batch.slot[lane]] = states[lane];
                });
}

/// Figures of one range of shells. Ranges are added in order, so that sums don't depend on the number of threads.
struct RangeFigures {
  Report report;
  std::array<double, kMetricCount> sum{};
  std::size_t triangles = 0;
  double mass = 0;
  Vec3 moment = Vec3::Zero();
  bool has_mass = false;
  double added_mass = 0;
  double composite_sum = 0;

  void add_shell(const Model& model, std::size_t shell, const Values& values, ShellState state, float composite) {
    ++report.elements;
    triangles += model.shell_nodes[shell].is_triangle();
    add_state(report.counts, state, 1);
    report.min_composite = std::min<double>(report.min_composite, composite);
    composite_sum += composite;
    for (std::size_t d = 0; d < kDefectCount; ++d) report.defects[d] += state.has(kDefects[d]);
    if (state.has_defect()) return;
    for (int m = 0; m < kMetricCount; ++m) add_metric(m, values[m], ShellIndex(shell), state);
  }

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

  void add(const RangeFigures& next) {
    report.elements += next.report.elements;
    report.counts.ok += next.report.counts.ok;
    report.counts.warn += next.report.counts.warn;
    report.counts.fail += next.report.counts.fail;
    triangles += next.triangles;
    report.min_composite = std::min(report.min_composite, next.report.min_composite);
    composite_sum += next.composite_sum;
    for (std::size_t d = 0; d < kDefectCount; ++d) report.defects[d] += next.report.defects[d];
    for (int m = 0; m < kMetricCount; ++m) add_summary(m, next);
    mass += next.mass;
    moment += next.moment;
    has_mass = has_mass || next.has_mass;
    added_mass += next.added_mass;
    if (next.report.time_step && (!report.time_step || next.report.time_step->seconds < report.time_step->seconds))
      report.time_step = next.report.time_step;
  }

 private:
  void add_summary(int m, const RangeFigures& next) {
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

/// Material data of a part's shells.
struct PartFactors {
  double density = 0;
  double wave_speed = 0;  ///< 0: not known, or the part doesn't limit the time step
};

std::vector<PartFactors> factors_of(const Model& model, int shell_option) {
  std::vector<PartFactors> factors;
  for (const Part& part : *model.parts) factors.push_back({part.density.value_or(0.0), wave_speed(part, shell_option).value_or(0.0)});
  return factors;
}

/// Measured data of one shell.
struct ShellFigures {
  Values values;
  ShellState state = ShellState::removed();
  float composite = 1;
  double area = 0;
  Vec3 moment = Vec3::Zero();
  double step_length = 0;
};

/// What the figures of a range depend on.
struct RangeInput {
  const Model& model;
  const LimitsByPart& limits;
  const TimeStepControl& control;
  const std::vector<PartFactors>& parts;
};

/// The mass that mass scaling adds to a shell. DT2MS < 0: only shells with a step below |DT2MS| get mass; DT2MS > 0: every shell gets
/// exactly that step, so that long ones lose mass.
double mass_added(double mass, double step, double mass_scaled) {
  if (mass_scaled == 0 || (mass_scaled < 0 && step >= -mass_scaled)) return 0;
  return mass * ((mass_scaled / step) * (mass_scaled / step) - 1.0);
}

/// Adds mass and time step of one shell.
void add_mass(const RangeInput& input, std::size_t shell, const ShellFigures& measured, RangeFigures& partial) {
  const PartIndex part = input.model.shell_parts[shell];
  if (!part.valid()) return;
  const PartFactors& factors = input.parts[part.value];
  const double thickness = thickness_of(input.model, shell);
  const bool has_mass = thickness > 0 && (*input.model.parts)[part.value].density.has_value();
  const double surface_density = has_mass ? factors.density * thickness : 0.0;
  partial.mass += surface_density * measured.area;
  partial.moment += surface_density * measured.moment;
  partial.has_mass = partial.has_mass || has_mass;
  if (!(factors.wave_speed > 0) || !(measured.step_length > 0) || measured.state.has(Defect::no_area)) return;
  const double step = measured.step_length / factors.wave_speed;
  if (has_mass) partial.added_mass += mass_added(surface_density * measured.area, step, input.control.mass_scaled);
  const double seconds = input.control.scale * step;
  if (!partial.report.time_step || seconds < partial.report.time_step->seconds) partial.report.time_step = {seconds, ShellIndex(shell)};
}

/// Shells are measured by shape, but of equal extremes the first in the model counts: so the figures are added in the shells' order.
RangeFigures figures_of_range(const RangeInput& input, std::size_t begin, std::size_t end, const ShellSet* shells) {
  const auto shell_of = [&](std::size_t i) { return shells != nullptr ? (*shells)[begin + i].value : begin + i; };
  std::vector<ShellFigures> all(end - begin);
  judge_batches(input.model, input.limits, end - begin, shell_of,
                [&](const ShellBatch& batch, const BatchValues& values, const ShellState* states, const ShellProperties* properties) {
                  float rated[kLanes];
                  rate_lanes(values, batch.count, input.limits, properties, rated);
                  BatchExtents extents;
                  (values.of_triangles ? extend_triangles : extend_quads)(batch, input.control.shell_option, extents);
                  for (std::size_t lane = 0; lane < batch.count; ++lane)
                    all[batch.slot[lane]] = {values.at(lane),
                                             states[lane],
                                             rated[lane],
                                             extents.area[lane],
                                             {extents.moment[0][lane], extents.moment[1][lane], extents.moment[2][lane]},
                                             extents.step_length[lane]};
                });
  RangeFigures partial;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].state.is_removed()) continue;
    partial.add_shell(input.model, shell_of(i), all[i].values, all[i].state, all[i].composite);
    if (!all[i].state.has(Defect::not_finite)) add_mass(input, shell_of(i), all[i], partial);
  }
  return partial;
}

/// Resizes the states to the model's number of shells. Returns how many of them had a state before. New ones are removed until judged.
std::size_t resize_states(ChunkedArray<ShellState>& states, std::size_t shells, Counts& counts) {
  const std::size_t known = std::min(states.size(), shells);
  for (std::size_t s = shells; s < states.size(); ++s) add_state(counts, states[s], -1);
  if (states.size() != shells) states.resize(shells, ShellState::removed());
  return known;
}

}  // namespace

ChunkedArray<ShellState> judge_model(const Model& model, const SizedCriteria& criteria) {
  ChunkedArray<ShellState> states(model.shell_count(), ShellState::removed());
  const LimitsByPart limits = limits_for(criteria);
  parallel_for(model.shell_count(), kReportGrain, [&](std::size_t begin, std::size_t end) {
    const std::span<ShellState> out = states.own_chunk(begin / kReportGrain);
    judge_shells(
        model, limits, end - begin, [&](std::size_t i) { return begin + i; }, out);
  });
  return states;
}

void rejudge(const Model& model, const SizedCriteria& criteria, const ShellSet& shells, ChunkedArray<ShellState>& states, Counts& counts) {
  const std::size_t known = resize_states(states, model.shell_count(), counts);
  ShellSet dirty(shells.begin(), std::lower_bound(shells.begin(), shells.end(), ShellIndex(known)));
  for (std::size_t s = known; s < model.shell_count(); ++s) dirty.emplace_back(s);

  const LimitsByPart limits = limits_for(criteria);
  std::vector<ShellState> fresh(dirty.size(), ShellState::removed());
  parallel_for(dirty.size(), kReportGrain, [&](std::size_t begin, std::size_t end) {
    judge_shells(
        model, limits, end - begin, [&](std::size_t i) { return dirty[begin + i].value; }, std::span(fresh).subspan(begin, end - begin));
  });
  for (std::size_t i = 0; i < dirty.size(); ++i) {
    const ShellState old = states[dirty[i].value];
    if (old == fresh[i]) continue;  // an unchanged chunk stays shared
    add_state(counts, old, -1);
    add_state(counts, fresh[i], 1);
    states.set(dirty[i].value, fresh[i]);
  }
}

Counts count(const ChunkedArray<ShellState>& states) {
  Counts counts;
  for (std::size_t c = 0; c < states.chunk_count(); ++c)
    for (const ShellState state : states.chunk(c)) add_state(counts, state, 1);
  return counts;
}

Report report(const Model& model, const SizedCriteria& criteria, const TimeStepControl& control, const ShellSet* shells) {
  const LimitsByPart limits = limits_for(criteria);
  const std::size_t elements = shells != nullptr ? shells->size() : model.shell_count();
  const std::vector<PartFactors> parts = factors_of(model, control.shell_option);
  std::vector<RangeFigures> partials((elements + kReportGrain - 1) / kReportGrain);
  parallel_for(elements, kReportGrain, [&](std::size_t begin, std::size_t end) {
    partials[begin / kReportGrain] = figures_of_range({model, limits, control, parts}, begin, end, shells);
  });
  RangeFigures all;
  for (const RangeFigures& partial : partials) all.add(partial);

  Report& report = all.report;
  for (int m = 0; m < kMetricCount; ++m)
    if (report.metrics[m].measured > 0) report.metrics[m].mean = all.sum[m] / static_cast<double>(report.metrics[m].measured);
  if (report.elements > 0) report.mean_composite = all.composite_sum / static_cast<double>(report.elements);
  if (report.elements > 0) report.triangles_percent = 100.0 * static_cast<double>(all.triangles) / static_cast<double>(report.elements);
  if (all.has_mass) report.mass = all.mass;
  if (all.mass > 0) report.centre_of_gravity = all.moment / all.mass;
  if (control.mass_scaled != 0 && all.has_mass) report.added_mass = all.added_mass;
  return report;
}

std::vector<PartReport> report_by_part(const Model& model, const SizedCriteria& criteria, const TimeStepControl& control,
                                       const ShellSet* shells) {
  std::vector<ShellSet> of_part(model.parts->size());
  const auto add = [&](ShellIndex shell) {
    const PartIndex part = model.shell_parts[shell.value];
    if (part.valid() && !model.is_removed(shell)) of_part[part.value].push_back(shell);
  };
  if (shells != nullptr)
    std::for_each(shells->begin(), shells->end(), add);
  else
    for (std::size_t s = 0; s < model.shell_count(); ++s) add(ShellIndex(s));
  std::vector<PartReport> reports;
  for (std::size_t p = 0; p < of_part.size(); ++p)
    if (!of_part[p].empty()) reports.push_back({PartIndex(p), report(model, criteria, control, &of_part[p])});
  return reports;
}

}  // namespace prismesh::mesh::quality
