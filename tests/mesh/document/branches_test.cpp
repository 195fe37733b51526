#include "mesh/document/branches.h"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/json/write.h"
#include "mesh/document/edit_json.h"
#include "mesh/document/journal.h"
#include "tests/mesh/document/document_fixture.h"
#include "tests/mesh/document/journal_session.h"
#include "tests/support/seed.h"

namespace prismesh::mesh::document {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

const char* const kUndo = R"({"edit":"undo"})";
const char* const kRedo = R"({"edit":"redo"})";

std::string branch(std::uint64_t number) { return R"({"edit":"branch","number":)" + std::to_string(number) + "}"; }

std::string lift_by(double distance) { return R"({"edit":"lift","distance":)" + std::to_string(distance) + R"(,"on":"1-3"})"; }

/// Two lifts, undone, and another in their place.
const std::vector<std::string> kForked{lift_by(0.1), lift_by(0.2), lift_by(0.3), kUndo, kUndo, lift_by(0.4)};

std::vector<std::uint64_t> numbers_of(std::span<const std::shared_ptr<const Generation>> states) {
  std::vector<std::uint64_t> numbers;
  for (const auto& state : states) numbers.push_back(state->number);
  return numbers;
}

Document forked() {
  Document document = small();
  for (const std::string& edit : kForked) must_apply(document, edit);
  return document;
}

void go_to(Document& document, std::uint64_t generation) {
  const Result<std::vector<Edit>> way = way_to(document, generation);
  ASSERT_TRUE(way) << way.error().text();
  for (const Edit& edit : *way) {
    const Result<EditReport> done = apply(document, edit);
    ASSERT_TRUE(done) << done.error().text();
  }
  ASSERT_EQ(document.current().number, generation);
}

void expect_same_branches(const Document& a, const Document& b) {
  ASSERT_EQ(a.branches.size(), b.branches.size());
  for (std::size_t i = 0; i < a.branches.size(); ++i) {
    EXPECT_EQ(a.branches[i].number, b.branches[i].number);
    EXPECT_EQ(a.branches[i].fork, b.branches[i].fork);
    ASSERT_EQ(a.branches[i].states.size(), b.branches[i].states.size());
    for (std::size_t k = 0; k < a.branches[i].states.size(); ++k) expect_same(*a.branches[i].states[k], *b.branches[i].states[k]);
  }
  EXPECT_EQ(a.next_branch, b.next_branch);
}

TEST(Branches, an_edit_keeps_what_was_undone_as_a_branch) {
  const Document document = forked();
  ASSERT_EQ(document.branches.size(), 1u);
  EXPECT_EQ(document.branches[0].number, 1u);
  EXPECT_EQ(document.branches[0].fork, 1u);
  EXPECT_THAT(numbers_of(document.branches[0].states), ElementsAre(2, 3));
  EXPECT_THAT(numbers_of(document.generations), ElementsAre(0, 1, 4));
}

TEST(Branches, undone_selections_alone_are_no_branch) {
  Document document = small();
  must_apply(document, R"({"edit":"select","expr":"1"})");
  must_apply(document, kUndo);
  must_apply(document, lift_by(1));
  EXPECT_TRUE(document.branches.empty());
}

TEST(Branches, a_branch_comes_back_to_the_bit_and_what_it_replaces_becomes_one) {
  Document document = forked();
  const Document before = document;
  must_apply(document, kUndo);
  EXPECT_THAT(must_apply(document, branch(1)).notes, Contains("redo now leads to branch 1"));
  EXPECT_EQ(document.current().number, 1u) << "the step itself changes nothing";
  must_apply(document, kRedo);
  must_apply(document, kRedo);
  EXPECT_EQ(&document.current(), before.branches[0].states[1].get());
  ASSERT_EQ(document.branches.size(), 1u);
  EXPECT_EQ(document.branches[0].number, 2u);
  EXPECT_EQ(&*document.branches[0].states[0], before.generations[2].get());
  go_to(document, 4);
  EXPECT_EQ(&document.current(), before.generations[2].get());
}

TEST(Branches, a_branch_is_taken_from_its_fork_only) {
  Document document = forked();
  EXPECT_EQ(refusal(document, branch(1)), "branch 1 leaves from state 1: undo or redo to that state first");
  EXPECT_EQ(refusal(document, branch(7)), "the history has no branch 7");
  EXPECT_THAT(way_to(document, 99).error().message, HasSubstr("no state 99"));
}

TEST(Branches, a_branch_of_a_branch_is_reached_through_both) {
  Document document = forked();
  go_to(document, 2);  // within branch 1
  must_apply(document, lift_by(0.5));
  ASSERT_EQ(document.current().number, 5u);
  go_to(document, 4);
  const auto find = [&](std::uint64_t number) {
    return std::ranges::any_of(document.branches, [&](const Branch& each) {
      return std::ranges::any_of(each.states, [&](const auto& state) { return state->number == number; });
    });
  };
  EXPECT_TRUE(find(5) && find(3) && find(2));
  for (const std::uint64_t target : {3, 4, 5, 0, 3, 5}) go_to(document, target);
  EXPECT_EQ(
      document.generations.size() +
          [&] {
            std::size_t aside = 0;
            for (const Branch& each : document.branches) aside += each.states.size();
            return aside;
          }(),
      6u)
      << "no state is lost or doubled";
}

TEST(Branches, every_state_stays_within_reach_and_the_journal_brings_all_back) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(test::seed(seed));
    const Folder folder;
    Document document = small();
    Result<Journal> journal = Journal::create(folder / "a.journal", document);
    ASSERT_TRUE(journal);
    std::vector<std::shared_ptr<const Generation>> made;
    for (int step = 0; step < 60; ++step) {
      std::vector<std::string> edits{random() % 3 == 0 ? R"({"edit":"hide","on":"1"})" : lift_by(0.001 * (step + 1))};
      if (random() % 2 == 0 && document.can_undo()) edits = {kUndo};
      if (random() % 4 == 0 && !made.empty()) {
        edits.clear();
        const Result<std::vector<Edit>> way = way_to(document, made[random() % made.size()]->number);
        ASSERT_TRUE(way) << way.error().text();
        for (const Edit& each : *way) edits.push_back(json::to_line(edit_to_json(each)));
      }
      for (const std::string& edit : edits) {
        const std::uint64_t next = document.next_number;
        ASSERT_TRUE(work(document, *journal, edit)) << edit;
        if (document.next_number > next) made.push_back(document.generations[document.cursor]);
      }
    }
    EXPECT_GT(document.branches.size(), 2u);
    for (const auto& state : made) {
      Document there = document;
      go_to(there, state->number);
      EXPECT_EQ(&there.current(), state.get());
    }
    journal = Journal::create(folder / "b.journal", small());  // lets go of the first
    Document recovered = small();
    ASSERT_TRUE(Journal::recover(folder / "a.journal", recovered));
    expect_same(recovered, document);
    expect_same_branches(recovered, document);
    // The intents alone give the same.
    Document again = small();
    const Result<JournalIntents> intents = read_intents(folder / "a.journal");
    ASSERT_TRUE(intents);
    for (const ReplayStep& step : replay(again, *intents)) ASSERT_TRUE(step.applied) << step.line << ": " << step.message;
    expect_same(again, document);
    expect_same_branches(again, document);
  }
}

