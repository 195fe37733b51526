// Repairs that are cancelled and kept: wherever that happens, what is kept is as valid as a finished repair, one step, and replayed the
// same.
#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/document/edit_json.h"
#include "mesh/document/journal.h"
#include "mesh/document/save.h"
#include "mesh/model/topology_change.h"
#include "tests/mesh/document/document_fixture.h"
#include "tests/mesh/document/restructuring.h"

namespace prismesh::mesh::document {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr auto kRepair = R"({"edit":"repair","scope":"all"})";
constexpr auto kKept = R"({"edit":"repair","scope":"all","on_cancel":"keep"})";

/// A sheet with nodes pulled out of it, as the text of a deck.
std::string bad_sheet(const Folder& folder) {
  Document document = open_text(folder / "flat.k", sheet_deck(8, 6));
  for (const int node : {31}) {
    const std::string on = std::to_string(node);
    must_apply(document, R"({"edit":"translate","by":[1,1,4],"on":")" + on + R"(","falloff":{"profile":"constant"}})");
  }
  EXPECT_TRUE(save(document, folder / "bad.k"));
  return content_of(folder / "bad.k");
}

/// A progress that stops at the `stop`-th call, from 0.
struct Stopping {
  std::size_t stop;
  std::size_t calls = 0;
  Progress discarding() {
    return [this](double) { return calls++ < stop; };
  }
  Progress keeping() {
    return {[this](double) { return calls++ < stop; }, [] { return true; }};
  }
};

std::size_t calls_of_a_whole_repair(const Document& document) {
  std::size_t calls = 0;
  EXPECT_TRUE(prepare(document, edit_of(kRepair), [&](double) { return ++calls > 0; }));
  return calls;
}

/// Calls at which to stop: the first ones, and then more and more sparsely.
std::vector<std::size_t> stops_of(std::size_t calls) {
  std::vector<std::size_t> stops;
  for (std::size_t stop = 0; stop < calls; stop += 1 + stop) stops.push_back(stop);
  return stops;
}

void expect_none_fails_that_did_not(const Generation& before, const Generation& after) {
  for (std::size_t s = 0; s < before.model.shell_count(); ++s)
    if (!after.model.is_removed(ShellIndex(s)) && before.quality[s].grade() != quality::Grade::fail) {
      EXPECT_NE(after.quality[s].grade(), quality::Grade::fail) << "shell " << before.model.shell_ids[s];
    }
}

TEST(StoppedRepair, is_valid_wherever_it_was_stopped_and_undone_whole) {
  const Folder folder;
  const std::string text = bad_sheet(folder);
  const Document opened = open_text(folder / "a.k", text);
  const std::size_t calls = calls_of_a_whole_repair(opened);
  ASSERT_GT(calls, 30u);
  std::size_t in_the_middle = 0;
  for (const std::size_t stop : stops_of(calls)) {
    SCOPED_TRACE("stopped at call " + std::to_string(stop) + " of " + std::to_string(calls));
    Document document = opened;
    Stopping stopping{stop};
    const Result<EditReport> report = apply(document, edit_of(kRepair), stopping.keeping());
    ASSERT_TRUE(report) << report.error().text();
    ASSERT_TRUE(report->stopped);
    EXPECT_EQ(report->stopped->bad_before, report->before.warn + report->before.fail);
    EXPECT_EQ(report->stopped->bad_left, report->after.warn + report->after.fail);
    EXPECT_THAT(report->notes, Contains(HasSubstr("of at most 20 rounds; kept, with ")));
    EXPECT_THAT(report->notes, Not(Contains(HasSubstr("no operation makes it better"))));
    EXPECT_LE(report->after.fail, report->before.fail);
    expect_none_fails_that_did_not(opened.current(), document.current());
    in_the_middle += report->nodes_moved > 0 && report->after.fail > 0 ? 1 : 0;
    ASSERT_TRUE(save(document, folder / "kept.k"));
    const Document again = open_text(folder / "kept.k", content_of(folder / "kept.k"));
    EXPECT_EQ(again.current().counts, document.current().counts) << "the deck holds what was kept";
    must_apply(document, R"({"edit":"undo"})");
    ASSERT_TRUE(save(document, folder / "undone.k"));
    EXPECT_EQ(content_of(folder / "undone.k"), text);
  }
  EXPECT_GT(in_the_middle, 0u) << "no stop came where something was reached and something left";
}

TEST(StoppedRepair, is_replayed_from_its_journal_to_the_same_bytes) {
  const Folder folder;
  const std::string text = bad_sheet(folder);
  const Document opened = open_text(folder / "a.k", text);
  const std::size_t calls = calls_of_a_whole_repair(opened);
  for (const std::size_t stop : stops_of(calls)) {
    SCOPED_TRACE(stop);
    Document document = opened;
    const auto path = folder / ("journal" + std::to_string(stop));
    Result<Journal> journal = Journal::create(path, document);
    ASSERT_TRUE(journal) << journal.error().text();
    Stopping stopping{stop};
    Result<Prepared> prepared = prepare(document, edit_of(kRepair), stopping.keeping());
    ASSERT_TRUE(prepared) << prepared.error().text();
    ASSERT_TRUE(journal->append(document, edit_of(kRepair), *prepared));
    const StoppedRepair stopped = prepared->report.stopped.value();
    commit(document, std::move(*prepared));
    const Result<JournalIntents> intents = read_intents(path);
    ASSERT_TRUE(intents) << intents.error().text();
    ASSERT_EQ(intents->edits.size(), 1u);
    const auto& intent = std::get<Repair>(intents->edits[0]);
    ASSERT_TRUE(intent.stop_at);
    EXPECT_EQ(intent.stop_at->steps, stopped.steps);
    Document replayed = opened;
    const std::vector<ReplayStep> steps = replay(replayed, *intents);
    ASSERT_EQ(steps.size(), 1u);
    EXPECT_TRUE(steps[0].applied) << steps[0].message;
    expect_same(replayed.current(), document.current());
    EXPECT_EQ(replayed.current().model.shell_count(), document.current().model.shell_count());
    EXPECT_EQ(steps[0].report.stopped->bad_left, stopped.bad_left);
  }
}

TEST(StoppedRepair, is_discarded_unless_the_edit_or_the_cancel_says_keep) {
  const Folder folder;
  const Document opened = open_text(folder / "a.k", bad_sheet(folder));
  const std::size_t half = calls_of_a_whole_repair(opened) / 2;
  Document document = opened;
  Stopping first{half}, second{half};
  const Result<EditReport> discarded = apply(document, edit_of(kRepair), first.discarding());
  ASSERT_FALSE(discarded);
  EXPECT_TRUE(is_cancelled(discarded.error()));
  EXPECT_EQ(document.generations.size(), 1u);
  const Result<EditReport> kept = apply(document, edit_of(kKept), second.discarding());
  ASSERT_TRUE(kept) << kept.error().text();
  EXPECT_TRUE(kept->stopped);
  EXPECT_EQ(document.generations.size(), 2u);
}

TEST(StoppedRepair, a_finished_one_says_nothing_of_it) {
  const Folder folder;
  Document document = open_text(folder / "a.k", bad_sheet(folder));
  EXPECT_FALSE(must_apply(document, kKept).stopped);
}

TEST(StoppedRepair, says_round_and_bad_elements_while_it_runs) {
  const Folder folder;
  const Document document = open_text(folder / "a.k", bad_sheet(folder));
  std::vector<std::string> said;
  const Progress listener = [&](double, const Doing& doing) {
    if (doing && (said.empty() || said.back() != doing())) said.push_back(doing());
    return true;
  };
  ASSERT_TRUE(prepare(document, edit_of(kRepair), listener));
  const std::string bad = std::to_string(document.current().counts.warn + document.current().counts.fail);
  ASSERT_GT(said.size(), 3u);
  EXPECT_EQ(said.front(), "round 1, " + bad + " of " + bad + " bad elements left");
  EXPECT_THAT(said, Contains(HasSubstr("round 2, ")));
}

TEST(StoppedRepair, stop_at_is_an_object_with_both_fields) {
  const auto refused = [](const std::string& field) {
    const Result<Edit> edit = parse_edit(R"({"edit":"repair",)" + field + "}");
    return edit ? "accepted" : edit.error().message;
  };
  EXPECT_EQ(refused(R"("stop_at":{"attempt":2,"steps":[7,0]})"), "accepted");
  EXPECT_THAT(refused(R"("stop_at":7)"), HasSubstr(R"("stop_at" must be an object like {"attempt": 1, "steps": [532]})"));
  EXPECT_THAT(refused(R"("stop_at":{"attempt":1})"), HasSubstr("steps"));
  EXPECT_THAT(refused(R"("stop_at":{"attempt":1001,"steps":[1]})"), HasSubstr("a whole number between 1 and 1000"));
  EXPECT_THAT(refused(R"("stop_at":{"attempt":1,"steps":[-1]})"), HasSubstr("a list of 1 to 1000000 whole numbers"));
  EXPECT_THAT(refused(R"("on_cancel":"kep")"), HasSubstr("on_cancel"));
  EXPECT_THAT(refused(R"("on_cancel":"kep")"), HasSubstr("keep"));
  EXPECT_THAT(refused(R"("on_cancel":true)"), HasSubstr("on_cancel"));
}

}  // namespace
}  // namespace prismesh::mesh::document
