#include "mesh/quality/criteria.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/file.h"
#include "mesh/quality/default_text.h"
#include "mesh/quality/judging.h"

namespace prismesh::mesh::quality {

namespace {

Threshold scaled(const Threshold& threshold, double by) {
  const auto scale = [by](float limit) { return static_cast<float>(limit * by); };
  return {scale(threshold.warn_low), scale(threshold.warn_high), scale(threshold.fail_low), scale(threshold.fail_high)};
}

bool is_length(int metric) { return metric == int(Metric::min_length) || metric == int(Metric::max_length); }

/// Bit `metric` of each lane that lies outside.
void mark_outside(const float* value, std::size_t lanes, float lowest, float highest, int metric, std::uint16_t* bits) {
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const unsigned outside = unsigned(value[lane] < lowest) | unsigned(value[lane] > highest);
    bits[lane] = static_cast<std::uint16_t>(bits[lane] | (outside << metric));
  }
}

void mark_thin(const BatchValues& values, std::size_t lanes, float factor, const float* thickness, std::uint16_t* bits) {
  constexpr int kMetric = int(Metric::min_length);
  for (std::size_t lane = 0; lane < lanes; ++lane)
    if (values.value[kMetric][lane] < factor * thickness[lane]) bits[lane] = static_cast<std::uint16_t>(bits[lane] | (1u << kMetric));
}

}  // namespace

Limits limits_for(const Criteria& criteria, double target_size) {
  Limits limits;
  for (int m = 0; m < kMetricCount; ++m) {
    const double by = is_length(m) ? target_size : 1.0;
    limits.quad[m] = scaled(criteria.quad[m], by);
    limits.triangle[m] = scaled(criteria.triangle[m], by);
  }
  limits.warn_thicknesses = criteria.warn_min_length_thicknesses;
  limits.fail_thicknesses = criteria.fail_min_length_thicknesses;
  return limits;
}

void judge_lanes(const BatchValues& values, std::size_t count, const Limits& limits, const float* thickness, ShellState* out) {
  std::uint16_t warn[kLanes] = {}, failed[kLanes] = {};
  // a batch is of one shape, and warpage applies to quads only
  const auto& thresholds = std::isnan(values.value[int(Metric::warpage)][0]) ? limits.triangle : limits.quad;
  for (int m = 0; m < kMetricCount; ++m) {
    const Threshold& t = thresholds[m];
    mark_outside(values.value[m], count, t.warn_low, t.warn_high, m, warn);
    mark_outside(values.value[m], count, t.fail_low, t.fail_high, m, failed);
  }
  if (thickness != nullptr) {
    mark_thin(values, count, limits.warn_thicknesses, thickness, warn);
    mark_thin(values, count, limits.fail_thicknesses, thickness, failed);
  }
  for (std::size_t lane = 0; lane < count; ++lane) out[lane] = {static_cast<std::uint16_t>(warn[lane] | failed[lane]), failed[lane]};
}

ShellState judge(const Values& values, const Criteria& criteria, double target_size, double thickness) {
  BatchValues batch;
  for (int m = 0; m < kMetricCount; ++m) batch.value[m][0] = values[m];
  const float lane_thickness = static_cast<float>(thickness);
  ShellState state;
  judge_lanes(batch, 1, limits_for(criteria, target_size), &lane_thickness, &state);
  return state;
}

void judge_points(std::span<const Vec3> moving, std::span<const Vec3> fixed, std::span<const std::array<std::int32_t, 4>> corners,
                  std::span<const float> thickness, const Criteria& criteria, double target_size, std::span<ShellState> out) {
  const Limits limits = limits_for(criteria, target_size);
  const bool by_thickness = limits.needs_thickness() && !thickness.empty();
  measure_in_batches(
      corners.size(),
      [&](std::size_t i, const Vec3*(&corner)[4]) {
        for (std::size_t c = 0; c < 4; ++c) {
          const std::int32_t at = corners[i][c];
          corner[c] = at >= 0 ? &moving[static_cast<std::size_t>(at)] : &fixed[static_cast<std::uint32_t>(~at)];
        }
        return corners[i][3] == corners[i][2];
      },
      [&](const ShellBatch& batch, const BatchValues& values) {
        ShellState states[kLanes];
        float lane_thickness[kLanes] = {};
        if (by_thickness)
          for (std::size_t lane = 0; lane < batch.count; ++lane) lane_thickness[lane] = thickness[batch.slot[lane]];
        judge_lanes(values, batch.count, limits, by_thickness ? lane_thickness : nullptr, states);
        for (std::size_t lane = 0; lane < batch.count; ++lane) out[batch.slot[lane]] = states[lane];
      });
}

Result<Criteria> load_criteria(const std::filesystem::path& path) {
  const Result<FileBytes> bytes = read_file(path);
  if (!bytes) return fail(bytes.error());
  return parse_criteria(bytes->text(), path.string());
}

const Criteria& default_criteria() {
  static const Criteria kCriteria = [] {
    const Result<Criteria> parsed = parse_criteria(kDefaultCriteriaText, "mesh/quality/criteria/default.toml");
    if (!parsed) std::abort();  // the text is compiled in and tested
    return *parsed;
  }();
  return kCriteria;
}

}  // namespace prismesh::mesh::quality
