#include "mesh/lod/simplify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <tuple>
#include <unordered_map>
#include <utility>

#include <Eigen/Geometry>

#include "mesh/spatial/point_triangle.h"

namespace prismesh::mesh::lod {

namespace {

/// Of the normals of a triangle before and after a collapse: below it the triangle would fold over.
constexpr double kLeastTurn = 0.25;
/// Share of the triangles that may be left before nodes are merged by cells.
constexpr double kStuck = 0.85;
constexpr int kCellSizes = 6;
constexpr double kDearer = 1.5;
/// Where the surface is flat, short edges are collapsed first: else long thin triangles come of it, which can't be collapsed further.
constexpr double kShortFirst = 1e-3;

/// Sum of squared distances from planes [Garland 1997].
struct Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  Vec3 b = Vec3::Zero();
  double c = 0;

  void add_plane(const Vec3& n, double d) {
    xx += n.x() * n.x();
    xy += n.x() * n.y();
    xz += n.x() * n.z();
    yy += n.y() * n.y();
    yz += n.y() * n.z();
    zz += n.z() * n.z();
    b += d * n;
    c += d * d;
  }
  void add(const Quadric& q) {
    xx += q.xx;
    xy += q.xy;
    xz += q.xz;
    yy += q.yy;
    yz += q.yz;
    zz += q.zz;
    b += q.b;
    c += q.c;
  }
  double at(const Vec3& p) const {
    const double square = p.x() * (xx * p.x() + 2 * (xy * p.y() + xz * p.z())) + p.y() * (yy * p.y() + 2 * yz * p.z()) + zz * p.z() * p.z();
    return std::max(square + 2 * b.dot(p) + c, 0.0);
  }
};

struct Triangle {
  std::array<std::uint32_t, 3> corner{};
  std::uint32_t part = 0;
  ShellIndex shell;
  bool alive = true;

  bool has(std::uint32_t v) const { return corner[0] == v || corner[1] == v || corner[2] == v; }
};

/// A neighbour of a node, with the triangles at the edge between them.
struct Neighbour {
  std::uint32_t vertex = 0;
  std::uint32_t triangles = 0;
  std::uint32_t part = 0;  ///< of the first
  bool is_border = false;  ///< not two triangles of one part
};

struct Collapse {
  double cost = 0;
  std::uint32_t from = 0, to = 0;
  std::uint32_t other_end = 0;  ///< the border goes on from `from` to this one; `from` itself: inside
  bool operator<(const Collapse& other) const { return std::tie(cost, from) < std::tie(other.cost, other.from); }
};

class Piece {
 public:
  Piece(const Model& model, std::span<const CoarseTriangle> given, const std::function<bool(NodeIndex)>& is_locked) {
    std::unordered_map<std::uint32_t, std::uint32_t> local;
    local.reserve(given.size());
    triangles_.reserve(given.size());
    for (const CoarseTriangle& each : given) {
      Triangle triangle;
      triangle.shell = each.shell;
      triangle.part = model.shell_parts[each.shell.value].value;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [at, is_new] = local.try_emplace(each.node[k].value, static_cast<std::uint32_t>(nodes_.size()));
        if (is_new) {
          nodes_.push_back(each.node[k]);
          locked_.push_back(is_locked(each.node[k]) ? 1 : 0);
        }
        triangle.corner[k] = at->second;
      }
      triangles_.push_back(triangle);
    }
    left_ = triangles_.size();
    // Relative to the first node: far from zero squares would lose their digits.
    for (const NodeIndex node : nodes_) places_.push_back(model.position(node) - model.position(nodes_.front()));
    quadrics_.resize(nodes_.size());
    off_.resize(nodes_.size());
  }

  void collapse_to(std::size_t wanted) {
    find_triangles_at();
    make_quadrics();
    while (left_ > wanted) {
      if (collapse_round(wanted) == 0) return;
      find_triangles_at();
    }
  }

  void merge_cells_to(std::size_t wanted) {
    const double side = mean_side();
    if (!(side > 0)) return;
    double size = side;
    for (int k = 0; k < kCellSizes && left_ > wanted; ++k, size *= 2) merge_cells(size);
  }

  std::size_t left() const { return left_; }

  Simplified result() const {
    Simplified result;
    result.error = error_;
    for (const Triangle& triangle : triangles_)
      if (triangle.alive)
        result.triangles.push_back({{nodes_[triangle.corner[0]], nodes_[triangle.corner[1]], nodes_[triangle.corner[2]]}, triangle.shell});
    return result;
  }

 private:
  std::span<const std::uint32_t> at(std::uint32_t v) const { return std::span(list_).subspan(first_[v], first_[v + 1] - first_[v]); }

  void find_triangles_at() {
    first_.assign(nodes_.size() + 1, 0);
    for (const Triangle& triangle : triangles_)
      if (triangle.alive)
        for (const std::uint32_t v : triangle.corner) ++first_[v + 1];
    for (std::size_t v = 0; v < nodes_.size(); ++v) first_[v + 1] += first_[v];
    list_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      if (triangles_[t].alive)
        for (const std::uint32_t v : triangles_[t].corner) list_[next[v]++] = t;
  }

