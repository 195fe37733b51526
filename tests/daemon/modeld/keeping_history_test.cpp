// Going to any state of the history and its branches, across saves and restarts.
#include <cmath>

#include <gtest/gtest.h>

#include "daemon/modeld/document_keeper.h"
#include "tests/daemon/modeld/folder.h"

namespace prismesh::modeld {
namespace {

namespace fs = std::filesystem;
using namespace mesh::document;

class KeepingHistory : public ::testing::Test {
 protected:
  DocumentKeeper keeper() const { return DocumentKeeper(StateFolder(folder_.state())); }
  static ipc::Open request(const fs::path& deck) {
    ipc::Open open;
    open.path = deck.string();
    return open;
  }
  static Edit move_edit(std::int64_t id, double by) {
    Translate translate;
    translate.by = {0, 0, by};
    translate.shaping.on = std::to_string(id);
    return translate;
  }
  static double height(const DocumentKeeper& keeper, std::int64_t id) {
    const mesh::Model& model = keeper.document().current().model;
    return model.position(model.find_node(id)).z();
  }
  test::Folder folder_;
};

TEST_F(KeepingHistory, what_an_edit_gives_up_is_a_branch_after_a_restart_too) {
  const fs::path deck = folder_.sheet();
  std::vector<double> heights;
  {
    DocumentKeeper first = keeper();
    ASSERT_TRUE(first.open(request(deck), {}));
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(first.edit(move_edit(1313, 0.25 * (i + 1))));
    heights.push_back(height(first, 1313));
    ASSERT_TRUE(first.go_to(1));
    ASSERT_TRUE(first.edit(move_edit(1313, 8)));  // gives up 2 and 3
    heights.push_back(height(first, 1313));
    const Result<EditReport> report = first.go_to(3);
    ASSERT_TRUE(report) << report.error().text();
    EXPECT_EQ(report->notes, std::vector<std::string>{"undid 1 step, did again: 2 steps"});
    EXPECT_EQ(report->nodes_moved, 1U);
    EXPECT_EQ(height(first, 1313), heights[0]);
  }  // as if killed
  DocumentKeeper second = keeper();
  ASSERT_TRUE(second.reopen({}));
  EXPECT_EQ(height(second, 1313), heights[0]);
  ASSERT_EQ(second.document().branches.size(), 1U);
  ASSERT_TRUE(second.go_to(4));
  EXPECT_EQ(height(second, 1313), heights[1]);
  ASSERT_TRUE(second.go_to(3));
  EXPECT_EQ(height(second, 1313), heights[0]);
}

TEST_F(KeepingHistory, a_repair_that_found_nothing_to_do_is_no_state_and_no_record) {
  const fs::path deck = folder_.sheet();
  DocumentKeeper keeper = this->keeper();
  ASSERT_TRUE(keeper.open(request(deck), {}));
  ASSERT_TRUE(keeper.edit(move_edit(1313, 0.001)));
  ASSERT_TRUE(keeper.go_to(0));
  const Result<EditReport> report = keeper.edit(Repair{});
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_EQ(report->notes, std::vector<std::string>{"nothing to repair: no edit made an element fail or warn"});
  EXPECT_EQ(keeper.state().journalled_edits, 2U);
  EXPECT_EQ(keeper.document().current().number, 0U);
  EXPECT_TRUE(keeper.state().can_redo) << "nor does it set aside what was undone";
}

TEST_F(KeepingHistory, a_branch_from_before_a_save_is_gone_to_and_a_restart_knows_it) {
  const fs::path deck = folder_.sheet();
  double lifted = 0;
  {
    DocumentKeeper first = keeper();
    ASSERT_TRUE(first.open(request(deck), {}));
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(first.edit(move_edit(1313, 0.25 * (i + 1))));
    lifted = height(first, 1313);
    ASSERT_TRUE(first.go_to(1));
    ASSERT_TRUE(first.edit(move_edit(1313, 8)));
    ASSERT_TRUE(first.save(std::nullopt, {}));
    ASSERT_TRUE(first.edit(move_edit(1314, 8)));
    ASSERT_TRUE(first.go_to(3));
    EXPECT_EQ(height(first, 1313), lifted);
    EXPECT_EQ(first.document().branches.size(), 1U) << "with the saved state";
  }
  DocumentKeeper second = keeper();
  ASSERT_TRUE(second.reopen({}));
  EXPECT_EQ(height(second, 1313), lifted);
}

TEST_F(KeepingHistory, any_state_can_be_gone_to_across_a_save_and_a_restart_knows_it) {
  const fs::path deck = folder_.sheet();
  std::vector<std::uint64_t> numbers;
  std::vector<double> heights;
  double expected = 0;
  {
    DocumentKeeper first = keeper();
    ASSERT_TRUE(first.open(request(deck), {}));
    const auto remember = [&] {
      numbers.push_back(first.document().current().number);
      heights.push_back(height(first, 1313));
    };
    remember();
    for (int i = 0; i < 4; ++i) {
      if (i == 2) {
        ASSERT_TRUE(first.save(std::nullopt, {}));
      }
      ASSERT_TRUE(first.edit(move_edit(1313, 0.25 * (i + 1))));
      remember();
    }
    EXPECT_EQ(first.go_to(99, {}).error().message, "the history has no state 99 any more");
    for (const std::size_t to : {0U, 4U, 1U, 3U, 3U, 2U}) {
      const std::size_t steps = first.document().cursor > to ? first.document().cursor - to : to - first.document().cursor;
      const std::uint64_t records = first.state().journalled_edits;
      const double before = height(first, 1313);
      const Result<EditReport> report = first.go_to(numbers[to], {});
      ASSERT_TRUE(report) << report.error().text();
      EXPECT_EQ(first.document().current().number, numbers[to]);
      EXPECT_EQ(height(first, 1313), heights[to]);
      EXPECT_EQ(report->nodes_moved, steps == 0 ? 0U : 1U);
      EXPECT_NEAR(report->largest_move.value_or(0), std::abs(heights[to] - before), 1e-12);
      EXPECT_EQ(first.state().journalled_edits, records + steps);
      EXPECT_EQ(first.state().generations.size(), 5U) << "nothing is lost";
    }
    ASSERT_TRUE(first.go_to(numbers[1], {}));
    expected = heights[1];
    int asked = 0;
    const Result<EditReport> stopped = first.go_to(numbers[4], [&](double, const Doing&) { return ++asked < 3; });
    ASSERT_TRUE(stopped) << "it stays where it has come";
    EXPECT_EQ(first.document().current().number, numbers[3]);
    EXPECT_EQ(stopped->notes, (std::vector<std::string>{"did again: 2 steps", "stopped after 2 of 3 steps"}));
    ASSERT_TRUE(first.go_to(numbers[1], {}));
  }  // as if killed
  DocumentKeeper second = keeper();
  ASSERT_TRUE(second.reopen({}));
  EXPECT_EQ(height(second, 1313), expected);
}

}  // namespace
}  // namespace prismesh::modeld
