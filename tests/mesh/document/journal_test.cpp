#include "mesh/document/journal.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/mesh/document/journal_session.h"

namespace prismesh::mesh::document {
namespace {

using testing::HasSubstr;

TEST(Journal, brings_back_every_generation) {
  const Session session;
  Document document = small();
  const Result<Journal> journal = Journal::recover(session.path, document);
  ASSERT_TRUE(journal) << journal.error().text();
  EXPECT_EQ(journal->records(), kSession.size());
  EXPECT_FALSE(journal->cut_torn_tail());
  expect_same(document, session.after.back());
  while (document.can_undo()) must_apply(document, R"({"edit":"undo"})");
  expect_same(document.current(), *session.after.front().opened);
}

TEST(Journal, goes_on_after_recovery) {
  const Session session;
  Document expected = session.after.back();
  {
    Document document = small();
    Result<Journal> journal = Journal::recover(session.path, document);
    ASSERT_TRUE(journal);
    for (const char* edit : {R"({"edit":"undo"})", R"({"edit":"translate","by":[0,0,-1],"on":"all"})"}) {
      ASSERT_TRUE(work(document, *journal, edit));
      must_apply(expected, edit);
    }
  }
  Document document = small();
  ASSERT_TRUE(Journal::recover(session.path, document));
  expect_same(document, expected);
}

TEST(Journal, cut_anywhere_gives_exactly_the_acknowledged_prefix) {
  const Session session;
  const std::string whole = content_of(session.path);
  const std::filesystem::path cut = session.folder / "cut.journal";
  std::size_t records = 0;
  for (std::size_t size = session.bytes.front(); size <= whole.size(); ++size) {
    while (records + 1 < session.bytes.size() && session.bytes[records + 1] <= size) ++records;
    put_content(cut, whole.substr(0, size));
    Document document = small();
    const Result<Journal> journal = Journal::recover(cut, document);
    ASSERT_TRUE(journal) << "cut at " << size << ": " << journal.error().text();
    ASSERT_EQ(journal->records(), records) << "cut at " << size;
    ASSERT_EQ(journal->cut_torn_tail(), size != session.bytes[records]);
    ASSERT_EQ(std::filesystem::file_size(cut), session.bytes[records]);
    expect_same(document, session.after[records]);
    if (HasFailure()) FAIL() << "cut at " << size;
  }
  EXPECT_EQ(records, kSession.size());
}

TEST(Journal, a_cut_header_is_damage) {
  const Session session;
  const std::string whole = content_of(session.path);
  for (std::size_t size = 0; size < session.bytes.front(); ++size) {
    put_content(session.path, whole.substr(0, size));
    Document document = small();
    ASSERT_FALSE(Journal::recover(session.path, document)) << size;
  }
}

TEST(Journal, every_flipped_byte_is_found_and_what_is_before_it_is_brought_back) {
  const Session session({kSession[0], kSession[1], kSession[4]});
  const std::string whole = content_of(session.path);
  const std::size_t last = session.bytes[2];
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (const int flip : {0x01, 0x0a, 0x20, 0xff}) {
      SCOPED_TRACE("byte " + std::to_string(at) + " ^ " + std::to_string(flip));
      const Folder folder;
      const std::filesystem::path bad = folder / "bad.journal";
      std::string text = whole;
      text[at] = static_cast<char>(text[at] ^ flip);
      put_content(bad, text);
      const Result<JournalIntents> intents = read_intents(bad);
      const std::size_t good =
          static_cast<std::size_t>(std::upper_bound(session.bytes.begin(), session.bytes.end(), at) - session.bytes.begin());
      if (good == 0) {
        ASSERT_FALSE(intents) << "the header";
      } else {
        ASSERT_TRUE(intents) << intents.error().text();
        ASSERT_TRUE(intents->damage || intents->torn_tail);
        ASSERT_EQ(intents->edits.size(), good - 1);
      }
      if (flip != 0x01 && whole[at] != '\n') continue;
      Document document = small();
      Result<Journal> journal = Journal::recover(bad, document);
      ASSERT_EQ(journal.has_value(), good > 0);
      if (!journal) {
        ASSERT_EQ(document.generations.size(), 1u);
        ASSERT_EQ(content_of(bad), text) << "a damaged journal was changed";
        continue;
      }
      ASSERT_EQ(journal->records(), good - 1);
      expect_same(document, session.after[good - 1]);
      ASSERT_EQ(journal->takes_edits(), at >= last);
      if (at >= last) {
        ASSERT_EQ(content_of(bad), whole.substr(0, last));
        ASSERT_EQ(copies_of(bad), std::vector{text}) << "what was found is kept";
        ASSERT_TRUE(work(document, *journal, kSession[3]));
      } else {
        ASSERT_FALSE(work(document, *journal, kSession[3])) << "it would be lost behind the damage";
        ASSERT_EQ(content_of(bad), text) << "a damaged journal was changed";
      }
      if (HasFailure()) return;
    }
}

TEST(Journal, damage_names_its_line) {
  const Session session;
  std::string text = content_of(session.path);
  const std::size_t third = text.find("\"n\":3");
  text[third + 5] = '!';
  put_content(session.path, text);
  Document document = small();
  Result<Journal> journal = Journal::recover(session.path, document);
  ASSERT_TRUE(journal) << journal.error().text();
  ASSERT_TRUE(journal->damage());
  EXPECT_EQ(journal->damage()->file, session.path.string());
  EXPECT_EQ(journal->damage()->line, 6);
  EXPECT_THAT(journal->damage()->message, HasSubstr("nothing after line 5 can be trusted"));
  const Result<EditReport> refused = work(document, *journal, kSession[0]);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().line, 6);
  EXPECT_THAT(refused.error().message, HasSubstr("save the deck"));
}

TEST(Journal, lost_doubled_or_swapped_records_are_found) {
  const Session session;
  const std::string whole = content_of(session.path);
  const auto record = [&](std::size_t k) { return whole.substr(session.bytes[k], session.bytes[k + 1] - session.bytes[k]); };
  const std::string head = whole.substr(0, session.bytes[1]);
  for (const std::string& text : {head + record(2), head + record(0), head + record(2) + record(1)}) {
    put_content(session.path, text);
    Document document = small();
    const Result<Journal> journal = Journal::recover(session.path, document);
    ASSERT_TRUE(journal) << journal.error().text();
    EXPECT_TRUE(journal->damage());
    EXPECT_EQ(journal->records(), 1u);
    expect_same(document, session.after[1]);
  }
  put_content(session.path, record(0) + whole);
  Document document = small();
  EXPECT_FALSE(Journal::recover(session.path, document));
}

TEST(Journal, a_record_of_another_history_is_found) {
  const Session session({kSession[0], kSession[1]});
  const Session other({R"({"edit":"select","expr":"2-20"})", kSession[1]});
  const std::string spliced = content_of(session.path).substr(0, session.bytes[1]) + content_of(other.path).substr(other.bytes[1]);
  put_content(session.path, spliced);
  const Result<JournalIntents> intents = read_intents(session.path);
  ASSERT_TRUE(intents);
  ASSERT_TRUE(intents->damage);
  EXPECT_EQ(intents->damage->line, 4);
  Document document = small();
  const Result<Journal> journal = Journal::recover(session.path, document);
  ASSERT_TRUE(journal);
  EXPECT_EQ(journal->records(), 1u);
}

TEST(Journal, blocks_that_never_reached_the_disk_leave_what_is_before_them) {
  const Session session;
  const std::string whole = content_of(session.path);
  const std::size_t last = session.bytes[session.bytes.size() - 2];
  const auto expect_all_but_last = [&](const std::string& text) {
    put_content(session.path, text);
    Document document = small();
    Result<Journal> journal = Journal::recover(session.path, document);
    ASSERT_TRUE(journal) << journal.error().text();
    EXPECT_EQ(journal->records(), kSession.size() - 1);
    expect_same(document, session.after[kSession.size() - 1]);
    EXPECT_TRUE(work(document, *journal, kSession.back()));
  };
  // Its last block is missing, or an earlier one.
  for (std::size_t missing = 1; missing < whole.size() - last; ++missing) {
    SCOPED_TRACE(missing);
    expect_all_but_last(whole.substr(0, whole.size() - missing) + std::string(missing, '\0'));
    expect_all_but_last(whole.substr(0, last) + std::string(missing, '\0') + whole.substr(last + missing));
    if (HasFailure()) return;
  }
}

TEST(Journal, is_pinned_to_its_deck) {
  const Session session;
  Document other = make_document(test::make_grid(5, 4, [](int i, int j) { return Vec3(5.0 * i, 5.0 * j, 0); }), 1 << 30, 8);
  const Result<Journal> journal = Journal::recover(session.path, other);
  ASSERT_FALSE(journal);
  EXPECT_EQ(journal.error().line, 1);
  EXPECT_THAT(journal.error().message, HasSubstr(other.deck->content.hex()));
  EXPECT_THAT(journal.error().message, HasSubstr(session.after[0].deck->content.hex()));
}

TEST(Journal, takes_over_guessed_settings_only) {
  const Session session;
  OpenOptions too_large;
  too_large.target_size = 77.0;
  Document guessed = open("model.k", {small().deck, small().opened->model}, too_large).value();
  guessed.settings.sizes_given = false;
  ASSERT_NE(guessed.current().counts, small().current().counts);
  ASSERT_TRUE(Journal::recover(session.path, guessed));
  EXPECT_EQ(guessed.settings.target_size, 5.0);
  EXPECT_EQ(guessed.current().counts, session.after.back().current().counts);
  Document told = open("model.k", {small().deck, small().opened->model}, too_large).value();
  ASSERT_TRUE(Journal::recover(session.path, told));
  EXPECT_EQ(told.settings.target_size, 77);
  EXPECT_EQ(told.opened->judging->deck_size, 77);
  ASSERT_EQ(small().settings.length_unit, LengthUnit::mm);
  for (const bool is_guess : {true, false}) {
    Document in_metres = small();
    in_metres.settings.length_unit = LengthUnit::m;
    in_metres.settings.length_unit_guessed = is_guess;
    ASSERT_TRUE(Journal::recover(session.path, in_metres));
    EXPECT_EQ(in_metres.settings.length_unit, is_guess ? LengthUnit::mm : LengthUnit::m);
  }
}

TEST(Journal, what_was_shaped_is_relaxed_towards_after_a_recovery_too) {
  const Session session({R"({"edit":"translate","by":[1,1,4],"on":"15"})", R"({"edit":"select","expr":"all"})"});
  Document recovered = small(), live = session.after.back();
  ASSERT_TRUE(Journal::recover(session.path, recovered));
  for (Document* document : {&recovered, &live}) EXPECT_GT(must_apply(*document, R"({"edit":"relax","scope":"all"})").nodes_moved, 0u);
  EXPECT_TRUE(same_bytes(recovered.current().model.positions, live.current().model.positions));
}

TEST(Journal, refuses_what_exists_and_what_is_in_use) {
  Session session;
  Document document = small();
  Result<Journal> again = Journal::create(session.path, document);
  ASSERT_FALSE(again);
  EXPECT_THAT(again.error().message, HasSubstr("already"));
  const std::string whole = content_of(session.path);
  Result<Journal> first = Journal::recover(session.path, document);
  ASSERT_TRUE(first);
  Document other = small();
  Result<Journal> second = Journal::recover(session.path, other);
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().message, HasSubstr("in use"));
  EXPECT_EQ(content_of(session.path), whole);
  EXPECT_FALSE(Journal::create(session.folder / "no" / "folder.journal", small()));
  EXPECT_FALSE(Journal::create(session.folder / "late.journal", document)) << "an edited document";
}

