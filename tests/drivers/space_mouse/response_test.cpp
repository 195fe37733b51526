#include "drivers/space_mouse/response.h"

#include <gtest/gtest.h>

namespace prismesh::drivers::space_mouse {
namespace {

double speed_at(int deflection, const SpaceMouseResponse& response) {
  SpaceMouseState state;
  state.shift[1] = deflection;
  return motion_of(state, response).shift[1];
}

TEST(SpaceMouseMotions, rest_within_the_dead_zone_and_begin_softly) {
  const SpaceMouseResponse response{.dead_zone = 0.1, .exponent = 2};
  EXPECT_EQ(speed_at(35, response), 0);
  EXPECT_EQ(speed_at(-35, response), 0);
  EXPECT_GT(speed_at(36, response), 0);
  EXPECT_LT(speed_at(36, response), 0.001);
}

TEST(SpaceMouseMotions, rise_without_jumps_to_one_and_are_the_same_both_ways) {
  for (const double exponent : {1.0, 2.0, 3.0}) {
    const SpaceMouseResponse response{.exponent = exponent};
    double before = 0;
    for (int deflection = 0; deflection <= 350; ++deflection) {
      const double speed = speed_at(deflection, response);
      EXPECT_EQ(speed, -speed_at(-deflection, response));
      EXPECT_GE(speed, before);
      EXPECT_LT(speed - before, 0.02);
      before = speed;
    }
    EXPECT_DOUBLE_EQ(before, 1);
  }
  // Half of the way between the dead zone and the end.
  EXPECT_DOUBLE_EQ(speed_at(210, {.dead_zone = 0.2, .exponent = 2}), 0.25);
}

TEST(SpaceMouseMotions, may_follow_the_most_deflected_axis_alone) {
  const SpaceMouseState state{{100, -200, 50}, {150, 0, 200}, 0};
  const SpaceMouseMotion all = motion_of(state, {});
  EXPECT_NE(all.shift[0], 0);
  EXPECT_FALSE(all.at_rest());
  const SpaceMouseMotion one = motion_of(state, {.dominant_axis = true});
  EXPECT_EQ(one.shift[1], all.shift[1]);
  EXPECT_EQ(one.shift[0], 0);
  EXPECT_EQ(one.turn, (std::array<double, 3>{}));
  EXPECT_TRUE(motion_of({}, {.dead_zone = 0, .dominant_axis = true}).at_rest());
}

}  // namespace
}  // namespace prismesh::drivers::space_mouse
