#include "base/counted.h"

#include <gtest/gtest.h>

namespace prismesh {
namespace {

TEST(Counted, takes_the_plural_but_for_one) {
  EXPECT_EQ(counted(0, "node"), "0 nodes");
  EXPECT_EQ(counted(1, "node"), "1 node");
  EXPECT_EQ(counted(12, "line"), "12 lines");
}

}  // namespace
}  // namespace prismesh
