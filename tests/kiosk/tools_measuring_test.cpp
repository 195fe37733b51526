// The list of measures: picking nodes, following states, and the words.
#include "kiosk/tools/measuring/measure_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/make_model.h"

namespace prismesh::kiosk::tools::measuring {
namespace {

using mesh::NodeIndex;
using mesh::Vec3;
using testing::ElementsAre;

NodeIndex at(std::size_t index) { return NodeIndex(index); }

TEST(Measures, two_picks_make_a_distance_and_three_an_angle) {
  MeasureList list;
  EXPECT_FALSE(list.pick(10, at(0), 2));
  EXPECT_FALSE(list.pick(10, at(0), 2)) << "the same node again";
  EXPECT_EQ(list.begun().ids, std::vector<std::int64_t>{10});
  EXPECT_TRUE(list.pick(30, at(2), 2));
  EXPECT_TRUE(list.begun().ids.empty());
  EXPECT_FALSE(list.pick(10, at(0), 3));
  EXPECT_FALSE(list.pick(20, at(1), 3));
  EXPECT_TRUE(list.pick(10, at(0), 3)) << "there and back";
  ASSERT_EQ(list.all().size(), 2U);
  EXPECT_EQ(measure_title(list.all()[1]), "nodes 10 \u2192 20 \u2192 10");
  EXPECT_FALSE(list.pick(10, at(0), 2));
  EXPECT_TRUE(list.give_up());
  EXPECT_FALSE(list.give_up());
  list.remove(0);
  EXPECT_EQ(list.all().size(), 1U);
  list.remove(7);
  EXPECT_EQ(list.all().size(), 1U);
}

TEST(Measures, figures_and_words) {
  const mesh::Model model =
      test::make_model({{1, {0, 0, 0}}, {2, {30, 0, 0}}, {3, {30, 40, 0}}, {4, {0, 40, 0}}, {5, {60, 0, 0}}}, {{1, 1, {1, 2, 3, 4}}});
  MeasureList list;
  list.pick(1, at(0), 2), list.pick(3, at(2), 2);
  list.pick(1, at(0), 3), list.pick(2, at(1), 3), list.pick(3, at(2), 3);
  list.pick(1, at(0), 3), list.pick(2, at(1), 3), list.pick(5, at(4), 3);
  EXPECT_EQ(measure_label(list.all()[0], "mm"), "") << "nothing is known yet";
  EXPECT_TRUE(list.compute(model, {}));
  EXPECT_FALSE(list.compute(model, {}));
  EXPECT_EQ(measure_label(list.all()[0], "mm"), "50\u00a0mm");
  EXPECT_THAT(measure_details(list.all()[0], "mm"), ElementsAre("x 30  y 40  z 0 mm", "along the surface 50\u00a0mm"));
  EXPECT_EQ(measure_label(list.all()[1], "mm"), "90\u00b0  R 25\u00a0mm");
  EXPECT_THAT(measure_details(list.all()[1], "mm"),
              ElementsAre("first to last 50\u00a0mm", "x 30  y 40  z 0 mm", "along the surface 50\u00a0mm"));
  EXPECT_EQ(measure_label(list.all()[2], "mm"), "180\u00b0  on a line");
  EXPECT_EQ(measure_details(list.all()[2], "mm").back(), "no way along the surface");
}

TEST(Measures, follow_a_state_and_come_back_with_their_nodes) {
  const mesh::Model model = test::make_model({{1, {0, 0, 0}}, {2, {30, 0, 0}}, {3, {30, 40, 0}}}, {{1, 1, {1, 2, 3}}});
  MeasureList list;
  list.pick(1, at(0), 2), list.pick(3, at(2), 2);
  list.compute(model, {});
  list.follow([](std::int64_t id, std::optional<NodeIndex>) { return id == 3 ? std::nullopt : std::optional(NodeIndex(std::size_t{0})); });
  EXPECT_THAT(measure_details(list.all()[0], "mm"), ElementsAre("one of its nodes isn't there"));
  EXPECT_EQ(measure_label(list.all()[0], "mm"), "");
  EXPECT_FALSE(list.compute(model, {}));
  std::vector<std::optional<NodeIndex>> last;
  list.follow([&](std::int64_t id, std::optional<NodeIndex> was) {
    last.push_back(was);
    return std::optional(NodeIndex(static_cast<std::size_t>(id - 1)));
  });
  EXPECT_TRUE(list.compute(model, {}));
  EXPECT_EQ(measure_label(list.all()[0], "mm"), "50\u00a0mm");
  list.pick(2, at(1), 3);
  list.follow([](std::int64_t id, std::optional<NodeIndex>) { return id == 2 ? std::nullopt : std::optional(NodeIndex(std::size_t{0})); });
  EXPECT_TRUE(list.begun().ids.empty()) << "its node is gone";
}

}  // namespace
}  // namespace prismesh::kiosk::tools::measuring
