#include "kiosk/link/server_progress.h"

#include <gtest/gtest.h>

namespace prismesh::kiosk::link {
namespace {

TEST(ServerProgressTest, is_over_with_the_last_answer_a_state_or_the_whole_of_it) {
  ServerProgress progress;
  progress.asked();
  progress.asked();
  EXPECT_FALSE(progress.can_stop()) << "the server has told nothing: it doesn't take long";
  progress.heard(ipc::ProgressMade{"save", 0.25});
  EXPECT_EQ(progress.fraction(), 0.25);
  EXPECT_TRUE(progress.can_stop());
  progress.answered();
  EXPECT_TRUE(progress.can_stop());
  progress.answered();
  EXPECT_TRUE(progress.words().empty());
  EXPECT_FALSE(progress.works_for_us());

  for (const ipc::Event& end :
       {ipc::Event(ipc::GenerationPublished{}), ipc::Event(ipc::DocumentOpened{}), ipc::Event(ipc::ProgressMade{"save", 1})}) {
    progress.heard(ipc::ProgressMade{"save", 0.5});
    EXPECT_FALSE(progress.words().empty());
    EXPECT_FALSE(progress.can_stop()) << "it is another client's";
    progress.heard(end);
    EXPECT_TRUE(progress.words().empty());
  }
}

TEST(ServerProgressTest, keeps_the_name_of_the_deck_that_is_being_opened) {
  ServerProgress progress;
  progress.begin_opening("a.k");
  progress.asked();
  progress.heard(ipc::ProgressMade{"open", 0.5});
  EXPECT_EQ(progress.words(), "Opening a.k ..   Esc stops it");
  EXPECT_EQ(progress.fraction(), 0.5);
  progress.lost();
  EXPECT_TRUE(progress.words().empty());
  EXPECT_FALSE(progress.works_for_us());
}

}  // namespace
}  // namespace prismesh::kiosk::link
