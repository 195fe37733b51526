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
constexpr double kDiskRim = 1.5, kDiskLift = 5;  ///< lifted off the surface that it touches, which would hide it
constexpr double kAxisRadius = 1.4, kAxisBeyond = 28, kAxisEnd = 5;
constexpr double kCircleRadius = 1.1, kArcRadius = 2.4, kTickRadius = 1.1, kSpokeRadius = 0.8;
constexpr double kTick = 11, kLongTick = 18;
constexpr double kFollowedRadius = 2.2;
constexpr double kMeasureRadius = 1.2, kMeasureBall = 4;
constexpr double kPenRadius = 4, kPenCollar = 6, kPenNodeRadius = 5, kMarkSize = 1.5;
constexpr double kPenConeEnd = 0.17, kPenGripEnd = 0.5;  ///< share of the pen's length
constexpr float kDiskAlpha = 0.42F, kActiveDiskAlpha = 0.6F, kFaintAlpha = 0.9F;
constexpr int kSides = 10, kRound = 48;
constexpr double kFullCircle = 360;

/// Maps deck points to screen millimetres and gives the size of a display pixel there.
class ScreenSpace {
 public:
  explicit ScreenSpace(const HandleSpace& space) : space_(space) {}

  Vec3 point(const Vec3& deck) const { return stereo::to_screen(space_.view, deck); }
  /// Size of a pixel at that depth, mm.
  double pixel(const Vec3& mm) const { return mm_of_pixel_at(space_.mm_per_pixel, space_.viewer_mm, mm.z()); }
  /// Size of a pixel at that point in the deck's unit, parallel to the screen.
  double deck_pixel(const Vec3& deck) const { return pixel(point(deck)) / space_.view.mm_per_unit; }
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

/// The axis foot + t * axis of a body of revolution, mm.
struct RevolutionAxis {
  Vec3 foot, axis;
};
/// A point of its profile: t on the axis, distance from it (mm).
struct ProfilePoint {
  double along, radius;
};
/// One band of the body. `normal`: components away from the axis and along it.
struct Band {
  ProfilePoint lower, upper;
  Eigen::Vector2d normal;
};

void add_band(std::vector<HandleVertex>& mesh, const RevolutionAxis& about, const Band& band) {
  const Vec3 unit = about.axis.normalized(), side_a = any_across(about.axis), side_b = unit.cross(side_a);
  const auto at = [&](const ProfilePoint& point, int side) {
    const double angle = 2 * std::numbers::pi * side / (2 * kSides);
    const Vec3 out = std::cos(angle) * side_a + std::sin(angle) * side_b;
    return vertex(about.foot + about.axis * point.along + out * point.radius, out * band.normal.x() + unit * band.normal.y());
  };
  for (int side = 0; side < 2 * kSides; ++side) {
    const HandleVertex a = at(band.lower, side), b = at(band.lower, side + 1), c = at(band.upper, side + 1), d = at(band.upper, side);
    mesh.insert(mesh.end(), {a, b, c, a, c, d});
  }
}

void add_arrow(std::vector<HandleVertex>& mesh, const Vec3& foot, const Vec3& axis, double pixel) {
  const double slope = 0.35;  // component of the head's normal along the axis: chosen for its shading, not exact
  const double shaft = kShaftRadius * pixel, head = kHeadRadius * pixel;
  const RevolutionAxis about{foot, axis};
  add_band(mesh, about, {{0, 0}, {0, shaft}, {0, -1}});
  add_band(mesh, about, {{0, shaft}, {kHeadStart, shaft}, {1, 0}});
  add_band(mesh, about, {{kHeadStart, shaft}, {kHeadStart, head}, {0, -1}});
  add_band(mesh, about, {{kHeadStart, head}, {1, 0.01 * pixel}, {std::sqrt(1 - slope * slope), slope}});
}

void add_ring(std::vector<HandleVertex>& mesh, const Vec3& foot, double pixel) {
  const RevolutionAxis about{foot + Vec3(0, 0, kRingBefore * pixel), Vec3(0, 0, kRingThickness * pixel)};
  const double outer = (kHandleRingPixels + kRingHalfWidth) * pixel, inner = (kHandleRingPixels - kRingHalfWidth) * pixel;
  add_band(mesh, about, {{0, outer}, {1, outer}, {1, 0}});
  add_band(mesh, about, {{1, outer}, {1, inner}, {0, 1}});
  add_band(mesh, about, {{1, inner}, {0, inner}, {-1, 0}});
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

/// Adds a tube along points of the screen's space (mm), with a radius of `radius` pixels at each depth. Its ends are open: neighbours cover
/// them.
void add_tube(std::vector<HandleVertex>& mesh, const ScreenSpace& screen, const std::vector<Vec3>& path, double radius) {
  if (path.size() < 2) return;
  Vec3 across = any_across(path[1] - path[0]);
  std::vector<std::array<HandleVertex, kSides>> rings;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Vec3 along = (path[std::min(i + 1, path.size() - 1)] - path[i > 0 ? i - 1 : 0]).normalized();
    if (!finite(along)) return;
    const Vec3 kept = across - along * across.dot(along);  // parallel transport, so that the tube doesn't twist
    across = kept.norm() > 1e-6 ? Vec3(kept.normalized()) : any_across(along);
    const Vec3 other = along.cross(across);
    std::array<HandleVertex, kSides>& ring = rings.emplace_back();
    for (int side = 0; side < kSides; ++side) {
      const double angle = 2 * std::numbers::pi * side / kSides;
      const Vec3 out = std::cos(angle) * across + std::sin(angle) * other;
      ring[static_cast<std::size_t>(side)] = vertex(path[i] + out * (radius * screen.pixel(path[i])), out);
    }
  }
  for (std::size_t i = 0; i + 1 < rings.size(); ++i)
    for (std::size_t side = 0; side < kSides; ++side) {
      const std::size_t next = (side + 1) % kSides;
      const HandleVertex &a = rings[i][side], &b = rings[i][next], &c = rings[i + 1][next], &d = rings[i + 1][side];
      mesh.insert(mesh.end(), {a, b, c, a, c, d});
    }
}

/// A circle in deck coordinates.
struct Circle {
  Vec3 centre = Vec3::Zero();
  Vec3 a = Vec3::UnitX(), b = Vec3::UnitY();  ///< radii, a quarter turn apart

