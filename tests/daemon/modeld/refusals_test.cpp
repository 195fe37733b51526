// Refusals of keeper and handler: each gives a sentence and changes nothing.
#include <algorithm>
#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/clock.h"
#include "base/hash.h"
#include "daemon/modeld/daemon.h"
#include "daemon/modeld/document_keeper.h"
#include "daemon/modeld/request_handler.h"
#include "daemon/modeld/save_intent.h"
#include "ipc/model/messages_json.h"
#include "mesh/document/edit_json.h"
#include "tests/daemon/modeld/folder.h"
#include "tests/support/few_descriptors.h"

namespace prismesh::modeld {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr auto kRaise = R"({"edit":"translate","by":[0,0,0.25],"on":"1313","falloff":{"profile":"constant"}})";
mesh::document::Edit json_edit(const std::string& json) { return mesh::document::parse_edit(json).value(); }
ipc::Open open_request(const fs::path& deck) {
  ipc::Open open;
  open.path = deck.string();
  return open;
}
/// Returns the refusal's sentence; "done" if it is an answer.
std::string words(const ipc::Answer& answer) {
  const auto* failed = std::get_if<ipc::Failed>(&answer);
  return failed == nullptr ? "done" : Error{failed->file, failed->line, failed->message}.text();
}

class Refusals : public ::testing::Test {
 protected:
  double height(std::int64_t id) const {
    const mesh::Model& model = keeper_.document().current().model;
    return model.position(model.find_node(id)).z();
  }
  void open_sheet() {
    const Result<bool> opened = keeper_.open(open_request(folder_.sheet()), {});
    ASSERT_TRUE(opened) << opened.error().text();
  }
  fs::path journal() const { return StateFolder(folder_.state()).journal(keeper_.document().path, keeper_.document().deck->content); }
  /// Removes the state folder during the work, so that nothing can be created or renamed in it.
  template <class Work>
  auto without_state_folder(const Work& work) {
    const fs::path away = folder_.path() / "away";
    fs::rename(folder_.state(), away);
    std::ofstream(folder_.state()) << "no folder";
    auto done = work();
    fs::remove(folder_.state());
    fs::rename(away, folder_.state());
    return done;
  }