TEST(Journal, remembers_which_steps_the_history_dropped) {
  Document document = small();
  must_apply(document, R"({"edit":"translate","by":[0,0,1],"on":"5"})");
  Document capped = small();
  capped.history_bytes = document.current().own_bytes * 2;
  const Session session(std::vector<std::string>(6, R"({"edit":"translate","by":[0,0,1],"on":"5"})"), capped);
  Document again = small();  // with a larger cap: what was dropped then is dropped now, so that later undos mean the same
  ASSERT_TRUE(Journal::recover(session.path, again));
  EXPECT_EQ(again.generations.size(), 3u);
  expect_same(again, session.after.back());
}

TEST(Replay, goes_on_after_a_failure) {
  const Session session({
      R"({"edit":"select","expr":"1-3"})",
      R"({"edit":"select","expr":"30"})",
      R"({"edit":"undo"})",
      R"({"edit":"translate","by":[0,0,1],"falloff":{"profile":"constant"}})",
  });
  const Result<JournalIntents> intents = read_intents(session.path);
  ASSERT_TRUE(intents) << intents.error().text();
  EXPECT_EQ(intents->deck_path, "model.k");
  EXPECT_EQ(intents->edits.size(), 4u);
  EXPECT_EQ(intents->lines, (std::vector<long>{2, 4, 6, 8}));
  Document same = small();
  for (const ReplayStep& step : replay(same, *intents)) EXPECT_TRUE(step.applied) << step.message;
  expect_same(same.current(), session.after.back().current());
  // a variant without node 30: the undo of what failed must not take the first selection back
  Document variant = make_sheet(3, 3);
  const std::vector<ReplayStep> steps = replay(variant, *intents);
  EXPECT_TRUE(steps[0].applied);
  EXPECT_FALSE(steps[1].applied);
  EXPECT_THAT(steps[1].message, HasSubstr("expression:1: "));
  EXPECT_EQ(steps[1].line, 4);
  EXPECT_FALSE(steps[2].applied);
  EXPECT_TRUE(steps[3].applied);
  EXPECT_EQ(steps[3].report.nodes_moved, 3u);
}