  Vec3 at(double degrees, double stretch = 1) const {
    const double angle = degrees * std::numbers::pi / 180;
    return centre + stretch * (std::cos(angle) * a + std::sin(angle) * b);
  }
  /// Points of an arc (degrees), in screen mm.
  std::vector<Vec3> arc(const ScreenSpace& screen, double from, double to) const {
    const int steps = std::max(2, static_cast<int>(std::ceil(std::abs(to - from) / kFullCircle * 2 * kRound)));
    std::vector<Vec3> points;
    for (int i = 0; i <= steps; ++i) points.push_back(screen.point(at(from + (to - from) * i / steps)));
    return points;
  }
};

void add_disk(std::vector<HandlePiece>& pieces, const Handle& handle, const ScreenSpace& screen, bool active) {
  const Vec3 normal = handle.direction.normalized();
  const double pixel = screen.deck_pixel(handle.at);
  Circle rim;
  rim.centre = handle.at + normal * (kDiskLift * pixel);
  rim.a = any_across(normal) * (kHandleDiskPixels * pixel);
  rim.b = normal.cross(rim.a);
  HandlePiece face{{}, active, true, active ? kActiveDiskAlpha : kDiskAlpha};
  const Vec3 centre = screen.point(rim.centre);
  const std::vector<Vec3> points = rim.arc(screen, 0, kFullCircle);
  const Vec3 outward = (points[kRound / 2] - centre).cross(points[kRound] - centre).normalized();
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    for (const Vec3& at : {centre, points[i], points[i + 1]}) face.triangles.push_back(vertex(at, outward));
  pieces.push_back(std::move(face));
  HandlePiece edge{{}, active, false, 1};
  add_tube(edge.triangles, screen, points, kDiskRim);
  pieces.push_back(std::move(edge));
}

/// The axis of rotation as a line through the model.
HandlePiece axis_line(const Handle::Turn& turn, const Vec3& at, const ScreenSpace& screen) {
  const Vec3 axis = turn.axis.normalized();
  double low = (at - turn.point).dot(axis), high = low;
  if (!screen.around().empty())
    for (int corner = 0; corner < 8; ++corner) {
      const stereo::Box& box = screen.around();
      const Vec3 point((corner & 1 ? box.high : box.low).x(), (corner & 2 ? box.high : box.low).y(), (corner & 4 ? box.high : box.low).z());
      low = std::min(low, (point - turn.point).dot(axis));
      high = std::max(high, (point - turn.point).dot(axis));
    }
  const double beyond = kAxisBeyond * screen.deck_pixel(turn.point);
  const Vec3 from = screen.point(turn.point + axis * (low - beyond)), to = screen.point(turn.point + axis * (high + beyond));
  HandlePiece line;
  add_tube(line.triangles, screen, {from, to}, kAxisRadius);
  for (const Vec3& end : {from, to}) add_ball(line.triangles, end, kAxisEnd * screen.pixel(end));
  return line;
}

/// Marks on the arc: every 5 degrees up to 45, else every 15; longer ones at the start and at quarter turns.
void add_ticks(std::vector<HandleVertex>& mesh, const Circle& circle, double degrees, const ScreenSpace& screen) {
  const int step = std::abs(degrees) > 45 ? 15 : 5;
  for (int tick = 0; tick <= std::abs(degrees); tick += step) {
    const double angle = degrees < 0 ? -tick : tick;
    const Vec3 on = circle.at(angle);
    const double length = (tick % 90 == 0 ? kLongTick : kTick) * screen.deck_pixel(on) / circle.a.norm();
    add_tube(mesh, screen, {screen.point(on), screen.point(circle.at(angle, 1 + length))}, kTickRadius);
  }
}

std::vector<HandlePiece> turn_pieces(const Handle& handle, const ScreenSpace& screen) {
  const Handle::Turn& turn = *handle.turn;
  if (!finite(turn.point) || !finite(turn.axis) || !(turn.axis.norm() > 0) || !std::isfinite(turn.degrees)) return {};
  const bool active = handle.use == Handle::Use::arc;
  std::vector<HandlePiece> pieces{axis_line(turn, handle.at, screen)};
  const Vec3 axis = turn.axis.normalized();
  Circle circle;  // angle 0 is at the grabbed point's first position
  circle.centre = turn.point + axis * (handle.at - turn.point).dot(axis);
  const Vec3 out = handle.at - circle.centre;
  if (!(out.norm() > kHandleBallPixels * screen.deck_pixel(handle.at))) return pieces;  // on the axis: no arc
  const double degrees = std::clamp(turn.degrees, -kFullCircle, kFullCircle);
  circle.a = Eigen::AngleAxisd(-turn.degrees * std::numbers::pi / 180, axis) * out;
  circle.b = axis.cross(circle.a);
  HandlePiece faint{{}, false, false, kFaintAlpha};
  add_tube(faint.triangles, screen, circle.arc(screen, 0, kFullCircle), kCircleRadius);
  if (degrees != 0)
    for (const double angle : {0.0, degrees})
      add_tube(faint.triangles, screen, {screen.point(circle.centre), screen.point(circle.at(angle))}, kSpokeRadius);
  pieces.push_back(std::move(faint));
  HandlePiece arc{{}, active, false, 1};
  if (degrees != 0) {
    add_tube(arc.triangles, screen, circle.arc(screen, 0, degrees), kArcRadius);
    add_ticks(arc.triangles, circle, degrees, screen);
  }
  const Vec3 ball = screen.point(handle.at);
  add_ball(arc.triangles, ball, kHandleBallPixels * screen.pixel(ball));
  pieces.push_back(std::move(arc));
  return pieces;
}

}  // namespace

