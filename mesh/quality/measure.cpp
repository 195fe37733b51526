#include "mesh/quality/measure.h"

#include <algorithm>
#include <limits>

#include "mesh/quality/shell_batch.h"

namespace prismesh::mesh::quality {

namespace {

/// Of a removed shell.
constexpr Values kNoValues = [] {
  Values values;
  values.fill(std::numeric_limits<float>::quiet_NaN());
  return values;
}();

}  // namespace

Values measure(std::span<const Vec3> corners) {
  Values out{};
  measure_in_batches(
      1,
      [&](std::size_t, const Vec3*(&corner)[4]) {
        for (std::size_t c = 0; c < 4; ++c) corner[c] = &corners[std::min(c, corners.size() - 1)];
        return corners.size() == 3 ? Shape::triangle : Shape::quad;
      },
      [&](const ShellBatch&, const BatchValues& values) { out = values.at(0); });
  return out;
}

void measure_range(const Model& model, std::size_t begin, std::size_t end, std::span<Values> out) {
  std::fill(out.begin(), out.end(), kNoValues);
  measure_in_batches(
      end - begin, [&](std::size_t i, const Vec3*(&corner)[4]) { return corners_of(model, begin + i, corner); },
      [&](const ShellBatch& batch, const BatchValues& values) {
        for (std::size_t lane = 0; lane < batch.count; ++lane) out[batch.slot[lane]] = values.at(lane);
      });
}

void measure_shells(const Model& model, std::span<const ShellIndex> shells, std::span<Values> out) {
  std::fill(out.begin(), out.end(), kNoValues);
  measure_in_batches(
      shells.size(), [&](std::size_t i, const Vec3*(&corner)[4]) { return corners_of(model, shells[i].value, corner); },
      [&](const ShellBatch& batch, const BatchValues& values) {
        for (std::size_t lane = 0; lane < batch.count; ++lane) out[batch.slot[lane]] = values.at(lane);
      });
}

}  // namespace prismesh::mesh::quality
