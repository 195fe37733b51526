// What holds for weights whatever the mesh: the same for any numbering and number of threads, finite for any numbers.
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "mesh/shape/normals.h"
#include "tests/mesh/shape/weighed.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::shape {
namespace {

using test::make_model;
using test::nodes_where;
using test::Weighed;

constexpr int kSide = 24;

/// Two wavy sheets of quads and triangles, one over the other, with nodes and shells in an order of chance. Ids stay.
Model shuffled_sheets(unsigned seed) {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int sheet = 0; sheet < 2; ++sheet) {
    const auto id = [=](int i, int j) { return 1 + i + (kSide + 1) * j + 1000 * sheet; };
    for (int j = 0; j <= kSide; ++j)
      for (int i = 0; i <= kSide; ++i)
        nodes.push_back({id(i, j), {i + 0.2 * std::sin(5 * i + j), j + 0.2 * std::cos(3 * j - i), std::sin(i / 4.0) + 0.6 * sheet}});
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i) {
        const std::int64_t a = id(i, j), b = id(i + 1, j), c = id(i + 1, j + 1), d = id(i, j + 1);
        if ((i * 7 + j * 3) % 5 == 0) {
          shells.push_back({2 * a, 1, {a, b, c}});
          shells.push_back({2 * a + 1, 1, {a, c, d}});
        } else {
          shells.push_back({2 * a, 1, {a, b, c, d}});
        }
      }
  }
  if (seed != 0) {
    std::mt19937 random(seed);
    std::shuffle(nodes.begin(), nodes.end(), random);
    std::shuffle(shells.begin(), shells.end(), random);
  }
  return test::with_thickness(make_model(nodes, shells), 1);
}

NodeSet disc(const Model& model) {
  return nodes_where(model, [](const Vec3& p) { return std::hypot(p.x() - 12, p.y() - 13) <= 8; });
}

WeightOptions across() {
  WeightOptions options;
  options.across_welds = true;
  return options;
}

TEST(WeightsProperties, do_not_depend_on_the_numbering) {
  const Model plain = shuffled_sheets(0);
  const Weighed expected(plain, disc(plain), plain.find_node(1 + 12 + 25 * 12), across());
  EXPECT_EQ(expected.weights.unreached, 0u);
  for (const unsigned seed : {1u, 2u, 3u}) {
    const Model model = shuffled_sheets(seed);
    const Weighed w(model, disc(model), model.find_node(1 + 12 + 25 * 12), across());
    ASSERT_EQ(w.weights.nodes.size(), expected.weights.nodes.size());
    for (const NodeIndex node : w.weights.nodes)
      EXPECT_NEAR(w(node), expected(plain.find_node(model.node_ids[node.value])), 2e-3) << model.node_ids[node.value];
  }
}

TEST(WeightsProperties, have_the_same_bits_for_any_number_of_threads) {
  const Model model = shuffled_sheets(4);
  const NodeSet everything = nodes_where(model, [](const Vec3& p) { return p.y() > 3; });
  std::vector<std::vector<double>> weights;
  for (const std::size_t threads : {1, 2, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    weights.push_back(Weighed(model, everything, std::nullopt, across()).weights.weight);
  }
  EXPECT_EQ(weights[0], weights[1]);
  EXPECT_EQ(weights[0], weights[2]);
}

TEST(WeightsProperties, stay_finite_where_coordinates_are_no_numbers) {
  const double odd[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                        -std::numeric_limits<double>::infinity(), 1e300, -1e200};
  const Model model = shuffled_sheets(5);
  const connections::JoinedSheets joined = connections::find_joined_sheets(model, {}, {});
  const NodeSet selection = disc(model);
  for (const double number : odd)
    for (std::size_t which = 0; which < selection.size(); which += 23)
      for (int axis = 0; axis < 4; ++axis) {
        Model broken = model;
        Vec3 place = model.position(selection[which]);
        if (axis < 3)
          place[axis] = number;
        else
          place = Vec3(number, number, number);
        broken.positions.set(selection[which].value, place);
        for (const bool along : {false, true})
          for (const Origin origin : {Origin::grab, Origin::free_edge}) {
            WeightOptions options = across();
            options.origin = origin;
            options.free_ends = std::array{FreeEnds::held, FreeEnds::weighted, FreeEnds::rigid}[which % 3];
            if (along) options.falloff.along = Vec3(1, 0.5, 0.1);
            for (const std::optional<NodeIndex> grab : {std::optional<NodeIndex>(), std::optional(selection[which])}) {
              const Result<Weights> result = compute_weights(broken, selection, grab, options, {{}, {}, &joined});
              if (!result) {
                EXPECT_FALSE(result.error().message.empty());
                continue;
              }
              for (const double weight : result->weight) EXPECT_TRUE(weight >= 0 && weight <= 1) << weight;
            }
          }
        for (const Vec3& normal : oriented_normals(broken, selection, selection[which]))
          EXPECT_TRUE(normal.allFinite() && normal.norm() < 1 + 1e-9);
      }
}

}  // namespace
}  // namespace prismesh::mesh::shape