std::vector<HandlePiece> handle_pieces(const Handle& handle, const HandleSpace& space) {
  if (!finite(handle.at)) return {};
  const ScreenSpace screen(space);
  if (handle.turn) return turn_pieces(handle, screen);
  if (!finite(handle.direction) || !(handle.direction.norm() > 0)) return {};
  using Use = Handle::Use;
  const auto shown = [&](Use part) { return handle.use == Use::idle || handle.use == part; };
  const Vec3 foot = screen.point(handle.at);
  const double pixel = screen.pixel(foot);
  std::vector<HandlePiece> pieces;
  if (shown(Use::disk)) add_disk(pieces, handle, screen, handle.use == Use::disk);
  if (shown(Use::ring)) {
    pieces.push_back({{}, handle.use == Use::ring, false, 1});
    add_ring(pieces.back().triangles, foot, pixel);
  }
  const double length = stereo::kHandleLengthPixels * pixel / space.view.mm_per_unit;
  const Vec3 axis = screen.point(handle.at + handle.direction.normalized() * length) - foot;
  if (shown(Use::arrow) && axis.norm() > 0) {
    pieces.push_back({{}, handle.use == Use::arrow, false, 1});
    add_arrow(pieces.back().triangles, foot, axis, pixel);
  }
  return pieces;
}