TEST(Branches, the_oldest_go_first_when_the_history_is_full) {
  Document document = forked();
  must_apply(document, kUndo);
  must_apply(document, lift_by(0.5));
  ASSERT_EQ(document.branches.size(), 2u);
  std::size_t all = 0;
  for (std::size_t i = 1; i < document.generations.size(); ++i) all += document.generations[i]->own_bytes;
  for (const Branch& each : document.branches) all += bytes_of(each.states);
  document.history_bytes = all + document.current().own_bytes - 1;  // one step more is a byte too many
  const EditReport report = must_apply(document, lift_by(0.6));
  EXPECT_THAT(report.notes, Contains(HasSubstr("the oldest branch of the history went")));
  ASSERT_EQ(document.branches.size(), 1u);
  EXPECT_EQ(document.branches[0].number, 2u);
  EXPECT_EQ(document.generations.size(), 4u) << "no step goes as long as there are branches";
  document.history_bytes = 0;
  must_apply(document, lift_by(0.7));
  EXPECT_TRUE(document.branches.empty()) << "a branch whose fork has gone goes with it";
}

TEST(Branches, what_was_dropped_is_dropped_again_by_the_journal) {
  Document document = small();
  const Folder folder;
  {
    Result<Journal> journal = Journal::create(folder / "a.journal", document);
    ASSERT_TRUE(journal);
    for (const std::string& edit : kForked) ASSERT_TRUE(work(document, *journal, edit));
    document.history_bytes = document.generations[1]->own_bytes + 2 * document.generations[2]->own_bytes;
    ASSERT_TRUE(work(document, *journal, lift_by(0.5)));
  }
  ASSERT_TRUE(document.branches.empty());
  Document recovered = small();  // with room for all
  ASSERT_TRUE(Journal::recover(folder / "a.journal", recovered));
  expect_same(recovered, document);
  expect_same_branches(recovered, document);
}

TEST(Branches, replay_leaves_out_a_branch_whose_edits_it_could_not_apply) {
  const Folder folder;
  const auto path = folder / "script.jsonl";
  std::string script;
  const std::vector<std::string> edits{
      lift_by(0.1), R"({"edit":"lift","distance":1,"on":"node:999"})", kUndo, lift_by(0.4), kUndo, branch(1), kRedo, lift_by(0.5)};
  for (const std::string& edit : edits) script += edit + "\n";
  put_content(path, script);
  const Result<JournalIntents> intents = read_intents(path);
  ASSERT_TRUE(intents);
  Document document = small();
  const std::vector<ReplayStep> steps = replay(document, *intents);
  ASSERT_EQ(steps.size(), edits.size());
  EXPECT_FALSE(steps[5].applied);
  EXPECT_EQ(steps[5].message, "branch 1 isn't there, or not all its edits");
  EXPECT_FALSE(steps[6].applied) << "redo doesn't bring back what the branch replaced";
  EXPECT_TRUE(steps[7].applied);
  Document expected = small();
  must_apply(expected, lift_by(0.1));
  must_apply(expected, lift_by(0.5));
  EXPECT_TRUE(moved_nodes(document.current().model, expected.current().model).empty());
}

}  // namespace
}  // namespace prismesh::mesh::document
