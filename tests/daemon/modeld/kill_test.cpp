// Kills modeld at random moments while it edits and saves: no acknowledged edit may be lost, and at most the edit in progress may have been
// applied. PRISMESH_KILL_CYCLES raises the number of kills.
#include <cstdlib>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "tests/daemon/modeld/restartable_daemon.h"
#include "tests/support/seed.h"

namespace prismesh::modeld {
namespace {

using namespace std::chrono_literals;
using namespace mesh::document;
using test::Folder;

constexpr auto kKillPatience = 90s;
constexpr std::int64_t kNodes = test::kSheetSide * test::kSheetSide;

using Heights = std::vector<double>;

/// The expected document: the heights of its nodes now and, to check an undo, before the last edit.
struct Expected {
  Heights now;
  std::optional<Heights> before;  ///< nothing: the result of an undo isn't known (a restart after a save may discard the history)
};

class Killing : public ::testing::Test {
 protected:
  Heights heights() {
    const auto view = runs_.client().snapshot();
    if (!view) {
      ADD_FAILURE() << view.error().text();
      return {};
    }
    Heights all;
    for (std::size_t n = 0; n < (*view)->node_count(); ++n) all.push_back((*view)->position(n).z());
    return all;
  }

  /// Compares up to the digits that the deck's columns can't hold after a save.
  static bool same(const Heights& a, const Heights& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
      if (std::abs(a[i] - b[i]) > 1e-6) return false;
    return true;
  }

  struct Step {
    std::vector<ipc::Request> requests;  ///< all must be acknowledged
    bool drag = false;
    Expected after;
  };

  Step random_step(const Expected& expected) {
    Step step;
    const unsigned kind = random_() % 16;
    if (kind == 0) {
      step.requests.emplace_back(ipc::Save{});
      step.after = {expected.now, std::nullopt};
      return step;
    }
    if (kind < 3 && expected.before) {
      step.requests.emplace_back(ipc::ApplyEdit{Undo{}});
      step.after = {*expected.before, std::nullopt};
      return step;
    }
    const std::int64_t node = static_cast<std::int64_t>(random_() % kNodes);
    Translate translate;
    translate.by = {0, 0, 0.25 * (1 + static_cast<double>(random_() % 8))};
    translate.shaping.on = std::to_string(test::kFirstNode + node);
    step.after = {expected.now, expected.now};
    step.after.now[static_cast<std::size_t>(node)] += translate.by.z();
    step.drag = kind < 6;
    step.requests.emplace_back(step.drag ? ipc::Request(ipc::BeginDrag{translate}) : ipc::Request(ipc::ApplyEdit{translate}));
    return step;
  }

  /// Returns false if the daemon has ended before it acknowledged the step.
  bool take(ipc::Client& client, const Step& step) {
    const auto answer = client.call(step.requests.front(), kKillPatience);
    if (!answer) {
      if (answer.error().message.find("is gone") == std::string::npos) ADD_FAILURE() << answer.error().text();
      return false;
    }
    if (!step.drag) return true;
    const auto& begun = std::get<ipc::DragBegun>(*answer);
    const auto& translate = std::get<Translate>(std::get<ipc::BeginDrag>(step.requests.front()).edit);
    for (std::uint64_t i = 1; i <= 4; ++i)
      if (!client.send(ipc::DragStep{begun.drag, i, {0, 0, translate.by.z() * static_cast<double>(i) / 4}, 0})) return false;
    return client.call(ipc::CommitDrag{begun.drag}, kKillPatience).has_value();
  }

  Folder folder_;
  test::RestartableDaemon runs_{folder_, folder_.sheet()};
  std::mt19937 random_{test::seed(20040601)};
};

int cycles() {
  const char* wanted = std::getenv("PRISMESH_KILL_CYCLES");
  return wanted != nullptr && std::atoi(wanted) > 0 ? std::atoi(wanted) : 60;
}

TEST_F(Killing, no_acknowledged_edit_is_lost) {
  const std::string original = test::whole_file(runs_.deck());
  runs_.start();
  runs_.wait_until_open();
  Expected expected{heights(), std::nullopt};
  std::size_t acknowledged = 0, done_unacknowledged = 0, lost_under_way = 0;
  for (int cycle = 0; cycle < cycles() && !HasFailure(); ++cycle) {
    const auto life = std::chrono::microseconds(random_() % (cycle % 4 == 0 ? 10'000 : 120'000));
    std::thread killer([&] {
      std::this_thread::sleep_for(life);
      runs_.send_kill();
    });
    Step step;
    for (;;) {
      step = random_step(expected);
      if (!take(runs_.client(), step)) break;
      expected = step.after;
      ++acknowledged;
    }
    killer.join();
    runs_.wait_for_end();

    runs_.start();
    if (cycle % 10 == 9) {  // once more while it opens the deck again
      std::this_thread::sleep_for(std::chrono::microseconds(random_() % 60'000));
      runs_.send_kill();
      runs_.wait_for_end();
      runs_.start();
    }
    runs_.wait_until_open();
    const Heights found = heights();
    if (same(found, expected.now)) {
      ++lost_under_way;
    } else if (same(found, step.after.now)) {
      ++done_unacknowledged;
    } else {
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < found.size() && i < expected.now.size(); ++i) wrong += std::abs(found[i] - expected.now[i]) > 1e-6;
      ADD_FAILURE() << "cycle " << cycle << ": after " << acknowledged << " acknowledged steps " << wrong << " nodes are elsewhere";
    }
    expected = {found, std::nullopt};
  }
  std::printf("%d kills, %zu steps acknowledged and kept, %zu done without an answer, %zu under way left out\n", cycles(), acknowledged,
              done_unacknowledged, lost_under_way);
  EXPECT_GT(acknowledged, static_cast<std::size_t>(cycles())) << "too few edits to mean anything";

  // The deck then differs only in the lines of the moved nodes.
  const auto saved = runs_.client().call(ipc::Save{}, kKillPatience);
  ASSERT_TRUE(saved) << saved.error().text();
  const std::string edited = test::whole_file(runs_.deck());
  const auto before = test::nodes_of_deck(original);
  const auto after = test::nodes_of_deck(edited);
  std::vector<std::int64_t> moved;
  for (const auto& [id, point] : after) {
    const auto index = static_cast<std::size_t>(id - test::kFirstNode);
    EXPECT_NEAR(point[2], expected.now[index], 1e-6) << "node " << id;
    if (point != before.at(id)) moved.push_back(id);
  }
  const test::DeckDifference difference = test::compare_decks(original, edited);
  EXPECT_TRUE(difference.same_line_count);
  EXPECT_TRUE(difference.other_changes.empty());
  EXPECT_EQ(difference.nodes, moved);
  runs_.end_in_order();
}

}  // namespace
}  // namespace prismesh::modeld
