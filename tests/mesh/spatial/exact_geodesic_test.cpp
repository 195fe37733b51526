// The oracle is tried where the answer is known by other means, before it judges anything.
#include "tests/mesh/spatial/exact_geodesic.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <queue>
#include <random>

#include <gtest/gtest.h>

namespace prismesh::test {
namespace {

using Vec3 = Eigen::Vector3d;
using std::numbers::pi;
constexpr double kInfiniteDistance = std::numeric_limits<double>::infinity();

/// (columns + 1) x (rows + 1) points, each square of them two triangles, cut at random along either diagonal.
TriangleSurface grid(int columns, int rows, const std::function<Vec3(int, int)>& place, const std::function<bool(int, int)>& keep = {}) {
  TriangleSurface surface;
  std::mt19937 random(7);
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) surface.point.push_back(place(i, j));
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const auto a = static_cast<std::uint32_t>(i + j * (columns + 1)), b = a + 1;
      const auto d = static_cast<std::uint32_t>(a + static_cast<std::uint32_t>(columns) + 1), c = d + 1;
      if (keep && !keep(i, j)) continue;
      if (random() % 2 == 0)
        surface.triangle.insert(surface.triangle.end(), {{a, b, c}, {a, c, d}});
      else
        surface.triangle.insert(surface.triangle.end(), {{a, b, d}, {b, c, d}});
    }
  return surface;
}

void expect_distances(const TriangleSurface& surface, std::uint32_t source, const std::function<double(const Vec3&)>& truth) {
  const std::vector<double> exact = exact_geodesic(surface, std::vector<std::uint32_t>{source});
  for (std::size_t p = 0; p < exact.size(); ++p)
    ASSERT_NEAR(exact[p], truth(surface.point[p]), 1e-9) << "point " << p << " at " << surface.point[p].transpose();
}

class Jitter {
 public:
  double operator()() { return spread_(random_); }

 private:
  std::mt19937 random_{5};
  std::uniform_real_distribution<double> spread_{-0.35, 0.35};
};

TEST(ExactGeodesic, is_straight_in_a_plane) {
  Jitter jitter;
  const TriangleSurface plane = grid(30, 30, [&](int i, int j) { return Vec3(i + jitter(), j + jitter(), 0); });
  const auto inner = [](const Vec3& p) { return (p - Vec3(15, 15, 0)).lpNorm<Eigen::Infinity>() < 12; };
  const std::uint32_t source = 15 + 15 * 31;
  const std::vector<double> exact = exact_geodesic(plane, std::vector<std::uint32_t>{source});
  for (std::size_t p = 0; p < exact.size(); ++p)
    if (inner(plane.point[p])) {
      EXPECT_NEAR(exact[p], (plane.point[p] - plane.point[source]).norm(), 1e-9);
    }
}

TEST(ExactGeodesic, turns_at_the_end_of_a_wall) {
  // squares are missing between x = 10 and x = 11 below y = 14
  const TriangleSurface walled = grid(
      24, 20, [](int i, int j) { return Vec3(i, j, 0); }, [](int i, int j) { return i != 10 || j >= 14; });
  const Vec3 from(4, 5, 0), near(10, 14, 0), far(11, 14, 0);
  expect_distances(walled, 4 + 5 * 25, [&](const Vec3& p) {
    if (p.x() <= 10) return (p - from).norm();
    const auto height_at = [&](double x) { return from.y() + (p.y() - from.y()) * (x - from.x()) / (p.x() - from.x()); };
    if (height_at(10) >= 14 && height_at(11) >= 14) return (p - from).norm();
    const double over_near = (near - from).norm();
    // past the first corner the second may be in the way too
    const double slope_at_far = near.y() + (p.y() - near.y()) * (11 - near.x()) / (p.x() - near.x());
    return over_near + (slope_at_far >= 14 ? (p - near).norm() : 1 + (p - far).norm());
  });
}

TEST(ExactGeodesic, unrolls_a_prism) {
  // 40 facets of width 1 all round; the points lie on its ridges at any height
  constexpr int kAround = 40;
  Jitter jitter;
  TriangleSurface prism;
  std::vector<std::array<double, 2>> flat;
  const double radius = 0.5 / std::sin(pi / kAround);
  for (int j = 0; j <= 30; ++j)
    for (int i = 0; i < kAround; ++i) {
      const double z = j + (j == 0 || j == 30 ? 0 : jitter());
      prism.point.emplace_back(radius * std::cos(2 * pi * i / kAround), radius * std::sin(2 * pi * i / kAround), z);
      flat.push_back({static_cast<double>(i), z});
    }
  for (std::uint32_t j = 0; j < 30; ++j)
    for (std::uint32_t i = 0; i < kAround; ++i) {
      const std::uint32_t a = i + j * kAround, b = (i + 1) % kAround + j * kAround;
      prism.triangle.push_back({a, b, b + kAround});
      prism.triangle.push_back({a, b + kAround, a + kAround});
    }
  const std::uint32_t source = 3 + 9 * kAround;
  const std::vector<double> exact = exact_geodesic(prism, std::vector<std::uint32_t>{source});
  for (std::size_t p = 0; p < exact.size(); ++p) {
    const double apart = std::abs(flat[p][0] - flat[source][0]);
    EXPECT_NEAR(exact[p], std::hypot(std::min(apart, kAround - apart), flat[p][1] - flat[source][1]), 1e-9);
  }
}

