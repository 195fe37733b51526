#include "mesh/deck/lsdyna/transformations.h"

#include <cmath>
#include <utility>

#include "base/letter_case.h"
#include "mesh/deck/lsdyna/card.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

using Eigen::Affine3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Kind = TransformStep::Kind;

constexpr std::size_t kMaxSteps = 1000;  ///< thousands of includes may name one transformation
/// No model reaches farther, and products of such numbers stay finite.
constexpr double kMaxTransformed = 1e60;

Kind kind_of(std::string_view word) {
  constexpr std::pair<std::string_view, Kind> kKinds[] = {
      {"TRANSL", Kind::translate}, {"TRANSL2ND", Kind::translate_along_nodes},
      {"ROTATE", Kind::rotate},    {"ROTATE3NA", Kind::rotate_about_nodes},
      {"SCALE", Kind::scale},      {"MIRROR", Kind::mirror},
      {"POINT", Kind::point},      {"POS6P", Kind::by_points},
      {"POS6N", Kind::by_nodes},   {"MATRIX", Kind::matrix},
  };
  for (const auto& [name, kind] : kKinds)
    if (word == name) return kind;
  return Kind::unknown;
}

/// An id that was read as a real number; -1: it can't be an id.
std::int64_t id_of(double value) { return std::abs(value) < 1e15 ? static_cast<std::int64_t>(value) : -1; }

/// The number of a step's first fields that are node ids.
std::size_t node_fields(Kind kind) {
  return kind == Kind::translate_along_nodes ? 2 : kind == Kind::rotate_about_nodes ? 3 : kind == Kind::by_nodes ? 6 : 0;
}

bool read_numbers(const Card& card, std::size_t first_field, std::size_t count, const Parameters& parameters, double* out) {
  bool readable = true;
  for (std::size_t f = 0; f < count; ++f) {
    const std::optional<double> value = card.real(first_field + f, parameters);
    readable &= value.has_value();
    out[f] = value.value_or(0);
  }
  return readable;
}

/// Axes with the first along a-b and c in the plane of the first two. nullopt: the three points are collinear.
std::optional<Matrix3d> axes_of(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d along = b - a;
  const Vector3d normal = along.cross(c - a);
  if (!(along.norm() > 0) || !(normal.norm() > 1e-12 * along.norm() * (c - a).norm())) return std::nullopt;
  Matrix3d out;
  out.col(0) = along.normalized();
  out.col(2) = normal.normalized();
  out.col(1) = out.col(2).cross(out.col(0));
  return out;
}

Affine3d rotation(const Vector3d& axis, const Vector3d& through, double degrees) {
  // Multiples of a right angle are exact, so that grids stay regular.
  const double turns = degrees / 90;
  Matrix3d linear;
  const double quarter = std::remainder(turns, 4.0);
  if (quarter == std::round(quarter)) {
    const double s = quarter == 1 ? 1 : quarter == -1 ? -1 : 0;
    const double c = quarter == 0 ? 1 : std::abs(quarter) == 2 ? -1 : 0;
    const Vector3d n = axis.normalized();
    Matrix3d cross;
    cross << 0, -n.z(), n.y(), n.z(), 0, -n.x(), -n.y(), n.x(), 0;
    linear = c * Matrix3d::Identity() + s * cross + (1 - c) * n * n.transpose();
  } else {
    linear = Eigen::AngleAxisd(degrees * (M_PI / 180), axis.normalized()).toRotationMatrix();
  }
  return Eigen::Translation3d(through) * linear * Eigen::Translation3d(-through);
}

class Composer {
 public:
  Composer(const Transformation& transformation, const NodePlace& place_of) : transformation_(transformation), place_of_(place_of) {
    for (const TransformStep& step : transformation.steps)
      if (step.kind == Kind::point) points_.try_emplace(id_of(step.a[0]), Vector3d(step.a[1], step.a[2], step.a[3]));
  }

