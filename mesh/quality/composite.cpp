#include "mesh/quality/composite.h"

#include <algorithm>
#include <limits>

#include "mesh/quality/judge_lanes.h"
#include "mesh/quality/shell_batch.h"

namespace prismesh::mesh::quality {

float composite(const Values& values, const SizedCriteria& criteria, const ShellProperties& properties) {
  const BatchValues batch = batch_of(values);
  const Limits limits = limits_without_part(criteria.of(properties.part));
  float rated = 0;
  rate_lanes(batch, 1, limits, limits.need_material() ? &properties : nullptr, &rated);
  return rated;
}

void composites(const Model& model, std::span<const ShellIndex> shells, const SizedCriteria& criteria, std::span<float> out,
                std::span<Values> values) {
  const LimitsByPart limits = limits_for(criteria);
  const auto shell_of = [&](std::size_t i) { return shells[i].value; };
  std::fill(out.begin(), out.end(), 1.0F);
  for (Values& none : values) none.fill(std::numeric_limits<float>::quiet_NaN());
  measure_in_batches(
      shells.size(), [&](std::size_t i, const Vec3*(&corner)[4]) { return corners_of(model, shell_of(i), corner); },
      [&](const ShellBatch& batch, const BatchValues& measured) {
        ShellProperties buffer[kLanes];
        float rated[kLanes];
        rate_lanes(measured, batch.count, limits, batch_properties(model, limits, batch, shell_of, buffer), rated);
        for (std::size_t lane = 0; lane < batch.count; ++lane) out[batch.slot[lane]] = rated[lane];
        if (values.empty()) return;
        for (std::size_t lane = 0; lane < batch.count; ++lane) values[batch.slot[lane]] = measured.at(lane);
      });
}

}  // namespace prismesh::mesh::quality
