#include "mesh/shape/surface_tracer.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>

#include "base/parallel_for.h"
#include "mesh/model/adjacency.h"
#include "mesh/shape/free_edge.h"

namespace prismesh::mesh::shape {

namespace {

constexpr std::size_t kSlideGrain = 128;
constexpr double kSame = 1e-9;                // shares of a face and sines of angles below this count as 0
constexpr double kInPlane = 1e-6;             // sine of the angle below which a line counts as lying in a plane
constexpr std::size_t kMaxShellsAround = 24;  // of a node, for its normal
constexpr int kMaxFaces = 10'000;             // of one path
constexpr int kMaxFacesAtOnePoint = 64;       // without progress: at the tip of a very sharp cone no straight path exists

/// One triangle of a shell. Its side i runs from corner i to the next and lies opposite corner (i + 2) % 3.
struct Face {
  std::array<NodeIndex, 3> node;
  std::array<Vec3, 3> at;
  ShellIndex shell;
  bool second = false;  ///< of a quad: corners 0, 2, 3
};

std::size_t next(std::size_t i) { return i == 2 ? 0 : i + 1; }

Face face_of(const Model& model, ShellIndex index, bool second) {
  const ShellNodes& shell = model.shell(index);
  Face face{{shell.node[0], shell.node[second ? 2 : 1], shell.node[second ? 3 : 2]}, {}, index, second};
  for (std::size_t i = 0; i < 3; ++i) face.at[i] = model.position(face.node[i]);
  return face;
}

Vec3 area_normal(const Face& face) { return (face.at[1] - face.at[0]).cross(face.at[2] - face.at[0]); }

/// The unit vector in the face at right angles to the side that begins at `a` in direction `along`, towards the third corner. Zero where
/// the face has no area.
Vec3 inward(const Vec3& a, const Vec3& along, const Vec3& third) {
  const Vec3 to_third = third - a;
  const Vec3 across = to_third - to_third.dot(along) * along;
  const double height = across.norm();
  return height > kSame * to_third.norm() ? Vec3(across / height) : Vec3::Zero();
}

/// The smallest rotation from one unit vector to another; the identity where they are opposite.
Eigen::Quaterniond turn_between(const Vec3& from, const Vec3& to) {
  const double cosine = from.dot(to);
  if (!(1 + cosine > kSame)) return Eigen::Quaterniond::Identity();
  const Vec3 axis = from.cross(to);
  return Eigen::Quaterniond(1 + cosine, axis.x(), axis.y(), axis.z()).normalized();
}

/// The path of one node.
class SurfacePath {
 public:
  /// `plane`: the normal of a plane that the path stays in; null: none.
  SurfacePath(const Model& model, NodeIndex node, double max_move, const Vec3* plane)
      : model_(model), start_(model.position(node)), here_(start_), max_move_(max_move), plane_(plane) {}

  const Vec3& here() const { return here_; }
  bool stopped() const { return stopped_; }

  /// Follows the faces from a node by the component of a displacement at right angles to the normal there.
  void over_faces(NodeIndex node, const Vec3& normal, const Vec3& by) {
    const Vec3 flat = by - by.dot(normal) * normal;
    left_ = flat.norm();
    if (!(left_ > 0) || !enter_face_at(node, normal, flat / left_)) return;
    int at_one_point = 0;
    for (int faces = 0; faces < kMaxFaces && left_ > 0 && !stopped_; ++faces) {
      const double before = left_;
      if (!cross_face()) return;
      at_one_point = left_ < before ? 0 : at_one_point + 1;
      if (at_one_point > kMaxFacesAtOnePoint) return;
    }
  }

