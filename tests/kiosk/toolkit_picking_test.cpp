// Places in two views, and what can't be pointed at any more.
#include "kiosk/toolkit/picking.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/kiosk/test_source.h"

namespace prismesh::kiosk::toolkit {
namespace {

using ::testing::ElementsAre;

TEST(InEachView, is_the_place_and_the_same_one_in_the_left_view) {
  PictureView view;
  view.size = {1000, 500};
  EXPECT_THAT(in_each_view(view, {700, 200}), ElementsAre(input::Pixel(700, 200)));
  view.two_views = true;  // the border is at 500
  EXPECT_THAT(in_each_view(view, {700, 200}), ElementsAre(input::Pixel(700, 200), input::Pixel(200, 200)));
  EXPECT_THAT(in_each_view(view, {450, 200}), ElementsAre(input::Pixel(-50, 200))) << "in the right view it is behind the border";
  EXPECT_THAT(in_each_view(view, {1100, 200}), ElementsAre(input::Pixel(1100, 200))) << "in the left view it is behind the border";
}

TEST(PointedAtTest, is_out_of_sight_when_its_part_is_hidden_or_its_shell_gone) {
  test::TestSource source = test::two_plates();
  PointedAt pointed;
  EXPECT_FALSE(is_out_of_sight(pointed, source)) << "nothing is named";
  pointed.words = "shell 5";
  pointed.shell = mesh::ShellIndex(5);
  EXPECT_FALSE(is_out_of_sight(pointed, source));
  source.hidden[1] = true;
  EXPECT_FALSE(is_out_of_sight(pointed, source)) << "another part";
  source.hidden[0] = true;
  EXPECT_TRUE(is_out_of_sight(pointed, source));
  source.hidden[0] = false;
  pointed.shell = mesh::ShellIndex(200);
  EXPECT_TRUE(is_out_of_sight(pointed, source));
  pointed.shell.reset();
  pointed.node = mesh::NodeIndex(3);
  EXPECT_FALSE(is_out_of_sight(pointed, source));
  pointed.node = mesh::NodeIndex(100000);
  EXPECT_TRUE(is_out_of_sight(pointed, source));
}

}  // namespace
}  // namespace prismesh::kiosk::toolkit