  test::Folder folder_;
  DocumentKeeper keeper_{StateFolder(folder_.state())};
};

TEST_F(Refusals, without_a_document_there_is_nothing_to_save_or_close) {
  const std::string other = (folder_.path() / "other.k").string();
  EXPECT_EQ(keeper_.save_copy(other).error().message, "no document is open");
  EXPECT_EQ(keeper_.save_as(other).error().message, "no document is open");
  EXPECT_EQ(keeper_.would(other).error().message, "no document is open");
  EXPECT_EQ(keeper_.close(false).error().message, "no document is open");
  EXPECT_EQ(keeper_.close(true).error().message, "no document is open");
  EXPECT_FALSE(fs::exists(other));
}

TEST_F(Refusals, a_deck_is_saved_under_an_absolute_path_only) {
  open_sheet();
  ASSERT_TRUE(keeper_.edit(json_edit(kRaise)));
  const std::string why = "the path must be absolute: the daemon has its own working folder";
  EXPECT_EQ(keeper_.save("other.k").error().message, why);
  EXPECT_EQ(keeper_.save_copy("other.k").error().message, why);
  EXPECT_EQ(keeper_.save_as("other.k").error().message, why);
  EXPECT_EQ(keeper_.would("other.k").error().message, why);
  EXPECT_EQ(keeper_.save("other.k").error().file, "other.k");
  EXPECT_TRUE(keeper_.changed());
}

TEST_F(Refusals, a_deck_that_cannot_be_opened_as_asked_leaves_no_journal_and_is_not_opened_again) {
  ipc::Open no_size = open_request(folder_.sheet());
  no_size.target_size = 0;
  EXPECT_EQ(keeper_.open(no_size, {}).error().text(), "the target size must be greater than 0");
  ipc::Open no_criteria = open_request(folder_.sheet());
  no_criteria.criteria = (folder_.path() / "none.toml").string();
  EXPECT_THAT(keeper_.open(no_criteria, {}).error().text(), HasSubstr("none.toml"));
  EXPECT_FALSE(keeper_.is_open());
  EXPECT_TRUE(fs::is_empty(folder_.state()));
}

TEST_F(Refusals, a_deck_that_is_missing_after_a_restart_is_refused_each_time) {
  open_sheet();
  keeper_ = DocumentKeeper(StateFolder(folder_.state()));
  fs::remove(folder_.path() / "sheet.k");
  for (int life = 0; life < 5; ++life) {
    const Result<bool> opened = keeper_.reopen({});
    ASSERT_FALSE(opened);
    EXPECT_THAT(opened.error().text(), HasSubstr("sheet.k"));
    EXPECT_EQ(opened.error().message.find("ended the daemon"), std::string::npos) << "it was refused, nothing ended";
  }
  ipc::SnapshotPublisher publisher(1);
  ManualClock clock;
  RequestHandler handler(StateFolder(folder_.state()), publisher, std::size_t{1} << 30, clock);
  EXPECT_THAT(words(handler.reopen({}).answer), HasSubstr("sheet.k"));
  folder_.sheet();
  EXPECT_TRUE(*keeper_.reopen({})) << "it is there again";
}

TEST_F(Refusals, reports_an_invalid_session_file) {
  const fs::path file = folder_.state() / "session.json";
  const auto with_check = [](const std::string& line) { return line + "\ncheck " + hash128(std::as_bytes(std::span(line))).hex() + "\n"; };
  const std::string get_state = ipc::encode_request(0, ipc::GetState{}).value();
  const std::pair<std::string, std::string> cases[] = {
      {"", "this file isn't as it was written"},
      {"one line without an end", "this file isn't as it was written"},
      {"a line\nand no check\n", "this file isn't as it was written"},
      {with_check("rubbish"), "it isn't JSON"},
      {with_check(get_state), "it doesn't say what was open"},
  };
  for (const auto& [text, why] : cases) {
    std::ofstream(file, std::ios::trunc) << text;
    const Result<bool> opened = keeper_.reopen({});
    ASSERT_FALSE(opened) << text;
    EXPECT_THAT(opened.error().message, HasSubstr(why)) << text;
    EXPECT_EQ(opened.error().file, file.string());
    EXPECT_EQ(opened.error().line, 1);
  }
  fs::remove(file);
  fs::create_directory(file);
  const Result<bool> opened = keeper_.reopen({});
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().file, file.string());
  ipc::Open deck = open_request(folder_.sheet());
  EXPECT_TRUE(keeper_.open(deck, {})) << "by hand it can be opened";
  EXPECT_EQ(keeper_.state().warnings.back().kind, "session-not-noted");
}

TEST_F(Refusals, an_unreadable_record_of_a_save_is_moved_aside_and_reported) {
  open_sheet();
  const fs::path deck = keeper_.document().path, record = StateFolder::save_intent(journal());
  ASSERT_TRUE(keeper_.edit(json_edit(kRaise)));
  const double raised = height(1313);
  keeper_ = DocumentKeeper(StateFolder(folder_.state()));
  const std::function<void()> records[] = {
      [&] { fs::create_directory(record); },
      [&] { std::ofstream(record) << "short"; },
      [&] { std::ofstream(record) << std::string(200, 'x'); },
  };
  std::size_t times = 0;
  for (const auto& write : records) {
    write();
    const Result<bool> opened = keeper_.open(open_request(deck), {});
    ASSERT_TRUE(opened) << opened.error().text();
    EXPECT_EQ(height(1313), raised) << "edits are brought back all the same";
    const auto warnings = keeper_.state().warnings;
    const auto unknown = std::find_if(warnings.begin(), warnings.end(), [](const auto& w) { return w.kind == "save-unknown"; });
    ASSERT_NE(unknown, warnings.end());
    EXPECT_THAT(unknown->message, HasSubstr(".saving.damaged." + std::to_string(++times)));
    EXPECT_FALSE(fs::exists(record));
    keeper_ = DocumentKeeper(StateFolder(folder_.state()));
  }
}