  ComposedTransformation run() {
    ComposedTransformation out;
    for (const TransformStep& step : transformation_.steps) {
      problem_.clear();
      std::optional<Affine3d> map;
      if (step.readable)
        map = one(step);
      else
        problem_ = "has a " + step.word + " whose numbers can't be read";
      if (map && !(((*map) * so_far_).matrix().cwiseAbs().maxCoeff() < kMaxTransformed)) {
        map.reset();
        problem_ = "moves things out of the range of numbers";
      }
      if (map)
        so_far_ = (*map) * so_far_;
      else if (out.problem.empty())
        out.problem = problem_;
    }
    out.map = so_far_;
    return out;
  }

 private:
  std::optional<Affine3d> one(const TransformStep& step) {
    const auto& a = step.a;
    switch (step.kind) {
      case Kind::point: return Affine3d::Identity();
      case Kind::translate: return Affine3d(Eigen::Translation3d(a[0], a[1], a[2]));
      case Kind::translate_along_nodes: return along_nodes(step);
      case Kind::rotate: return rotated(step);
      case Kind::rotate_about_nodes: return about_nodes(step);
      case Kind::scale: return Affine3d(Eigen::Scaling(a[0] == 0 ? 1 : a[0], a[1] == 0 ? 1 : a[1], a[2] == 0 ? 1 : a[2]));
      case Kind::mirror: return mirrored(step);
      case Kind::by_points:
      case Kind::by_nodes: return positioned(step);
      case Kind::matrix: {
        // Row vectors: (x y z 1) times the matrix.
        Affine3d out = Affine3d::Identity();
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 4; ++j) out.matrix()(i, j) = a[static_cast<std::size_t>(4 * j + i)];
        return out;
      }
      case Kind::unknown: break;
    }
    problem_ = "has the option " + (step.word.empty() ? "\"\"" : step.word) + ", which this version doesn't know";
    return std::nullopt;
  }

  std::optional<Vector3d> node(const TransformStep& step, std::size_t field) {
    const auto id = id_of(step.a[field]);
    std::optional<Vector3d> place = place_of_(id, so_far_);
    if (!place) problem_ = "needs node " + std::to_string(id) + " for its " + step.word + ", whose place can't be told";
    return place;
  }

  std::optional<Vector3d> point(const TransformStep& step, std::size_t field) {
    const auto id = id_of(step.a[field]);
    const auto at = points_.find(id);
    if (at != points_.end()) return so_far_ * at->second;
    problem_ = "needs POINT " + std::to_string(id) + " for its " + step.word + ", which it doesn't have";
    return std::nullopt;
  }

  std::nullopt_t pointless(const TransformStep& step) {
    problem_ = "has a " + step.word + " whose points leave no direction";
    return std::nullopt;
  }

  std::optional<Affine3d> along_nodes(const TransformStep& step) {
    const std::optional<Vector3d> first = node(step, 0);
    const std::optional<Vector3d> second = first ? node(step, 1) : std::nullopt;
    if (!second) return std::nullopt;
    const Vector3d way = *second - *first;
    if (step.a[2] == 0) return Affine3d(Eigen::Translation3d(way));
    if (!(way.norm() > 0)) return pointless(step);
    return Affine3d(Eigen::Translation3d(way.normalized() * step.a[2]));
  }

  std::optional<Affine3d> rotated(const TransformStep& step) {
    const auto& a = step.a;
    if (a[3] == 0 && a[4] == 0 && a[5] == 0 && a[6] == 0) {
      // Without a point and an angle the first two fields are POINTs; with neither, nothing is rotated.
      if (a[2] == 0 || (a[0] == 0 && a[1] == 0)) return Affine3d::Identity();
      const std::optional<Vector3d> first = point(step, 0);
      const std::optional<Vector3d> second = first ? point(step, 1) : std::nullopt;
      if (!second) return std::nullopt;
      if (!((*second - *first).norm() > 0)) return pointless(step);
      return rotation(*second - *first, *first, a[2]);
    }
    const Vector3d axis(a[0], a[1], a[2]);
    if (!(axis.norm() > 0)) return pointless(step);
    return rotation(axis, {a[3], a[4], a[5]}, a[6]);
  }

  std::optional<Affine3d> about_nodes(const TransformStep& step) {
    std::array<Vector3d, 3> at;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::optional<Vector3d> place = i == 2 && step.a[2] == 0 ? at[0] : node(step, i);
      if (!place) return std::nullopt;
      at[i] = *place;
    }
    if (!((at[1] - at[0]).norm() > 0)) return pointless(step);
    return rotation(at[1] - at[0], at[2], step.a[3]);
  }

  std::optional<Affine3d> mirrored(const TransformStep& step) {
    const Vector3d in_plane(step.a[0], step.a[1], step.a[2]);
    const Vector3d normal = Vector3d(step.a[3], step.a[4], step.a[5]) - in_plane;
    if (!(normal.norm() > 0)) return pointless(step);
    const Vector3d n = normal.normalized();
    const Matrix3d linear = Matrix3d::Identity() - 2 * n * n.transpose();
    return Eigen::Translation3d(in_plane) * Affine3d(linear) * Eigen::Translation3d(-in_plane);
  }

  std::optional<Affine3d> positioned(const TransformStep& step) {
    std::array<Vector3d, 6> at;
    for (std::size_t i = 0; i < 6; ++i) {
      const std::optional<Vector3d> place = step.kind == Kind::by_points ? point(step, i) : node(step, i);
      if (!place) return std::nullopt;
      at[i] = *place;
    }
    const std::optional<Matrix3d> from = axes_of(at[0], at[1], at[2]);
    const std::optional<Matrix3d> to = axes_of(at[3], at[4], at[5]);
    if (!from || !to) return pointless(step);
    const Matrix3d linear = *to * from->transpose();
    return Eigen::Translation3d(at[3]) * Affine3d(linear) * Eigen::Translation3d(-at[0]);
  }

  const Transformation& transformation_;
  const NodePlace& place_of_;
  std::map<std::int64_t, Vector3d> points_;
  Affine3d so_far_ = Affine3d::Identity();
  std::string problem_;
};

}  // namespace