  /// Follows the line of free edges.
  void along_free_edge(NodeIndex node, const Vec3& by) {
    std::array<NodeIndex, 2> both{};
    if (!free_neighbours(node, both)) return;
    const auto towards = [&](NodeIndex other) -> Vec3 { return (model_.position(other) - model_.position(node)).normalized(); };
    const Vec3 line = towards(both[0]) - towards(both[1]);
    const double length = line.norm();
    if (plane_ != nullptr && std::abs(line.dot(*plane_)) > kInPlane * length) return;
    left_ = length > 0 ? by.dot(line) / length : 0;
    NodeIndex to = left_ >= 0 ? both[0] : both[1];
    left_ = std::abs(left_);
    for (int edges = 0; edges < kMaxFaces && left_ > 0 && !stopped_; ++edges) {
      const Vec3 edge = model_.position(to) - here_;
      const double edge_length = edge.norm();
      if (left_ <= edge_length) return go_to(here_ + edge * (left_ / edge_length));
      go_to(model_.position(to));
      left_ -= edge_length;
      const NodeIndex from = node;
      node = to;
      if (stopped_ || !free_neighbours(node, both)) return;
      to = both[0] == from ? both[1] : both[0];
    }
  }

 private:
  /// Goes straight to a point, or to where the distance from the start reaches the limit.
  void go_to(const Vec3& point) {
    if ((point - start_).norm() > max_move_) {
      // |here + s (point - here) - start| = max_move
      const Vec3 step = point - here_;
      const Vec3 gone = here_ - start_;
      const double a = step.squaredNorm();
      const double b = step.dot(gone);
      const double c = gone.squaredNorm() - max_move_ * max_move_;
      const double s = std::clamp((-b + std::sqrt(std::max(0.0, b * b - a * c))) / a, 0.0, 1.0);
      here_ += s * step;
      stopped_ = true;
      return;
    }
    here_ = point;
  }

  /// Finds the face at a node that a direction leads into: the one whose projection into the node's tangent plane contains the direction.
  bool enter_face_at(NodeIndex node, const Vec3& normal, const Vec3& direction) {
    const Vec3 aside = normal.cross(direction);
    double best = 0;  // cosine between the best face's normal and the node's
    const auto consider = [&](ShellIndex shell, bool second) {
      const Face face = face_of(model_, shell, second);
      const auto at = static_cast<std::size_t>(std::find(face.node.begin(), face.node.end(), node) - face.node.begin());
      if (at == 3) return;
      const std::size_t b = next(at), c = next(b);
      const Vec3 side_b = face.at[b] - face.at[at];
      const Vec3 side_c = face.at[c] - face.at[at];
      const Vec3 across = side_b.cross(side_c);
      const double sense = across.dot(normal) < 0 ? -1 : 1;
      const double area = sense * across.dot(normal);
      // in the projection: whether the direction leads into this face
      const double share_b = sense * side_c.dot(aside);
      const double share_c = -sense * side_b.dot(aside);
      const double along_b2 = share_b * share_b * side_b.squaredNorm();
      const double along_c2 = share_c * share_c * side_c.squaredNorm();
      const double same2 = kSame * kSame * area * area;
      if ((share_b < 0 && along_b2 > same2) || (share_c < 0 && along_c2 > same2)) return;
      const double facing = area / across.norm();
      if (!(facing > std::max(kSame, best))) return;
      best = facing;
      // the direction in the face: rotated about the line in which face and tangent plane intersect, which keeps angles at a crease
      const Vec3 in_face = turn_between(normal, across * (sense / across.norm())) * direction;
      const double in_face_b = along_b2 < same2 ? 0 : std::max(0.0, in_face.cross(side_c).dot(across));
      const double in_face_c = along_c2 < same2 ? 0 : std::max(0.0, side_b.cross(in_face).dot(across));
      face_ = face;
      entered_by_ = 3;
      share_ = {0, 0, 0};
      share_[at] = 1;
      direction_ = (in_face_b * side_b + in_face_c * side_c).normalized();
    };
    for (const ShellIndex shell : model_.adjacency->shells_of(node)) {
      consider(shell, false);
      if (!model_.shell(shell).is_triangle()) consider(shell, true);
    }
    if (best > 0) keep_in_plane();
    return best > 0;
  }

