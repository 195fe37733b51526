#include "kiosk/render/plate_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/parallel_for.h"

namespace prismesh::kiosk::render {

using mesh::Vec3;

namespace {

constexpr std::uint32_t kWayMask = (1U << kPlateWayBits) - 1;
/// With more shells at a node, each has its own way there.
constexpr std::size_t kMaxFan = 24;

std::uint32_t pack(const Vec3& way) {
  std::uint32_t word = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto steps = static_cast<std::int32_t>(std::lround(way[axis] / kPlateWayUnit));  // rounds -x as x: opposite ways stay opposite
    word |= (static_cast<std::uint32_t>(steps) & kWayMask) << (kPlateWayBits * axis);
  }
  return word;
}

std::int32_t steps_of(std::uint32_t corner, int axis) {
  return static_cast<std::int32_t>(corner << (32 - kPlateWayBits * (axis + 1))) >> (32 - kPlateWayBits);
}

std::size_t corner_count(const std::array<std::uint32_t, 4>& corners) { return corners[2] == corners[3] ? 3 : 4; }

std::size_t corner_at(const std::array<std::uint32_t, 4>& corners, std::uint32_t node) {
  return static_cast<std::size_t>(std::find(corners.begin(), corners.end(), node) - corners.begin());
}

}  // namespace

Vec3 plate_way(std::uint32_t corner) { return kPlateWayUnit * Vec3(steps_of(corner, 0), steps_of(corner, 1), steps_of(corner, 2)); }

std::vector<float> plate_thicknesses(const ModelSource& source) {
  std::vector<float> thicknesses(source.part_count());
  for (std::size_t part = 0; part < thicknesses.size(); ++part) {
    const auto [thinnest, thickest] = source.part_thickness(part);
    const float mean = 0.5F * (thinnest + thickest);
    if (thinnest > 0 && std::isfinite(mean)) thicknesses[part] = mean;
  }
  return thicknesses;
}

PlateRow PlateShape::row(std::size_t shell) const {
  PlateRow row = ways_[shell];
  for (std::size_t k = 0; k < 4; ++k)
    if ((sides_[shell] >> k & 1U) != 0) row[k] |= kPlateSide;
  return row;
}

/// A shell at a node: its nodes before and after it in the shell, and whether the shell's upper face is that of the first shell of the fan.
struct PlateShape::Fan {
  std::uint32_t shell = 0, before = 0, after = 0;
  float sign = 0;  ///< 1 or -1; 0: not in the fan
};

void PlateShape::make(const ModelTable& table, std::span<const float> thickness_of_part) {
  const std::size_t shells = table.shell_count();
  ways_.assign(shells, PlateRow{});
  sides_.assign(shells, 0);
  corners_.assign(shells, {kNoIndex, kNoIndex, kNoIndex, kNoIndex});
  thickness_.assign(shells, 0);
  normals_.assign(shells, Eigen::Vector3f::Zero());
  first_of_.assign(table.node_count() + 1, 0);
  mesh::ShellNodes nodes;
  for (std::size_t s = 0; s < shells; ++s) {
    if (!table.shell(s, nodes) || !table.shell_visible(s)) continue;
    for (std::size_t k = 0; k < 4; ++k) corners_[s][k] = nodes.node[k].value;
    const std::size_t part = table.shell_part(s).value;
    thickness_[s] = part < thickness_of_part.size() ? thickness_of_part[part] : 0;
    for (std::size_t k = 0; k < corner_count(corners_[s]); ++k) ++first_of_[corners_[s][k] + 1];
  }
  for (std::size_t n = 1; n < first_of_.size(); ++n) first_of_[n] += first_of_[n - 1];
  shells_of_.resize(first_of_.back());
  std::vector<std::uint32_t> next(first_of_.begin(), first_of_.end() - 1);
  for (std::size_t s = 0; s < shells; ++s)
    if (corners_[s][0] != kNoIndex)
      for (std::size_t k = 0; k < corner_count(corners_[s]); ++k) shells_of_[next[corners_[s][k]]++] = static_cast<std::uint32_t>(s);
  const auto each = [&](const auto& of_chunk) {
    parallel_for(chunk_count(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c) of_chunk(c);
    });
  };
  each([&](std::size_t c) { find_normals(table, c); });
  each([&](std::size_t c) { find_ways(table, c); });
  each([&](std::size_t c) { find_sides(c); });
}