  Vec3 normal_of(const Triangle& triangle) const {
    return (places_[triangle.corner[1]] - places_[triangle.corner[0]]).cross(places_[triangle.corner[2]] - places_[triangle.corner[0]]);
  }

  const std::vector<Neighbour>& neighbours_of(std::uint32_t v) {
    neighbours_.clear();
    for (const std::uint32_t t : at(v)) {
      const Triangle& triangle = triangles_[t];
      if (!triangle.alive) continue;
      for (const std::uint32_t other : triangle.corner) {
        if (other == v) continue;
        const auto known = std::find_if(neighbours_.begin(), neighbours_.end(), [&](const Neighbour& n) { return n.vertex == other; });
        if (known == neighbours_.end()) {
          neighbours_.push_back({other, 1, triangle.part, false});
        } else {
          ++known->triangles;
          known->is_border = known->is_border || triangle.part != known->part;
        }
      }
    }
    for (Neighbour& each : neighbours_) each.is_border = each.is_border || each.triangles != 2;
    return neighbours_;
  }

  /// Planes of the triangles; at borders planes across them too, which keep their line.
  void make_quadrics() {
    for (const Triangle& triangle : triangles_) {
      const Vec3 normal = normal_of(triangle).normalized();
      if (!normal.allFinite()) continue;
      for (const std::uint32_t v : triangle.corner) quadrics_[v].add_plane(normal, -normal.dot(places_[triangle.corner[0]]));
    }
    for (std::uint32_t v = 0; v < nodes_.size(); ++v)
      for (const Neighbour& each : neighbours_of(v)) {
        if (!each.is_border || each.vertex < v) continue;
        for (const std::uint32_t t : at(v)) {
          if (!triangles_[t].has(each.vertex)) continue;
          const Vec3 across = (places_[each.vertex] - places_[v]).cross(normal_of(triangles_[t])).normalized();
          if (!across.allFinite()) continue;
          quadrics_[v].add_plane(across, -across.dot(places_[v]));
          quadrics_[each.vertex].add_plane(across, -across.dot(places_[v]));
        }
      }
  }

  bool folds(std::uint32_t from, std::uint32_t to) const {
    for (const std::uint32_t t : at(from)) {
      const Triangle& triangle = triangles_[t];
      if (!triangle.alive || triangle.has(to)) continue;
      const Vec3 before = normal_of(triangle);
      Triangle moved = triangle;
      std::replace(moved.corner.begin(), moved.corner.end(), from, to);
      const Vec3 after = normal_of(moved);
      if (!(before.dot(after) > kLeastTurn * before.norm() * after.norm())) return true;
    }
    return false;
  }

  /// Where a collapse would glue triangles onto each other: the ends have more common neighbours than their edge has triangles.
  bool pinches(std::uint32_t from, std::uint32_t to) {
    std::vector<std::uint32_t> about;
    std::uint32_t shared = 0, triangles = 0;
    for (const Neighbour& each : neighbours_of(from)) {
      about.push_back(each.vertex);
      if (each.vertex == to) triangles = each.triangles;
    }
    for (const Neighbour& each : neighbours_of(to)) shared += std::find(about.begin(), about.end(), each.vertex) != about.end() ? 1 : 0;
    return shared != triangles;
  }

  /// The cheapest allowed collapse of the node.
  bool best(std::uint32_t v, Collapse& found) {
    const std::vector<Neighbour>& about = neighbours_of(v);
    std::array<std::uint32_t, 2> along{};
    std::size_t borders = 0;
    for (const Neighbour& each : about)
      if (each.is_border) {
        if (borders < 2) along[borders] = each.vertex;
        ++borders;
      }
    if (about.empty() || borders == 1 || borders > 2) return false;
    found.cost = std::numeric_limits<double>::infinity();
    found.from = v;
    for (const Neighbour& each : about) {
      if (borders == 2 && !each.is_border) continue;
      const double cost = quadrics_[v].at(places_[each.vertex]) + kShortFirst * (places_[each.vertex] - places_[v]).squaredNorm();
      if (!(cost < found.cost) || folds(v, each.vertex)) continue;
      found.cost = cost;
      found.to = each.vertex;
      found.other_end = borders == 0 ? v : along[0] == each.vertex ? along[1] : along[0];
    }
    return std::isfinite(found.cost);
  }

  /// Collapses nodes whose surroundings this round hasn't changed yet. Returns how many.
  std::size_t collapse_round(std::size_t wanted) {
    std::vector<Collapse> collapses;
    Collapse found;
    for (std::uint32_t v = 0; v < nodes_.size(); ++v)
      if (locked_[v] == 0 && !at(v).empty() && best(v, found)) collapses.push_back(found);
    if (collapses.empty()) return 0;
    std::sort(collapses.begin(), collapses.end());
    // Those that would be enough if none got in another's way, and little more: the next round has cheaper ones than the rest.
    const double dearest = kDearer * collapses[std::min((left_ - wanted) / 2, collapses.size() - 1)].cost;
    std::vector<std::uint8_t> touched(nodes_.size());
    std::size_t done = 0;
    for (const Collapse& each : collapses) {
      if (left_ <= wanted || each.cost > dearest) break;
      if (touched[each.from] != 0 || touched[each.to] != 0 || pinches(each.from, each.to)) continue;
      for (const Neighbour& near : neighbours_of(each.from)) touched[near.vertex] = 1;
      touched[each.from] = 1;
      apply(each);
      ++done;
    }
    return done;
  }