  /// Rotates the direction within the face into the plane that the path stays in.
  void keep_in_plane() {
    if (plane_ == nullptr) return;
    const Vec3 cut = area_normal(face_).cross(*plane_);
    const double sense = cut.dot(direction_);
    if (std::abs(sense) > 0) direction_ = cut.normalized() * (sense < 0 ? -1.0 : 1.0);
  }

  /// Goes to the end of the path or over a side of the face. False where the surface ends.
  bool cross_face() {
    const Vec3 normal = area_normal(face_);
    const double area2 = normal.squaredNorm();
    if (!(area2 > 0)) return false;
    // how each corner's barycentric share changes along the path, and which one first becomes 0
    std::array<double, 3> rate{};
    std::size_t leaves = 3;
    double length = left_;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 gradient = normal.cross(face_.at[next(next(i))] - face_.at[next(i)]) / area2;
      rate[i] = gradient.dot(direction_);
      if (rate[i] * rate[i] < kSame * kSame * gradient.squaredNorm()) rate[i] = 0;
      if (rate[i] < 0 && next(i) != entered_by_ && share_[i] < -rate[i] * length) {
        length = share_[i] / -rate[i];
        leaves = i;
      }
    }
    for (std::size_t i = 0; i < 3; ++i) share_[i] = std::max(0.0, share_[i] + length * rate[i]);
    if (leaves != 3) share_[leaves] = 0;
    const double sum = share_[0] + share_[1] + share_[2];
    for (double& share : share_) share /= sum;
    go_to(share_[0] * face_.at[0] + share_[1] * face_.at[1] + share_[2] * face_.at[2]);
    left_ -= length;
    if (leaves == 3) left_ = 0;
    if (stopped_ || !(left_ > 0)) return true;
    const std::size_t a = next(leaves), b = next(a);
    if (share_[a] < kSame) return pass_node(b, normal / std::sqrt(area2));
    if (share_[b] < kSame) return pass_node(a, normal / std::sqrt(area2));
    return cross_side(a, b);
  }

  /// Crosses a side into the face beyond it with the smallest turn.
  bool cross_side(std::size_t a, std::size_t b) {
    const Vec3 along = (face_.at[b] - face_.at[a]).normalized();
    const Vec3 back = inward(face_.at[a], along, face_.at[next(b)]);
    std::optional<Face> beyond;
    Vec3 on = Vec3::Zero();
    std::size_t entered_by = 3;
    const auto consider = [&](ShellIndex shell, bool second) {
      const Face face = face_of(model_, shell, second);
      for (std::size_t i = 0; i < 3; ++i) {
        const bool same_side = (face.node[i] == face_.node[a] && face.node[next(i)] == face_.node[b]) ||
                               (face.node[i] == face_.node[b] && face.node[next(i)] == face_.node[a]);
        if (!same_side) continue;
        const Vec3 into = inward(face_.at[a], along, face.at[next(next(i))]);
        // a duplicate of the shell lies on it, not beyond the side
        if (!(into.squaredNorm() > 0) || into.dot(back) > 1 - 1e-12 || (beyond && into.dot(back) >= on.dot(back))) return;
        beyond = face;
        on = into;
        entered_by = i;
      }
    };
    const ShellNodes& shell = model_.shell(face_.shell);
    if (!shell.is_triangle() && is_diagonal(a, b)) consider(face_.shell, !face_.second);
    // a quad that names a corner twice has one triangle without area, and a side in place of its diagonal
    if (const EdgeIndex edge = model_.adjacency->find_edge(face_.node[a], face_.node[b]); !beyond && edge.valid())
      for (const ShellIndex other : model_.adjacency->shells_of(edge))
        if (other != face_.shell) {
          consider(other, false);
          if (!model_.shell(other).is_triangle()) consider(other, true);
        }
    if (!beyond) return false;
    const double share_b = share_[b];
    const bool same_sense = beyond->node[entered_by] == face_.node[a];
    share_ = {0, 0, 0};
    share_[same_sense ? next(entered_by) : entered_by] = share_b;
    share_[same_sense ? entered_by : next(entered_by)] = 1 - share_b;
    direction_ = (direction_.dot(along) * along - direction_.dot(back) * on).normalized();
    face_ = *beyond;
    entered_by_ = entered_by;
    keep_in_plane();
    return true;
  }

