// The proxy on analytic shapes: where it rests, how it slides, and that nothing passes.
#include "drivers/haptics/proxy.h"

#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/drivers/haptics/field_rig.h"
#include "tests/support/seed.h"

namespace prismesh::drivers::haptics {
namespace {

using test::FieldShape;
using test::Triangle;
using test::Triangles;

std::unique_ptr<HapticField> field_of(const Triangles& triangles, const FieldShape& shape = {}) {
  return test::make_field([&](const Eigen::Vector3d& at) { return test::distance_to(triangles, at); }, shape);
}

/// Moves a pen in short ticks and returns the last contact.
ProxyContact move_pen(Proxy& proxy, const HapticField& field, Eigen::Vector3d from, const Eigen::Vector3d& to, double friction = 0) {
  const int ticks = static_cast<int>((to - from).norm() / 0.5) + 20;
  ProxyContact contact;
  for (int i = 0; i <= ticks; ++i) contact = proxy.step(&field, from + (to - from) * std::min(1.0, i / (ticks - 10.0)), friction);
  return contact;
}

TEST(field_sample, is_the_distance_within_its_proved_bound) {
  const Triangles shape = test::hole_shape();
  const auto field = field_of(shape, {.centre_mm = {1, 2, 0.3}, .fine_count = 30});
  std::mt19937 random(test::seed(2));
  std::uniform_real_distribution<double> within(-30, 30);
  int fine = 0;
  for (int i = 0; i < 20'000; ++i) {
    Eigen::Vector3d at(within(random), within(random), within(random));
    if (i % 2 == 0) at *= 0.12;
    const FieldSample here = sample(*field, at);
    ASSERT_TRUE(here.known);
    const double exact = test::distance_to(shape, at);
    ASSERT_LE(here.proved_mm, exact);
    ASSERT_LE(std::abs(here.distance_mm - exact), 0.8661 * here.spacing_mm + 1e-4);
    fine += here.spacing_mm < 1;
    const double h = 1e-4;
    const FieldSample next = sample(*field, at + h * Eigen::Vector3d::UnitY());
    if (next.known && next.spacing_mm == here.spacing_mm && i % 10 == 0) {
      ASSERT_NEAR((next.distance_mm - here.distance_mm) / h, here.gradient.y(), 0.05);
    }
  }
  EXPECT_GT(fine, 5000);
  EXPECT_FALSE(sample(*field, {100, 0, 0}).known);
  EXPECT_FALSE(sample(*field, Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())).known);
}

TEST(field_sample, refuses_headers_and_distances_that_cannot_be) {
  const auto good = field_of(test::plane_shape(), {.fine_count = 8, .coarse_count = 8});
  ASSERT_TRUE(usable(*good));
  const auto broken = [&](auto&& change) {
    auto field = std::make_unique<HapticField>(*good);
    change(*field);
    return !usable(*field);
  };
  EXPECT_TRUE(broken([](HapticField& f) { f.number = 0; }));
  EXPECT_TRUE(broken([](HapticField& f) { f.mesh_generation = 0; }));
  EXPECT_TRUE(broken([](HapticField& f) { f.fine.count[1] = 65; }));
  EXPECT_TRUE(broken([](HapticField& f) { f.coarse.count[2] = 1; }));
  EXPECT_TRUE(broken([](HapticField& f) { f.fine.spacing_mm = 0; }));
  EXPECT_TRUE(broken([](HapticField& f) { f.fine.spacing_mm = std::numeric_limits<double>::quiet_NaN(); }));
  EXPECT_TRUE(broken([](HapticField& f) { f.coarse.origin_mm[0] = std::numeric_limits<double>::infinity(); }));
  EXPECT_TRUE(broken([](HapticField& f) { f.moved_count = kMaxMovedTriangles + 1; }));
  EXPECT_TRUE(broken([](HapticField& f) { f.max_moved_mm = -1; }));
  for (const float bad : {-1.0F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    auto field = std::make_unique<HapticField>(*good);
    std::fill(std::begin(field->fine.distance_mm), std::end(field->fine.distance_mm), bad);
    EXPECT_FALSE(sample(*field, {0, 0, 0.1}).known);
  }
}

TEST(proxy, is_the_pen_in_free_space) {
  const auto field = field_of(test::plane_shape());
  Proxy proxy;
  const ProxyContact contact = move_pen(proxy, *field, {0, 0, 5}, {3, -2, 1});
  EXPECT_TRUE(contact.attached);
  EXPECT_FALSE(contact.touching);
  EXPECT_NEAR((contact.proxy_mm - Eigen::Vector3d(3, -2, 1)).norm(), 0, 1e-12);
}

TEST(proxy, rests_on_a_plane_above_the_pen_on_the_side_from_which_it_came) {
  const auto field = field_of(test::plane_shape());
  for (const double side : {1.0, -1.0}) {
    Proxy proxy;
    const ProxyContact contact = move_pen(proxy, *field, {0, 0, 5 * side}, {2, 1, -3 * side});
    EXPECT_TRUE(contact.touching);
    EXPECT_NEAR(contact.proxy_mm.z() * side, 1.5 * 0.3175, 0.02 * 0.3175);
    EXPECT_NEAR(contact.proxy_mm.x(), 2, 1e-3);
    EXPECT_NEAR(contact.proxy_mm.y(), 1, 1e-3);
    EXPECT_NEAR(contact.normal.z() * side, 1, 1e-6);
    EXPECT_EQ(contact.element, 7);
  }
}

TEST(proxy, friction_holds_it_within_the_cone) {
  const auto field = field_of(test::plane_shape());
  Proxy proxy;
  move_pen(proxy, *field, {0, 0, 5}, {0, 0, -2}, 0.5);
  const double depth = 2 + 1.51 * 0.3175;
  ProxyContact contact = move_pen(proxy, *field, {0, 0, -2}, {0.45 * depth, 0, -2}, 0.5);
  EXPECT_NEAR(contact.proxy_mm.x(), 0, 1e-3) << "it sticks";
  contact = move_pen(proxy, *field, {0.45 * depth, 0, -2}, {3, 0, -2}, 0.5);
  EXPECT_NEAR(contact.proxy_mm.x(), 3 - 0.5 * depth, 0.01) << "and is dragged along at the cone's edge";
}

TEST(proxy, slides_off_a_free_edge_and_is_free) {
  const auto field = field_of(test::edge_shape());
  Proxy proxy;
  EXPECT_TRUE(move_pen(proxy, *field, {-3, 0, 4}, {-3, 0, -2}).touching);
  const ProxyContact contact = move_pen(proxy, *field, {-3, 0, -2}, {2, 0, -2});
  EXPECT_FALSE(contact.touching);
  EXPECT_NEAR((contact.proxy_mm - Eigen::Vector3d(2, 0, -2)).norm(), 0, 1e-9);
}

TEST(proxy, goes_through_a_hole_that_is_wide_enough_and_not_through_a_narrow_one) {
  const auto field = field_of(test::hole_shape());
  Proxy through;
  EXPECT_FALSE(move_pen(through, *field, {0, 0, 5}, {0, 0, -5}).touching);
  // The same hole of 3 mm radius with a contact distance of 3.75 mm.
  const auto wide = field_of(test::hole_shape(), {.fine_mm = 2.5, .fine_count = 20, .coarse_mm = 2.5, .coarse_count = 40});
  Proxy stopped;
  const ProxyContact contact = move_pen(stopped, *wide, {0, 0, 15}, {0, 0, -5});
  EXPECT_TRUE(contact.touching);
  EXPECT_GT(contact.proxy_mm.z(), 0);
}

TEST(proxy, comes_to_rest_in_the_corner_of_a_box_and_slides_along_its_creases) {
  const auto field = field_of(test::corner_shape());
  Proxy proxy;
  const double rest = 1.5 * 0.3175;
  ProxyContact contact = move_pen(proxy, *field, {5, 5, 5}, {-2, -2, -2});
  EXPECT_NEAR((contact.proxy_mm - Eigen::Vector3d::Constant(rest)).norm(), 0, 0.3);
  contact = move_pen(proxy, *field, {-2, -2, -2}, {4, -2, -2});
  EXPECT_NEAR(contact.proxy_mm.x(), 4, 0.1);
  EXPECT_NEAR(contact.proxy_mm.y(), rest, 0.2);
  EXPECT_NEAR(contact.proxy_mm.z(), rest, 0.2);
}

TEST(proxy, rests_still_under_a_still_pen) {
  const auto field = field_of(test::junction_shape());
  Proxy proxy;
  const ProxyContact first = move_pen(proxy, *field, {3, 0, 4}, {-1, 0.5, -2});
  for (int i = 0; i < 100; ++i) {
    const ProxyContact again = proxy.step(field.get(), {-1, 0.5, -2}, 0);
    ASSERT_LT((again.proxy_mm - first.proxy_mm).norm(), 0.02);
  }
}

TEST(proxy, begins_only_in_free_space) {
  const auto field = field_of(test::plane_shape());
  Proxy proxy;
  EXPECT_FALSE(proxy.step(field.get(), {0, 0, 0.3}, 0).attached);
  EXPECT_TRUE(proxy.step(field.get(), {0, 0, 0.6}, 0).attached);
}

TEST(proxy, lets_go_where_nothing_is_known_and_does_not_catch_hold_at_once) {
  const auto field = field_of(test::plane_shape(), {.fine_count = 32, .coarse_count = 20});
  const auto expect_let_go = [&](const HapticField* other, const Eigen::Vector3d& pen) {
    Proxy proxy;
    ASSERT_TRUE(move_pen(proxy, *field, {0, 0, 4}, {0, 0, -2}).touching);
    const ProxyContact contact = proxy.step(other, pen, 0);
    EXPECT_TRUE(contact.let_go);
    EXPECT_FALSE(contact.attached);
    EXPECT_FALSE(proxy.step(field.get(), {0, 0, -0.2}, 0).attached);
  };
  expect_let_go(nullptr, {0, 0, -2});
  expect_let_go(field.get(), {0, 0, -40});
  expect_let_go(field.get(), Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  auto other = std::make_unique<HapticField>(*field);
  other->placement = 2;
  expect_let_go(other.get(), {0, 0, -2});
  // Shells moved, and a generation was missed.
  other = std::make_unique<HapticField>(*field);
  other->number = 3;
  other->mesh_generation = 3;
  other->before_generation = 2;
  expect_let_go(other.get(), {0, 0, -2});
  // Distances that are none.
  other = std::make_unique<HapticField>(*field);
  other->number = 2;
  std::fill(std::begin(other->fine.distance_mm), std::end(other->fine.distance_mm), std::numeric_limits<float>::quiet_NaN());
  expect_let_go(other.get(), {0, 0, -2});
}

/// A hand at random about the origin: long pushes, quick turns, stops.
class RandomPen {
 public:
  explicit RandomPen(unsigned seed, double range_mm) : random_(seed), range_mm_(range_mm) {}
  Eigen::Vector3d next() {
    if (below(40) == 0) goal_ = random_vector(range_mm_);
    if (below(400) == 0) speed_ = below(2) == 0 ? 1.4 : 0.2;
    const Eigen::Vector3d way = goal_ - place_;
    if (way.norm() > 1e-9) place_ += way.normalized() * std::min(speed_, way.norm());
    return place_ + random_vector(0.02);
  }
  unsigned below(unsigned count) { return static_cast<unsigned>(random_() % count); }
  Eigen::Vector3d random_vector(double length) {
    std::uniform_real_distribution<double> within(-length, length);
    return {within(random_), within(random_), within(random_)};
  }

 private:
  std::mt19937 random_;
  double range_mm_;
  Eigen::Vector3d place_ = Eigen::Vector3d::Zero(), goal_ = Eigen::Vector3d::Zero();
  double speed_ = 0.5;
};

struct PassFigures {
  int touching = 0, let_go = 0, both_sides = 0;
};

/// 100,000 steps; every segment of the proxy's way is tested. Bricks change at random: other origins, spacings and sizes.
PassFigures pass_nothing(const test::Distance& distance, const std::function<bool(const Eigen::Vector3d&, const Eigen::Vector3d&)>& hits,
                         unsigned seed) {
  std::array<std::unique_ptr<HapticField>, 3> fields = {
      test::make_field(distance, {.fine_mm = 0.4, .fine_count = 44, .coarse_mm = 1.5, .coarse_count = 24}),
      test::make_field(distance,
                       {.centre_mm = {0.13, -0.21, 0.07}, .fine_mm = 0.25, .fine_count = 32, .coarse_mm = 1.1, .coarse_count = 32}),
      test::make_field(distance, {.centre_mm = {3, 2, -1}, .fine_mm = 0.6, .fine_count = 16, .coarse_mm = 2, .coarse_count = 20})};
  for (std::size_t i = 0; i < fields.size(); ++i) fields[i]->number = i + 1;
  RandomPen pen(seed, 8);
  Proxy proxy;
  ProxyPath path;
  PassFigures figures;
  std::size_t chosen = 0;
  for (int i = 0; i < 100'000; ++i) {
    if (pen.below(20) == 0) chosen = pen.below(3);
    const double friction = i % 1000 < 500 ? 0 : 0.3;
    const Eigen::Vector3d at = pen.next();
    const ProxyContact contact = proxy.step(fields[chosen].get(), at, friction, &path);
    figures.touching += contact.touching;
    figures.let_go += contact.let_go;
    figures.both_sides += contact.attached && hits(contact.proxy_mm, at);
    for (std::size_t s = 1; s < path.count; ++s) {
      if (hits(path.places_mm[s - 1], path.places_mm[s])) {
        ADD_FAILURE() << "the proxy passes at step " << i << ", from " << path.places_mm[s - 1].transpose() << " to "
                      << path.places_mm[s].transpose();
        return figures;
      }
    }
  }
  return figures;
}

void pass_no_triangle(const Triangles& triangles, unsigned seed) {
  const PassFigures figures =
      pass_nothing([&](const Eigen::Vector3d& at) { return test::distance_to(triangles, at); },
                   [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return test::meets(triangles, a, b); }, test::seed(seed));
  EXPECT_GT(figures.touching, 10'000);
  EXPECT_GT(figures.both_sides, 5'000) << "the pen was often behind a shell";
  EXPECT_EQ(figures.let_go, 0);
}

TEST(ProxyLong, passes_no_plane) { pass_no_triangle(test::plane_shape(), 10); }
TEST(ProxyLong, passes_no_free_edge) { pass_no_triangle(test::edge_shape(), 11); }
TEST(ProxyLong, passes_no_corner_of_a_box) { pass_no_triangle(test::corner_shape(), 12); }
TEST(ProxyLong, passes_nothing_about_a_hole) { pass_no_triangle(test::hole_shape(), 13); }
TEST(ProxyLong, passes_no_junction) { pass_no_triangle(test::junction_shape(), 14); }
TEST(ProxyLong, passes_no_sphere) {
  const double radius = 5;
  const auto inside = [&](const Eigen::Vector3d& at) { return at.norm() < radius; };
  const PassFigures figures = pass_nothing([&](const Eigen::Vector3d& at) { return std::abs(at.norm() - radius); },
                                           [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
                                             if (inside(a) != inside(b)) return true;
                                             if (inside(a)) return false;
                                             const Eigen::Vector3d way = b - a;
                                             const double t = std::clamp(-a.dot(way) / std::max(way.squaredNorm(), 1e-30), 0.0, 1.0);
                                             return inside(a + t * way);
                                           },
                                           test::seed(15));
  EXPECT_GT(figures.touching, 10'000);
  EXPECT_GT(figures.both_sides, 5'000);
  EXPECT_EQ(figures.let_go, 0);
}

}  // namespace
}  // namespace prismesh::drivers::haptics