TEST(Replay, stops_when_told) {
  const Session session;
  const Result<JournalIntents> intents = read_intents(session.path);
  ASSERT_TRUE(intents) << intents.error().text();
  ASSERT_GT(intents->edits.size(), 2u);
  Document document = small();
  std::size_t asked = 0;
  EXPECT_EQ(replay(document, *intents, [&](double) { return ++asked < 3; }).size(), 2u);
}

TEST(Replay, leaves_another_selection_than_was_meant_alone) {
  const Session session({
      R"({"edit":"select","expr":"1-3"})",                                               // 0: there
      R"({"edit":"select","expr":"30"})",                                                // 1: not on the variant
      R"({"edit":"translate","by":[0,0,1],"falloff":{"profile":"constant"}})",           // 2: would move 1 to 3
      R"({"edit":"grow"})",                                                              // 3
      R"({"edit":"translate","by":[0,0,1],"on":"5","falloff":{"profile":"constant"}})",  // 4: names its own node
      R"({"edit":"select","expr":"2","mode":"add"})",                                    // 5
      R"({"edit":"hide"})",                                                              // 6
      R"({"edit":"undo"})",                                                              // 7
      R"({"edit":"undo"})",                                                              // 8
      R"({"edit":"undo"})",                                                              // 9: of 4
      R"({"edit":"undo"})",                                                              // 10
      R"({"edit":"undo"})",                                                              // 11
      R"({"edit":"undo"})",                                                              // 12: 1 to 3 are selected again
      R"({"edit":"translate","by":[0,0,1],"falloff":{"profile":"constant"}})",           // 13
      R"({"edit":"select","expr":"7"})",                                                 // 14
      R"({"edit":"translate","by":[0,0,1],"falloff":{"profile":"constant"}})",           // 15
  });
  const Result<JournalIntents> intents = read_intents(session.path);
  ASSERT_TRUE(intents) << intents.error().text();
  Document same = small();
  for (const ReplayStep& step : replay(same, *intents)) EXPECT_TRUE(step.applied) << step.message;
  Document variant = make_sheet(3, 3);
  const std::vector<ReplayStep> steps = replay(variant, *intents);
  std::vector<std::size_t> applied;
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (steps[i].applied) applied.push_back(i);
  EXPECT_EQ(applied, (std::vector<std::size_t>{0, 4, 9, 13, 14, 15}));
  for (const std::size_t i : {2, 3, 5, 6}) EXPECT_EQ(steps[i].message, "the selection it acts on couldn't be made");
  EXPECT_EQ(steps[13].report.nodes_moved, 3u);
}