TEST_F(Refusals, without_its_journal_a_document_can_still_be_closed_or_saved) {
  const fs::path deck = folder_.sheet();
  const std::string before = test::whole_file(deck);
  for (const char* way : {"close", "another", "save"}) {
    ASSERT_TRUE(keeper_.open(open_request(deck), {})) << way;
    ASSERT_TRUE(keeper_.edit(json_edit(kRaise)));
    fs::remove(journal());
    EXPECT_THAT(keeper_.edit(json_edit(kRaise)).error().message,
                HasSubstr("has been deleted; edits can't be kept any more, save the deck"));
    if (way == std::string("close")) {
      const Result<void> closed = keeper_.close(true);
      EXPECT_TRUE(closed) << closed.error().text();
    } else if (way == std::string("another")) {
      ipc::Open other = open_request(folder_.two_files());
      other.discard = true;
      const Result<bool> opened = keeper_.open(other, {});
      ASSERT_TRUE(opened) << opened.error().text();
      EXPECT_EQ(keeper_.state().path, other.path);
      ASSERT_TRUE(keeper_.close(false));
    } else {
      EXPECT_EQ(test::whole_file(deck), before) << "discarded edits aren't in the deck";
      const Result<ipc::Saved> saved = keeper_.save(std::nullopt);
      ASSERT_TRUE(saved) << saved.error().text();
      EXPECT_EQ(test::compare_decks(before, test::whole_file(deck)).nodes.size(), 1u);
      EXPECT_TRUE(keeper_.edit(json_edit(kRaise))) << "there is a journal again";
    }
  }
}

TEST_F(Refusals, a_damaged_journal_is_moved_aside_or_stays) {
  const fs::path deck = folder_.sheet();
  open_sheet();
  ASSERT_TRUE(keeper_.edit(json_edit(kRaise)));
  ASSERT_TRUE(keeper_.edit(json_edit(kRaise)));
  const fs::path file = journal();
  keeper_ = DocumentKeeper(StateFolder(folder_.state()));
  std::string text = test::whole_file(file);
  text[text.find("translate")] = 'T';
  std::ofstream(file, std::ios::binary) << text;
  open_sheet();
  const auto refused = without_state_folder([&] { return keeper_.save(std::nullopt); });
  ASSERT_FALSE(refused) << "no journal can be made";
  EXPECT_EQ(test::whole_file(file), text);
  EXPECT_THAT(keeper_.edit(json_edit(kRaise)).error().message, HasSubstr("the journal is damaged here"));
  fs::remove(file);
  const Result<ipc::Saved> saved = keeper_.save(std::nullopt);
  EXPECT_TRUE(saved) << saved.error().text();
  EXPECT_TRUE(keeper_.edit(json_edit(kRaise)));
}

TEST_F(Refusals, a_save_is_refused_where_its_record_or_the_next_journal_cannot_be_made) {
  const fs::path deck = folder_.sheet();
  open_sheet();
  ASSERT_TRUE(keeper_.edit(json_edit(kRaise)));
  const double raised = height(1313);
  const std::string before = test::whole_file(deck);
  const auto refused = without_state_folder([&] { return keeper_.save(std::nullopt); });
  ASSERT_FALSE(refused);
  EXPECT_EQ(test::whole_file(deck), before);
  EXPECT_TRUE(keeper_.changed());
  ASSERT_TRUE(keeper_.edit(json_edit(kRaise)));
  EXPECT_EQ(height(1313), raised + 0.25);
  ASSERT_TRUE(keeper_.save(std::nullopt));
  EXPECT_NE(test::whole_file(deck), before);
}

TEST_F(Refusals, the_criteria_of_an_open_document_outlive_their_file) {
  const fs::path criteria = folder_.path() / "own.toml", deck = folder_.sheet(), other = folder_.path() / "other.k";
  std::ofstream(criteria) << "[metrics.warpage]\nwarn_above = 0.001\nfail_above = 0.002\n";
  ipc::Open asked = open_request(deck);
  asked.criteria = criteria.string();
  ASSERT_TRUE(keeper_.open(asked, {}));
  ASSERT_TRUE(keeper_.edit(json_edit(kRaise)));
  const mesh::quality::Counts counts = keeper_.state().counts;
  ASSERT_GT(counts.fail, 0u);
  fs::remove(criteria);
  const Result<ipc::Saved> saved = keeper_.save(std::nullopt);
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(keeper_.state().counts, counts);
  ASSERT_TRUE(keeper_.edit(json_edit(R"({"edit":"split","at":["shell:64"]})")));
  const Result<ipc::Saved> as = keeper_.save_as(other.string());
  ASSERT_TRUE(as) << as.error().text();
  EXPECT_GT(keeper_.state().counts.fail, 0u) << "judged by the criteria that it was opened with";
}