  bool is_diagonal(std::size_t a, std::size_t b) const {
    const std::size_t side = next(a) == b ? a : b;
    return face_.second ? side == 0 : side == 2;
  }

  /// The area-weighted normal of the shells at a node. The current face gives the orientation, which spreads from shell to shell over the
  /// sides at the node.
  Vec3 normal_at(NodeIndex node, const Vec3& face_normal) const {
    const auto shells = model_.adjacency->shells_of(node);
    struct Around {
      Vec3 normal;
      NodeIndex after, before;
      int sense = 0;  ///< 0: not known yet
    };
    std::array<Around, kMaxShellsAround> around;
    const std::size_t count = std::min(shells.size(), around.size());
    for (std::size_t i = 0; i < count; ++i) {
      const ShellNodes& shell = model_.shell(shells[i]);
      const auto corners = static_cast<std::size_t>(shell.corners());
      const auto at =
          static_cast<std::size_t>(std::find(shell.node.begin(), shell.node.begin() + shell.corners(), node) - shell.node.begin());
      Vec3 normal = area_normal(face_of(model_, shells[i], false));
      if (!shell.is_triangle()) normal += area_normal(face_of(model_, shells[i], true));
      around[i] = {normal, shell.node[(at + 1) % corners], shell.node[(at + corners - 1) % corners], 0};
      if (shells[i] == face_.shell) around[i].sense = normal.dot(face_normal) < 0 ? -1 : 1;
    }
    for (bool spread = true; spread;) {
      spread = false;
      for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < count && around[i].sense == 0; ++k) {
          if (around[k].sense == 0) continue;
          if (around[i].after == around[k].before || around[i].before == around[k].after) around[i].sense = around[k].sense;
          if (around[i].after == around[k].after || around[i].before == around[k].before) around[i].sense = -around[k].sense;
          spread = spread || around[i].sense != 0;
        }
    }
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < count; ++i) sum += around[i].sense * around[i].normal;
    return sum;
  }

  /// Continues straight over a node: in its tangent plane, into which all its faces are projected.
  bool pass_node(std::size_t corner, const Vec3& face_normal) {
    const NodeIndex node = face_.node[corner];
    const Vec3 sum = normal_at(node, face_normal);
    const double length = sum.norm();
    std::array<NodeIndex, 2> unused{};
    if (!(length > 0) || free_edges_at(model_, node, unused) > 0) return false;
    const Vec3 normal = sum / length;
    const Vec3 turned = turn_between(face_normal, normal) * direction_;
    const Vec3 flat = turned - turned.dot(normal) * normal;
    return flat.squaredNorm() > 0 && enter_face_at(node, normal, flat.normalized());
  }

  /// Finds the neighbours of a node on its line of free edges. False at corners and forks of the line, and away from it.
  bool free_neighbours(NodeIndex node, std::array<NodeIndex, 2>& both) const {
    return free_edges_at(model_, node, both) == 2 && !is_boundary_corner(model_, node);
  }

  const Model& model_;
  Vec3 start_;
  Vec3 here_;
  double max_move_;
  const Vec3* plane_;
  bool stopped_ = false;
  double left_ = 0;
  Face face_;
  std::array<double, 3> share_{};  ///< barycentric coordinates of the point in the face
  std::size_t entered_by_ = 3;     ///< side of the face; 3: none
  Vec3 direction_ = Vec3::Zero();  ///< of length 1, in the face
};

}  // namespace

