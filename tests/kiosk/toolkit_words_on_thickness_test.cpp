// What is said about parts that aren't drawn with the real thickness of their shells.
#include "kiosk/toolkit/words_on_thickness.h"

#include <vector>

#include <gtest/gtest.h>

namespace prismesh::kiosk::toolkit {
namespace {

ipc::SnapshotPart part_with(float thinnest, float thickest, std::uint32_t shells = 10) {
  ipc::SnapshotPart part;
  part.shells = shells;
  part.thinnest = thinnest;
  part.thickest = thickest;
  return part;
}

TEST(WordsOnThickness, count_parts_without_thickness_and_those_whose_shells_differ) {
  std::vector<ipc::SnapshotPart> parts{part_with(1, 1), part_with(2, 2), part_with(0, 0, 0)};
  EXPECT_EQ(words_on_thickness(parts), "") << "a part without shells has nothing to draw";
  parts.push_back(part_with(0, 0));
  EXPECT_EQ(words_on_thickness(parts), "1 part with shells without thickness is drawn as surfaces");
  parts.push_back(part_with(0, 2));
  EXPECT_EQ(words_on_thickness(parts), "2 parts with shells without thickness are drawn as surfaces");
  parts.push_back(part_with(1, 2));
  EXPECT_EQ(words_on_thickness(parts),
            "2 parts with shells without thickness are drawn as surfaces; 1 part with shells of different thickness has the mean of the "
            "thinnest and the thickest");
}

}  // namespace
}  // namespace prismesh::kiosk::toolkit