TEST_F(Refusals, saving_as_another_deck_told_to_stop_when_it_is_written_leaves_a_copy) {
  open_sheet();
  ASSERT_TRUE(keeper_.edit(json_edit(kRaise)));
  const fs::path deck = keeper_.document().path, other = folder_.path() / "other.k";
  const Result<ipc::Saved> saved = keeper_.save_as(other.string(), [&](double) { return !fs::exists(other); });
  ASSERT_FALSE(saved);
  EXPECT_EQ(saved.error().message, "cancelled. " + other.string() + " is written, as a copy; the document is still " + deck.string());
  EXPECT_EQ(keeper_.state().path, deck.string());
  EXPECT_TRUE(keeper_.changed());
  ASSERT_TRUE(keeper_.save_as(other.string()));
  EXPECT_EQ(keeper_.state().path, other.string());
}

TEST_F(Refusals, reports_what_a_save_elsewhere_cannot_write_before_it_starts) {
  fs::create_directory(folder_.path() / "deck");
  const fs::path outside = folder_.path() / "outside.k", deck = folder_.path() / "deck/main.k";
  fs::copy_file(folder_.sheet(), outside);
  std::ofstream(deck) << "*KEYWORD\n*INCLUDE\n../outside.k\n*END\n";
  ASSERT_TRUE(keeper_.open(open_request(deck), {}));
  const auto would = keeper_.would((folder_.path() / "new/main.k").string());
  ASSERT_FALSE(would);
  EXPECT_THAT(would.error().message, HasSubstr("is an include outside the main file's folder"));
  EXPECT_THAT(would.error().file, HasSubstr("outside.k"));
  EXPECT_FALSE(fs::exists(folder_.path() / "new"));
}

TEST_F(Refusals, a_closed_document_is_not_opened_after_a_restart) {
  open_sheet();
  ASSERT_TRUE(keeper_.edit(json_edit(kRaise)));
  ASSERT_TRUE(keeper_.close(true));
  keeper_ = DocumentKeeper(StateFolder(folder_.state()));
  const Result<bool> opened = keeper_.reopen({});
  ASSERT_TRUE(opened) << opened.error().text();
  EXPECT_FALSE(*opened);
}

TEST_F(Refusals, warnings_about_the_old_deck_end_with_save_as) {
  const fs::path deck = folder_.sheet();
  open_sheet();
  ASSERT_TRUE(keeper_.edit(json_edit(kRaise)));
  ASSERT_TRUE(keeper_.edit(json_edit(kRaise)));
  const fs::path file = journal();
  keeper_ = DocumentKeeper(StateFolder(folder_.state()));
  const std::string text = test::whole_file(file);
  std::ofstream(file, std::ios::binary) << text.substr(0, text.size() - 1);
  open_sheet();
  const std::size_t warnings = keeper_.state().warnings.size();
  EXPECT_EQ(keeper_.state().warnings.back().kind, "torn-journal");
  EXPECT_EQ(keeper_.state().recovered_edits, 1u);
  ASSERT_TRUE(keeper_.save_as((folder_.path() / "other.k").string()));
  EXPECT_EQ(keeper_.state().warnings.size(), warnings - 1);
  EXPECT_EQ(keeper_.state().recovered_edits, 0u);
}

TEST_F(Refusals, a_journal_of_an_earlier_time_is_kept_beside_the_one_of_a_save_as) {
  const fs::path deck = folder_.sheet(), other = folder_.path() / "other.k";
  const auto save_as_other = [&] {
    ASSERT_TRUE(keeper_.open(open_request(deck), {}));
    ASSERT_TRUE(keeper_.edit(json_edit(kRaise)));
    const Result<ipc::Saved> saved = keeper_.save_as(other.string());
    ASSERT_TRUE(saved) << saved.error().text();
  };
  save_as_other();
  const fs::path file = journal();
  ASSERT_TRUE(keeper_.edit(json_edit(kRaise)));
  keeper_ = DocumentKeeper(StateFolder(folder_.state()));  // as if killed: the edit is only in that journal
  const std::string earlier = test::whole_file(file);
  save_as_other();
  EXPECT_EQ(journal(), file) << "the same deck as then";
  bool kept = false;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_.state()))
    kept |= entry.path().string().starts_with(file.string() + ".") && test::whole_file(entry.path()) == earlier;
  EXPECT_TRUE(kept) << "edits that weren't discarded";
  EXPECT_EQ(keeper_.state().journalled_edits, 0u);
}

