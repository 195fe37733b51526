#include "mesh/connections/bond_strip.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "mesh/quality/shell_properties.h"

namespace prismesh::mesh::connections {

namespace {

/// On the flange's end rounding decides whether a sheet is there: if none is, the strip begins this share of a hexahedron's length from it.
constexpr double kInsideEnd = 1e-6;
/// Faces closer than this share of the strip's width touch.
constexpr double kNoRoom = 1e-6;

/// The two corners that lie opposite to each other, the lower one first.
struct CornerPair {
  std::array<BondCorner, 2> corner;
  std::optional<NoBond> missing;
  std::array<std::uint32_t, 2> index{};  ///< in BondStrip::corners, once a hexahedron uses them
  bool is_used = false;
};

struct Station {
  Vec3 place = Vec3::Zero();
  std::array<CornerPair, 2> side;
};

Vec3 point_at(std::span<const Vec3> line, double distance) {
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double step = (line[i] - line[i - 1]).norm();
    if (distance <= step || i + 1 == line.size())
      return step > 0 ? Vec3(line[i - 1] + std::clamp(distance / step, 0.0, 1.0) * (line[i] - line[i - 1])) : line[i];
    distance -= step;
  }
  return line.empty() ? Vec3(Vec3::Zero()) : line.front();
}

double half_thickness(const Model& model, ShellIndex shell) {
  const double known = quality::thickness_of(model, shell.value);
  return std::isfinite(known) && known > 0 ? known / 2 : 0;
}

class StripMaker {
 public:
  StripMaker(const Model& model, const spatial::BoxTree& tree, const Flange& flange, const BondShape& shape)
      : model_(model), tree_(tree), flange_(flange), shape_(shape), length_(connections::length_of(flange.middle)) {
    options_.gap = shape.gap;
  }

  BondStrip make() {
    std::vector<Station> stations = lay_stations();
    BondStrip strip;
    strip.thinnest = std::numeric_limits<double>::infinity();
    const std::size_t count = flange_.closed ? stations.size() : stations.size() - 1;
    for (std::size_t s = 0; s < count; ++s) add_solid(stations[s], stations[(s + 1) % stations.size()], strip);
    if (strip.solids.empty()) strip.thinnest = 0;
    return strip;
  }

 private:
  std::vector<Station> lay_stations() {
    const double ends = flange_.closed ? 0 : shape_.end_distance;
    const double covered = length_ - 2 * ends;
    // A ring has at least three, for with two both would have the same corners.
    const double least = flange_.closed ? 3 : 1;
    const double count = std::max(least, std::round(covered / shape_.length));
    std::vector<Station> stations;
    const double step = covered / count;
    for (double i = 0; i < count + (flange_.closed ? 0 : 1); ++i) {
      stations.push_back(station_at(ends + i * step, step));
      if (flange_.closed || ends > 0 || (i > 0 && i < count) || !is_off(stations.back())) continue;
      if (Station inside = station_at(i > 0 ? length_ - kInsideEnd * step : kInsideEnd * step, step); !is_off(inside))
        stations.back() = std::move(inside);
    }
    return stations;
  }

  static bool is_off(const Station& station) {
    return station.side[0].missing == NoBond::off_sheets || station.side[1].missing == NoBond::off_sheets;
  }

  Station station_at(double distance, double step) {
    Station station;
    station.place = point_at(flange_.middle, distance);
    const auto beside = [&](double by) {
      const double at = distance + by;
      return point_at(flange_.middle, flange_.closed ? at - length_ * std::floor(at / length_) : std::clamp(at, 0.0, length_));
    };
    const Vec3 along = beside(step / 2) - beside(-step / 2);
    const std::optional<NoBond> missing = turn_up(station.place);
    const Vec3 across = up_.cross(along).normalized();
    for (std::size_t side = 0; side < 2; ++side) {
      if (missing)
        station.side[side].missing = missing;
      else
        station.side[side] = pair_at(station.place + (side == 0 ? -0.5 : 0.5) * shape_.width * across);
    }
    return station;
  }

