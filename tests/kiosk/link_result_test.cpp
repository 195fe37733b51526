// The line of the last edit goes when the edit is undone, by whomever.
#include <gtest/gtest.h>

#include "kiosk/link/link_notices.h"

namespace prismesh::kiosk::link {
namespace {

TEST(LastResult, is_forgotten_when_a_state_before_it_is_shown) {
  DocumentNumber number;
  number.follow("/decks/car.k");
  LinkNotices notices(number, notices::Trace(nullptr));
  mesh::document::EditReport report;
  report.edit = "lift";
  report.nodes_moved = 3;
  notices.tell_edit("Lifted 2 mm", report, "mm", 7);
  const std::string words = notices.result();
  EXPECT_FALSE(words.empty());
  notices.follow_state(6, false);
  EXPECT_EQ(notices.result(), words) << "its own state is still on the way";
  notices.follow_state(7, false);
  notices.follow_state(8, false);
  EXPECT_EQ(notices.result(), words) << "a later edit of another client";
  notices.follow_state(6, true);
  EXPECT_EQ(notices.result(), "") << "undone";
  report.edit = "undo";
  notices.tell_edit("", report, "mm", 6);
  notices.follow_state(6, true);
  EXPECT_FALSE(notices.result().empty()) << "what the undo itself did stays";
}

}  // namespace
}  // namespace prismesh::kiosk::link
