#include "mesh/deck/sample/body_side.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace prismesh::mesh::deck::sample {
namespace {

// Sheet thicknesses.
constexpr double kRail = 1.8, kPlate = 1.5, kPillar = 1.6, kPillarInner = 1.2, kReinforcement = 1.4, kFloor = 0.8, kCross = 1.2;
constexpr double kFlange = 20;       // width of every weld flange
constexpr double kWeldPitch = 42;    // distance of spot welds
constexpr double kPillarAt = 1040;   // x of the pillar's and the crossmember's middle
constexpr double kFloorLevel = -30;  // z of the floor's middle surface
constexpr double kPlatePlane = -(kRail + kPlate) / 2;
constexpr double kFloorFlangePlane = kPlatePlane - (kPlate + kFloor) / 2;

/// Faces of a hat: flange, wall, top, wall, flange. A closing plate has the same flanges and one face between them.
enum HatFace : std::size_t { kLowerFlange, kLowerWall, kTop, kUpperWall, kUpperFlange, kHatFaces };

double mix(double a, double b, double t) { return a + (b - a) * t; }

/// 1 in the middle of [centre - half, centre + half], 0 at its ends and beyond.
double bump(double centre, double half, double x) {
  const double t = std::clamp((x - centre) / half, -1.0, 1.0);
  const double u = 1 - t * t;
  return u * u;
}

/// A line in the plane with places and normals by arc length.
class Path {
 public:
  /// `line(t)` for t in 0..1.
  template <class Line>
  explicit Path(const Line& line) {
    points_.reserve(kSteps + 1);
    for (std::size_t i = 0; i <= kSteps; ++i) {
      points_.push_back(line(static_cast<double>(i) / kSteps));
      const double step = i == 0 ? 0 : std::sqrt((points_[i] - points_[i - 1]).squaredNorm());
      arc_.push_back(i == 0 ? 0 : arc_.back() + step);
    }
  }
  double length() const { return arc_.back(); }
  Eigen::Vector2d at(double arc) const {
    const auto [i, t] = find(arc);
    return points_[i] + t * (points_[i + 1] - points_[i]);
  }
  /// Unit vector a quarter turn left of the line's direction, without steps between the table's entries.
  Eigen::Vector2d normal(double arc) const {
    const double reach = length() / kSteps;
    const Eigen::Vector2d d = at(std::min(arc + reach, length())) - at(std::max(arc - reach, 0.0));
    return Eigen::Vector2d(-d.y(), d.x()) / std::sqrt(d.squaredNorm());
  }