SurfaceTracer::SurfaceTracer(const Model& surface, const NodeSet& nodes, std::vector<Vec3> normals)
    : surface_(surface), nodes_(nodes), normals_(std::move(normals)), on_free_edge_(nodes.size(), 0) {
  parallel_for(nodes_.size(), kSlideGrain, [&](std::size_t begin, std::size_t end) {
    std::array<NodeIndex, 2> unused{};
    for (std::size_t i = begin; i < end; ++i) on_free_edge_[i] = free_edges_at(surface_, nodes_[i], unused) > 0 ? 1 : 0;
  });
}

void SurfaceTracer::keep_in_plane(const Vec3& normal, std::vector<std::uint8_t> nodes) {
  plane_ = normal;
  in_plane_ = std::move(nodes);
}

std::size_t SurfaceTracer::positions(std::span<const Vec3> by, std::optional<double> max_move, std::span<Vec3> out) const {
  std::atomic<std::size_t> stopped = 0;
  parallel_for(nodes_.size(), kSlideGrain, [&](std::size_t begin, std::size_t end) {
    std::size_t stopped_here = 0;
    for (std::size_t i = begin; i < end; ++i) {
      SurfacePath path(surface_, nodes_[i], max_move.value_or(std::numeric_limits<double>::infinity()),
                       !in_plane_.empty() && in_plane_[i] != 0 ? &plane_ : nullptr);
      if (on_free_edge_[i] != 0)
        path.along_free_edge(nodes_[i], by[i]);
      else
        path.over_faces(nodes_[i], normals_[i], by[i]);
      out[i] = path.here();
      if (path.stopped()) ++stopped_here;
    }
    stopped += stopped_here;
  });
  return stopped;
}

namespace {

/// Finds the positions of nodes in a set: by a table over the span of their indices where it isn't too long, else by binary search.
class NodePlaces {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  explicit NodePlaces(const NodeSet& nodes) : nodes_(nodes) {
    const std::size_t span = nodes.empty() ? 0 : nodes.back().value - nodes.front().value + std::size_t{1};
    if (span > 256 * nodes.size()) return;
    table_.assign(span, kNone);
    for (std::size_t i = 0; i < nodes.size(); ++i) table_[nodes[i].value - nodes.front().value] = static_cast<std::uint32_t>(i);
  }

  std::uint32_t find(NodeIndex node) const {
    if (nodes_.empty() || node < nodes_.front() || nodes_.back() < node) return kNone;
    if (!table_.empty()) return table_[node.value - nodes_.front().value];
    const auto found = std::lower_bound(nodes_.begin(), nodes_.end(), node);
    return *found == node ? static_cast<std::uint32_t>(found - nodes_.begin()) : kNone;
  }

 private:
  const NodeSet& nodes_;
  std::vector<std::uint32_t> table_;
};

}  // namespace

std::vector<Eigen::Quaterniond> turns_along(const Model& model, const NodeSet& nodes, std::span<const Vec3> normals, NodeIndex from) {
  std::vector<Eigen::Quaterniond> turns(nodes.size(), Eigen::Quaterniond::Identity());
  std::vector<std::uint8_t> reached(nodes.size(), 0);
  std::vector<std::uint32_t> queue;
  const NodePlaces places(nodes);
  const auto reach = [&](NodeIndex node, const std::uint32_t* before) {
    const std::uint32_t at = places.find(node);
    if (at == NodePlaces::kNone || reached[at] != 0) return;
    reached[at] = 1;
    if (before != nullptr) turns[at] = (turn_between(normals[*before], normals[at]) * turns[*before]).normalized();
    queue.push_back(at);
  };
  reach(from, nullptr);
  for (std::size_t next_up = 0; next_up < queue.size(); ++next_up) {
    const std::uint32_t here = queue[next_up];
    for (const ShellIndex shell : model.adjacency->shells_of(nodes[here]))
      for (const NodeIndex corner : model.shell(shell).node) reach(corner, &here);
  }
  return turns;
}

}  // namespace prismesh::mesh::shape