ComposedTransformation compose(const Transformation& transformation, const NodePlace& place_of) {
  return Composer(transformation, place_of).run();
}

void Transformations::read(std::string_view text, std::uint32_t file, const Block& block, const Parameters& parameters,
                           const IdOffsets& offsets) {
  Lines lines(text, block.begin, block.end);
  Line line;
  Card card;
  if (block.name.size() > 6 && block.name.compare(block.name.size() - 6, 6, "_TITLE") == 0 && !lines.next(line)) return;
  if (!lines.next(line)) return;
  card.cut(line.text, block.columns);
  const std::optional<std::int64_t> id = card.integer(0, parameters);
  if (!id || *id <= 0) return;
  Transformation transformation{file, block.keyword, {}};
  while (lines.next(line)) {
    if (transformation.steps.size() == kMaxSteps) {
      transformation.steps.push_back({.word = "thousand and first card"});
      break;
    }
    card.cut(line.text, block.columns);
    TransformStep step;
    step.word = upper(card.text(0).substr(0, 20));
    if (trim(line.text).empty()) continue;
    step.kind = kind_of(step.word);
    if (step.kind == Kind::matrix) {
      for (std::size_t half = 0; half < 2 && lines.next(line); ++half) {
        card.cut(line.text, block.columns);
        step.readable &= read_numbers(card, 0, 8, parameters, step.a.data() + 8 * half);
      }
    } else {
      step.readable = read_numbers(card, 1, 7, parameters, step.a.data());
    }
    for (double& value : step.a) step.readable &= std::abs(value) < kMaxTransformed;
    for (std::size_t f = 0; f < node_fields(step.kind); ++f) {
      step.readable &= std::abs(step.a[f]) < 1e15;
      if (step.a[f] > 0) step.a[f] += static_cast<double>(offsets.node);
      if (step.readable) nodes_.push_back(id_of(step.a[f]));
    }
    if (step.kind == Kind::point || step.kind == Kind::by_points) step.readable &= std::abs(step.a[0]) < 1e15;
    if (!step.readable) step.a = {};
    transformation.steps.push_back(std::move(step));
  }
  by_id_.try_emplace(*id + offsets.define, std::move(transformation));
}

const Transformation* Transformations::find(std::int64_t id) const {
  const auto at = by_id_.find(id);
  return at == by_id_.end() ? nullptr : &at->second;
}

}  // namespace prismesh::mesh::deck::lsdyna
