// The order in which the user reads what there is to say, and what is left out.
#include "kiosk/notices/notices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prismesh::kiosk::notices {
namespace {

using Kind = Notice::Kind;

std::vector<std::string> in_order(Notices notices) {
  std::vector<std::string> texts;
  for (; !notices.empty(); notices.read()) texts.push_back(notices.front().text);
  return texts;
}

TEST(NoticesTest, errors_come_first_then_warnings_then_information) {
  Notices notices{Trace(nullptr)};
  for (const char* text : {"first warning", "second warning"}) notices.take({Kind::warning, text});
  for (const char* text : {"first error", "second error"}) notices.take({Kind::error, text});
  notices.take({Kind::information, "information"});
  EXPECT_THAT(in_order(notices), testing::ElementsAre("first error", "second error", "first warning", "second warning", "information"));
  notices.take({Kind::information, "newer"});
  EXPECT_EQ(in_order(notices).back(), "newer");
  EXPECT_EQ(notices.count(), 5U) << "information gives way";
}

TEST(NoticesTest, what_speaks_of_a_document_that_is_closed_goes) {
  Notices notices{Trace(nullptr)};
  notices.follow(1);
  notices.say(Kind::error, "of the first");
  notices.take({Kind::warning, "of none", 0});
  notices.take({Kind::warning, "of the second, said early", 2});
  notices.follow(2);
  notices.take({Kind::error, "of the first, said late", 1});
  EXPECT_THAT(in_order(notices), testing::ElementsAre("of none", "of the second, said early"));
}

TEST(NoticesTest, reading_the_list_reads_the_notice_that_names_it) {
  Notices notices{Trace(nullptr)};
  notices.take({Kind::error, "the worst of the deck", 0, true});
  notices.take({Kind::warning, "another"});
  notices.read_warnings();
  EXPECT_THAT(in_order(notices), testing::ElementsAre("another"));
}

}  // namespace
}  // namespace prismesh::kiosk::notices