std::vector<std::uint32_t> PlateShape::move(const ModelTable& table, std::span<const std::uint32_t> moved_chunks) {
  // The normals of shells with moved nodes change; the ways of all corners at these shells' nodes depend on them, and sides on these ways.
  std::vector<std::uint8_t> moved(table.node_count() / mesh::kChunkSize + 1, 0), reached(table.node_count(), 0);
  for (const std::uint32_t chunk : moved_chunks)
    if (chunk < moved.size()) moved[chunk] = 1;
  const auto chunks_with = [&](const auto& holds) {
    std::vector<std::uint32_t> chunks;
    for (std::size_t s = 0; s < corners_.size(); ++s) {
      const auto chunk = static_cast<std::uint32_t>(s / mesh::kChunkSize);
      if (corners_[s][0] == kNoIndex || (!chunks.empty() && chunks.back() == chunk)) continue;
      if (std::any_of(corners_[s].begin(), corners_[s].end(), holds)) chunks.push_back(chunk);
    }
    return chunks;
  };
  const auto reach = [&](const std::vector<std::uint32_t>& chunks) {
    for (const std::uint32_t chunk : chunks)
      for (std::size_t s = chunk * mesh::kChunkSize; s < std::min((chunk + 1) * mesh::kChunkSize, corners_.size()); ++s)
        if (corners_[s][0] != kNoIndex)
          for (const std::uint32_t node : corners_[s]) reached[node] = 1;
  };
  const auto each = [&](const std::vector<std::uint32_t>& chunks, const auto& of_chunk) {
    parallel_for(chunks.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) of_chunk(chunks[i]);
    });
  };
  const auto bent = chunks_with([&](std::uint32_t node) { return moved[node / mesh::kChunkSize] != 0; });
  each(bent, [&](std::size_t c) { find_normals(table, c); });
  reach(bent);
  const auto turned = chunks_with([&](std::uint32_t node) { return reached[node] != 0; });
  each(turned, [&](std::size_t c) { find_ways(table, c); });
  reach(turned);
  std::vector<std::uint32_t> changed = chunks_with([&](std::uint32_t node) { return reached[node] != 0; });
  each(changed, [&](std::size_t c) { find_sides(c); });
  return changed;
}

void PlateShape::find_normals(const ModelTable& table, std::size_t chunk) {
  for (std::size_t s = chunk * mesh::kChunkSize; s < std::min((chunk + 1) * mesh::kChunkSize, corners_.size()); ++s) {
    normals_[s].setZero();
    if (corners_[s][0] == kNoIndex) continue;
    std::array<Vec3, 4> at;
    for (std::size_t k = 0; k < 4; ++k) at[k] = table.position(corners_[s][k]);
    const Vec3 normal = (at[2] - at[0]).cross(at[3] - at[1]);
    const double size = normal.norm();
    if (size > 0 && std::isfinite(size)) normals_[s] = (normal / size).cast<float>();
  }
}

void PlateShape::find_ways(const ModelTable& table, std::size_t chunk) {
  for (std::size_t s = chunk * mesh::kChunkSize; s < std::min((chunk + 1) * mesh::kChunkSize, corners_.size()); ++s) {
    ways_[s] = {};
    if (corners_[s][0] == kNoIndex || !(thickness_[s] > 0)) continue;
    for (std::size_t k = 0; k < corner_count(corners_[s]); ++k) ways_[s][k] = pack_way(table, static_cast<std::uint32_t>(s), k);
    if (corner_count(corners_[s]) == 3) ways_[s][3] = ways_[s][2];
  }
}