// --- the handler ---

class BenchRefusals : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(words(handler_.open(open_request(folder_.sheet()), {}).answer), "done"); }
  static mesh::document::Edit dragged() { return json_edit(R"({"edit":"translate","by":[0,0,0],"on":"1313"})"); }

  test::Folder folder_;
  ipc::SnapshotPublisher publisher_{1};
  ManualClock clock_;
  RequestHandler handler_{StateFolder(folder_.state()), publisher_, std::size_t{1} << 30, clock_};
};

TEST_F(BenchRefusals, refuses_requests_without_an_answer_with_a_sentence) {
  EXPECT_THAT(words(handler_.quality({"warpege", false}).answer), HasSubstr("\"warpage\""));
  EXPECT_THAT(words(handler_.find({"warpege", std::nullopt, std::nullopt, false}).answer), HasSubstr("\"warpage\""));
  EXPECT_THAT(words(handler_.preview({json_edit(R"({"edit":"translate","by":[0,0,1],"on":"9"})")}).answer), HasSubstr("no node 9"));
  EXPECT_THAT(words(handler_.count({"9", mesh::select::EntityKind::node}).answer), HasSubstr("no node 9"));
  EXPECT_THAT(words(handler_.begin_drag(1, json_edit(R"({"edit":"grow"})")).answer), HasSubstr("only shaping edits can be dragged"));
  EXPECT_THAT(words(handler_.begin_drag(1, json_edit(R"({"edit":"translate","by":[0,0,1],"on":"9"})")).answer), HasSubstr("no node 9"));
  const auto go_on = [](double) { return true; };
  ipc::GetField field;
  field.against_generation = 99;
  EXPECT_THAT(words(handler_.field(field, go_on).answer), HasSubstr("the history has no state 99 any more"));
  field.against_generation.reset();
  field.against = folder_.sheet("other.k").string();
  EXPECT_EQ(words(handler_.field(field, [](double) { return false; }).answer), field.against + ": cancelled") << "where it was";
  const ipc::Answer one = handler_.field(field, go_on).answer, other = handler_.field(field, go_on).answer;
  ASSERT_EQ(words(one), "done");
  EXPECT_NE(std::get<ipc::FieldMade>(one).field, std::get<ipc::FieldMade>(other).field);
}

TEST_F(BenchRefusals, a_closed_document_is_held_by_nobody) {
  const fs::path second = folder_.sheet("second.k"), other = folder_.sheet("other.k");
  std::weak_ptr<const mesh::deck::Deck> deck;
  std::weak_ptr<const mesh::document::Generation> generation;
  {
    ASSERT_EQ(words(handler_.close({}).answer), "done");
    const Outcome opened = handler_.open(open_request(second), {});
    ASSERT_TRUE(opened.published);
    deck = opened.published->document->deck;
    generation = opened.published->document->opened;
  }
  ASSERT_EQ(words(handler_.close({}).answer), "done");
  EXPECT_TRUE(generation.expired());
  EXPECT_TRUE(deck.expired());
  {
    const Outcome opened = handler_.open(open_request(second), {});
    ASSERT_TRUE(opened.published);
    deck = opened.published->document->deck;
    generation = opened.published->document->opened;
    ASSERT_EQ(words(handler_.edit(json_edit(kRaise)).answer), "done");
    ipc::GetField field;
    field.against = other.string();
    ASSERT_EQ(words(handler_.field(field, [](double) { return true; }).answer), "done");
    ASSERT_EQ(words(handler_.save({}).answer), "done");
  }
  EXPECT_FALSE(deck.expired());
  ASSERT_EQ(words(handler_.close({}).answer), "done");
  EXPECT_TRUE(generation.expired());
  EXPECT_TRUE(deck.expired());
}