  void apply(const Collapse& collapse) {
    const Vec3& gone = places_[collapse.from];
    double nearest2 = std::numeric_limits<double>::infinity();
    for (const std::uint32_t t : at(collapse.from)) {
      Triangle& triangle = triangles_[t];
      if (!triangle.alive) continue;
      if (triangle.has(collapse.to)) {
        triangle.alive = false;
        --left_;
        continue;
      }
      std::replace(triangle.corner.begin(), triangle.corner.end(), collapse.from, collapse.to);
      const std::array<Vec3, 3> corners{places_[triangle.corner[0]], places_[triangle.corner[1]], places_[triangle.corner[2]]};
      nearest2 = std::min(nearest2, spatial::closest_on_triangle(corners, gone).distance2);
    }
    double off = std::isfinite(nearest2) ? std::sqrt(nearest2) : (places_[collapse.to] - gone).norm();
    if (collapse.other_end != collapse.from) {
      const Vec3& a = places_[collapse.to];
      const Vec3& b = places_[collapse.other_end];
      off = std::max(off, std::sqrt(spatial::closest_on_triangle({a, b, b}, gone).distance2));
    }
    quadrics_[collapse.to].add(quadrics_[collapse.from]);
    // One after the other they go to either side: their sum would say far too much.
    off_[collapse.to] = std::max(off_[collapse.to], std::hypot(off_[collapse.from], off));
    error_ = std::max(error_, off_[collapse.to]);
  }

  double mean_side() const {
    double sum = 0;
    std::size_t count = 0;
    for (const Triangle& triangle : triangles_)
      if (triangle.alive)
        for (std::size_t k = 0; k < 3; ++k, ++count) sum += (places_[triangle.corner[k]] - places_[triangle.corner[(k + 1) % 3]]).norm();
    return count > 0 ? sum / static_cast<double>(count) : 0;
  }

  /// The first node of each cell takes the place of the others; a locked one goes first.
  void merge_cells(double size) {
    std::map<std::array<std::int64_t, 3>, std::uint32_t> chosen;
    const auto cell_of = [&](std::uint32_t v) {
      std::array<std::int64_t, 3> cell{};
      for (int k = 0; k < 3; ++k) cell[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(std::floor(places_[v][k] / size));
      return cell;
    };
    find_triangles_at();
    for (const bool locked : {true, false})
      for (std::uint32_t v = 0; v < nodes_.size(); ++v)
        if ((locked_[v] != 0) == locked && !at(v).empty()) chosen.try_emplace(cell_of(v), v);
    std::set<std::pair<std::array<std::uint32_t, 3>, std::uint32_t>> seen;
    double farthest = 0;
    for (Triangle& triangle : triangles_) {
      if (!triangle.alive) continue;
      for (std::uint32_t& v : triangle.corner) {
        if (locked_[v] != 0) continue;
        const std::uint32_t to = chosen.at(cell_of(v));
        farthest = std::max(farthest, off_[v] + (places_[to] - places_[v]).norm());
        v = to;
      }
      std::array<std::uint32_t, 3> sorted = triangle.corner;
      std::sort(sorted.begin(), sorted.end());
      triangle.alive = sorted[0] != sorted[1] && sorted[1] != sorted[2] && seen.emplace(sorted, triangle.part).second;
      if (!triangle.alive) --left_;
    }
    error_ = std::max(error_, farthest);
    std::fill(off_.begin(), off_.end(), error_);
  }

  std::vector<NodeIndex> nodes_;
  std::vector<Vec3> places_;
  std::vector<std::uint8_t> locked_;
  std::vector<Quadric> quadrics_;
  std::vector<double> off_;  ///< how far the removed nodes that a node stands for may be from the surface
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> first_, list_;  ///< triangles at node v: list_[first_[v] .. first_[v+1]); as of the last round
  std::vector<Neighbour> neighbours_;
  std::size_t left_ = 0;
  double error_ = 0;
};

}  // namespace

Simplified simplify(const Model& model, std::span<const CoarseTriangle> triangles, const std::function<bool(NodeIndex)>& is_locked,
                    std::size_t wanted) {
  if (triangles.empty()) return {};
  Piece piece(model, triangles, is_locked);
  piece.collapse_to(wanted);
  const auto stuck = static_cast<std::size_t>(kStuck * static_cast<double>(triangles.size()));
  if (piece.left() > stuck) piece.merge_cells_to(std::max(wanted, stuck * 3 / 4));
  return piece.result();
}

}  // namespace prismesh::mesh::lod
