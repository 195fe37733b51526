#include "mesh/quality/limits.h"

namespace prismesh::mesh::quality {

namespace {

constexpr float kMax = 3e38F;  ///< of a limit: keeps one beyond a float's range finite

float in_float(double limit) {
  return std::isfinite(limit) ? static_cast<float>(std::clamp<double>(limit, -kMax, kMax)) : static_cast<float>(limit);
}

Threshold scaled(const Threshold& threshold, double by) {
  const auto scale = [by](float limit) { return in_float(limit * by); };
  return {scale(threshold.warn_low), scale(threshold.warn_high), scale(threshold.fail_low), scale(threshold.fail_high)};
}

bool is_length(int metric) { return metric == kMinLength || metric == int(Metric::max_length); }

/// The value of a metric for a square or an equilateral triangle of the target size.
float ideal(Metric metric, bool of_triangle, double target_size) {
  switch (metric) {
    case Metric::warpage:
    case Metric::skew:
    case Metric::taper: return 0;
    case Metric::aspect:
    case Metric::jacobian: return 1;
    case Metric::min_angle_quad:
    case Metric::max_angle_quad: return 90;
    case Metric::min_angle_tri:
    case Metric::max_angle_tri: return 60;
    case Metric::min_length: return static_cast<float>(of_triangle ? 0.8660254037844386 * target_size : target_size);
    case Metric::max_length: break;
  }
  return static_cast<float>(target_size);
}

ShapeLimits shape_limits(const std::array<Threshold, kMetricCount>& thresholds, bool of_triangle, double target_size) {
  ShapeLimits shape;
  for (int m = 0; m < kMetricCount; ++m) {
    const Threshold& t = shape.threshold[m] = scaled(thresholds[m], is_length(m) ? target_size : 1.0);
    const float best = ideal(static_cast<Metric>(m), of_triangle, target_size);
    if (std::isfinite(t.fail_low))
      shape.side[m][0] = {t.fail_low, best > t.fail_low ? 1 / span_of(t.fail_low, best) : 1 / span_of(t.fail_low, t.fail_low)};
    if (std::isfinite(t.fail_high))
      shape.side[m][1] = {t.fail_high, best < t.fail_high ? -1 / span_of(t.fail_high, best) : -1 / span_of(t.fail_high, t.fail_high)};
  }
  shape.ideal_min_length = ideal(Metric::min_length, of_triangle, target_size);
  return shape;
}

/// The limit of min_length: by the wanted time step, if there is one and the material is known, else the fraction of the target size; at
/// least the multiple of the thickness.
float min_length(float fraction, float step, float thicknesses, const ShellProperties& properties) {
  const float length = step > 0 && properties.wave_speed > 0 ? std::min(step * properties.wave_speed, kMax) : fraction;
  return thicknesses > 0 && properties.thickness > 0 ? std::max(length, std::min(thicknesses * properties.thickness, kMax)) : length;
}

/// The length for a wave speed of 1; the deck scales the step by time_step_scale.
float length_of_step(double time_step, const Criteria& criteria) { return static_cast<float>(time_step / criteria.time_step_scale); }

}  // namespace

Limits limits_without_part(const SizedCriteria& sized) {
  const Criteria& criteria = sized.criteria;
  const double target_size = sized.target_size;
  Limits limits;
  limits.quad = shape_limits(criteria.quad, false, target_size);
  limits.triangle = shape_limits(criteria.triangle, true, target_size);
  limits.warn_thicknesses = criteria.warn_min_length_thicknesses;
  limits.fail_thicknesses = criteria.fail_min_length_thicknesses;
  limits.warn_step = length_of_step(criteria.warn_time_step, criteria);
  limits.fail_step = length_of_step(criteria.fail_time_step, criteria);
  return limits;
}

LimitsByPart limits_for(const SizedCriteria& sized) {
  LimitsByPart limits;
  limits.distinct.push_back(limits_without_part(sized));
  if (sized.by_part != nullptr) {
    for (const PartCriteria& each : sized.by_part->distinct)
      limits.distinct.push_back(limits_without_part({each.criteria ? *each.criteria : sized.criteria, each.target_size}));
    limits.part_limits = sized.by_part->of_part;
  }
  for (const Limits& each : limits.distinct) limits.needs_material = limits.needs_material || each.need_material();
  return limits;
}

Threshold threshold_of(const SizedCriteria& by_part, Metric metric, bool of_triangle, const ShellProperties& properties) {
  const SizedCriteria sized = by_part.of(properties.part);
  const Criteria& criteria = sized.criteria;
  const double target_size = sized.target_size;
  const int m = int(metric);
  const Threshold& given = (of_triangle ? criteria.triangle : criteria.quad)[static_cast<std::size_t>(m)];
  if (!is_length(m)) return given;
  Threshold limits = scaled(given, target_size);
  if (m != kMinLength) return limits;
  const float warn_step = length_of_step(criteria.warn_time_step, criteria), fail_step = length_of_step(criteria.fail_time_step, criteria);
  limits.warn_low = min_length(limits.warn_low, warn_step, criteria.warn_min_length_thicknesses, properties);
  limits.fail_low = min_length(limits.fail_low, fail_step, criteria.fail_min_length_thicknesses, properties);
  return limits;
}

void min_lengths(const ShapeLimits& shape, const Limits& limits, std::span<const ShellProperties> properties, MinLengths& out) {
  const Threshold& t = shape.threshold[kMinLength];
  for (std::size_t lane = 0; lane < properties.size(); ++lane) {
    out.warn[lane] = min_length(t.warn_low, limits.warn_step, limits.warn_thicknesses, properties[lane]);
    out.fail[lane] = min_length(t.fail_low, limits.fail_step, limits.fail_thicknesses, properties[lane]);
  }
}

}  // namespace prismesh::mesh::quality
