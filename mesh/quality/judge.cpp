#include "mesh/quality/judge.h"

#include "mesh/quality/judge_lanes.h"
#include "mesh/quality/shell_batch.h"

namespace prismesh::mesh::quality {

ShellState judge(const Values& values, const SizedCriteria& criteria, const ShellProperties& properties) {
  const BatchValues batch = batch_of(values);
  const Limits limits = limits_without_part(criteria.of(properties.part));
  ShellState state;
  judge_lanes(batch, 1, limits, limits.need_material() ? &properties : nullptr, &state);
  return state;
}

void judge_points(const PointShells& shells, const SizedCriteria& criteria, std::span<ShellState> out, std::span<float> composites) {
  judge_points(shells, limits_for(criteria), out, composites);
}

void judge_points(const PointShells& shells, const LimitsByPart& limits, std::span<ShellState> out, std::span<float> composites) {
  const bool by_properties = limits.need_properties() && !shells.properties.empty();
  measure_in_batches(
      shells.corners.size(),
      [&](std::size_t i, const Vec3*(&corner)[4]) {
        for (std::size_t c = 0; c < 4; ++c) {
          const std::int32_t at = shells.corners[i][c];
          corner[c] = at >= 0 ? &shells.moving[static_cast<std::size_t>(at)] : &shells.fixed[static_cast<std::uint32_t>(~at)];
        }
        return shells.corners[i][3] == shells.corners[i][2] ? Shape::triangle : Shape::quad;
      },
      [&](const ShellBatch& batch, const BatchValues& values) {
        ShellState states[kLanes];
        ShellProperties buffer[kLanes];
        if (by_properties)
          for (std::size_t lane = 0; lane < batch.count; ++lane) buffer[lane] = shells.properties[batch.slot[lane]];
        const ShellProperties* lane_properties = by_properties ? buffer : nullptr;
        judge_lanes(values, batch.count, limits, lane_properties, states);
        for (std::size_t lane = 0; lane < batch.count; ++lane) out[batch.slot[lane]] = states[lane];
        if (composites.empty()) return;
        float rated[kLanes];
        rate_lanes(values, batch.count, limits, lane_properties, rated);
        for (std::size_t lane = 0; lane < batch.count; ++lane) composites[batch.slot[lane]] = rated[lane];
      });
}

}  // namespace prismesh::mesh::quality