/// The way at a corner: common to the shells around the node that hang together by edges with small bends, so that their outer faces meet.
std::uint32_t PlateShape::pack_way(const ModelTable& table, std::uint32_t shell, std::size_t corner) const {
  static const float kMinCosine = static_cast<float>(std::cos(kMaxMitreDegrees * std::numbers::pi / 180));
  const std::uint32_t node = corners_[shell][corner];
  const std::span<const std::uint32_t> ring = around(node);
  if (ring.size() > kMaxFan) return pack(normals_[shell].cast<double>());
  std::array<Fan, kMaxFan> fan;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const std::array<std::uint32_t, 4>& corners = corners_[ring[i]];
    const std::size_t count = corner_count(corners), at = corner_at(corners, node);
    fan[i] = {ring[i], corners[(at + count - 1) % count], corners[(at + 1) % count], ring[i] == shell ? 1.0F : 0.0F};
  }
  const std::span<Fan> all = std::span(fan).first(ring.size());
  const auto users_of = [&](std::uint32_t other) {
    return std::count_if(all.begin(), all.end(), [&](const Fan& each) { return each.before == other || each.after == other; });
  };
  for (bool grown = true; grown;) {
    grown = false;
    for (const Fan& known : all)
      for (Fan& other : all) {
        if (known.sign == 0 || other.sign != 0 || normals_[other.shell].isZero()) continue;
        const bool same = known.after == other.before || known.before == other.after;
        const bool opposite = known.after == other.after || known.before == other.before;
        if (!same && !opposite) continue;
        const std::uint32_t end = known.after == other.before || known.after == other.after ? known.after : known.before;
        const float turn = same ? 1.0F : -1.0F;
        if (users_of(end) != 2 || turn * normals_[known.shell].dot(normals_[other.shell]) < kMinCosine) continue;
        other.sign = known.sign * turn;
        grown = true;
      }
  }
  // Signs count from the first of the fan, so that every shell of it finds the same numbers.
  const float own = std::find_if(all.begin(), all.end(), [](const Fan& each) { return each.sign != 0; })->sign;
  const Vec3 at = table.position(node);
  Vec3 mean = Vec3::Zero();
  std::array<double, kMaxFan> weight{};
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].sign == 0) continue;
    const Vec3 a = table.position(all[i].after) - at, b = table.position(all[i].before) - at;
    weight[i] = std::atan2(a.cross(b).norm(), a.dot(b));
    mean += weight[i] * own * all[i].sign * normals_[all[i].shell].cast<double>();
  }
  if (!(mean.norm() > 1e-6)) return pack(normals_[shell].cast<double>());
  mean.normalize();
  // Outer faces are half a thickness away from each shell of the fan, by least squares.
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double cosine = own * all[i].sign * mean.dot(normals_[all[i].shell].cast<double>());
    sum += weight[i] * cosine;
    squares += weight[i] * cosine * cosine;
  }
  const double length = squares > 0 ? std::clamp(sum / squares, 1.0, kMaxPlateWay) : 1.0;
  return pack(own * length * mean);
}

void PlateShape::find_sides(std::size_t chunk) {
  for (std::size_t s = chunk * mesh::kChunkSize; s < std::min((chunk + 1) * mesh::kChunkSize, corners_.size()); ++s) {
    sides_[s] = 0;
    if (corners_[s][0] == kNoIndex || !(thickness_[s] > 0)) continue;
    for (std::size_t k = 0; k < 4; ++k) {
      const bool is_side = corners_[s][k] != corners_[s][(k + 1) % 4];
      if (is_side && !faces_go_on(static_cast<std::uint32_t>(s), k)) sides_[s] = static_cast<std::uint8_t>(sides_[s] | 1U << k);
    }
  }
}

/// Whether a neighbour's outer faces meet the shell's at a side.
bool PlateShape::faces_go_on(std::uint32_t shell, std::size_t side) const {
  const std::uint32_t a = corners_[shell][side], b = corners_[shell][(side + 1) % 4];
  std::optional<std::uint32_t> neighbour;
  for (const std::uint32_t other : around(a)) {
    const std::array<std::uint32_t, 4>& corners = corners_[other];
    const std::size_t at = corner_at(corners, a), count = corner_count(corners);
    if (other == shell || (corners[(at + 1) % count] != b && corners[(at + count - 1) % count] != b)) continue;
    if (neighbour) return false;  // a junction
    neighbour = other;
  }
  if (!neighbour || thickness_[*neighbour] != thickness_[shell]) return false;
  const std::array<std::uint32_t, 4>& corners = corners_[*neighbour];
  const std::size_t at_a = corner_at(corners, a), at_b = corner_at(corners, b), count = corner_count(corners);
  const std::int32_t sign = corners[(at_b + 1) % count] == a ? 1 : -1;
  const auto meets = [&](std::uint32_t own, std::uint32_t its) {
    for (int axis = 0; axis < 3; ++axis)
      if (steps_of(own, axis) != sign * steps_of(its, axis)) return false;
    return true;
  };
  return meets(ways_[shell][side], ways_[*neighbour][at_a]) && meets(ways_[shell][(side + 1) % 4], ways_[*neighbour][at_b]);
}

}  // namespace prismesh::kiosk::render
