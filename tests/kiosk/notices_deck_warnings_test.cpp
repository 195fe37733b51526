// How a deck's warnings are put before the user.
#include "kiosk/notices/deck_warnings.h"

#include <gtest/gtest.h>

namespace prismesh::kiosk::notices {
namespace {

TEST(DeckWarningsTest, what_the_model_lacks_goes_first_and_all_are_there_with_their_places) {
  const std::vector<mesh::deck::Warning> warnings{{"car.k", 7, "unread-card", "a card nobody knows", 3},
                                                  {"car.k", 12, "missing-include", "the include file lost.k is missing", 1},
                                                  {"door.k", 0, "unused-part", "no element names part 5", 1}};
  const std::vector<ToldWarning> told = told_warnings(warnings);
  ASSERT_EQ(told.size(), 3U);
  EXPECT_TRUE(told[0].is_error);
  EXPECT_EQ(told[0].place, "car.k:12");
  EXPECT_FALSE(told[1].is_error);
  EXPECT_EQ(told[1].text, "a card nobody knows (3 times)");
  EXPECT_EQ(told[2].place, "door.k");
  EXPECT_EQ(counts_of(told), "1 error and 2 warnings");
}

TEST(DeckWarningsTest, counts_name_only_what_there_is) {
  EXPECT_EQ(counts_of(std::vector<ToldWarning>{{true, "", ""}}), "1 error");
  EXPECT_EQ(counts_of(std::vector<ToldWarning>{{false, "", ""}, {false, "", ""}}), "2 warnings");
}

}  // namespace
}  // namespace prismesh::kiosk::notices
