// Ids as an expression: what the expression names is what was written.
#include "mesh/report/id_list.h"

#include <gtest/gtest.h>

namespace prismesh::mesh::report {
namespace {

TEST(IdListTest, runs_become_ranges_and_nothing_else_is_named) {
  EXPECT_EQ(id_list({}), "");
  EXPECT_EQ(id_list({7}), "7");
  EXPECT_EQ(id_list({7, 8}), "7,8");
  EXPECT_EQ(id_list({1, 2, 3, 5, 9, 10, 11, 12}), "1-3,5,9-12");
  EXPECT_EQ(id_list({9223372036854775805, 9223372036854775806, 9223372036854775807}), "9223372036854775805-9223372036854775807");
}

}  // namespace
}  // namespace prismesh::mesh::report
