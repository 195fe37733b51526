// Cross sections: curves of known shapes, and pieces against a cut that is found another way.
#include "mesh/measure/cross_section.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/support/make_model.h"
#include "tests/support/real_deck.h"

namespace prismesh::mesh::measure {
namespace {

using test::make_model;
using test::NodeSpec;
using test::ShellSpec;

constexpr double kPi = 3.14159265358979;

/// A tube about x of `around` x `along` quads, of radius 10 and length 100.
Model tube(int around, int along) {
  std::vector<NodeSpec> nodes;
  std::vector<ShellSpec> shells;
  for (int i = 0; i <= along; ++i)
    for (int j = 0; j < around; ++j) {
      const double angle = 2 * kPi * j / around;
      nodes.push_back({i * around + j + 1, Vec3(100.0 * i / along, 10 * std::cos(angle), 10 * std::sin(angle))});
    }
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < around; ++j) {
      const auto id = [&](int a, int b) { return std::int64_t{a} * around + b % around + 1; };
      shells.push_back({i * around + j + 1, 1, {id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)}});
    }
  return make_model(nodes, shells);
}

TEST(CrossSection, of_a_tube_is_a_closed_curve) {
  const Model model = tube(24, 7);
  const Result<CrossSection> section = cross_section(model, {Vec3(33, 0, 0), Vec3(2, 0, 0)});
  ASSERT_TRUE(section) << section.error().text();
  ASSERT_EQ(section->curves.size(), 1u);
  const SectionCurve& curve = section->curves[0];
  EXPECT_TRUE(curve.closed);
  EXPECT_EQ(section->shells, 24u);
  EXPECT_EQ(curve.points.size(), 48u) << "one on each edge along the tube, one on each diagonal";
  EXPECT_NEAR(curve.length, 24 * 2 * 10 * std::sin(kPi / 24), 1e-9);
  EXPECT_NEAR(section->length, curve.length, 1e-12);
  for (const Vec3& point : curve.points) EXPECT_NEAR(point.x(), 33, 1e-9);
}

TEST(CrossSection, along_the_axis_ends_at_free_edges) {
  const Result<CrossSection> section = cross_section(tube(24, 7), {Vec3(0, 0, 0.5), Vec3(0, 0, 1)});
  ASSERT_TRUE(section);
  ASSERT_EQ(section->curves.size(), 2u);
  for (const SectionCurve& curve : section->curves) {
    EXPECT_FALSE(curve.closed);
    EXPECT_NEAR(curve.length, 100, 1e-9);
    EXPECT_NEAR(std::abs(curve.points.front().x() - curve.points.back().x()), 100, 1e-9);
  }
}

/// Two quads with a common edge at x = 1.
Model two_quads(std::int64_t second_part) {
  return make_model({{1, {0, 0, 0}}, {2, {1, 0, 0}}, {3, {1, 1, 0}}, {4, {0, 1, 0}}, {5, {2, 0, 0}}, {6, {2, 1, 0}}},
                    {{1, 1, {1, 2, 3, 4}}, {2, second_part, {2, 5, 6, 3}}});
}

TEST(CrossSection, through_nodes_is_cut_once) {
  const Result<CrossSection> section = cross_section(two_quads(1), {Vec3(1, 0, 0), Vec3(1, 0, 0)});
  ASSERT_TRUE(section);
  ASSERT_EQ(section->curves.size(), 1u);
  EXPECT_NEAR(section->length, 1, 1e-12);
  // The other side of the plane: the other shell is cut, at the same place.
  const Result<CrossSection> other = cross_section(two_quads(1), {Vec3(1, 0, 0), Vec3(-1, 0, 0)});
  ASSERT_TRUE(other);
  EXPECT_NEAR(other->length, 1, 1e-12);
}

TEST(CrossSection, a_sheet_in_the_plane_and_one_that_touches_it_have_no_curve) {
  const Result<CrossSection> within = cross_section(two_quads(1), {Vec3(0, 0, 0), Vec3(0, 0, 1)});
  ASSERT_TRUE(within);
  EXPECT_TRUE(within->curves.empty());
  // The corner at (2, 1) alone lies in the plane.
  const Result<CrossSection> touching = cross_section(two_quads(1), {Vec3(2, 1, 0), Vec3(1, 1, 0)});
  ASSERT_TRUE(touching);
  EXPECT_TRUE(touching->curves.empty());
  EXPECT_EQ(touching->length, 0);
}

TEST(CrossSection, through_nothing_is_empty) {
  const Result<CrossSection> section = cross_section(two_quads(1), {Vec3(50, 0, 0), Vec3(1, 0, 0)});
  ASSERT_TRUE(section);
  EXPECT_TRUE(section->curves.empty());
  EXPECT_EQ(section->shells, 0u);
}

