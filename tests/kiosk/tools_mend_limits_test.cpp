// The limits of relaxing and repairing as they are typed.
#include <gtest/gtest.h>

#include "kiosk/tools/quality/set_limit.h"

namespace prismesh::kiosk::tools::quality {
namespace {

TEST(MendLimitsTest, a_number_sets_its_limit_alone_and_nothing_takes_it_away) {
  MendLimits limits;
  limits = *with_limit(limits, MendLimit::sheet, "3");
  limits = *with_limit(limits, MendLimit::line, " 0 ");
  limits = *with_limit(limits, MendLimit::threshold, "0.25");
  EXPECT_EQ(limits.max_move.free, 3);
  EXPECT_EQ(limits.max_move.line, 0) << "nodes on lines stay";
  EXPECT_EQ(limits.threshold, 0.25);
  EXPECT_EQ(typed_limit(limits, MendLimit::threshold), "0.25") << "the field begins with the number as it is";
  limits = *with_limit(limits, MendLimit::sheet, "  ");
  EXPECT_FALSE(limits.max_move.free);
  EXPECT_EQ(typed_limit(limits, MendLimit::sheet), "");
  EXPECT_EQ(limits.max_move.line, 0);
  EXPECT_EQ(limits.threshold, 0.25);
}

TEST(MendLimitsTest, what_the_edit_would_refuse_is_refused_while_it_is_typed) {
  for (const MendLimit which : {MendLimit::sheet, MendLimit::line, MendLimit::threshold})
    for (const char* text : {"-1", "1 2", "far", "nan"}) EXPECT_FALSE(with_limit({}, which, text)) << title_of(which) << ": " << text;
  for (const MendLimit which : {MendLimit::sheet, MendLimit::threshold}) {
    const auto refused = with_limit({}, which, "0");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message, "type one number greater than 0, or nothing");
  }
}

}  // namespace
}  // namespace prismesh::kiosk::tools::quality