TEST(Replay, relaxes_and_repairs_no_other_selection_than_was_meant) {
  JournalIntents intents;
  for (const char* edit : {R"({"edit":"select","expr":"6"})", R"({"edit":"select","expr":"99"})", R"({"edit":"relax"})",
                           R"({"edit":"repair","scope":"selection"})", R"({"edit":"relax","scope":"part"})",
                           R"({"edit":"relax","scope":"all"})", R"({"edit":"repair"})"})
    intents.edits.push_back(edit_of(edit));
  Document variant = small();
  const std::vector<ReplayStep> steps = replay(variant, intents);
  ASSERT_EQ(steps.size(), 7u);
  EXPECT_TRUE(steps[0].applied);
  EXPECT_FALSE(steps[1].applied);
  for (const std::size_t i : {2, 3, 4}) EXPECT_EQ(steps[i].message, "the selection it acts on couldn't be made");
  EXPECT_TRUE(steps[5].applied) << "it asks for no selection";
  EXPECT_TRUE(steps[6].applied);
}

TEST(Replay, reads_scripts) {
  const Folder folder;
  put_content(folder / "script.jsonl", "{\"edit\":\"select\",\"expr\":\"1\"}\r\n\n{\"edit\":\"undo\"}");
  const Result<JournalIntents> intents = read_intents(folder / "script.jsonl");
  ASSERT_TRUE(intents) << intents.error().text();
  EXPECT_EQ(intents->lines, (std::vector<long>{1, 3}));
  put_content(folder / "bad.jsonl", "{\"edit\":\"undo\"}\n{\"edit\":\"unod\"}\n");
  bool syntax_error = true;
  const Result<JournalIntents> bad = read_intents(folder / "bad.jsonl", &syntax_error);
  ASSERT_FALSE(bad);
  EXPECT_FALSE(syntax_error);
  EXPECT_EQ(bad.error().line, 2);
  put_content(folder / "bad.jsonl", "{\"edit\":\"undo\"}\n{\"edit\"\n");
  EXPECT_FALSE(read_intents(folder / "bad.jsonl", &syntax_error));
  EXPECT_TRUE(syntax_error);
}

TEST(Replay, a_torn_tail_is_said) {
  const Session session;
  const std::string whole = content_of(session.path);
  put_content(session.path, whole.substr(0, whole.size() - 1));
  const Result<JournalIntents> intents = read_intents(session.path);
  ASSERT_TRUE(intents);
  EXPECT_TRUE(intents->torn_tail);
  EXPECT_EQ(intents->edits.size(), kSession.size() - 1);
}

}  // namespace
}  // namespace prismesh::mesh::document
