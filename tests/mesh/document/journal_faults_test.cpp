// Journals on disks that fail, and journals that don't belong to what is open.
#include <sys/mount.h>
#include <sys/stat.h>

#include <cerrno>
#include <functional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/document/journal.h"
#include "mesh/document/journal_records.h"
#include "tests/mesh/document/faulty_disk.h"
#include "tests/mesh/document/journal_session.h"

namespace prismesh::mesh::document {
namespace {

using testing::HasSubstr;

class JournalFaultTest : public testing::Test {
 protected:
  ~JournalFaultTest() override { disk.mend(); }
  /// One edit that must fail, then one that must be kept; the journal must hold exactly what was acknowledged.
  void fail_once(Session& session, const std::function<void()>& break_disk, const std::function<void()>& mend_disk,
                 const std::string& words) {
    Document document = small();
    Result<Journal> journal = Journal::recover(session.path, document);
    ASSERT_TRUE(journal);
    const std::string before = content_of(session.path);
    break_disk();
    const Result<EditReport> failed = work(document, *journal, R"({"edit":"invert"})");
    mend_disk();
    ASSERT_FALSE(failed);
    EXPECT_THAT(failed.error().message, HasSubstr(words));
    EXPECT_EQ(failed.error().file, session.path.string());
    EXPECT_EQ(content_of(session.path), before);
    expect_same(document, session.after.back());
    const Result<EditReport> kept = work(document, *journal, R"({"edit":"select","expr":"7"})");
    ASSERT_TRUE(kept) << kept.error().text();
    Document expected = session.after.back();
    must_apply(expected, R"({"edit":"select","expr":"7"})");
    journal = Journal::create(session.folder / "other.journal", small());  // lets go of the first
    std::filesystem::remove(session.folder / "other.journal");
    Document again = small();
    ASSERT_TRUE(Journal::recover(session.path, again));
    expect_same(again, expected);
  }
};

TEST_F(JournalFaultTest, a_failed_write_leaves_the_journal_as_it_was) {
  for (const int error : {ENOSPC, EIO, EDQUOT})
    for (const bool half : {false, true}) {
      Session session;
      fail_once(
          session,
          [&] {
            disk.write_error = error;
            disk.short_write = half;
            disk.writes_left = 0;
          },
          [] { disk.writes_left = -1; }, std::generic_category().message(error));
    }
}

TEST_F(JournalFaultTest, a_failed_flush_moves_what_was_acknowledged_to_a_new_file) {
  Session session;
  struct stat before {};
  ASSERT_EQ(::stat(session.path.c_str(), &before), 0);
  fail_once(
      session, [] { disk.sync_error = EIO; }, [] { disk.sync_error = 0; }, "can't be flushed to disk");
  struct stat after {};
  ASSERT_EQ(::stat(session.path.c_str(), &after), 0);
  EXPECT_NE(before.st_ino, after.st_ino);
}

TEST_F(JournalFaultTest, when_nothing_can_be_flushed_no_edits_are_taken_until_the_journal_is_written_anew) {
  for (const int truncate_error : {0, EIO}) {
    Session session;
    Document document = small();
    {
      Result<Journal> journal = Journal::recover(session.path, document);
      ASSERT_TRUE(journal);
      disk.sync_error = EIO;
      disk.folder_sync_error = EIO;
      disk.truncate_error = truncate_error;
      const Result<EditReport> refused = work(document, *journal, R"({"edit":"invert"})");
      ASSERT_FALSE(refused);
      EXPECT_THAT(refused.error().message, HasSubstr("the edit wasn't made")) << "its bytes were overwritten if not cut off";
      const Result<EditReport> later = work(document, *journal, R"({"edit":"invert"})");
      ASSERT_FALSE(later);
      EXPECT_THAT(later.error().message, HasSubstr("takes no more edits since an earlier failure"));
    }
    Document again = small();
    Result<Journal> journal = Journal::recover(session.path, again);
    disk.sync_error = disk.folder_sync_error = disk.truncate_error = 0;
    if (!journal) journal = Journal::recover(session.path, again);  // what is left of the record couldn't be cut off
    ASSERT_TRUE(journal) << journal.error().text();
    expect_same(again, session.after.back());
  }
  Session session;
  Document document = small();
  {
    Result<Journal> journal = Journal::recover(session.path, document);
    disk.sync_error = disk.folder_sync_error = EIO;
    EXPECT_FALSE(work(document, *journal, R"({"edit":"invert"})"));
    disk.sync_error = disk.folder_sync_error = 0;
    EXPECT_TRUE(work(document, *journal, R"({"edit":"invert"})")) << "it is written anew first";
  }
  Document again = small();
  ASSERT_TRUE(Journal::recover(session.path, again));
  expect_same(again, document);
}

TEST_F(JournalFaultTest, a_journal_that_was_deleted_or_changed_takes_no_edit) {
  Session session;
  Document document = small();
  Result<Journal> journal = Journal::recover(session.path, document);
  ASSERT_TRUE(journal);
  const std::string whole = content_of(session.path);
  put_content(session.path, whole + "{}\n");
  EXPECT_THAT(work(document, *journal, R"({"edit":"invert"})").error().message, HasSubstr("changed by another program"));
  put_content(session.path, whole);
  const std::filesystem::path away = session.folder / "away";
  std::filesystem::rename(session.path, away);
  EXPECT_THAT(work(document, *journal, R"({"edit":"invert"})").error().message, HasSubstr("moved away or replaced"));
  put_content(session.path, whole);
  EXPECT_THAT(work(document, *journal, R"({"edit":"invert"})").error().message, HasSubstr("moved away or replaced"));
  EXPECT_EQ(content_of(away), whole);
  std::filesystem::rename(away, session.path);
  std::filesystem::remove(session.path);
  EXPECT_THAT(work(document, *journal, R"({"edit":"invert"})").error().message, HasSubstr("has been deleted"));
}

TEST(Journal, a_full_disk_loses_nothing) {
  Folder folder;
  if (::mount("none", folder.path().c_str(), "tmpfs", 0, "size=64k") != 0)
    GTEST_SKIP() << "SKIPPED ALOUD: a full disk needs a small tmpfs, and mounting one needs root";
  const std::filesystem::path path = folder / "full.journal";
  Document document = make_sheet(20, 20);
  std::size_t kept = 0;
  {
    Result<Journal> journal = Journal::create(path, document);
    ASSERT_TRUE(journal) << journal.error().text();
    Result<EditReport> report =
        work(document, *journal, R"({"edit":"translate","by":[0,0,1],"on":"all","falloff":{"profile":"constant"}})");
    while (report && kept < 1000) {
      ++kept;
      report = work(document, *journal, R"({"edit":"translate","by":[0,0,1],"on":"all","falloff":{"profile":"constant"}})");
    }
    ASSERT_FALSE(report);
    EXPECT_THAT(report.error().message, HasSubstr("No space left on device"));
    EXPECT_TRUE(work(document, *journal, R"({"edit":"undo"})")) << "a small record still fits";
  }
  Document again = make_sheet(20, 20);
  const Result<Journal> journal = Journal::recover(path, again);
  EXPECT_TRUE(journal) << journal.error().text();
  EXPECT_GT(kept, 0u);
  expect_same(again, document);
  ::umount2(folder.path().c_str(), MNT_DETACH);
}

/// Files beside the one named.
std::vector<std::string> others_in(const std::filesystem::path& folder, const std::string& but = "") {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().filename() != but) names.push_back(entry.path().filename().string());
  return names;
}

struct DiskFault {
  std::function<void()> set;
  std::string words;
};

TEST_F(JournalFaultTest, a_journal_that_cannot_be_made_is_a_sentence_and_leaves_nothing) {
  const DiskFault faults[] = {
      {[] { disk.lock_error = ENOLCK; }, "the journal can't be written: No locks available"},
      {[] { disk.folder_sync_error = EIO; }, "the journal can't be written: Input/output error"},
      {[] { disk.link_error = EIO; }, "the journal can't be made: Input/output error"},
      {[] {
         disk.link_error = EPERM;
         disk.rename_new_error = EINVAL;
       },
       "the journal can't be made: Invalid argument"},
  };
  for (const DiskFault& fault : faults) {
    const Folder folder;
    fault.set();
    const Result<Journal> journal = Journal::create(folder / "a.journal", small());
    disk.mend();
    ASSERT_FALSE(journal) << fault.words;
    EXPECT_EQ(journal.error().message, fault.words);
    EXPECT_EQ(journal.error().file, (folder / "a.journal").string());
    EXPECT_TRUE(others_in(folder.path()).empty()) << fault.words;
  }
}

TEST_F(JournalFaultTest, without_hard_links_a_journal_is_made_all_the_same_and_replaces_nothing) {
  for (const int error : {EPERM, EOPNOTSUPP}) {
    const Folder folder;
    disk.link_error = error;
    {
      Document document = small();
      Result<Journal> journal = Journal::create(folder / "a.journal", document);
      ASSERT_TRUE(journal) << journal.error().text();
      EXPECT_TRUE(work(document, *journal, kSession[0]));
    }
    const std::string whole = content_of(folder / "a.journal");
    const Result<Journal> again = Journal::create(folder / "a.journal", small());
    ASSERT_FALSE(again);
    EXPECT_THAT(again.error().message, HasSubstr("there is a journal (or another file) already"));
    EXPECT_EQ(content_of(folder / "a.journal"), whole);
    EXPECT_TRUE(others_in(folder.path(), "a.journal").empty());
  }
}

/// A recovery that must fail with these words, and leave the document and the file as they were.
void expect_unrecovered(const std::filesystem::path& path, const std::string& words) {
  const bool is_file = std::filesystem::is_regular_file(path);
  const std::string before = is_file ? content_of(path) : "";
  Document document = small();
  const Result<Journal> journal = Journal::recover(path, document);
  disk.mend();
  ASSERT_FALSE(journal) << words;
  EXPECT_THAT(journal.error().message, HasSubstr(words));
  EXPECT_EQ(document.generations.size(), 1u);
  EXPECT_EQ(document.generations.front(), document.opened);
  if (is_file) {
    EXPECT_EQ(content_of(path), before) << words;
  }
}

TEST_F(JournalFaultTest, a_journal_that_cannot_be_read_is_a_sentence_and_stays_as_it_is) {
  const Session session;
  const DiskFault faults[] = {
      {[] { disk.lock_error = ENOLCK; }, "the journal can't be locked: No locks available"},
      {[] { disk.read_error = EIO; }, "the journal can't be read: Input/output error"},
      {[] { disk.ends_early = true; }, "the journal can't be read: Input/output error"},
      {[] { disk.status_error = EIO; }, "the journal isn't a regular file"},
  };
  for (const DiskFault& fault : faults) {
    fault.set();
    expect_unrecovered(session.path, fault.words);
  }
  expect_unrecovered(session.folder / "none.journal", "the journal can't be opened: No such file or directory");
  ASSERT_EQ(::mkfifo((session.folder / "pipe.journal").c_str(), 0600), 0);
  expect_unrecovered(session.folder / "pipe.journal", "the journal isn't a regular file");
}

TEST_F(JournalFaultTest, what_cannot_be_cut_off_or_kept_beside_is_left_for_the_next_time) {
  const Session session;
  const std::string whole = content_of(session.path);
  put_content(session.path, whole.substr(0, whole.size() - 1));
  disk.sync_error = EIO;
  Document document = small();
  const Result<Journal> uncut = Journal::recover(session.path, document);
  disk.mend();
  ASSERT_FALSE(uncut);
  EXPECT_EQ(uncut.error().message, "the journal's incomplete last record can't be cut off: Input/output error");
  EXPECT_EQ(document.generations.size(), 1u);
  ASSERT_TRUE(Journal::recover(session.path, document)) << "what was acknowledged is there";
  expect_same(document, session.after[kSession.size() - 1]);

  std::string damaged = whole;
  damaged[damaged.size() - 5] = '!';  // in the last record
  put_content(session.path, damaged);
  disk.folder_sync_error = EIO;
  expect_unrecovered(session.path, "Input/output error");
  EXPECT_TRUE(copies_of(session.path).empty());
  Document later = small();
  ASSERT_TRUE(Journal::recover(session.path, later));
  EXPECT_EQ(copies_of(session.path), std::vector{damaged});
}

TEST_F(JournalFaultTest, a_file_that_cannot_be_reached_or_is_another_one_takes_no_edit) {
  const std::pair<std::function<void()>, std::string> faults[] = {
      {[] { disk.status_error = EIO; }, "the journal can't be reached: Input/output error"},
      {[] { disk.other_device = true; }, "the journal has been moved away or replaced"},
  };
  for (const auto& [fault, words] : faults) {
    Session session;
    fail_once(
        session, fault, [] { disk.mend(); }, words);
  }
}

TEST_F(JournalFaultTest, a_file_that_cannot_be_written_anew_takes_no_edit_until_it_can) {
  const std::function<void()> faults[] = {
      [] { disk.read_error = EIO; },
      [] { disk.ends_early = true; },
      [] { disk.rename_error = EACCES; },
      [] { disk.lock_error = ENOLCK; },
  };
  for (const auto& fault : faults) {
    Session session;
    Document document = small();
    Document expected = session.after.back();
    {
      Result<Journal> journal = Journal::recover(session.path, document);
      ASSERT_TRUE(journal) << journal.error().text();
      const std::string before = content_of(session.path);
      disk.sync_error = EIO;
      fault();
      for (const char* words : {"the edit wasn't made", "takes no more edits since an earlier failure"}) {
        const Result<EditReport> refused = work(document, *journal, R"({"edit":"invert"})");
        ASSERT_FALSE(refused);
        EXPECT_THAT(refused.error().message, HasSubstr(words));
        EXPECT_EQ(content_of(session.path), before);
        EXPECT_EQ(others_in(session.folder.path()), std::vector<std::string>{"session.journal"});
      }
      disk.mend();
      ASSERT_TRUE(work(document, *journal, R"({"edit":"select","expr":"7"})"));
      must_apply(expected, R"({"edit":"select","expr":"7"})");
    }
    Document again = small();
    ASSERT_TRUE(Journal::recover(session.path, again));
    expect_same(again, expected);
  }
}

// --- journals that don't belong to what is open ---

JournalHeader header_for(const Document& document) {
  const Model& model = document.opened->model;
  return {"0.1-old",
          {"model.k", document.deck->content.hex(), model.node_count(), model.shell_count(), model.parts->size()},
          {LengthUnit::mm, 5.0, ""}};
}

TEST(JournalOfAnother, the_same_deck_read_differently_is_refused) {
  const Folder folder;
  const JournalHeader same = header_for(small());
  std::vector<JournalHeader> others(3, same);
  ++others[0].deck.nodes, ++others[1].deck.shells, ++others[2].deck.parts;
  for (const JournalHeader& other : others) {
    put_content(folder / "a.journal", header_text(other));
    Document document = small();
    const Result<Journal> journal = Journal::recover(folder / "a.journal", document);
    ASSERT_FALSE(journal);
    EXPECT_EQ(journal.error().message, "the journal was written by version 0.1-old, which read this deck differently; replay it instead");
    EXPECT_EQ(journal.error().line, 1);
  }
  put_content(folder / "a.journal", header_text(same));
  Document document = small();
  EXPECT_TRUE(Journal::recover(folder / "a.journal", document));
}

TEST(JournalOfAnother, criteria_that_cant_be_used_are_refused) {
  const Folder folder;
  const auto recovered = [&](const JournalHeader::ChosenOn& chosen) {
    JournalHeader header = header_for(small());
    header.settings.chosen_criteria = {{std::nullopt, "", ""}, chosen};
    put_content(folder / "a.journal", header_text(header));
    Document document = small();
    const Result<Journal> journal = Journal::recover(folder / "a.journal", document);
    return journal ? judged_by(document).of(PartIndex(0)).criteria.name : journal.error().message;
  };
  EXPECT_EQ(recovered({"all", "ours.toml", "name = \"ours\"\n"}), "ours");
  EXPECT_EQ(recovered({"all", "ours.toml", "nam = \"ours\"\n"}),
            "its criteria can't be used: ours.toml:1: a criteria file has no \"nam\"; the nearest known is \"name\"");
  EXPECT_THAT(recovered({"999", "ours.toml", ""}), testing::StartsWith("its criteria can't be used: expression:1: "));
}

TEST(JournalOfAnother, a_record_that_does_not_fit_names_its_edit_and_its_line) {
  struct Case {
    Prepared::Step step;
    std::string delta, why;
  };
  const Case cases[] = {
      {Prepared::Step::push, "!", "its delta isn't base64"},
      {Prepared::Step::push, "AA==", "its delta is of another version"},
      {Prepared::Step::push, "Ag==", "its delta doesn't fit the model"},
      {Prepared::Step::undo, "", "there is nothing to undo"},
      {Prepared::Step::redo, "", "there is nothing to redo"},
      {Prepared::Step::branch, "", "no branch 0 leaves from there"},
  };
  const Session session({kSession[0]});
  const std::string good = content_of(session.path);
  const std::string check = check_in(good.substr(session.bytes[0]));
  for (const auto& [step, delta, why] : cases) {
    // An undo has something to take back after the first record, so it comes first.
    const bool first = step == Prepared::Step::undo;
    const std::string head = header_text(header_for(small()));
    const std::string text = first ? head + record_text({1, R"({"edit":"undo"})", step, 0, delta}, check_in(head))
                                   : good + record_text({2, R"({"edit":"redo"})", step, 0, delta}, check);
    put_content(session.path, text);
    Document document = small();
    const Result<Journal> journal = Journal::recover(session.path, document);
    ASSERT_FALSE(journal) << why;
    EXPECT_EQ(journal.error().message, std::string("edit ") + (first ? "1" : "2") + " can't be brought back: " + why);
    EXPECT_EQ(journal.error().line, first ? 2 : 4);
    EXPECT_EQ(document.generations.size(), 1u) << "all or nothing";
    EXPECT_EQ(content_of(session.path), text);
  }
}

TEST(JournalOfAnother, an_edited_document_takes_no_journal) {
  const Session session;
  Document edited = small();
  must_apply(edited, kSession[0]);
  const Result<Journal> journal = Journal::recover(session.path, edited);
  ASSERT_FALSE(journal);
  EXPECT_EQ(journal.error().message, "a journal is recovered before the first edit; this document has been edited");
  EXPECT_EQ(edited.generations.size(), 2u);
  const Result<Journal> made = Journal::create(session.folder / "b.journal", edited);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().message, "a journal is started before the first edit; this document has been edited");
}

TEST(JournalOfAnother, intents_that_are_no_edits_name_their_line) {
  const Session session({kSession[0]});
  const std::string good = content_of(session.path);
  put_content(session.path,
              good + record_text({2, R"({"edit":"unod"})", Prepared::Step::push, 0, ""}, check_in(good.substr(session.bytes[0]))));
  const Result<JournalIntents> intents = read_intents(session.path);
  ASSERT_FALSE(intents);
  EXPECT_THAT(intents.error().message, HasSubstr("there is no edit \"unod\"; the nearest is \"undo\""));
  EXPECT_EQ(intents.error().line, 4);
  EXPECT_EQ(intents.error().file, session.path.string());
  const Result<JournalIntents> none = read_intents(session.folder / "none.jsonl");
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().text(), HasSubstr("none.jsonl"));
}
}  // namespace
}  // namespace prismesh::mesh::document
