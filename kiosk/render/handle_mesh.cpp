#include "kiosk/render/handle_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "kiosk/render/frame.h"

namespace prismesh::kiosk::render {

namespace {

// Display pixels.
constexpr double kShaftRadius = 2.6, kHeadRadius = 8.0, kHeadStart = 0.72;
constexpr double kRingHalfWidth = 1.5, kRingBefore = 6, kRingThickness = 2;
constexpr double kDiskRim = 1.5, kDiskLift = 5;  ///< lifted, so that the surface it touches doesn't swallow it
constexpr double kAxisRadius = 1.4, kAxisBeyond = 28, kAxisEnd = 5;
constexpr double kCircleRadius = 1.1, kArcRadius = 2.4, kTickRadius = 1.1, kSpokeRadius = 0.8;
constexpr double kTick = 11, kLongTick = 18;
constexpr float kDiskAlpha = 0.42F, kActiveDiskAlpha = 0.6F, kFaintAlpha = 0.9F;
constexpr int kSides = 10, kRound = 48;
constexpr double kFullCircle = 360;

/// Puts things into the screen's space.
class Workshop {
 public:
  explicit Workshop(const HandleSpace& space) : space_(space) {}

  Vec3 place(const Vec3& deck) const { return stereo::to_screen(space_.view, deck); }
  /// Millimetres that a pixel measures there.
  double pixel(const Vec3& mm) const { return mm_of_pixel_at(space_.mm_per_pixel, space_.viewer_mm, mm.z()); }
  /// Length of a pixel there in the deck's unit, across the line of sight.
  double deck_pixel(const Vec3& deck) const { return pixel(place(deck)) / space_.view.mm_per_unit; }
  const stereo::Box& around() const { return space_.around; }

 private:
  const HandleSpace& space_;
};

HandleVertex vertex(const Vec3& at, const Vec3& outward) {
  const Eigen::Vector3f a = at.cast<float>(), n = outward.cast<float>();
  return {{a.x(), a.y(), a.z()}, {n.x(), n.y(), n.z()}};
}

Vec3 any_across(const Vec3& along) {
  const Vec3 helper = std::abs(along.z()) < 0.9 * along.norm() ? Vec3(Vec3::UnitZ()) : Vec3(Vec3::UnitX());
  return helper.cross(along).normalized();
}

/// A place on the outline of what is turned on a lathe: along the axis, out of it (mm).
struct Outline2 {
  double along, radius;
};

/// One band of a body of revolution about foot + t * axis; `slant`: its normal's share out of the axis and along it.
void add_band(std::vector<HandleVertex>& mesh, const Vec3& foot, const Vec3& axis, const Outline2& lower, const Outline2& upper,
              const Eigen::Vector2d& slant) {
  const Vec3 unit = axis.normalized(), side_a = any_across(axis), side_b = unit.cross(side_a);
  const auto at = [&](const Outline2& point, int side) {
    const double angle = 2 * std::numbers::pi * side / (2 * kSides);
    const Vec3 out = std::cos(angle) * side_a + std::sin(angle) * side_b;
    return vertex(foot + axis * point.along + out * point.radius, out * slant.x() + unit * slant.y());
  };
  for (int side = 0; side < 2 * kSides; ++side) {
    const HandleVertex a = at(lower, side), b = at(lower, side + 1), c = at(upper, side + 1), d = at(upper, side);
    mesh.insert(mesh.end(), {a, b, c, a, c, d});
  }
}

void add_arrow(std::vector<HandleVertex>& mesh, const Vec3& foot, const Vec3& axis, double pixel) {
  const double slope = 0.35;  // of the head's normal along the axis: how it catches light, not its exact geometry
  const double shaft = kShaftRadius * pixel, head = kHeadRadius * pixel;
  add_band(mesh, foot, axis, {0, 0}, {0, shaft}, {0, -1});
  add_band(mesh, foot, axis, {0, shaft}, {kHeadStart, shaft}, {1, 0});
  add_band(mesh, foot, axis, {kHeadStart, shaft}, {kHeadStart, head}, {0, -1});
  add_band(mesh, foot, axis, {kHeadStart, head}, {1, 0.01 * pixel}, {std::sqrt(1 - slope * slope), slope});
}

void add_ring(std::vector<HandleVertex>& mesh, const Vec3& foot, double pixel) {
  const Vec3 from = foot + Vec3(0, 0, kRingBefore * pixel), axis(0, 0, kRingThickness * pixel);
  const double outer = (kHandleRingPixels + kRingHalfWidth) * pixel, inner = (kHandleRingPixels - kRingHalfWidth) * pixel;
  add_band(mesh, from, axis, {0, outer}, {1, outer}, {1, 0});
  add_band(mesh, from, axis, {1, outer}, {1, inner}, {0, 1});
  add_band(mesh, from, axis, {1, inner}, {0, inner}, {-1, 0});
}

void add_ball(std::vector<HandleVertex>& mesh, const Vec3& centre, double radius) {
  const auto at = [&](int ring, int side) {
    const double down = std::numbers::pi * ring / kSides, angle = 2 * std::numbers::pi * side / (2 * kSides);
    const Vec3 out(std::sin(down) * std::cos(angle), std::sin(down) * std::sin(angle), std::cos(down));
    return vertex(centre + radius * out, out);
  };
  for (int ring = 0; ring < kSides; ++ring)
    for (int side = 0; side < 2 * kSides; ++side) {
      const HandleVertex a = at(ring + 1, side), b = at(ring + 1, side + 1), c = at(ring, side + 1), d = at(ring, side);
      mesh.insert(mesh.end(), {a, b, c, a, c, d});
    }
}

/// A tube along places of the screen's space, as thick as `radius` pixels everywhere; its ends are closed by its neighbours.
void add_tube(std::vector<HandleVertex>& mesh, const Workshop& shop, const std::vector<Vec3>& way, double radius) {
  if (way.size() < 2) return;
  Vec3 across = any_across(way[1] - way[0]);
  std::vector<std::array<HandleVertex, kSides>> rings;
  for (std::size_t i = 0; i < way.size(); ++i) {
    const Vec3 along = (way[std::min(i + 1, way.size() - 1)] - way[i > 0 ? i - 1 : 0]).normalized();
    if (!finite(along)) return;
    const Vec3 kept = across - along * across.dot(along);  // carried along the way, so that the tube doesn't twist
    across = kept.norm() > 1e-6 ? Vec3(kept.normalized()) : any_across(along);
    const Vec3 other = along.cross(across);
    std::array<HandleVertex, kSides>& ring = rings.emplace_back();
    for (int side = 0; side < kSides; ++side) {
      const double angle = 2 * std::numbers::pi * side / kSides;
      const Vec3 out = std::cos(angle) * across + std::sin(angle) * other;
      ring[static_cast<std::size_t>(side)] = vertex(way[i] + out * (radius * shop.pixel(way[i])), out);
    }
  }
  for (std::size_t i = 0; i + 1 < rings.size(); ++i)
    for (std::size_t side = 0; side < kSides; ++side) {
      const std::size_t next = (side + 1) % kSides;
      const HandleVertex &a = rings[i][side], &b = rings[i][next], &c = rings[i + 1][next], &d = rings[i + 1][side];
      mesh.insert(mesh.end(), {a, b, c, a, c, d});
    }
}

/// Places on a circle in deck space, as the screen shows it.
struct Circle {
  Vec3 centre = Vec3::Zero();
  Vec3 a = Vec3::UnitX(), b = Vec3::UnitY();  ///< radii, a quarter turn apart