TEST_F(BenchRefusals, an_edit_counts_though_views_cannot_be_given_it) {
#ifdef PRISMESH_ADDRESS_SANITIZER
  GTEST_SKIP() << "UndefinedBehaviorSanitizer needs descriptors of its own to look at an object's type";
#endif
  const Outcome told = [&] {
    const test::FewDescriptors none(0);
    return handler_.edit(json_edit(kRaise));
  }();
  const auto* edited = std::get_if<ipc::Edited>(&told.answer);
  ASSERT_NE(edited, nullptr) << words(told.answer);
  EXPECT_THAT(edited->report.notes, ::testing::Contains(HasSubstr("the views couldn't be given the new state: ")));
  ASSERT_TRUE(told.published);
  EXPECT_EQ(told.published->state.generation, edited->generation);
  EXPECT_TRUE(told.published->state.changed);
  const Outcome next = handler_.edit(json_edit(kRaise));
  for (const std::string& note : std::get<ipc::Edited>(next.answer).report.notes) EXPECT_EQ(note.find("views"), std::string::npos);
}

TEST_F(BenchRefusals, requests_for_shared_memory_are_refused_until_there_is_some) {
#ifdef PRISMESH_ADDRESS_SANITIZER
  GTEST_SKIP() << "UndefinedBehaviorSanitizer needs descriptors of its own to look at an object's type";
#endif
  const auto go_on = [](double) { return true; };
  const std::pair<const char*, std::function<Outcome()>> works[] = {
      {"a drag", [&] { return handler_.begin_drag(7, dragged()); }},
      {"a field", [&] { return handler_.field({}, go_on); }},
  };
  for (const auto& [what, work] : works) {
    int free = 0;
    for (; free < 20; ++free) {
      const Outcome outcome = [&, &work = work] {
        const test::FewDescriptors few(free);
        return work();
      }();
      if (words(outcome.answer) == "done") break;
      EXPECT_THAT(words(outcome.answer), HasSubstr("Too many open files")) << what << " with " << free << " free";
      EXPECT_TRUE(outcome.descriptors.empty());
      EXPECT_FALSE(outcome.published);
    }
    EXPECT_GT(free, 0) << what << " needs some";
    EXPECT_LT(free, 20) << what;
  }
}

TEST_F(BenchRefusals, a_drag_whose_edit_fails_tells_every_client_why) {
  ASSERT_EQ(words(handler_.begin_drag(7, dragged()).answer), "done");
  handler_.step_drag({7, 1, {0, 0, 0.5}, 0, 0}, true);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_.state()))
    if (entry.path().extension() == ".journal") fs::remove(entry.path());
  const Outcome outcome = handler_.commit_drag();
  EXPECT_THAT(words(outcome.answer), HasSubstr("the journal has been deleted"));
  ASSERT_EQ(outcome.events.size(), 1u);
  const auto& ended = std::get<ipc::DragEnded>(outcome.events.front());
  EXPECT_EQ(ended.drag, 7u);
  EXPECT_FALSE(ended.committed);
  EXPECT_THAT(ended.why, HasSubstr("the journal has been deleted"));
  EXPECT_FALSE(outcome.published) << "nothing changed";
}

TEST(DaemonStart, fails_with_a_sentence_and_leaves_nothing_behind) {
  const test::Folder folder;
  std::ofstream(folder.path() / "file") << "no folder";
  const auto why_not = [](const DaemonOptions& options) {
    const Result<Daemon> daemon = Daemon::start(options);
    return daemon ? std::string("started") : daemon.error().text();
  };
  EXPECT_THAT(why_not({folder.path() / "run", folder.path() / "file" / "state"}), HasSubstr((folder.path() / "file").string()));
  EXPECT_THAT(why_not({folder.path() / "file" / "run", folder.state()}), HasSubstr((folder.path() / "file").string()));
  for (const int free : {0, 1}) {  // for the lock, and for the page of its health
    const test::FewDescriptors few(free);
    EXPECT_THAT(why_not({folder.path() / "run", folder.state()}), HasSubstr("Too many open files"));
  }
  EXPECT_EQ(why_not({folder.path() / "run", folder.state()}), "started");
}

}  // namespace
}  // namespace prismesh::modeld