 private:
  static constexpr std::size_t kSteps = 8192;
  std::pair<std::size_t, double> find(double arc) const {
    const auto above = std::upper_bound(arc_.begin() + 1, arc_.end() - 1, arc);
    const auto i = static_cast<std::size_t>(above - arc_.begin()) - 1;
    return {i, std::clamp((arc - arc_[i]) / (arc_[i + 1] - arc_[i]), 0.0, 1.0)};
  }
  std::vector<Eigen::Vector2d> points_;
  std::vector<double> arc_;
};

/// The corners of a hat's section: `p` across, `q` out of the flanges' plane.
struct Section {
  std::array<Eigen::Vector2d, kHatFaces + 1> corner;
  double width(std::size_t face) const { return std::sqrt((corner[face + 1] - corner[face]).squaredNorm()); }
  Eigen::Vector2d at(std::size_t face, double across) const { return corner[face] + across * (corner[face + 1] - corner[face]); }
};

Section hat(double half_width, double height, double draft) {
  return {{Eigen::Vector2d(-half_width - kFlange, 0),
           {-half_width, 0},
           {-half_width + draft, height},
           {half_width - draft, height},
           {half_width, 0},
           {half_width + kFlange, 0}}};
}

// --- the rail: its line lies in the plane of x and z, the hat opens inwards ---

Path rail_path() {
  return Path([](double t) {
    const double x = 1640 * t;
    return Eigen::Vector2d(x, 150 * (1 - smooth_step(280, 720, x)));
  });
}

Section rail_section(double arc) {
  const double sill = smooth_step(350, 750, arc);
  return hat(mix(48, 64, sill), mix(62, 84, sill), 9);
}

/// Crush beads across the front of the rail, no narrower than the mesh can show.
double rail_bead(double arc, double across, double size) {
  const double half = std::max(15.0, 2.0 * size);
  const double pitch = 3.2 * half;
  double depth = 0;
  for (double centre = 40 + 1.6 * half; centre + half < 300; centre += pitch) depth = std::max(depth, bump(centre, half, arc));
  return -6 * depth * smooth_step(0, 0.5, across) * smooth_step(0, 0.5, 1 - across);
}

Part rail_outer(const std::shared_ptr<const Path>& path, double size) {
  Part part{1, "Rail and sill outer", kRail, path->length(), kHatFaces, {}, {}, {}};
  part.width = [](std::size_t face, double arc) { return rail_section(arc).width(face); };
  part.surface = [path, size](std::size_t face, double across, double arc) {
    Eigen::Vector2d section = rail_section(arc).at(face, across);
    if (face == kTop) section.y() += rail_bead(arc, across, size);
    const Eigen::Vector2d place = path->at(arc) + section.x() * path->normal(arc);
    return Vec3(place.x(), section.y(), place.y());
  };
  for (const double arc : {380.0, 520.0, 660.0}) part.holes.push_back({kTop, arc, 0.5, 17});
  for (const double arc : {800.0, 1300.0, 1420.0, 1540.0}) part.holes.push_back({kTop, arc, 0.5, 21});
  return part;
}

Part closing_plate(const std::shared_ptr<const Path>& path) {
  Part part{2, "Closing plate", kPlate, path->length(), 3, {}, {}, {}};
  const auto section = [](std::size_t face, double across, double arc) {
    const Section outer = rail_section(arc);
    const std::size_t hat_face = face == 0 ? kLowerFlange : kUpperFlange;
    if (face != 1) return outer.at(hat_face, across).x();
    return mix(outer.corner[kLowerWall].x(), outer.corner[kUpperFlange].x(), across);
  };
  part.width = [section](std::size_t face, double arc) { return section(face, 1, arc) - section(face, 0, arc); };
  part.surface = [path, section](std::size_t face, double across, double arc) {
    const Eigen::Vector2d place = path->at(arc) + section(face, across, arc) * path->normal(arc);
    return Vec3(place.x(), kPlatePlane, place.y());
  };
  for (const double arc : {150.0, 300.0, 560.0}) part.holes.push_back({1, arc, 0.5, 24});
  for (const double arc : {780.0, 1400.0, 1520.0}) part.holes.push_back({1, arc, 0.62, 19});
  return part;
}

// --- the pillar: its line lies in the plane of z and y (first and second coordinate), the hat opens inwards ---

constexpr double kPillarFoot = 66;  // z of the lower edge, on the sill's upper flange

Path pillar_path() {
  return Path([](double t) {
    const double s = 930 * t;
    return Eigen::Vector2d(kPillarFoot + s, (kRail + kPillar) / 2 - 130 * smooth_step(120, 1500, s));
  });
}

Section pillar_section(double arc) {
  const double waist = smooth_step(20, 420, arc);
  const double head = smooth_step(560, 930, arc);
  const double rise = smooth_step(20, 400, arc);
  return hat(mix(mix(178, 66, waist), 92, head), 70 * rise, mix(60, 14, rise));
}

Vec3 pillar_point(const Path& path, double across_x, double out, double arc) {
  // The line goes up, so its left is outwards.
  const Eigen::Vector2d place = path.at(arc) + out * path.normal(arc);
  return {kPillarAt + across_x, place.y(), place.x()};
}

Part pillar_outer(const std::shared_ptr<const Path>& path) {
  Part part{3, "Pillar outer", kPillar, path->length(), kHatFaces, {}, {}, {}};
  part.width = [](std::size_t face, double arc) { return pillar_section(arc).width(face); };
  part.surface = [path](std::size_t face, double across, double arc) {
    const Eigen::Vector2d section = pillar_section(arc).at(face, across);
    return pillar_point(*path, section.x(), section.y(), arc);
  };
  for (const double arc : {300.0, 395.0}) part.holes.push_back({kTop, arc, 0.5, 13});
  for (const double arc : {640.0, 770.0}) part.holes.push_back({kTop, arc, 0.5, 22});
  return part;
}

/// Behind the sill's closing plate at its foot, on the outer pillar's flanges above it.
double pillar_inner_depth(double arc) {
  const double foot = kPlatePlane - (kPlate + kPillarInner) / 2 - (kRail + kPillar) / 2;
  return mix(foot, -(kPillar + kPillarInner) / 2, smooth_step(28, 95, arc));
}

Part pillar_inner(const std::shared_ptr<const Path>& path) {
  Part part{4, "Pillar inner", kPillarInner, path->length(), 3, {}, {}, {}};
  const auto section = [](std::size_t face, double across, double arc) {
    const Section outer = pillar_section(arc);
    if (face != 1) return outer.at(face == 0 ? kLowerFlange : kUpperFlange, across).x();
    return mix(outer.corner[kLowerWall].x(), outer.corner[kUpperFlange].x(), across);
  };
  part.width = [section](std::size_t face, double arc) { return section(face, 1, arc) - section(face, 0, arc); };
  part.surface = [path, section](std::size_t face, double across, double arc) {
    return pillar_point(*path, section(face, across, arc), pillar_inner_depth(arc), arc);
  };
  part.holes = {{1, 210, 0.5, 46}, {1, 390, 0.5, 30}, {1, 520, 0.5, 30}, {1, 700, 0.5, 36}, {1, 840, 0.5, 24}};
  return part;
}

constexpr double kReinforcementFrom = 240, kReinforcementTo = 540;

/// Lies inside the outer pillar: its top and the upper parts of its walls, half both thicknesses away.
Part reinforcement(const std::shared_ptr<const Path>& path) {
  Part part{5, "Hinge reinforcement", kReinforcement, kReinforcementTo - kReinforcementFrom, 3, {}, {}, {}};
  const auto section = [](double arc) {
    const Section outer = pillar_section(arc + kReinforcementFrom);
    const double gap = (kPillar + kReinforcement) / 2;
    const Eigen::Vector2d wall = outer.corner[kTop] - outer.corner[kLowerWall];
    const double length = outer.width(kLowerWall);
    // The walls' lines moved inwards by the gap meet the top's at `corner`.
    const double corner = outer.corner[kTop].x() + gap * (length - wall.x()) / wall.y();
    const double height = outer.corner[kTop].y() - gap;
    const double foot = corner - wall.x() * 0.55;
    const double foot_height = height - wall.y() * 0.55;
    return std::array<Eigen::Vector2d, 4>{Eigen::Vector2d(foot, foot_height), {corner, height}, {-corner, height}, {-foot, foot_height}};
  };
  part.width = [section](std::size_t face, double arc) {
    const auto corner = section(arc);
    return std::sqrt((corner[face + 1] - corner[face]).squaredNorm());
  };
  part.surface = [path, section](std::size_t face, double across, double arc) {
    const auto corner = section(arc);
    const Eigen::Vector2d at = corner[face] + across * (corner[face + 1] - corner[face]);
    return pillar_point(*path, at.x(), at.y(), arc + kReinforcementFrom);
  };
  part.holes = {{1, 300 - kReinforcementFrom, 0.5, 13}, {1, 395 - kReinforcementFrom, 0.5, 13}};
  return part;
}

// --- the floor: swept along x, its faces go inwards from a flange on the sill's plate ---

constexpr double kFloorFrom = 700, kFloorLength = 820;

/// Faces of the floor across: the flange, then flat and bead (slope, ground, slope) by turns.
constexpr std::array<double, 19> kFloorFaces{kFlange, 44, 16, 24, 16, 44, 16, 24, 16, 44, 16, 24, 16, 44, 16, 24, 16, 44, 30};

/// Beads end before the crossmember's flanges and the floor's ends.
double floor_bead_depth(double x) {
  const double front = smooth_step(40, 130, x - kFloorFrom) * smooth_step(95, 185, kPillarAt - x);
  const double rear = smooth_step(95, 185, x - kPillarAt) * smooth_step(40, 130, kFloorFrom + kFloorLength - x);
  return -6 * std::max(front, rear);
}

Part floor_panel() {
  Part part{6, "Floor panel", kFloor, kFloorLength, kFloorFaces.size(), {}, {}, {}};
  const auto corner = [](std::size_t i, double x) {
    if (i == 0) return Eigen::Vector2d(kFloorFlangePlane, kFloorLevel + kFlange);
    double y = kFloorFlangePlane;
    for (std::size_t f = 1; f < i; ++f) y -= kFloorFaces[f];
    const bool ground = i >= 3 && i < kFloorFaces.size() - 1 && ((i - 3) % 4 == 0 || (i - 4) % 4 == 0);
    return Eigen::Vector2d(y, kFloorLevel + (ground ? floor_bead_depth(x) : 0));
  };
  // Widths are those of the flat sheet: the beads' depth doesn't change how many elements lie across.
  part.width = [](std::size_t face, double) { return kFloorFaces[face]; };
  part.surface = [corner](std::size_t face, double across, double along) {
    const double x = kFloorFrom + along;
    const Eigen::Vector2d place = corner(face, x) + across * (corner(face + 1, x) - corner(face, x));
    return Vec3(x, place.x(), place.y());
  };
  return part;
}

// --- the crossmember: swept inwards, on the floor, between its beads ---

constexpr double kCrossFrom = 8, kCrossLength = 420;

Part crossmember() {
  Part part{7, "Crossmember", kCross, kCrossLength, kHatFaces, {}, {}, {}};
  const auto section = [](double along) {
    return hat(mix(66, 54, smooth_step(0, 400, along)), mix(72, 52, smooth_step(40, 400, along)), 11);
  };
  part.width = [section](std::size_t face, double along) { return section(along).width(face); };
  part.surface = [section](std::size_t face, double across, double along) {
    const Eigen::Vector2d at = section(along).at(face, across);
    return Vec3(kPillarAt + at.x(), kFloorFlangePlane - kCrossFrom - along, kFloorLevel + (kFloor + kCross) / 2 + at.y());
  };
  for (const double along : {95.0, 210.0, 325.0}) part.holes.push_back({kTop, along, 0.5, 18});
  return part;
}

/// Where welds of a row sit: `pitch` apart, half a pitch from the ends.
std::vector<double> weld_places(double from, double to) {
  std::vector<double> places;
  const auto count = static_cast<std::size_t>((to - from) / kWeldPitch);
  for (std::size_t i = 0; i < count; ++i) places.push_back(mix(from, to, (static_cast<double>(i) + 0.5) / static_cast<double>(count)));
  return places;
}

void weld_rail(Assembly& assembly) {
  const Part& rail = assembly.parts[0];
  const Part& plate = assembly.parts[1];
  for (const double arc : weld_places(0, rail.length))
    for (const bool upper : {false, true})
      assembly.welds.push_back({rail.surface(upper ? kUpperFlange : kLowerFlange, 0.5, arc), plate.surface(upper ? 2 : 0, 0.5, arc)});
}

void weld_pillar(Assembly& assembly) {
  const Part& outer = assembly.parts[2];
  const Part& inner = assembly.parts[3];
  const Part& patch = assembly.parts[4];
  for (const double arc : weld_places(110, outer.length))
    for (const bool rear : {false, true})
      assembly.welds.push_back({outer.surface(rear ? kUpperFlange : kLowerFlange, 0.5, arc), inner.surface(rear ? 2 : 0, 0.5, arc)});
  for (const double arc : weld_places(0, patch.length))
    for (const double across : {0.15, 0.85})
      assembly.welds.push_back({outer.surface(kTop, across, arc + kReinforcementFrom), patch.surface(1, across, arc)});
}

/// The pillar's foot through the sill's upper flange: outer to sill, sill to plate is there already, plate to inner.
void weld_foot(Assembly& assembly) {
  const double z = kPillarFoot + 0.5 * kFlange;
  for (const double x : weld_places(kPillarAt - 165, kPillarAt + 165)) {
    assembly.welds.push_back({Vec3(x, (kRail + kPillar) / 2, z), Vec3(x, 0, z)});
    assembly.welds.push_back({Vec3(x, kPlatePlane, z), Vec3(x, kPlatePlane - (kPlate + kPillarInner) / 2, z)});
  }
}

void weld_floor(Assembly& assembly) {
  for (const double x : weld_places(kFloorFrom, kFloorFrom + kFloorLength)) {
    const double z = kFloorLevel + 0.5 * kFlange;
    assembly.welds.push_back({Vec3(x, kPlatePlane, z), Vec3(x, kFloorFlangePlane, z)});
  }
  const Part& cross = assembly.parts[6];
  for (const double along : weld_places(0, cross.length))
    for (const std::size_t flange : {kLowerFlange, kUpperFlange}) {
      const Vec3 on_cross = cross.surface(flange, 0.5, along);
      assembly.welds.push_back({on_cross, Vec3(on_cross.x(), on_cross.y(), kFloorLevel)});
    }
}

/// Parts are drawn with y outwards; the left side of a car has it inwards.
Vec3 to_the_left_side(const Vec3& at) { return {at.x(), -at.y(), at.z()}; }

}  // namespace

Assembly body_side(double size) {
  const auto rail = std::make_shared<const Path>(rail_path());
  const auto pillar = std::make_shared<const Path>(pillar_path());
  Assembly assembly;
  assembly.parts = {rail_outer(rail, size), closing_plate(rail), pillar_outer(pillar), pillar_inner(pillar),
                    reinforcement(pillar),  floor_panel(),       crossmember()};
  weld_rail(assembly);
  weld_pillar(assembly);
  weld_foot(assembly);
  weld_floor(assembly);
  for (Part& part : assembly.parts)
    part.surface = [drawn = part.surface](std::size_t face, double across, double along) {
      return to_the_left_side(drawn(face, across, along));
    };
  for (SpotWeld& weld : assembly.welds) weld = {to_the_left_side(weld.from), to_the_left_side(weld.to)};
  return assembly;
}

}  // namespace prismesh::mesh::deck::sample