std::vector<HandlePiece> cut_pieces(const Handle& handle, const HandleSpace& space) {
  if (!finite(handle.at) || !finite(handle.direction) || !(handle.direction.norm() > 0)) return {};
  const ScreenSpace screen(space);
  const bool active = handle.use == Handle::Use::arrow;
  std::vector<HandlePiece> pieces;
  const Vec3 normal = handle.direction.normalized(), u = any_across(normal), v = normal.cross(u);
  if (const stereo::Box& box = screen.around(); !box.empty()) {
    Eigen::Vector2d low(0, 0), high(0, 0);  // the arrow is in it
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 at((corner & 1 ? box.high : box.low).x(), (corner & 2 ? box.high : box.low).y(), (corner & 4 ? box.high : box.low).z());
      const Eigen::Vector2d place((at - handle.at).dot(u), (at - handle.at).dot(v));
      low = low.cwiseMin(place);
      high = high.cwiseMax(place);
    }
    const auto corner = [&](double a, double b) { return screen.point(handle.at + a * u + b * v); };
    const std::array<Vec3, 4> frame{corner(low.x(), low.y()), corner(high.x(), low.y()), corner(high.x(), high.y()),
                                    corner(low.x(), high.y())};
    pieces.push_back({{}, active, false, kFaintAlpha});
    for (std::size_t i = 0; i < frame.size(); ++i)
      if (frame[i] != frame[(i + 1) % frame.size()])
        add_tube(pieces.back().triangles, screen, {frame[i], frame[(i + 1) % frame.size()]}, kCircleRadius);
  }
  const Vec3 foot = screen.point(handle.at);
  const double length = stereo::kHandleLengthPixels * screen.pixel(foot) / space.view.mm_per_unit;
  const Vec3 axis = screen.point(handle.at + normal * length) - foot;
  pieces.push_back({{}, active, false, 1});
  if (axis.norm() > 0) add_arrow(pieces.back().triangles, foot, axis, screen.pixel(foot));
  return pieces;
}