  Vec3 at(double degrees, double stretch = 1) const {
    const double angle = degrees * std::numbers::pi / 180;
    return centre + stretch * (std::cos(angle) * a + std::sin(angle) * b);
  }
  std::vector<Vec3> way(const Workshop& shop, double from, double to) const {
    const int steps = std::max(2, static_cast<int>(std::ceil(std::abs(to - from) / kFullCircle * 2 * kRound)));
    std::vector<Vec3> places;
    for (int i = 0; i <= steps; ++i) places.push_back(shop.place(at(from + (to - from) * i / steps)));
    return places;
  }
};

void add_disk(std::vector<HandlePiece>& pieces, const Handle& handle, const Workshop& shop, bool active) {
  const Vec3 normal = handle.direction.normalized();
  const double pixel = shop.deck_pixel(handle.at);
  Circle rim;
  rim.centre = handle.at + normal * (kDiskLift * pixel);
  rim.a = any_across(normal) * (kHandleDiskPixels * pixel);
  rim.b = normal.cross(rim.a);
  HandlePiece face{{}, active, true, active ? kActiveDiskAlpha : kDiskAlpha};
  const Vec3 centre = shop.place(rim.centre);
  const std::vector<Vec3> places = rim.way(shop, 0, kFullCircle);
  const Vec3 outward = (places[kRound / 2] - centre).cross(places[kRound] - centre).normalized();
  for (std::size_t i = 0; i + 1 < places.size(); ++i)
    for (const Vec3& at : {centre, places[i], places[i + 1]}) face.triangles.push_back(vertex(at, outward));
  pieces.push_back(std::move(face));
  HandlePiece edge{{}, active, false, 1};
  add_tube(edge.triangles, shop, places, kDiskRim);
  pieces.push_back(std::move(edge));
}

/// The line through the model about which it turns.
HandlePiece axis_line(const Handle::Turn& turn, const Vec3& at, const Workshop& shop) {
  const Vec3 axis = turn.axis.normalized();
  double low = (at - turn.point).dot(axis), high = low;
  if (!shop.around().empty())
    for (int corner = 0; corner < 8; ++corner) {
      const stereo::Box& box = shop.around();
      const Vec3 point((corner & 1 ? box.high : box.low).x(), (corner & 2 ? box.high : box.low).y(), (corner & 4 ? box.high : box.low).z());
      low = std::min(low, (point - turn.point).dot(axis));
      high = std::max(high, (point - turn.point).dot(axis));
    }
  const double beyond = kAxisBeyond * shop.deck_pixel(turn.point);
  const Vec3 from = shop.place(turn.point + axis * (low - beyond)), to = shop.place(turn.point + axis * (high + beyond));
  HandlePiece line;
  add_tube(line.triangles, shop, {from, to}, kAxisRadius);
  for (const Vec3& end : {from, to}) add_ball(line.triangles, end, kAxisEnd * shop.pixel(end));
  return line;
}

/// Marks on the arc: fine while it is small; longer ones where it began and at quarters of the circle.
void add_ticks(std::vector<HandleVertex>& mesh, const Circle& circle, double degrees, const Workshop& shop) {
  const int step = std::abs(degrees) > 45 ? 15 : 5;
  for (int tick = 0; tick <= std::abs(degrees); tick += step) {
    const double angle = degrees < 0 ? -tick : tick;
    const Vec3 on = circle.at(angle);
    const double length = (tick % 90 == 0 ? kLongTick : kTick) * shop.deck_pixel(on) / circle.a.norm();
    add_tube(mesh, shop, {shop.place(on), shop.place(circle.at(angle, 1 + length))}, kTickRadius);
  }
}

std::vector<HandlePiece> turn_pieces(const Handle& handle, const Workshop& shop) {
  const Handle::Turn& turn = *handle.turn;
  if (!finite(turn.point) || !finite(turn.axis) || !(turn.axis.norm() > 0) || !std::isfinite(turn.degrees)) return {};
  const bool active = handle.use == Handle::Use::arc;
  std::vector<HandlePiece> pieces{axis_line(turn, handle.at, shop)};
  const Vec3 axis = turn.axis.normalized();
  Circle circle;  // its angles count from where the grab was
  circle.centre = turn.point + axis * (handle.at - turn.point).dot(axis);
  const Vec3 out = handle.at - circle.centre;
  if (!(out.norm() > kHandleBallPixels * shop.deck_pixel(handle.at))) return pieces;  // on the axis: there is nothing to turn
  const double degrees = std::clamp(turn.degrees, -kFullCircle, kFullCircle);
  circle.a = Eigen::AngleAxisd(-turn.degrees * std::numbers::pi / 180, axis) * out;
  circle.b = axis.cross(circle.a);
  HandlePiece faint{{}, false, false, kFaintAlpha};
  add_tube(faint.triangles, shop, circle.way(shop, 0, kFullCircle), kCircleRadius);
  if (degrees != 0)
    for (const double angle : {0.0, degrees})
      add_tube(faint.triangles, shop, {shop.place(circle.centre), shop.place(circle.at(angle))}, kSpokeRadius);
  pieces.push_back(std::move(faint));
  HandlePiece arc{{}, active, false, 1};
  if (degrees != 0) {
    add_tube(arc.triangles, shop, circle.way(shop, 0, degrees), kArcRadius);
    add_ticks(arc.triangles, circle, degrees, shop);
  }
  const Vec3 ball = shop.place(handle.at);
  add_ball(arc.triangles, ball, kHandleBallPixels * shop.pixel(ball));
  pieces.push_back(std::move(arc));
  return pieces;
}

}  // namespace

std::vector<HandlePiece> handle_pieces(const Handle& handle, const HandleSpace& space) {
  if (!finite(handle.at)) return {};
  const Workshop shop(space);
  if (handle.turn) return turn_pieces(handle, shop);
  if (!finite(handle.direction) || !(handle.direction.norm() > 0)) return {};
  using Use = Handle::Use;
  const auto shown = [&](Use part) { return handle.use == Use::idle || handle.use == part; };
  const Vec3 foot = shop.place(handle.at);
  const double pixel = shop.pixel(foot);
  std::vector<HandlePiece> pieces;
  if (shown(Use::disk)) add_disk(pieces, handle, shop, handle.use == Use::disk);
  if (shown(Use::ring)) {
    pieces.push_back({{}, handle.use == Use::ring, false, 1});
    add_ring(pieces.back().triangles, foot, pixel);
  }
  const double length = stereo::kHandleLengthPixels * pixel / space.view.mm_per_unit;
  const Vec3 axis = shop.place(handle.at + handle.direction.normalized() * length) - foot;
  if (shown(Use::arrow) && axis.norm() > 0) {
    pieces.push_back({{}, handle.use == Use::arrow, false, 1});
    add_arrow(pieces.back().triangles, foot, axis, pixel);
  }
  return pieces;
}

}  // namespace prismesh::kiosk::render
