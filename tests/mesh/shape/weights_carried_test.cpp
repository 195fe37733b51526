// Weights that carry to sheets which are welded, not joined.
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/shape/weights_carried.h"
#include "tests/mesh/shape/weighed.h"
#include "tests/support/make_model.h"
#include "tests/support/real_deck.h"

namespace prismesh::mesh::shape {
namespace {

using test::make_model;
using test::nodes_where;
using test::Weighed;

struct Sheet {
  int columns, rows;
  std::function<Vec3(int, int)> place;
};

using Welds = std::vector<test::ElementSpec>;

/// Sheets that share no nodes; node (i, j) of sheet s has the id 10000 (s + 1) + 100 j + i.
Model sheets(const std::vector<Sheet>& all, double thickness = 0, const Welds& welds = {}) {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (std::size_t s = 0; s < all.size(); ++s) {
    const auto id = [s](int i, int j) { return static_cast<std::int64_t>(10000 * (s + 1)) + 100 * j + i; };
    for (int j = 0; j <= all[s].rows; ++j)
      for (int i = 0; i <= all[s].columns; ++i) nodes.push_back({id(i, j), all[s].place(i, j)});
    for (int j = 0; j < all[s].rows; ++j)
      for (int i = 0; i < all[s].columns; ++i)
        shells.push_back({id(i, j), static_cast<std::int64_t>(s) + 1, {id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)}});
  }
  Model model = make_model(nodes, shells, welds);
  return thickness > 0 ? test::with_thickness(std::move(model), thickness) : model;
}

/// A beam between the nodes (i, j) of two sheets.
test::ElementSpec weld(int sheet, int other, int i, int j) {
  return {ElementClass::beam, 1, 9, {10000 * (sheet + 1) + 100 * j + i, 10000 * (other + 1) + 100 * j + i}};
}

WeightOptions carried() {
  WeightOptions options;
  options.falloff.profile = Profile::linear;
  options.across_welds = true;
  return options;
}

Sheet flat(double z, double shift = 0) {
  return {20, 20, [=](int i, int j) { return Vec3(i + shift, j + shift, z); }};
}

/// A disc of all sheets.
NodeSet selection_of(const Model& model) {
  return nodes_where(model, [](const Vec3& p) { return (p - Vec3(10, 10, p.z())).norm() <= 7; });
}

/// The weight of the first sheet at a place over it, bilinear within its square.
double below(const Model& model, const Weighed& w, const Vec3& p) {
  const int i = std::min(19, static_cast<int>(p.x())), j = std::min(19, static_cast<int>(p.y()));
  const auto at = [&](int di, int dj) { return w(model.find_node(10000 + 100 * (j + dj) + i + di)); };
  const double u = p.x() - i, v = p.y() - j;
  // over the triangle of the diagonal from the first corner to the third
  return u > v ? (1 - u) * at(0, 0) + (u - v) * at(1, 0) + v * at(1, 1) : (1 - v) * at(0, 0) + (v - u) * at(0, 1) + u * at(1, 1);
}

TEST(WeightsAcrossWelds, carry_to_a_parallel_sheet_straight_across_the_gap) {
  const Model model = sheets({flat(0), flat(1.2, 0.3)}, 2);
  const NodeSet selection = selection_of(model);
  const NodeIndex grab = model.find_node(10000 + 1010);
  const Weighed w(model, selection, grab, carried());
  EXPECT_EQ(w.weights.unreached, 0u);
  double most = 0;
  for (const NodeIndex node : selection) {
    const Vec3& p = model.position(node);
    if (p.z() == 0) continue;
    EXPECT_NEAR(w(node), below(model, w, p), 1e-12);
    most = std::max(most, w(node));
  }
  EXPECT_GT(most, 0.8);
  // without being asked for, the other sheet stays
  WeightOptions alone = carried();
  alone.across_welds = false;
  const Weighed left(model, selection, grab, alone);
  EXPECT_GT(left.weights.unreached, 100u);
  for (const NodeIndex node : selection) EXPECT_EQ(left(node), model.position(node).z() == 0 ? w(node) : 0);
}

TEST(WeightsAcrossWelds, end_where_sheets_no_longer_touch) {
  for (const double scale : {1.0, 0.01, 250.0})
    for (const double gap : {0.95, 1.05}) {
      const auto scaled = [&](double z) { return Sheet{8, 8, [=](int i, int j) { return Vec3(scale * Vec3(i, j, z)); }}; };
      const Model model = sheets({scaled(0), scaled(gap)}, scale / 1.2);
      const NodeSet all = nodes_where(model, [](const Vec3&) { return true; });
      const Weighed w(model, all, model.find_node(10000), carried());
      EXPECT_EQ(w.weights.unreached, gap < 1 ? 0u : 81u) << scale << ", " << gap;
      for (const double weight : w.weights.weight) EXPECT_TRUE(weight == 0 || weight == 1);
    }
}

TEST(WeightsAcrossWelds, carry_from_a_welded_sheet_however_near_others_are) {
  // the third sheet is nearer to the first than the second is, which is welded to it at one place
  const Model model = sheets({flat(0), flat(1.9), flat(-0.5)}, 0, {weld(0, 1, 2, 2)});
  const NodeSet selection = selection_of(model);
  const Weighed w(model, selection, model.find_node(10000 + 1010), carried());
  for (const NodeIndex node : selection) {
    const Vec3& p = model.position(node);
    if (p.z() != 0) {
      EXPECT_NEAR(w(node), p.z() > 0 ? below(model, w, p) : 0, 1e-12);
    }
  }
  // the weld is longer than a joint may be
  const Model far = sheets({flat(0), flat(2.1)}, 0, {weld(0, 1, 2, 2)});
  EXPECT_GT(Weighed(far, selection_of(far), far.find_node(10000 + 1010), carried()).weights.unreached, 100u);
}

TEST(WeightsAcrossWelds, leave_what_is_joined_elsewhere_but_far_off) {
  // the second sheet is welded to the first where it begins, and rises from there
  const Sheet rising{20, 20, [](int i, int j) { return Vec3(i, j, 0.5 + 0.4 * i); }};
  const Model model = sheets({flat(0), rising}, 0, {weld(0, 1, 0, 10)});
  const auto reached = [&](double from) {
    const NodeSet selection = nodes_where(model, [&](const Vec3& p) { return p.x() >= from && p.x() <= from + 4; });
    return Weighed(model, selection, model.find_node(10000 + 1002 + static_cast<int>(from)), carried()).weights.unreached == 0;
  };
  EXPECT_TRUE(reached(0));
  EXPECT_TRUE(reached(2)) << "beside the weld";
  EXPECT_FALSE(reached(12));
}

TEST(WeightsAcrossWelds, end_at_a_distance_that_scales_with_the_closest_element) {
  // columns 1 wide and then 4 wide, below one sheet each at the same height
  const Model model = sheets({{12, 4, [](int i, int j) { return Vec3(i <= 8 ? i : 8 + 4 * (i - 8), j, 0); }},
                              {4, 4, [](int i, int j) { return Vec3(i, j, 2.5); }},
                              {4, 4, [](int i, int j) { return Vec3(13 + 2 * i, j, 2.5); }}});
  std::vector<std::uint32_t> numbers;  // of the sheets: 48, 16 and 16 shells
  for (std::uint32_t s = 0; s < 80; ++s) numbers.push_back(s < 48 ? 0 : s < 64 ? 1 : 2);
  const connections::JoinedSheets joined(
      {{ShellIndex(std::size_t{0}), ShellIndex(std::size_t{48})}, {ShellIndex(std::size_t{0}), ShellIndex(std::size_t{64})}}, numbers);
  const Weighed w(model, nodes_where(model, [](const Vec3&) { return true; }), model.find_node(10000), carried(), joined);
  EXPECT_EQ(w.weights.unreached, 25u);
  EXPECT_EQ(w(model.find_node(20000)), 0) << "over the small shells";
  EXPECT_EQ(w(model.find_node(30000)), 1) << "over the large ones";
}

TEST(WeightsAcrossWelds, carry_a_standing_sheet_whole_with_its_foot) {
  // the second sheet stands on the first, half an element above it; what is high up follows the foot
  const Model model =
      sheets({flat(0), {20, 12, [](int i, int j) { return Vec3(i, 10, 0.5 + j); }}}, 0, {{ElementClass::beam, 1, 9, {11010, 20010}}});
  const NodeSet selection = selection_of(model);
  const Weighed w(model, selection, model.find_node(10000 + 1010), carried());
  EXPECT_EQ(w.weights.unreached, 0u);
  for (int j = 0; j <= 12; ++j)
    for (int i = 3; i <= 17; ++i)
      EXPECT_NEAR(w(model.find_node(20000 + 100 * j + i)), w(model.find_node(10000 + 1000 + i)), 1e-12) << i << ", " << j;
}

TEST(WeightsAcrossWelds, carry_from_piece_to_piece) {
  const Model model = sheets({flat(0), flat(1), flat(2), flat(3), flat(9)}, 1);
  const NodeSet selection = selection_of(model);
  const Weighed w(model, selection, model.find_node(30000 + 1010), carried());
  for (int j = 4; j <= 16; ++j)
    for (int i = 6; i <= 14; ++i)
      for (const int other : {1, 2, 4}) {
        const NodeIndex node = model.find_node(10000 * other + 100 * j + i);
        EXPECT_NEAR(w(node), w(model.find_node(30000 + 100 * j + i)), 1e-12);
      }
  EXPECT_EQ(w(model.find_node(50000 + 1010)), 0);
  EXPECT_GT(w.weights.unreached, 100u);
}

TEST(WeightsAcrossWelds, carry_to_lone_nodes) {
  Model model = make_model({{1, {0, 0, 0}}, {2, {1, 0, 0}}, {3, {1, 1, 0}}, {4, {0, 1, 0}}, {5, {0.5, 0.5, 1}}, {6, {0.5, 0.5, 9}}},
                           {{1, 1, {1, 2, 3, 4}}}, {{ElementClass::beam, 1, 2, {5, 6}}});
  const Weighed w(model, nodes_where(model, [](const Vec3&) { return true; }), NodeIndex(0), carried());
  EXPECT_EQ(w.weights.weight, (std::vector<double>{1, 1, 1, 1, 1, 0}));
  EXPECT_EQ(w.weights.unreached, 1u);
}

TEST(WeightsAcrossWelds, leave_the_constant_profile_as_it_is) {
  const Model model = sheets({flat(0), flat(1)}, 1);
  const NodeSet selection = nodes_where(model, [](const Vec3& p) { return p.x() < 8; });
  WeightOptions options = carried();
  options.falloff.profile = Profile::constant;
  const Weighed with(model, selection, std::nullopt, options);
  options.across_welds = false;
  const Weighed without(model, selection, std::nullopt, options);
  EXPECT_EQ(with.weights.weight, without.weights.weight);
  EXPECT_EQ(with.weights.unreached, without.weights.unreached);
}

/// A real bumper: a beam, its flanges, and sheets that share no nodes with them.
TEST(WeightsAcrossWelds, carry_over_the_flanges_of_a_real_deck) {
  const auto decks = test::real_decks();
  if (!decks) GTEST_SKIP() << "PRISMESH_MODELS doesn't point to the real decks";
  for (const char* name : {"bumper_beam_rad", "simplecar_nas"}) {
    SCOPED_TRACE(name);
    const Model model = test::open_real(*decks, name);
    // everything near a node in the middle of the first part, whichever sheet it belongs to
    const Vec3 middle = model.position(model.shell(ShellIndex(model.shell_count() / 2)).node[0]);
    double widest = 0;
    for (std::size_t n = 0; n < model.node_count(); ++n) widest = std::max(widest, (model.positions[n] - middle).norm());
    const NodeSet selection = nodes_where(model, [&](const Vec3& p) { return (p - middle).norm() < 0.4 * widest; });
    WeightOptions options = carried();
    options.across_welds = false;
    const Weighed alone(model, selection, std::nullopt, options);
    options.across_welds = true;
    const Weighed w(model, selection, std::nullopt, options);
    std::cout << "  " << name << ": " << selection.size() << " nodes, unreached " << alone.weights.unreached << ", across welds "
              << w.weights.unreached << "\n";
    EXPECT_LT(w.weights.unreached, alone.weights.unreached);
    for (std::size_t i = 0; i < selection.size(); ++i) {
      const double before = alone.weights.weight[i], after = w.weights.weight[i];
      EXPECT_TRUE(after >= before && after <= 1);
      EXPECT_TRUE(before == 0 || after == before);
    }
  }
}

}  // namespace
}  // namespace prismesh::mesh::shape
