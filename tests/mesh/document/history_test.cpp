#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/mesh/document/document_fixture.h"

namespace prismesh::mesh::document {
namespace {

using testing::Contains;
using testing::HasSubstr;

const std::vector<std::string> kEdits{
    R"({"edit":"select","expr":"1-10"})", R"({"edit":"translate","by":[0,0,1.1]})",
    R"({"edit":"grow","rings":2})",       R"({"edit":"lift","distance":0.3})",
    R"({"edit":"lock","on":"1"})",
};

TEST(History, undo_and_redo_are_bit_exact) {
  Document document = make_sheet(30, 30);
  std::vector<std::shared_ptr<const Generation>> states{document.generations[0]};
  for (const std::string& edit : kEdits) {
    must_apply(document, edit);
    states.push_back(document.generations.back());
  }
  for (std::size_t i = states.size(); i-- > 1;) {
    const EditReport report = must_apply(document, R"({"edit":"undo"})");
    EXPECT_EQ(report.edit, "undo");
    EXPECT_THAT(report.notes, Contains("undid " + states[i]->made_by));
    EXPECT_EQ(&document.current(), states[i - 1].get());
    EXPECT_EQ(report.after, states[i - 1]->counts);
  }
  EXPECT_THAT(refusal(document, R"({"edit":"undo"})"), HasSubstr("there is nothing to undo"));
  for (std::size_t i = 1; i < states.size(); ++i) {
    must_apply(document, R"({"edit":"redo"})");
    EXPECT_EQ(&document.current(), states[i].get());
  }
  EXPECT_THAT(refusal(document, R"({"edit":"redo"})"), HasSubstr("there is nothing to redo"));
}

TEST(History, undo_says_how_many_nodes_went_back) {
  Document document = make_sheet(10, 10);
  must_apply(document, R"({"edit":"translate","by":[0,0,1],"on":"5-20","falloff":{"profile":"constant"}})");
  EXPECT_EQ(must_apply(document, R"({"edit":"undo"})").nodes_moved, 16u);
  EXPECT_EQ(must_apply(document, R"({"edit":"redo"})").nodes_moved, 16u);
}

TEST(History, a_new_edit_drops_redo_and_numbers_are_never_reused) {
  Document document = make_sheet(10, 10);
  must_apply(document, kEdits[0]);
  must_apply(document, kEdits[1]);
  EXPECT_EQ(document.current().number, 2u);
  must_apply(document, R"({"edit":"undo"})");
  EXPECT_TRUE(document.can_redo());
  must_apply(document, R"({"edit":"lift","distance":1})");
  EXPECT_FALSE(document.can_redo());
  EXPECT_EQ(document.current().number, 3u);
  EXPECT_EQ(document.current().made_by, "lift");
  EXPECT_EQ(document.generations.size(), 3u);
}

TEST(History, a_failed_edit_leaves_no_trace) {
  Document document = make_sheet(4, 4);
  must_apply(document, kEdits[0]);
  must_apply(document, R"({"edit":"undo"})");
  EXPECT_NE(refusal(document, R"({"edit":"lift","distance":1})"), "");
  EXPECT_TRUE(document.can_redo());
  EXPECT_EQ(document.next_number, 2u);
}

TEST(History, a_target_size_that_is_none_is_refused) {
  for (const double size : {0.0, -1.0, 1e300, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    auto deck = std::make_shared<deck::Deck>();
    OpenOptions options;
    options.target_size = size;
    const Result<Document> document =
        open("model.k", {deck, test::make_grid(2, 2, [](int i, int j) { return Vec3(5.0 * i, 5.0 * j, 0); })}, options);
    ASSERT_FALSE(document) << size;
    EXPECT_EQ(document.error().text(), "the target size must be greater than 0");
  }
}

TEST(History, preparing_changes_nothing) {
  Document document = make_sheet(4, 4);
  const Result<Prepared> prepared = prepare(document, edit_of(kEdits[0]));
  ASSERT_TRUE(prepared);
  EXPECT_EQ(prepared->next->number, 1u);
  EXPECT_EQ(document.generations.size(), 1u);
  EXPECT_TRUE(selected_ids(document).empty());
}

/// Goes on by 3 ms each time it is read.
class SteppingClock final : public Clock {
 public:
  std::int64_t now_ns() override { return now_ns_ += 3'000'000; }

 private:
  std::int64_t now_ns_ = 0;
};

TEST(History, an_edit_takes_the_time_of_the_clock_given) {
  const Document document = make_sheet(4, 4);
  SteppingClock clock;
  EXPECT_EQ(prepare(document, edit_of(kEdits[0]), {}, &clock)->report.milliseconds, 3);
  EXPECT_EQ(prepare(document, edit_of(kEdits[0]))->report.milliseconds, 0);
}

TEST(History, keeps_its_byte_cap_and_says_so) {
  // each step owns a chunk or two of positions and quality: 5 steps fit, no more
  Document probe = make_sheet(10, 10);
  must_apply(probe, R"({"edit":"translate","by":[0,0,1],"on":"5"})");
  const std::size_t step = probe.current().own_bytes;
  Document document = make_sheet(10, 10);
  document.history_bytes = 5 * step + step / 2;
  for (int i = 0; i < 5; ++i) {
    const EditReport report = must_apply(document, R"({"edit":"translate","by":[0,0,1],"on":"5"})");
    EXPECT_THAT(report.notes, testing::Not(Contains(HasSubstr("can't be undone"))));
  }
  EXPECT_EQ(document.generations.size(), 6u);
  const EditReport report = must_apply(document, R"({"edit":"translate","by":[0,0,1],"on":"5"})");
  EXPECT_THAT(report.notes, Contains(HasSubstr("the oldest 1 step can't be undone any more")));
  EXPECT_EQ(document.generations.size(), 6u);
  for (int i = 0; i < 5; ++i) must_apply(document, R"({"edit":"undo"})");
  EXPECT_EQ(document.current().model.positions[4].z(), 1);
  EXPECT_THAT(refusal(document, R"({"edit":"undo"})"), HasSubstr("nothing to undo any more: the oldest steps went"));
}

TEST(History, without_room_for_one_step_the_edit_still_happens) {
  Document document = make_sheet(10, 10);
  document.history_bytes = 0;
  must_apply(document, R"({"edit":"translate","by":[0,0,1],"on":"5"})");
  must_apply(document, R"({"edit":"translate","by":[0,0,1],"on":"5"})");
  EXPECT_EQ(document.generations.size(), 1u);
  EXPECT_EQ(document.current().model.positions[4].z(), 2);
  EXPECT_EQ(document.opened->model.positions[4].z(), 0);
}

}  // namespace
}  // namespace prismesh::mesh::document
