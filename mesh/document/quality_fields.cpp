#include "mesh/document/quality_fields.h"

#include <algorithm>
#include <array>

#include "mesh/document/field_values.h"
#include "mesh/quality/composite.h"
#include "mesh/quality/judge.h"
#include "mesh/quality/limits.h"
#include "mesh/quality/measure.h"
#include "mesh/quality/time_step.h"

namespace prismesh::mesh::document {

namespace {

using quality::Metric;

constexpr double kClearComposite = 0.5, kFailingComposite = 0;
constexpr double kClearTimeSteps = 2;  ///< of the smallest

std::string title_of(Metric metric) {
  std::string title(quality::name(metric));
  std::replace(title.begin(), title.end(), '_', ' ');
  return title;
}

bool have_same_limits(const quality::Threshold& a, const quality::Threshold& b) {
  return a.warn_low == b.warn_low && a.warn_high == b.warn_high && a.fail_low == b.fail_low && a.fail_high == b.fail_high;
}

/// Whether all parts have the same limits of a metric, as far as they don't depend on thickness and material; `limits` are these.
bool limited_alike(const quality::SizedCriteria& criteria, Metric metric, quality::Threshold& limits) {
  const bool of_triangles = quality::is_of_triangles(metric);
  limits = quality::threshold_of({criteria.criteria, criteria.target_size}, metric, of_triangles);
  if (criteria.by_part == nullptr || criteria.by_part->distinct.empty()) return true;
  bool is_first = true, alike = true;
  for (const quality::PartCriteria& each : criteria.by_part->distinct) {
    const quality::Threshold its =
        quality::threshold_of({each.criteria ? *each.criteria : criteria.criteria, each.target_size}, metric, of_triangles);
    alike = alike && (is_first || have_same_limits(its, limits));
    limits = its;
    is_first = false;
  }
  return alike;
}

/// From warning to failing if the criteria have both on one side; otherwise from the better end of the values to the worse one.
FieldLimits colours_of(Metric metric, const quality::SizedCriteria& criteria, const FieldFigures& figures) {
  quality::Threshold limits;
  if (!limited_alike(criteria, metric, limits)) return apart(figures.min, figures.max);
  if (std::isfinite(limits.warn_high) && std::isfinite(limits.fail_high)) return apart(limits.warn_high, limits.fail_high);
  if (std::isfinite(limits.warn_low) && std::isfinite(limits.fail_low)) return apart(limits.warn_low, limits.fail_low);
  return apart(figures.min, figures.max);
}

/// The existing shells of a chunk.
std::vector<ShellIndex> live_shells_in(const Model& model, std::size_t begin, std::size_t end) {
  std::vector<ShellIndex> shells;
  for (std::size_t s = begin; s < end; ++s)
    if (!model.is_removed(ShellIndex(s))) shells.emplace_back(s);
  return shells;
}

Result<Field> unless_empty(Field field, const char* why) {
  if (field.figures.measured == 0) return fail(field.title, why);
  return field;
}

}  // namespace

Result<Field> metric_field(const Model& model, Metric metric, const quality::SizedCriteria& criteria, LengthUnit unit) {
  Field field{title_of(metric), std::string(quality::unit_of(metric, name(unit))), false, {}, {}, {}};
  fill(field, model.shell_count(), [&](std::size_t begin, std::size_t end, double* out) {
    const std::vector<ShellIndex> shells = live_shells_in(model, begin, end);
    std::vector<quality::Values> values(shells.size());
    quality::measure_shells(model, shells, values);
    for (std::size_t i = 0; i < shells.size(); ++i)
      // A defective shell has no value; its defect is reported instead.
      if (!quality::judge(values[i], {criteria.criteria, criteria.target_size}).has_defect())
        out[shells[i].value - begin] = values[i][static_cast<std::size_t>(metric)];
  });
  field.limits = colours_of(metric, criteria, field.figures);
  return unless_empty(std::move(field), "there is no shell that it applies to");
}

Result<Field> composite_field(const Model& model, const quality::SizedCriteria& criteria) {
  Field field{"composite quality", {}, false, {}, {}, {kClearComposite, kFailingComposite}};
  fill(field, model.shell_count(), [&](std::size_t begin, std::size_t end, double* out) {
    const std::vector<ShellIndex> shells = live_shells_in(model, begin, end);
    std::vector<float> values(shells.size());
    quality::composites(model, shells, criteria, values);
    for (std::size_t i = 0; i < shells.size(); ++i) out[shells[i].value - begin] = values[i];
  });
  return unless_empty(std::move(field), "there are no shells");
}

Result<Field> time_step_field(const Model& model, const TimeStepControl& control) {
  Field field{"time step", "deck's time unit", false, {}, {}, {}};
  fill(field, model.shell_count(), [&](std::size_t begin, std::size_t end, double* out) {
    for (std::size_t s = begin; s < end; ++s) {
      const PartIndex part = model.shell_parts[s];
      if (model.is_removed(ShellIndex(s)) || !part.valid() || part.value >= model.parts->size()) continue;
      const ShellNodes& nodes = model.shell_nodes[s];
      std::array<Vec3, 4> corners;
      for (std::size_t c = 0; c < 4; ++c) corners[c] = model.position(nodes.node[c]);
      const std::span<const Vec3> used(corners.data(), static_cast<std::size_t>(nodes.corners()));
      if (const auto step = quality::shell_time_step((*model.parts)[part.value], used, control.shell_option))
        out[s - begin] = control.scale * *step;
    }
  });
  field.limits = apart(kClearTimeSteps * field.figures.min, field.figures.min);
  return unless_empty(std::move(field), "no shell's density and stiffness are known, so there is no time step");
}

}  // namespace prismesh::mesh::document