std::vector<HandlePiece> pen_pieces(const Pen& pen, const HandleSpace& space) {
  if (!finite(pen.tip) || !finite(pen.shaft) || !(pen.shaft.norm() > 0)) return {};
  const ScreenSpace screen(space);
  std::vector<HandlePiece> pieces;
  if (!pen.shell.empty()) pieces.push_back(followed_edges_piece(pen.shell, space));
  if (pen.node && finite(*pen.node)) {
    const Vec3 node = screen.point(*pen.node);
    pieces.push_back({{}, true, false, 1});
    add_ball(pieces.back().triangles, node, kPenNodeRadius * screen.pixel(node));
  }
  const Vec3 tip = screen.point(pen.tip);
  const double pixel = screen.pixel(tip), length = kPenLengthPixels * pixel / space.view.mm_per_unit;
  const RevolutionAxis about{tip, screen.point(pen.tip + pen.shaft.normalized() * length) - tip};
  if (!(about.axis.norm() > 0)) return {};
  const double radius = kPenRadius * pixel, collar = kPenCollar * pixel, slope = -0.3;  // of the cone's normal along the axis
  HandlePiece cone{{}, pen.busy, false, 1}, shaft{{}, false, false, 1};
  add_band(cone.triangles, about, {{0, 0.01 * pixel}, {kPenConeEnd, radius}, {std::sqrt(1 - slope * slope), slope}});
  add_band(shaft.triangles, about, {{kPenConeEnd, radius}, {kPenConeEnd, collar}, {0, -1}});
  add_band(shaft.triangles, about, {{kPenConeEnd, collar}, {kPenGripEnd, collar}, {1, 0}});
  add_band(shaft.triangles, about, {{kPenGripEnd, collar}, {kPenGripEnd, radius}, {0, 1}});
  add_band(shaft.triangles, about, {{kPenGripEnd, radius}, {1, radius}, {1, 0}});
  add_ball(shaft.triangles, tip + about.axis, radius);
  pieces.push_back(std::move(cone));
  pieces.push_back(std::move(shaft));
  return pieces;
}

std::vector<HandlePiece> mark_pieces(const Vec3& point, const HandleSpace& space) {
  if (!finite(point)) return {};
  const ScreenSpace screen(space);
  const Vec3 at = screen.point(point);
  const double pixel = screen.pixel(at);
  std::vector<HandlePiece> pieces{{{}, true, false, 1}};
  add_ball(pieces.back().triangles, at, kPenNodeRadius * pixel);
  add_ring(pieces.back().triangles, at, kMarkSize * pixel);
  return pieces;
}

HandlePiece measures_piece(const std::vector<std::vector<Vec3>>& ways, const HandleSpace& space) {
  const ScreenSpace screen(space);
  HandlePiece piece;
  for (const std::vector<Vec3>& way : ways) {
    std::vector<Vec3> points;
    for (const Vec3& at : way)
      if (finite(at)) points.push_back(screen.point(at));
    for (const Vec3& at : points) add_ball(piece.triangles, at, kMeasureBall * screen.pixel(at));
    // Each piece by itself: a tube round a corner would be bent.
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
      if (points[i] != points[i + 1]) add_tube(piece.triangles, screen, {points[i], points[i + 1]}, kMeasureRadius);
  }
  return piece;
}

namespace {

HandlePiece tubes(const std::vector<std::array<Vec3, 2>>& edges, const HandleSpace& space, bool active) {
  const ScreenSpace screen(space);
  HandlePiece piece{{}, active, false, 1};
  for (const auto& [from, to] : edges)
    if (finite(from) && finite(to) && from != to)
      add_tube(piece.triangles, screen, {screen.point(from), screen.point(to)}, kFollowedRadius);
  return piece;
}

}  // namespace

HandlePiece followed_edges_piece(const std::vector<std::array<Vec3, 2>>& edges, const HandleSpace& space) {
  return tubes(edges, space, true);
}

HandlePiece halfway_piece(const std::vector<std::array<Vec3, 2>>& pieces, const HandleSpace& space) { return tubes(pieces, space, false); }

}  // namespace prismesh::kiosk::render