TEST(CrossSection, curves_belong_to_one_part_and_hidden_parts_have_none) {
  const Model model = two_quads(2);
  const Plane plane{Vec3(0, 0.5, 0), Vec3(0, 1, 0)};
  const Result<CrossSection> both = cross_section(model, plane);
  ASSERT_TRUE(both);
  ASSERT_EQ(both->curves.size(), 2u);
  EXPECT_EQ(both->curves[0].part, PartIndex(std::size_t{0}));
  EXPECT_EQ(both->curves[1].part, PartIndex(std::size_t{1}));
  const std::vector<std::uint8_t> hidden{1, 0};
  const Result<CrossSection> one = cross_section(model, plane, hidden);
  ASSERT_TRUE(one);
  ASSERT_EQ(one->curves.size(), 1u);
  EXPECT_EQ(one->curves[0].part, PartIndex(std::size_t{1}));
  EXPECT_EQ(cross_section(two_quads(1), plane)->curves.size(), 1u) << "one part: the curve goes on";
}

TEST(CrossSection, refuses_what_is_no_plane) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Model model = two_quads(1);
  EXPECT_EQ(cross_section(model, {Vec3(0, 0, 0), Vec3(0, 0, 0)}).error().message, "the plane's normal has no length");
  EXPECT_FALSE(cross_section(model, {Vec3(nan, 0, 0), Vec3(1, 0, 0)}));
  EXPECT_FALSE(cross_section(model, {Vec3(0, 0, 0), Vec3(0, std::numeric_limits<double>::infinity(), 0)}));
  // Absurd numbers that are planes.
  EXPECT_TRUE(cross_section(model, {Vec3(1e300, 0, 0), Vec3(1, 0, 0)}));
  EXPECT_NEAR(cross_section(model, {Vec3(0.5, 0, 0), Vec3(1e300, 0, 0)})->length, 1, 1e-12);
  EXPECT_NEAR(cross_section(model, {Vec3(0.5, 0, 0), Vec3(1e-300, 0, 0)})->length, 1, 1e-12);
}

TEST(CrossSection, leaves_nodes_out_that_arent_finite) {
  Model model = two_quads(1);
  model.positions.set(model.find_node(6).value, Vec3(2, std::numeric_limits<double>::quiet_NaN(), 0));
  const Result<CrossSection> section = cross_section(model, {Vec3(0, 0.5, 0), Vec3(0, 1, 0)});
  ASSERT_TRUE(section);
  for (const SectionCurve& curve : section->curves)
    for (const Vec3& point : curve.points) EXPECT_TRUE(point.allFinite());
  EXPECT_NEAR(section->length, 1, 1e-12) << "the whole quad is left";
}

/// The part of the line in which two planes meet that lies in a triangle: an independent way to the same piece.
double length_in_triangle(const std::array<Vec3, 3>& corner, const Vec3& at, const Vec3& normal) {
  const Vec3 own = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
  Vec3 along = own.cross(normal);
  if (along.norm() < 1e-12) return 0;
  along.normalize();
  // The point of the line nearest to the first corner: within the triangle's plane, straight to the other plane.
  const Vec3 across = along.cross(own);
  const Vec3 origin = corner[0] + across * ((at - corner[0]).dot(normal) / across.dot(normal));
  double from = -1e300, to = 1e300;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 inward = own.cross(corner[(i + 1) % 3] - corner[i]);
    const double offset = (origin - corner[i]).dot(inward), rate = along.dot(inward);
    if (std::abs(rate) < 1e-14) {
      if (offset < 0) return 0;
      continue;
    }
    (rate > 0 ? from : to) = rate > 0 ? std::max(from, -offset / rate) : std::min(to, -offset / rate);
  }
  return std::max(0.0, to - from);
}

double length_found_otherwise(const Model& model, const Plane& plane) {
  double length = 0;
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    const ShellNodes& shell = model.shell_nodes[s];
    const auto at = [&](std::size_t corner) { return model.position(shell.node[corner]); };
    length += length_in_triangle({at(0), at(1), at(2)}, plane.point, plane.normal.normalized());
    if (!shell.is_triangle()) length += length_in_triangle({at(0), at(2), at(3)}, plane.point, plane.normal.normalized());
  }
  return length;
}

TEST(CrossSection, agrees_with_another_way_on_real_decks) {
  const auto decks = test::real_decks();
  if (!decks) GTEST_SKIP() << "PRISMESH_MODELS isn't set";
  std::mt19937 random(7);
  std::normal_distribution<double> any;
  for (const char* name : {"hatprofile", "bumper_beam_rad", "wing_ferig", "jp_model_inp"}) {
    const Model model = test::open_real(*decks, name);
    ASSERT_GT(model.node_count(), 0u);
    Vec3 middle = Vec3::Zero();
    for (std::size_t n = 0; n < model.node_count(); ++n) middle += model.positions[n] / static_cast<double>(model.node_count());
    for (int i = 0; i < 5; ++i) {
      const Plane plane{middle, Vec3(any(random), any(random), any(random))};
      const Result<CrossSection> section = cross_section(model, plane);
      ASSERT_TRUE(section);
      const double expected = length_found_otherwise(model, plane);
      EXPECT_GT(expected, 0) << name;
      EXPECT_NEAR(section->length, expected, 1e-6 * expected) << name;
      for (const SectionCurve& curve : section->curves)
        for (const Vec3& point : curve.points)
          EXPECT_NEAR((point - plane.point).dot(plane.normal.normalized()), 0, 1e-9 * (1 + point.norm())) << name;
    }
  }
}

}  // namespace
}  // namespace prismesh::mesh::measure
