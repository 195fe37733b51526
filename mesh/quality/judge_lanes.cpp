#include "mesh/quality/judge_lanes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prismesh::mesh::quality {

namespace {

constexpr float kWorstWithoutDefect = -0.99999994F;  ///< the float above -1

struct Range {
  float min, max;
};

/// Sets bit `metric` of each lane whose value lies outside.
void mark_outside(const float* value, std::size_t lanes, Range range, int metric, std::uint16_t* bits) {
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const unsigned outside = unsigned(value[lane] < range.min) | unsigned(value[lane] > range.max);
    bits[lane] = static_cast<std::uint16_t>(bits[lane] | (outside << metric));
  }
}

void mark_short(const float* value, std::size_t lanes, const float* min, std::uint16_t* bits) {
  for (std::size_t lane = 0; lane < lanes; ++lane)
    bits[lane] = static_cast<std::uint16_t>(bits[lane] | (unsigned(value[lane] < min[lane]) << kMinLength));
}

/// Defects are told from the values (shell_lanes.h).
void mark_defects(const BatchValues& values, std::size_t lanes, std::uint16_t* bits) {
  const float* aspect = values.value[int(Metric::aspect)];
  const float* skew = values.value[int(Metric::skew)];
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const unsigned found = unsigned(!(aspect[lane] == aspect[lane])) << int(Defect::not_finite) |
                           unsigned(aspect[lane] == kRepeatedAspect) << int(Defect::repeated_node) |
                           unsigned(skew[lane] == kNoAreaSkew) << int(Defect::no_area);
    bits[lane] = static_cast<std::uint16_t>(bits[lane] | found);
  }
}

/// Whether all lanes are judged by the same limits; then `common` are these.
bool judged_alike(const LimitsByPart& limits, const ShellProperties* properties, std::size_t count, const Limits*& common) {
  common = &limits.distinct.front();
  if (!limits.need_part() || properties == nullptr || count == 0) return true;
  const std::uint32_t first = limits.index_of(properties[0].part);
  common = &limits.distinct[first];
  for (std::size_t lane = 1; lane < count; ++lane)
    if (properties[lane].part != properties[lane - 1].part && limits.index_of(properties[lane].part) != first) return false;
  return true;
}

/// Calls `judge(values, count, limits, properties, out)` for lanes that are judged alike, brought together, and spreads what it puts out.
template <class Out, class Judge>
void judge_in_groups(const BatchValues& values, std::size_t count, const LimitsByPart& limits, const ShellProperties* properties, Out* out,
                     const Judge& judge) {
  const auto material = [](const Limits& of, const ShellProperties* known) { return of.need_material() ? known : nullptr; };
  const Limits* common = nullptr;
  if (judged_alike(limits, properties, count, common)) return judge(values, count, *common, material(*common, properties), out);
  std::uint32_t index[kLanes];
  for (std::size_t lane = 0; lane < count; ++lane) index[lane] = limits.index_of(properties[lane].part);
  bool is_done[kLanes] = {};
  BatchValues group;
  group.of_triangles = values.of_triangles;
  for (std::size_t first = 0; first < count; ++first) {
    if (is_done[first]) continue;
    std::size_t lanes[kLanes], size = 0;
    ShellProperties of_group[kLanes];
    for (std::size_t lane = first; lane < count; ++lane) {
      if (index[lane] != index[first]) continue;
      is_done[lane] = true;
      for (int m = 0; m < kMetricCount; ++m) group.value[m][size] = values.value[m][lane];
      of_group[size] = properties[lane];
      lanes[size++] = lane;
    }
    Out judged[kLanes];
    judge(group, size, limits.distinct[index[first]], material(limits.distinct[index[first]], of_group), judged);
    for (std::size_t i = 0; i < size; ++i) out[lanes[i]] = judged[i];
  }
}

}  // namespace

void judge_lanes(const BatchValues& values, std::size_t count, const LimitsByPart& limits, const ShellProperties* properties,
                 ShellState* out) {
  judge_in_groups(values, count, limits, properties, out,
                  [](const BatchValues& group, std::size_t size, const Limits& by, const ShellProperties* known, ShellState* judged) {
                    judge_lanes(group, size, by, known, judged);
                  });
}

void rate_lanes(const BatchValues& values, std::size_t count, const LimitsByPart& limits, const ShellProperties* properties, float* out) {
  judge_in_groups(values, count, limits, properties, out,
                  [](const BatchValues& group, std::size_t size, const Limits& by, const ShellProperties* known, float* rated) {
                    rate_lanes(group, size, by, known, rated);
                  });
}

void judge_lanes(const BatchValues& values, std::size_t count, const Limits& limits, const ShellProperties* properties, ShellState* out) {
  std::uint16_t warn[kLanes] = {}, failed[kLanes] = {};
  const ShapeLimits& shape = limits.of(values.of_triangles);
  for (int m = 0; m < kMetricCount; ++m) {
    Threshold t = shape.threshold[m];
    if (m == kMinLength && properties != nullptr) {
      MinLengths min;
      min_lengths(shape, limits, {properties, count}, min);
      mark_short(values.value[m], count, min.warn, warn);
      mark_short(values.value[m], count, min.fail, failed);
      t.warn_low = t.fail_low = -std::numeric_limits<float>::infinity();
    }
    mark_outside(values.value[m], count, {t.warn_low, t.warn_high}, m, warn);
    mark_outside(values.value[m], count, {t.fail_low, t.fail_high}, m, failed);
  }
  mark_defects(values, count, failed);
  for (std::size_t lane = 0; lane < count; ++lane) out[lane] = {static_cast<std::uint16_t>(warn[lane] | failed[lane]), failed[lane]};
}

void rate_lanes(const BatchValues& values, std::size_t count, const Limits& limits, const ShellProperties* properties, float* out) {
  const ShapeLimits& shape = limits.of(values.of_triangles);
  for (std::size_t lane = 0; lane < count; ++lane) out[lane] = 1;
  // A metric that doesn't apply is NaN, and so is its score: it never is the min.
  const auto take = [&](const float* value, const ScoreSide& side) {
    for (std::size_t lane = 0; lane < count; ++lane) {
      const float score = (value[lane] - side.limit) * side.slope;
      out[lane] = score < out[lane] ? score : out[lane];
    }
  };
  for (int m = 0; m < kMetricCount; ++m) {
    if (m == kMinLength && properties != nullptr) {
      MinLengths min;
      min_lengths(shape, limits, {properties, count}, min);
      for (std::size_t lane = 0; lane < count; ++lane) {
        if (!std::isfinite(min.fail[lane])) continue;
        const float best = std::max(shape.ideal_min_length, min.fail[lane]);
        const float score = (values.value[m][lane] - min.fail[lane]) / span_of(min.fail[lane], best);
        out[lane] = score < out[lane] ? score : out[lane];
      }
    } else if (shape.side[m][0].slope != 0) {
      take(values.value[m], shape.side[m][0]);
    }
    if (shape.side[m][1].slope != 0) take(values.value[m], shape.side[m][1]);
  }
  std::uint16_t defect[kLanes] = {};
  mark_defects(values, count, defect);
  for (std::size_t lane = 0; lane < count; ++lane) {
    // Below the fail limit the score approaches -1 without reaching it, so that two failing shells can be compared.
    const float bad = std::max(out[lane], -1e30F);
    const float score = bad < 0 ? bad / (1 - bad) : bad;
    out[lane] = defect[lane] != 0 ? -1.0F : std::max(score, kWorstWithoutDefect);
  }
}

}  // namespace prismesh::mesh::quality
