#include "mesh/contact/shell_crossings.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>

#include "mesh/contact/in_batches.h"
#include "mesh/contact/orientation.h"
#include "mesh/contact/shares_node.h"
#include "mesh/contact/shell_triangles.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::contact {

namespace {

constexpr std::size_t kCrossingGrain = 1024;

bool on_one_side(const Sides& sides) {
  return (sides[0] > 0 && sides[1] > 0 && sides[2] > 0) || (sides[0] < 0 && sides[1] < 0 && sides[2] < 0);
}

/// A side of a triangle: from the node with the lower index, so that the shells at it compute the same bits.
struct TriangleSide {
  NodeIndex low, high;
  CurveSegment at;
};

TriangleSide side_of(const ShellTriangle& t, std::size_t i) {
  std::size_t j = (i + 1) % 3;
  if (t.node[j] < t.node[i]) std::swap(i, j);
  return {t.node[i], t.node[j], {t.at[i], t.at[j]}};
}

/// The third corners of the triangles at a side: of a shell, and of its neighbours over the side.
std::vector<Vec3> corners_about(const Model& model, ShellIndex shell, const TriangleSide& side) {
  std::vector<Vec3> corners;
  const auto add_of = [&](ShellIndex from) {
    each_shell_triangle(model, from, [&](const ShellTriangle& t) {
      for (std::size_t i = 0; i < 3; ++i) {
        const TriangleSide its = side_of(t, i);
        const Vec3& corner = t.at[(i + 2) % 3];
        if (its.low == side.low && its.high == side.high && !on_a_line(side.at.from, side.at.to, corner)) corners.push_back(corner);
      }
    });
  };
  add_of(shell);
  if (const EdgeIndex edge = model.adjacency->find_edge(side.low, side.high); edge.valid())
    for (const ShellIndex neighbour : model.adjacency->shells_of(edge))
      if (neighbour != shell) add_of(neighbour);
  return corners;
}

struct Facing {
  ShellIndex shell;
  const ShellTriangle& triangle;
  Sides sides;  ///< its corners from the other triangle's plane
};

bool side_lies_in(const Sides& sides, std::size_t i) { return sides[i] == 0 && sides[(i + 1) % 3] == 0; }

/// The sides of one triangle along which its sheet passes through the inside of the other.
void add_sides_inside(const Model& model, const Facing& one, const Triangle& other, std::vector<CurveSegment>& segments) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double above = one.sides[(i + 2) % 3];
    if (!side_lies_in(one.sides, i) || above == 0) continue;
    const TriangleSide side = side_of(one.triangle, i);
    const auto inside = inside_part(side.at.from, side.at.to, other);
    if (!inside) continue;
    const std::vector<Vec3> about = corners_about(model, one.shell, side);
    if (std::any_of(about.begin(), about.end(), [&](const Vec3& corner) {
          const double its = orientation(other[0], other[1], other[2], corner);
          return above > 0 ? its < 0 : its > 0;
        }))
      segments.push_back(*inside);
  }
}

/// The parts of lines on which a side of each triangle lies, where the two sheets pass through each other.
void add_shared_sides(const Model& model, const Facing& a, const Facing& b, std::vector<CurveSegment>& segments) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      if (!side_lies_in(a.sides, i) || !side_lies_in(b.sides, j)) continue;
      const TriangleSide side_a = side_of(a.triangle, i), side_b = side_of(b.triangle, j);
      const auto shared = shared_part(side_a.at, side_b.at);
      if (!shared) continue;
      const Vec3& own_a = a.triangle.at[(i + 2) % 3];
      const Vec3& own_b = b.triangle.at[(j + 2) % 3];
      const std::vector<Vec3> about_a = corners_about(model, a.shell, side_a), about_b = corners_about(model, b.shell, side_b);
      if (std::any_of(about_a.begin(), about_a.end(), [&](const Vec3& of_a) {
            return std::any_of(about_b.begin(), about_b.end(), [&](const Vec3& of_b) {
              return alternate(side_a.at.from, side_a.at.to, {own_a, of_a}, {own_b, of_b});
            });
          }))
        segments.push_back(*shared);
    }
}

void add_crossing(const Model& model, ShellIndex a, const ShellTriangle& of_a, ShellIndex b, const ShellTriangle& of_b,
                  std::vector<CurveSegment>& segments) {
  const Sides sides_b = sides_of(of_a.at, of_b.at);
  if (on_one_side(sides_b)) return;
  const Sides sides_a = sides_of(of_b.at, of_a.at);
  if (on_one_side(sides_a)) return;
  if (on_a_line(of_a.at[0], of_a.at[1], of_a.at[2]) || on_a_line(of_b.at[0], of_b.at[1], of_b.at[2])) return;
  if (const auto segment = crossing_of(of_a.at, sides_a, of_b.at, sides_b)) segments.push_back(*segment);
  const Facing facing_a{a, of_a, sides_a}, facing_b{b, of_b, sides_b};
  add_sides_inside(model, facing_a, of_b.at, segments);
  add_sides_inside(model, facing_b, of_a.at, segments);
  add_shared_sides(model, facing_a, facing_b, segments);
}

}  // namespace

std::vector<CurveSegment> crossing_segments(const Model& model, ShellIndex a, ShellIndex b) {
  std::vector<CurveSegment> segments;
  each_shell_triangle(model, a, [&](const ShellTriangle& of_a) {
    each_shell_triangle(model, b, [&](const ShellTriangle& of_b) { add_crossing(model, a, of_a, b, of_b, segments); });
  });
  return segments;
}

std::vector<ShellCrossing> find_shell_crossings(const Model& model, const spatial::BoxTree& tree, const ShellSet* among,
                                                const Progress& progress) {
  const std::size_t count = among != nullptr ? among->size() : model.shell_count();
  std::vector<std::vector<ShellCrossing>> of_range((count + kCrossingGrain - 1) / kCrossingGrain);
  const bool done = in_batches(count, kCrossingGrain, progress, [&](std::size_t begin, std::size_t end) {
    std::vector<ShellCrossing>& found = of_range[begin / kCrossingGrain];
    for (std::size_t s = begin; s < end; ++s) {
      const ShellIndex a = among != nullptr ? (*among)[s] : ShellIndex(s);
      if (!tree.contains(a)) continue;
      const spatial::FloatBox box = tree.box_of(a);
      const Vec3 low(box.low[0], box.low[1], box.low[2]), high(box.high[0], box.high[1], box.high[2]);
      if (!can_decide(low) || !can_decide(high)) continue;
      tree.near_box(low, high, 0, [&](ShellIndex b, const spatial::FloatBox&) {
        if (!(a < b) || share_a_node(model.shell(a), model.shell(b))) return true;
        if (among != nullptr && !std::binary_search(among->begin(), among->end(), b)) return true;
        if (std::vector<CurveSegment> segments = crossing_segments(model, a, b); !segments.empty())
          found.push_back({a, b, std::move(segments)});
        return true;
      });
    }
  });
  if (!done) return {};
  std::vector<ShellCrossing> all;
  for (auto& some : of_range) std::move(some.begin(), some.end(), std::back_inserter(all));
  std::sort(all.begin(), all.end(),
            [](const ShellCrossing& x, const ShellCrossing& y) { return std::pair(x.a, x.b) < std::pair(y.a, y.b); });
  return all;
}

}  // namespace prismesh::mesh::contact