/// A pyramid of facets of one apex angle each, laid around the apex; the truth by the law of cosines, or over the apex.
void expect_on_pyramid(int around, double facet_angle, const std::function<Vec3(int, double)>& place) {
  TriangleSurface pyramid;
  std::vector<std::array<double, 2>> polar{{0, 0}};
  pyramid.point.push_back(Vec3::Zero());
  for (int r = 1; r <= 14; ++r)
    for (int i = 0; i < around; ++i) {
      pyramid.point.push_back(place(i, r));
      polar.push_back({i * facet_angle, static_cast<double>(r)});
    }
  const auto point = [&](int i, int r) { return static_cast<std::uint32_t>(1 + i % around + (r - 1) * around); };
  for (int i = 0; i < around; ++i) pyramid.triangle.push_back({0, point(i, 1), point(i + 1, 1)});
  for (int r = 1; r < 14; ++r)
    for (int i = 0; i < around; ++i) {
      pyramid.triangle.push_back({point(i, r), point(i, r + 1), point(i + 1, r + 1)});
      pyramid.triangle.push_back({point(i, r), point(i + 1, r + 1), point(i + 1, r)});
    }
  const std::uint32_t source = point(2, 9);
  const std::vector<double> exact = exact_geodesic(pyramid, std::vector<std::uint32_t>{source});
  for (std::size_t p = 0; p < exact.size(); ++p) {
    double angle = std::abs(polar[p][0] - polar[source][0]);
    angle = std::min(angle, around * facet_angle - angle);
    const double a = polar[p][1], b = polar[source][1];
    // the rim's sides cut across the sector: only paths that stay inside them count
    if (angle < pi && std::min(a, b) * std::cos(angle / 2) > 14) continue;
    EXPECT_NEAR(exact[p], angle < pi ? std::sqrt(std::max(0.0, a * a + b * b - 2 * a * b * std::cos(angle))) : a + b, 1e-9);
  }
}

TEST(ExactGeodesic, unrolls_a_pyramid) {
  // the ridges leave the apex with half angle 0.5: a facet's apex angle follows from the chord between two of them
  constexpr int kAround = 24;
  const double chord = 2 * std::sin(0.5) * std::sin(pi / kAround);
  expect_on_pyramid(kAround, 2 * std::asin(chord / 2), [](int i, double r) {
    return Vec3(r * std::sin(0.5) * std::cos(2 * pi * i / kAround), r * std::sin(0.5) * std::sin(2 * pi * i / kAround), r * std::cos(0.5));
  });
}

TEST(ExactGeodesic, goes_over_the_middle_of_a_saddle) {
  // ridges at heights that alternate: 12 equal facets of 40 degrees, 480 in all, so that paths between far sides turn at the apex
  constexpr int kAround = 12;
  // cos 40 = cos(30) c^2 - s^2 for the elevation with cosine c and sine s, one up, the next down
  const double c2 = (std::cos(40 * pi / 180) + 1) / (std::cos(pi / 6) + 1);
  const double c = std::sqrt(c2), s = std::sqrt(1 - c2);
  expect_on_pyramid(kAround, 40 * pi / 180, [&](int i, double r) {
    return Vec3(r * c * std::cos(i * pi / 6), r * c * std::sin(i * pi / 6), i % 2 == 0 ? r * s : -r * s);
  });
}

TEST(ExactGeodesic, crosses_the_edges_of_a_cube) {
  constexpr int kSide = 8;
  TriangleSurface cube;
  std::vector<std::array<int, 3>> place;
  const auto point = [&](const std::array<int, 3>& at) {
    const auto found = std::find(place.begin(), place.end(), at);
    if (found != place.end()) return static_cast<std::uint32_t>(found - place.begin());
    place.push_back(at);
    cube.point.emplace_back(at[0], at[1], at[2]);
    return static_cast<std::uint32_t>(place.size() - 1);
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int level : {0, kSide})
      for (int u = 0; u < kSide; ++u)
        for (int v = 0; v < kSide; ++v) {
          const auto at = [&](int du, int dv) {
            std::array<int, 3> p{};
            p[axis] = level;
            p[(axis + 1) % 3] = u + du;
            p[(axis + 2) % 3] = v + dv;
            return point(p);
          };
          const std::uint32_t a = at(0, 0), b = at(1, 0), c = at(1, 1), d = at(0, 1);
          cube.triangle.push_back({a, b, c});
          cube.triangle.push_back({a, c, d});
        }
  const std::uint32_t corner = point({0, 0, 0});
  expect_distances(cube, corner, [&](const Vec3& p) {
    if (p.minCoeff() == 0) return p.norm();
    // on a far side: the nearer of the two sides between
    double shortest = kInfiniteDistance;
    for (int axis = 0; axis < 3; ++axis) {
      if (p[axis] != kSide) continue;
      const double u = p[(axis + 1) % 3], v = p[(axis + 2) % 3];
      shortest = std::min({shortest, std::hypot(kSide + u, v), std::hypot(kSide + v, u)});
    }
    return shortest;
  });
  const std::vector<double> exact = exact_geodesic(cube, std::vector<std::uint32_t>{corner});
  EXPECT_NEAR(exact[point({kSide, kSide, kSide})], kSide * std::sqrt(5.0), 1e-9);
}

