#include "mesh/field/guides.h"

#include <algorithm>
#include <memory>
#include <set>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "mesh/model/features.h"
#include "tests/mesh/spatial/tree_trials.h"

namespace prismesh::mesh::field {
namespace {

using spatial::BoxTree;
using test::make_grid;

HapticGuides guides_of(const Model& model, const Vec3& pen_mm, const Placement& placement = {}) {
  HapticGuides guides{};
  find_guides(model, BoxTree(model), placement, pen_mm, guides);
  return guides;
}

Vec3 from(const HapticGuides& guides, int i) { return Vec3(guides.guides[i].from_mm); }
Vec3 to(const HapticGuides& guides, int i) { return Vec3(guides.guides[i].to_mm); }
double distance(const HapticGuides& guides, int i, const Vec3& pen_mm) {
  const Vec3 along = to(guides, i) - from(guides, i);
  const double square = along.squaredNorm();
  const double share = square > 0 ? std::clamp((pen_mm - from(guides, i)).dot(along) / square, 0.0, 1.0) : 0;
  return (from(guides, i) + share * along - pen_mm).norm();
}

/// A plane sheet of 10 mm quads that is bent by 90 degrees at x = 50.
Model bent_sheet() {
  return make_grid(10, 10, [](int i, int j) { return i <= 5 ? Vec3(10 * i, 10 * j, 0) : Vec3(50, 10 * j, 10 * (i - 5)); });
}

TEST(Guides, the_nearest_node_of_a_plane_sheet_guides) {
  const Vec3 pen(31, 52, 1);
  const HapticGuides guides = guides_of(bent_sheet(), pen);
  ASSERT_EQ(guides.count, 1);
  EXPECT_EQ(from(guides, 0), Vec3(30, 50, 0));
  EXPECT_EQ(to(guides, 0), Vec3(30, 50, 0));
}

TEST(Guides, between_the_nodes_of_a_plane_sheet_nothing_guides) { EXPECT_EQ(guides_of(bent_sheet(), {35, 55, 1}).count, 0); }

TEST(Guides, a_crease_guides_between_its_nodes_and_its_nodes_do) {
  const Vec3 pen(48, 55, 1);
  const HapticGuides guides = guides_of(bent_sheet(), pen);
  ASSERT_EQ(guides.count, 5);  // its two nodes and the pieces before and behind it, too
  EXPECT_EQ(from(guides, 0), Vec3(50, 50, 0));
  EXPECT_EQ(to(guides, 0), Vec3(50, 60, 0));
  EXPECT_EQ(from(guides, 1), to(guides, 1));
  EXPECT_EQ(from(guides, 2), to(guides, 2));
}

TEST(Guides, a_free_edge_guides) {
  const HapticGuides guides = guides_of(bent_sheet(), {25, -3, 0});
  ASSERT_EQ(guides.count, 5);
  EXPECT_EQ(from(guides, 0), Vec3(20, 0, 0));
  EXPECT_EQ(to(guides, 0), Vec3(30, 0, 0));
}

TEST(Guides, a_junction_guides_though_its_sheets_are_smooth) {
  const Model model = test::junction();
  const HapticGuides guides = guides_of(model, {0.1, 0, 4.5});
  ASSERT_GT(guides.count, 0);
  EXPECT_LT(from(guides, 0).head<2>().norm(), 1e-9);
}

TEST(Guides, the_nodes_of_a_mesh_that_is_fine_for_the_hand_dont_guide) {
  const Vec3 pen(31, 52, 1);
  EXPECT_EQ(guides_of(bent_sheet(), 0.39 * pen, {Eigen::Matrix3d::Identity(), Vec3::Zero(), 0.39}).count, 0);
  EXPECT_GT(guides_of(bent_sheet(), 0.41 * pen, {Eigen::Matrix3d::Identity(), Vec3::Zero(), 0.41}).count, 0);
}

/// Every edge and node of the model by a plain search.
TEST(Guides, are_all_within_reach_nearest_first_in_the_pens_space) {
  const Model model = test::make_grid(30, 30, [](int i, int j) { return Vec3(5 * i, 5 * j, 3 * ((i / 3 + j / 4) % 2)); });
  const Placement placement{Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()).toRotationMatrix(), Vec3(4, 5, 6), 1.3};
  for (const Vec3& place : {Vec3(40, 40, 1), Vec3(77, 33, 2), Vec3(0, 1, 3), Vec3(75, 149, 0)}) {
    const Vec3 pen = placement.to_pen(place);
    const HapticGuides guides = guides_of(model, pen, placement);
    std::set<std::tuple<double, double, double, double, double, double>> got, wanted;
    for (int i = 0; i < guides.count; ++i) {
      if (i > 0) {
        EXPECT_LE(distance(guides, i - 1, pen), distance(guides, i, pen) + 1e-12);
      }
      const Vec3 a = from(guides, i), b = to(guides, i);
      got.emplace(a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
    }
    const auto want = [&](const Vec3& a, const Vec3& b) {
      HapticGuides one{};
      Eigen::Map<Vec3>(one.guides[0].from_mm) = a;
      Eigen::Map<Vec3>(one.guides[0].to_mm) = b;
      if (distance(one, 0, pen) <= kGuideReachMm) wanted.emplace(a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
    };
    const std::vector<EdgeKind> kinds = classify_edges(model, kGuideCreaseDegrees);
    for (std::size_t e = 0; e < kinds.size(); ++e) {
      const Edge ends = model.adjacency->edge(EdgeIndex(e));
      if (kinds[e] != EdgeKind::smooth) want(placement.to_pen(model.position(ends.low)), placement.to_pen(model.position(ends.high)));
    }
    for (std::size_t n = 0; n < model.node_count(); ++n) want(placement.to_pen(model.positions[n]), placement.to_pen(model.positions[n]));
    EXPECT_EQ(got, wanted);
    EXPECT_EQ(got.size(), static_cast<std::size_t>(guides.count));
    EXPECT_GT(guides.count, 2);
  }
}

TEST(Guides, of_many_the_nearest_count) {
  // Steps of 1 mm: each line is a crease.
  const Model model = make_grid(60, 60, [](int i, int j) { return Vec3(0.5 * i, 0.5 * j, i % 2); });
  const Vec3 pen(15, 15, 0.5);
  const HapticGuides guides = guides_of(model, pen);
  ASSERT_EQ(guides.count, kMaxGuides);
  EXPECT_LT(distance(guides, kMaxGuides - 1, pen), 3);
}

TEST(Guides, a_mesh_with_too_many_shells_in_reach_has_guides_nearer_by) {
  // 5,900 shells are within 6 mm, 1,500 within 3 mm.
  const Model model = make_grid(120, 120, [](int i, int j) { return Vec3(0.14 * i, 0.14 * j, i < 60 ? 0 : 0.14 * (i - 60)); });
  const Vec3 near(60 * 0.14 - 1, 8, 0), far(60 * 0.14 - 4, 8, 0);
  EXPECT_GT(guides_of(model, near).count, 0);
  EXPECT_EQ(guides_of(model, far).count, 0);
}

TEST(Guides, shells_that_the_tree_leaves_out_dont_guide) {
  const Model model = bent_sheet();
  BoxTree tree(model);
  ShellSet all;
  for (std::size_t s = 0; s < model.shell_count(); ++s) all.push_back(ShellIndex(s));
  tree.leave_out(all);
  HapticGuides guides{};
  find_guides(model, tree, {}, {50, 50, 0}, guides);
  EXPECT_EQ(guides.count, 0);
}

TEST(Guides, corners_that_arent_finite_and_shells_without_area_do_no_harm) {
  const Model model = test::spoiled_sheet();
  for (int i = 0; i <= 20; i += 3)
    for (int j = 0; j <= 20; j += 3) {
      const HapticGuides guides = guides_of(model, Vec3(i, j, 0.1), {Eigen::Matrix3d::Identity(), Vec3::Zero(), 1});
      for (int g = 0; g < guides.count; ++g) EXPECT_TRUE(from(guides, g).allFinite() && to(guides, g).allFinite());
    }
}

}  // namespace
}  // namespace prismesh::mesh::field
