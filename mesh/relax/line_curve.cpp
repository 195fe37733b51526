#include "mesh/relax/line_curve.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace prismesh::mesh::relax {

namespace {

constexpr int kMaxPieces = 64;  ///< that a walk passes
constexpr double kAtEnd = 1e-9;

/// The other end of the line's next edge after `at`, coming from `from`; invalid at a corner.
NodeIndex next_on_line(const LineCache& lines, NodeIndex at, NodeIndex from) {
  const auto& [ends, pass_through] = lines.at(at);
  if (!pass_through) return {};
  return ends.other[0] == from ? ends.other[1] : ends.other[1] == from ? ends.other[0] : NodeIndex();
}

/// Unit tangent at `b` of the circle through a, b, c, from a to c.
Vec3 circle_tangent(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 in = b - a, out = c - b;
  // These weights make it exact on circles, whatever the spacing.
  return (in / in.squaredNorm() + out / out.squaredNorm()).normalized();
}

/// Mirrors the other end's tangent at the chord, for an end without a neighbour: the piece becomes an arc.
Vec3 mirrored(const Vec3& tangent, const Vec3& chord) { return 2 * tangent.dot(chord) * chord - tangent; }

struct Curve {
  Vec3 a, b, at_a, at_b;  ///< ends and the derivatives there

  Vec3 point(double t) const {
    const double s = 1 - t;
    return s * s * (1 + 2 * t) * a + t * t * (3 - 2 * t) * b + t * s * s * at_a - t * t * s * at_b;
  }
  Vec3 derivative(double t) const { return 6 * t * (1 - t) * (b - a) + (1 - t) * (1 - 3 * t) * at_a + t * (3 * t - 2) * at_b; }
};

Curve curve_of(const LineCache& lines, LinePiece piece) {
  const Model& model = lines.model();
  const Vec3& a = model.position(piece.from);
  const Vec3& b = model.position(piece.to);
  const double length = (b - a).norm();
  const Vec3 chord = (b - a) / length;
  const NodeIndex before = next_on_line(lines, piece.from, piece.to);
  const NodeIndex after = next_on_line(lines, piece.to, piece.from);
  Vec3 first = before.valid() ? circle_tangent(model.position(before), a, b) : Vec3::Zero();
  Vec3 last = after.valid() ? circle_tangent(a, b, model.position(after)) : Vec3::Zero();
  if (!before.valid()) first = after.valid() ? mirrored(last, chord) : chord;
  if (!after.valid()) last = before.valid() ? mirrored(first, chord) : chord;
  // The length of the derivatives makes an arc of a circle exact to the sixth order.
  const auto derivative = [&](const Vec3& tangent) { return Vec3(tangent * (2 * length / (1 + std::max(tangent.dot(chord), 0.0)))); };
  return {a, b, derivative(first), derivative(last)};
}

}  // namespace

CurvePoint closest_on_piece(const LineCache& lines, LinePiece piece, const Vec3& point) {
  const Model& model = lines.model();
  const Vec3 chord = model.position(piece.to) - model.position(piece.from);
  const double length2 = chord.squaredNorm();
  CurvePoint place{piece, model.position(piece.from), Vec3::Zero(), 0};
  if (length2 > 0) {
    const Curve curve = curve_of(lines, piece);
    double t = std::clamp((point - curve.a).dot(chord) / length2, 0.0, 1.0);
    for (int i = 0; i < 4; ++i) {
      const Vec3 along = curve.derivative(t);
      const double step = (point - curve.point(t)).dot(along) / along.squaredNorm();
      if (!std::isfinite(step)) break;
      t = std::clamp(t + step, 0.0, 1.0);
    }
    place.point = t < kAtEnd ? curve.a : t > 1 - kAtEnd ? curve.b : curve.point(t);
    place.tangent = curve.derivative(t).normalized();
  }
  place.distance = (point - place.point).norm();
  return place;
}

CurvePoint follow_line(const LineCache& lines, LinePiece piece, const Vec3& point) {
  const Model& model = lines.model();
  CurvePoint best = closest_on_piece(lines, piece, point);
  for (int i = 0; i < kMaxPieces; ++i) {
    const bool at_from = best.point == model.position(best.piece.from);
    const bool at_to = best.point == model.position(best.piece.to);
    if (!at_from && !at_to) break;
    const NodeIndex turn = at_from ? best.piece.from : best.piece.to;
    const NodeIndex next = next_on_line(lines, turn, at_from ? best.piece.to : best.piece.from);
    if (!next.valid()) break;
    const CurvePoint beyond = closest_on_piece(lines, at_from ? LinePiece{next, turn} : LinePiece{turn, next}, point);
    if (!(beyond.distance < best.distance)) break;
    best = beyond;
  }
  return best;
}

}  // namespace prismesh::mesh::relax