/// An upper bound by other means: Dijkstra over points and `steps` more on each edge, straight across each triangle.
std::vector<double> along_added_points(const TriangleSurface& surface, std::uint32_t source, int steps) {
  std::vector<Vec3> place = surface.point;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> first_added;
  std::vector<std::vector<std::uint32_t>> of_triangle;
  for (const auto& t : surface.triangle) {
    std::vector<std::uint32_t> around(t.begin(), t.end());
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = std::min(t[i], t[(i + 1) % 3]), b = std::max(t[i], t[(i + 1) % 3]);
      const auto [added, is_new] = first_added.try_emplace({a, b}, static_cast<std::uint32_t>(place.size()));
      for (int k = 1; k <= steps; ++k) {
        if (is_new) place.push_back(surface.point[a] + (surface.point[b] - surface.point[a]) * k / (steps + 1));
        around.push_back(added->second + static_cast<std::uint32_t>(k) - 1);
      }
    }
    of_triangle.push_back(around);
  }
  std::vector<std::vector<std::uint32_t>> triangles_at(place.size());
  for (std::uint32_t t = 0; t < of_triangle.size(); ++t)
    for (const std::uint32_t p : of_triangle[t]) triangles_at[p].push_back(t);
  std::vector<double> distance(place.size(), kInfiniteDistance);
  std::priority_queue<std::pair<double, std::uint32_t>, std::vector<std::pair<double, std::uint32_t>>, std::greater<>> queue;
  queue.push({distance[source] = 0, source});
  while (!queue.empty()) {
    const auto [d, p] = queue.top();
    queue.pop();
    if (d > distance[p]) continue;
    for (const std::uint32_t t : triangles_at[p])
      for (const std::uint32_t q : of_triangle[t])
        if (const double over = d + (place[q] - place[p]).norm(); over < distance[q]) queue.push({distance[q] = over, q});
  }
  distance.resize(surface.point.size());
  return distance;
}

void expect_just_below_added_points(const TriangleSurface& surface, std::uint32_t source) {
  const std::vector<double> exact = exact_geodesic(surface, std::vector<std::uint32_t>{source});
  const std::vector<double> bound = along_added_points(surface, source, 40);
  for (std::size_t p = 0; p < exact.size(); ++p) {
    EXPECT_LE(exact[p], bound[p] * (1 + 1e-12));
    EXPECT_GE(exact[p], bound[p] * 0.997) << p;  // over 40 points an edge a path is less than 0.3 % longer
  }
}

TEST(ExactGeodesic, is_just_below_a_bound_on_rough_ground) {
  Jitter jitter;
  expect_just_below_added_points(grid(14, 14, [&](int i, int j) { return Vec3(i + jitter(), j + jitter(), 3 * jitter()); }), 7 + 5 * 15);
}

TEST(ExactGeodesic, is_just_below_a_bound_where_sheets_branch) {
  // a rough sheet and a second one that stands on its middle row
  Jitter jitter;
  TriangleSurface surface = grid(12, 12, [&](int i, int j) { return Vec3(i + jitter(), j + jitter(), 2 * jitter()); });
  const auto first = static_cast<std::uint32_t>(surface.point.size());
  for (int k = 1; k <= 6; ++k)
    for (int i = 0; i <= 12; ++i) surface.point.emplace_back(i + jitter(), 6 + jitter(), k + jitter());
  const auto at = [&](std::uint32_t i, std::uint32_t k) { return k == 0 ? i + 6 * 13 : first + i + (k - 1) * 13; };
  for (std::uint32_t k = 0; k < 6; ++k)
    for (std::uint32_t i = 0; i < 12; ++i) {
      surface.triangle.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      surface.triangle.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  for (const std::uint32_t source : {4u + 2 * 13, at(3, 4), at(6, 0)}) expect_just_below_added_points(surface, source);
}

TEST(ExactGeodesic, takes_the_nearest_source_and_ends_at_the_radius) {
  const TriangleSurface plane = grid(20, 20, [](int i, int j) { return Vec3(i, j, 0); });
  const std::vector<std::uint32_t> sources{0, 20 + 20 * 21};
  const std::vector<double> exact = exact_geodesic(plane, sources, 12);
  for (std::size_t p = 0; p < exact.size(); ++p) {
    const double truth = std::min(plane.point[p].norm(), (plane.point[p] - Vec3(20, 20, 0)).norm());
    if (truth > 12)
      EXPECT_EQ(exact[p], kInfiniteDistance);
    else
      EXPECT_NEAR(exact[p], truth, 1e-9);
  }
}

}  // namespace
}  // namespace prismesh::test