  /// Takes the direction from one sheet to the other at the place: the one that differs less from the last.
  std::optional<NoBond> turn_up(const Vec3& place) {
    const SpotStack stack = stack_at(model_, tree_, place, options_);
    if (stack.sheets.size() != 2) return NoBond::off_sheets;
    const Vec3 up = stack.sheets[1].point - stack.sheets[0].point;
    if (!(up.norm() > kNoRoom * shape_.width)) return NoBond::no_room;
    up_ = up_.dot(up) < 0 ? Vec3(-up.normalized()) : Vec3(up.normalized());
    return std::nullopt;
  }

  CornerPair pair_at(const Vec3& place) const {
    CornerPair pair;
    SpotStack stack = stack_at(model_, tree_, place, options_);
    if (stack.sheets.size() != 2) {
      pair.missing = NoBond::off_sheets;
      return pair;
    }
    if (up_.dot(stack.sheets[1].point - stack.sheets[0].point) < 0) std::swap(stack.sheets[0], stack.sheets[1]);
    const Vec3 up = stack.sheets[1].point - stack.sheets[0].point;
    double room = up.norm();
    std::array<double, 2> inside{};
    if (!shape_.from_middle)
      for (std::size_t e = 0; e < 2; ++e) room -= inside[e] = half_thickness(model_, stack.sheets[e].shell);
    if (!(room > kNoRoom * shape_.width)) {
      pair.missing = NoBond::no_room;
      return pair;
    }
    for (std::size_t e = 0; e < 2; ++e)
      pair.corner[e] = {stack.sheets[e], stack.sheets[e].point + (e == 0 ? inside[e] : -inside[e]) * up.normalized()};
    return pair;
  }

  /// The hexahedron between two stations.
  void add_solid(Station& from, Station& to, BondStrip& strip) const {
    const std::array<CornerPair*, 4> around{from.side.data(), to.side.data(), &to.side[1], &from.side[1]};
    const auto leave = [&](NoBond why) { strip.left.push_back({(from.place + to.place) / 2, why}); };
    for (const CornerPair* pair : around)
      if (pair->missing) return leave(*pair->missing);
    std::array<Vec3, 8> points;
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t e = 0; e < 2; ++e) points[c + 4 * e] = around[c]->corner[e].point;
    if (!(least_corner_volume(points) > 0)) return leave(NoBond::turned_over);
    std::array<std::uint32_t, 8> solid{};
    for (std::size_t c = 0; c < 4; ++c) {
      CornerPair& pair = *around[c];
      for (std::size_t e = 0; e < 2; ++e) {
        if (!pair.is_used) {
          pair.index[e] = static_cast<std::uint32_t>(strip.corners.size());
          strip.corners.push_back(pair.corner[e]);
        }
        solid[c + 4 * e] = pair.index[e];
      }
      pair.is_used = true;
      const double thick = (pair.corner[1].point - pair.corner[0].point).norm();
      strip.thinnest = std::min(strip.thinnest, thick);
      strip.thickest = std::max(strip.thickest, thick);
    }
    strip.solids.push_back(solid);
  }

  const Model& model_;
  const spatial::BoxTree& tree_;
  const Flange& flange_;
  const BondShape& shape_;
  double length_;
  SpotOptions options_;
  Vec3 up_ = Vec3::Zero();
};

}  // namespace

void turn_over(BondStrip& strip) {
  for (std::array<std::uint32_t, 8>& solid : strip.solids)
    solid = {solid[4], solid[7], solid[6], solid[5], solid[0], solid[3], solid[2], solid[1]};
}

double least_corner_volume(const std::array<Vec3, 8>& corners) {
  // Each corner with its neighbours in the order in which their edges are right-handed.
  constexpr std::size_t kEdges[8][3] = {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < 8; ++c) {
    const auto edge = [&](std::size_t e) -> Vec3 { return corners[kEdges[c][e]] - corners[c]; };
    const double volume = edge(0).cross(edge(1)).dot(edge(2));
    if (!std::isfinite(volume)) return -std::numeric_limits<double>::infinity();
    least = std::min(least, volume);
  }
  return least;
}

BondStrip lay_strip(const Model& model, const spatial::BoxTree& tree, const Flange& flange, const BondShape& shape) {
  return StripMaker(model, tree, flange, shape).make();
}

}  // namespace prismesh::mesh::connections
