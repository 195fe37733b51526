#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <tuple>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "daemon/modeld/document_keeper.h"
#include "mesh/document/edit_json.h"
#include "mesh/model/topology_change.h"
#include "tests/daemon/modeld/folder.h"

namespace prismesh::modeld {
namespace {

namespace fs = std::filesystem;
using namespace mesh::document;
using test::Folder;

Edit move_edit(std::int64_t id, double by) {
  Translate translate;
  translate.by = {0, 0, by};
  translate.shaping.on = std::to_string(id);
  return translate;
}

double height(const DocumentKeeper& keeper, std::int64_t id) {
  const mesh::Model& model = keeper.document().current().model;
  return model.position(model.find_node(id)).z();
}

class Keeping : public ::testing::Test {
 protected:
  DocumentKeeper keeper() const { return DocumentKeeper(StateFolder(folder_.state())); }
  static ipc::Open request(const fs::path& deck) {
    ipc::Open open;
    open.path = deck.string();
    return open;
  }
  std::vector<std::string> state_files(const std::string& ending) const {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_.state()))
      if (entry.path().string().find(ending) != std::string::npos) names.push_back(entry.path().filename().string());
    return names;
  }
  Folder folder_;
};

TEST_F(Keeping, the_history_keeps_its_size_limit_and_reports_what_it_drops) {
  const fs::path deck = folder_.sheet();
  DocumentKeeper all = keeper();
  ASSERT_TRUE(all.open(request(deck), {}));
  EXPECT_EQ(all.state().history_bytes, 0u) << "one state alone is no history";
  ASSERT_TRUE(all.edit(move_edit(1313, 0.25)));
  const std::uint64_t step = all.state().history_bytes;
  ASSERT_GT(step, 0u);
  EXPECT_EQ(all.state().history_cap, OpenOptions{}.history_bytes);
  ASSERT_TRUE(all.close(true));

  const std::size_t cap = 4 * step;
  DocumentKeeper few(StateFolder(folder_.state()), cap);
  ASSERT_TRUE(few.open(request(deck), {}));
  bool said = false;
  for (int i = 0; i < 12; ++i) {
    const Result<EditReport> report = few.edit(move_edit(1313, 0.25));
    ASSERT_TRUE(report) << report.error().text();
    for (const std::string& note : report->notes) said = said || note.find("can't be undone any more") != std::string::npos;
    EXPECT_LE(few.state().history_bytes, cap) << "after edit " << i;
  }
  EXPECT_TRUE(said) << "dropped history is reported";
  EXPECT_EQ(few.state().history_cap, cap);
  int undone = 0;
  while (few.state().can_undo && undone < 12) {
    ASSERT_TRUE(few.edit(Undo{}));
    ++undone;
  }
  EXPECT_GT(undone, 0);
  EXPECT_LT(undone, 12) << "the oldest have gone";
}

TEST_F(Keeping, the_state_says_which_files_hold_which_parts) {
  DocumentKeeper keeper = this->keeper();
  ASSERT_TRUE(keeper.open(request(folder_.two_files()), {}));
  const std::vector<ipc::DeckFile> files = keeper.state().files;
  std::uint64_t shells = 0;
  for (const ipc::DeckFile& file : files) {
    EXPECT_FALSE(file.name.empty());
    EXPECT_FALSE(file.parts.empty()) << file.name;
    EXPECT_GT(file.shells, 0u) << file.name << " holds none and shouldn't be named";
    shells += file.shells;
  }
  EXPECT_EQ(shells, keeper.state().shells);
}

TEST_F(Keeping, a_restart_brings_every_edit_back) {
  const fs::path deck = folder_.sheet();
  double expected = 0;
  {
    DocumentKeeper first = keeper();
    ASSERT_TRUE(first.open(request(deck), {}));
    expected = height(first, 1313) + 0.5;
    ASSERT_TRUE(first.edit(move_edit(1313, 0.25)));
    ASSERT_TRUE(first.edit(move_edit(1313, 0.25)));
    ASSERT_TRUE(first.edit(move_edit(1001, 3)));
    ASSERT_TRUE(first.edit(Undo{}));
  }  // as if killed: nothing was closed
  DocumentKeeper second = keeper();
  const Result<bool> again = second.reopen({});
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_TRUE(*again);
  EXPECT_EQ(height(second, 1313), expected);
  EXPECT_EQ(second.state().recovered_edits, 4u);
  EXPECT_TRUE(second.changed());
  EXPECT_TRUE(second.state().can_redo);
  ASSERT_TRUE(second.edit(Undo{}));
  EXPECT_EQ(height(second, 1313), expected - 0.25);
}

TEST_F(Keeping, undo_reaches_back_beyond_a_save_in_place) {
  const fs::path deck = folder_.sheet();
  const std::string original = test::whole_file(deck);
  DocumentKeeper first = keeper();
  ASSERT_TRUE(first.open(request(deck), {}));
  const double start = height(first, 1313);
  ASSERT_TRUE(first.edit(move_edit(1313, 0.25)));
  const Result<ipc::Saved> saved = first.save(std::nullopt);
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(saved->lines_changed, 1u);
  EXPECT_FALSE(first.changed());
  ASSERT_TRUE(first.edit(Undo{}));
  EXPECT_EQ(height(first, 1313), start);
  EXPECT_TRUE(first.changed());
  const Result<ipc::Saved> again = first.save(std::nullopt);
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ(test::whole_file(deck).size(), original.size());
  EXPECT_TRUE(test::compare_decks(original, test::whole_file(deck)).other_changes.empty());
}

TEST_F(Keeping, a_save_that_rounded_writes_nothing_the_second_time) {
  const fs::path deck = folder_.sheet();
  DocumentKeeper first = keeper();
  ASSERT_TRUE(first.open(request(deck), {}));
  for (const int node : {1313, 1314, 1315}) ASSERT_TRUE(first.edit(move_edit(node, 1.0 / 3)));
  const Result<ipc::Saved> saved = first.save(std::nullopt);
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(saved->nodes_written, 3u);
  ASSERT_EQ(saved->notes.size(), 1u) << "sixteen columns don't hold a third";
  const std::string text = test::whole_file(deck);
  const Result<ipc::Saved> again = first.save(std::nullopt);
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ(again->nodes_written, 0u);
  EXPECT_EQ(again->lines_changed, 0u);
  EXPECT_EQ(test::whole_file(deck), text);
  ASSERT_TRUE(first.edit(move_edit(1001, 0.5)));
  const Result<ipc::Saved> one = first.save(std::nullopt);
  ASSERT_TRUE(one) << one.error().text();
  EXPECT_EQ(one->nodes_written, 1u);
  EXPECT_EQ(one->lines_changed, 1u);
}

TEST_F(Keeping, what_was_undone_beyond_a_save_survives_a_restart) {
  const fs::path deck = folder_.sheet();
  double start = 0;
  {
    DocumentKeeper first = keeper();
    ASSERT_TRUE(first.open(request(deck), {}));
    start = height(first, 1313);
    ASSERT_TRUE(first.edit(move_edit(1313, 0.25)));
    ASSERT_TRUE(first.save(std::nullopt));
    ASSERT_TRUE(first.edit(Undo{}));
    ASSERT_TRUE(first.edit(move_edit(1314, 1)));
    ASSERT_TRUE(first.edit(Undo{}));
  }
  DocumentKeeper second = keeper();
  ASSERT_TRUE(second.reopen({}));
  EXPECT_EQ(height(second, 1313), start);
  EXPECT_TRUE(second.changed()) << "the deck on disk has the edit";
}

TEST_F(Keeping, selection_and_locked_parts_survive_a_save_and_a_restart) {
  const fs::path deck = folder_.sheet();
  {
    DocumentKeeper first = keeper();
    ASSERT_TRUE(first.open(request(deck), {}));
    ASSERT_TRUE(first.edit(move_edit(1313, 0.25)));
    Select select;
    select.expr = "1001-1010";
    ASSERT_TRUE(first.edit(select));
    SetParts lock;
    lock.action = VisibilityAction::lock;
    lock.on = "7";
    const auto locked = first.edit(lock);
    ASSERT_TRUE(locked) << locked.error().text();
    ASSERT_EQ(first.state().selected_nodes, 10u);
    ASSERT_TRUE(first.save(std::nullopt));
  }
  DocumentKeeper second = keeper();
  ASSERT_TRUE(second.reopen({}));
  EXPECT_EQ(second.state().selected_nodes, 10u);
  EXPECT_TRUE(second.document().current().parts->at(0).locked);
  EXPECT_FALSE(second.changed());
}

/// One item at a time that is carried over a save besides the nodes, so that it can't be carried along with another one.
class CarriedAlone : public ::testing::TestWithParam<const char*> {
 protected:
  Folder folder_;
};

TEST_P(CarriedAlone, survives_a_save_and_a_restart) {
  for (const bool grown : {false, true}) {
    const fs::path deck = folder_.sheet(grown ? "grown.k" : "moved.k");
    ipc::Open request;
    request.path = deck.string();
    const auto facts = [](const DocumentKeeper& keeper) {
      const Generation& now = keeper.document().current();
      return std::tuple(now.parts->at(0).locked, now.parts->at(0).hidden, now.selected_nodes, now.selected_shells,
                        mesh::live_shells(now.model), now.judging->by_part.of(mesh::PartIndex(0)).target_size,
                        judged_by(keeper.document()).of(mesh::PartIndex(0)).criteria.name);
    };
    auto killed = std::make_unique<DocumentKeeper>(StateFolder(folder_.state()));
    ASSERT_TRUE(killed->open(request, {}));
    ASSERT_TRUE(killed->edit(move_edit(1313, 0.25)));
    const auto split = mesh::document::parse_edit(R"({"edit":"split","at":["shell:64"]})").value();
    const auto changed = grown ? killed->edit(split) : killed->edit(move_edit(1313, 0.5));
    ASSERT_TRUE(changed) << changed.error().text();
    const auto edited = killed->edit(mesh::document::parse_edit(GetParam()).value());
    ASSERT_TRUE(edited) << edited.error().text();
    const auto before = facts(*killed);
    ASSERT_TRUE(killed->save(std::nullopt));
    killed.reset();
    DocumentKeeper second(StateFolder(folder_.state()));
    ASSERT_TRUE(second.reopen({}));
    EXPECT_EQ(facts(second), before) << (grown ? "grown" : "moved");
    EXPECT_FALSE(second.changed());
  }
}

const char* name_of_carried(const ::testing::TestParamInfo<const char*>& info) {
  constexpr std::array kNames{"Locks", "HiddenParts", "Nodes", "Shells", "TargetSize", "Criteria"};
  return kNames.at(info.index);
}

INSTANTIATE_TEST_SUITE_P(Keeping, CarriedAlone,
                         ::testing::Values(R"({"edit":"lock","on":"7"})", R"({"edit":"hide","on":"7"})",
                                           R"({"edit":"select","expr":"1001-1010"})", R"({"edit":"select","expr":"1-10","kind":"element"})",
                                           R"({"edit":"set_target_size","size":0.125})", R"({"edit":"set_criteria","criteria":"strict"})"),
                         name_of_carried);

TEST_F(Keeping, target_sizes_are_kept_beside_the_deck_at_once) {
  const fs::path deck = folder_.sheet(), file = deck.string() + ".prismesh.toml";
  const auto size = [](const DocumentKeeper& of) { return of.document().current().judging->by_part.of(mesh::PartIndex(0)).target_size; };
  DocumentKeeper first = keeper();
  ASSERT_TRUE(first.open(request(deck), {}));
  const double guessed = size(first);
  ASSERT_TRUE(first.edit(move_edit(1313, 0.25)));
  EXPECT_FALSE(fs::exists(file)) << "nothing was chosen";
  const Edit set = mesh::document::parse_edit(R"({"edit":"set_target_size","size":0.125,"on":"7"})").value();
  ASSERT_TRUE(first.edit(set));
  EXPECT_TRUE(fs::exists(file));
  ASSERT_TRUE(first.close(true));
  DocumentKeeper second = keeper();
  ASSERT_TRUE(second.open(request(deck), {}));
  EXPECT_EQ(size(second), 0.125) << "the size outlives the edits that were given up";
  EXPECT_FALSE(second.changed());
  const Edit back = mesh::document::parse_edit(R"({"edit":"set_target_size","size":"part"})").value();
  ASSERT_TRUE(second.edit(back));
  EXPECT_EQ(size(second), guessed);
  ASSERT_TRUE(second.edit(Undo{}));
  ASSERT_TRUE(second.close(true));
  DocumentKeeper third = keeper();
  ASSERT_TRUE(third.open(request(deck), {}));
  EXPECT_EQ(size(third), 0.125) << "an undo is kept too";
}

TEST_F(Keeping, criteria_are_kept_at_once_and_come_back_without_their_file) {
  const fs::path deck = folder_.sheet(), ours = deck.parent_path() / "ours.toml";
  const auto criteria = [](const DocumentKeeper& of) { return judged_by(of.document()).of(mesh::PartIndex(0)).criteria.name; };
  std::ofstream(ours) << "name = \"ours\"\n[metrics.max_length]\nfail_above = 0.01\n";
  auto killed = std::make_unique<DocumentKeeper>(StateFolder(folder_.state()));
  ASSERT_TRUE(killed->open(request(deck), {}));
  const mesh::quality::Counts by_default = killed->state().counts;
  const Edit gone = mesh::document::parse_edit(R"({"edit":"set_criteria","criteria":"gone.toml"})").value();
  EXPECT_FALSE(killed->edit(gone));
  const Edit set = mesh::document::parse_edit(R"({"edit":"set_criteria","criteria":"ours.toml","on":"7"})").value();
  const Result<EditReport> report = killed->edit(set);
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_TRUE(fs::exists(deck.string() + ".prismesh.toml"));
  const mesh::quality::Counts by_ours = killed->state().counts;
  EXPECT_EQ(by_ours.fail, mesh::live_shells(killed->document().current().model));
  killed.reset();
  fs::remove(ours);
  DocumentKeeper second = keeper();
  const Result<bool> reopened = second.reopen({});
  ASSERT_TRUE(reopened) << reopened.error().text();
  EXPECT_EQ(criteria(second), "ours");
  EXPECT_EQ(second.state().counts, by_ours);
  const auto warnings = second.state().warnings;
  const auto said = std::find_if(warnings.begin(), warnings.end(), [](const auto& each) { return each.kind == "criteria-not-read"; });
  ASSERT_NE(said, warnings.end());
  EXPECT_NE(said->file.find("ours.toml"), std::string::npos);
  ASSERT_TRUE(second.edit(Undo{}));
  EXPECT_EQ(criteria(second), "default");
  EXPECT_EQ(second.state().counts, by_default) << "the first state is that of the first opening";
  ASSERT_TRUE(second.edit(Redo{}));
  EXPECT_EQ(criteria(second), "ours");
  ASSERT_TRUE(second.close(true));
  DocumentKeeper third = keeper();
  const Result<bool> refused = third.open(request(deck), {});
  ASSERT_FALSE(refused) << "without unsaved edits nothing has the file's content";
  EXPECT_NE(refused.error().text().find("ours.toml"), std::string::npos);
}

TEST_F(Keeping, rules_of_the_request_count_more_than_the_file) {
  const fs::path deck = folder_.sheet();
  std::ofstream(deck.string() + ".prismesh.toml") << "target_size = 3\n";
  ipc::Open asked = request(deck);
  asked.rules = {{"7", TargetSize(2.0), "strict", "", 0}};
  DocumentKeeper told = keeper();
  ASSERT_TRUE(told.open(asked, {}));
  EXPECT_EQ(judged_by(told.document()).of(mesh::PartIndex(0)).target_size, 2);
  EXPECT_EQ(judged_by(told.document()).of(mesh::PartIndex(0)).criteria.name, "strict");
  EXPECT_EQ(told.state().target_size, 3);
}

TEST_F(Keeping, the_users_unit_and_criteria_are_those_of_the_document) {
  ipc::Open asked = request(folder_.sheet());
  asked.length_unit = "m";
  asked.criteria = "strict";
  DocumentKeeper strict = keeper();
  ASSERT_TRUE(strict.open(asked, {}));
  EXPECT_EQ(strict.state().length_unit, "m");
  EXPECT_EQ(strict.document().current().judging->criteria.criteria->name, "strict");
  ASSERT_TRUE(strict.close(false));
  DocumentKeeper usual = keeper();
  ASSERT_TRUE(usual.open(request(folder_.sheet()), {}));
  EXPECT_EQ(usual.state().length_unit, "mm");
  EXPECT_NE(usual.document().current().judging->criteria.criteria->name, "strict");
  ASSERT_TRUE(usual.close(false));
  asked.length_unit = "feet";
  const auto refused = usual.open(asked, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "unknown length unit \"feet\": mm, m or in");
}

TEST_F(Keeping, a_save_removes_the_record_of_an_earlier_one) {
  const fs::path deck = folder_.sheet();
  DocumentKeeper first = keeper();
  ASSERT_TRUE(first.open(request(deck), {}));
  ASSERT_TRUE(first.edit(move_edit(1313, 0.25)));
  ASSERT_TRUE(first.save(std::nullopt));
  // As if the previous journal couldn't be renamed after a save: the next opening has to do it.
  const std::vector<std::string> retired = state_files(".saved");
  ASSERT_EQ(retired.size(), 1u);
  const std::string left = retired.front().substr(0, retired.front().find(".saved")) + ".saving";
  std::ofstream(folder_.state() / left) << "an earlier save";
  ASSERT_TRUE(first.edit(move_edit(1314, 0.25)));
  ASSERT_TRUE(first.save(std::nullopt));
  EXPECT_TRUE(StateFolder(folder_.state()).save_intents(deck).empty()) << "it would be taken for what happened to the deck as it is now";
}

TEST_F(Keeping, a_save_that_was_taken_back_leaves_nothing_behind_and_can_be_made_again) {
  const fs::path deck = folder_.two_files(), include = folder_.path() / "rest.k";
  const std::string deck_before = test::whole_file(deck), include_before = test::whole_file(include);
  DocumentKeeper first = keeper();
  ASSERT_TRUE(first.open(request(deck), {}));
  ASSERT_TRUE(first.edit(move_edit(1, 0.25)));
  ASSERT_TRUE(first.edit(move_edit(4, 0.25)));
  const auto save_without_main_file = [&] {
    return first.save(std::nullopt, [&](double fraction) {
      if (fraction < 0.999) return true;
      // All files have been written and verified; the include is the first to be replaced.
      for (const fs::directory_entry& entry : fs::directory_iterator(folder_.path()))
        if (entry.path().filename().string().starts_with(".main.k.")) return fs::remove(entry.path());
      return true;
    });
  };
  const Result<ipc::Saved> refused = save_without_main_file();
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("the files that had been replaced were given back what they held before"), std::string::npos)
      << refused.error().text();
  EXPECT_EQ(test::whole_file(deck), deck_before);
  EXPECT_EQ(test::whole_file(include), include_before);
  EXPECT_TRUE(state_files(".saving").empty()) << "nothing is under way any more";
  EXPECT_EQ(state_files(".journal").size(), 1u);
  EXPECT_TRUE(first.changed());

  first = keeper();
  ASSERT_TRUE(first.open(request(deck), {}));
  EXPECT_EQ(first.state().recovered_edits, 2u);
  EXPECT_TRUE(first.state().warnings.empty()) << first.state().warnings[0].message;
  EXPECT_FALSE(save_without_main_file());
  ASSERT_TRUE(first.edit(move_edit(1, 0.25)));
  const Result<ipc::Saved> saved = first.save(std::nullopt);
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(saved->nodes_written, 2u);
}

TEST_F(Keeping, a_deck_that_something_else_changed_keeps_its_old_journal_and_says_so) {
  const fs::path deck = folder_.sheet();
  {
    DocumentKeeper first = keeper();
    ASSERT_TRUE(first.open(request(deck), {}));
    ASSERT_TRUE(first.edit(move_edit(1313, 0.25)));
  }
  std::ofstream(deck, std::ios::app) << "$ changed by hand\n";
  DocumentKeeper second = keeper();
  ASSERT_TRUE(second.open(request(deck), {}));
  EXPECT_FALSE(second.changed());
  ASSERT_FALSE(second.state().warnings.empty());
  EXPECT_EQ(second.state().warnings.back().kind, "deck-changed");
  EXPECT_EQ(state_files(".journal").size(), 2u) << "the old journal is kept";
}

TEST_F(Keeping, saving_in_place_is_refused_when_the_deck_changed_on_disk) {
  const fs::path deck = folder_.sheet();
  DocumentKeeper first = keeper();
  ASSERT_TRUE(first.open(request(deck), {}));
  ASSERT_TRUE(first.edit(move_edit(1313, 0.25)));
  std::ofstream(deck, std::ios::app) << "$ changed by hand\n";
  const std::string by_hand = test::whole_file(deck);
  const Result<ipc::Saved> saved = first.save(std::nullopt);
  ASSERT_FALSE(saved);
  EXPECT_EQ(saved.error().file, deck.string());
  EXPECT_EQ(test::whole_file(deck), by_hand);
  EXPECT_TRUE(first.changed());
  EXPECT_TRUE(first.save((folder_.path() / "elsewhere.k").string())) << "elsewhere it can be saved";
  EXPECT_TRUE(first.edit(move_edit(1313, 0.25))) << "and edited";
}

TEST_F(Keeping, unsaved_edits_are_not_discarded_without_request) {
  const fs::path deck = folder_.sheet();
  DocumentKeeper first = keeper();
  ASSERT_TRUE(first.open(request(deck), {}));
  ASSERT_TRUE(first.edit(move_edit(1313, 0.25)));
  EXPECT_FALSE(first.close(false));
  EXPECT_FALSE(first.open(request(folder_.sheet("other.k")), {}));
  EXPECT_TRUE(first.open(request(deck), {})) << "it is open already";
  EXPECT_TRUE(first.changed());
  EXPECT_TRUE(first.close(true));
  EXPECT_EQ(state_files(".journal.discarded.").size(), 1u);
  ASSERT_TRUE(first.open(request(deck), {}));
  EXPECT_FALSE(first.changed());
  EXPECT_EQ(first.state().recovered_edits, 0u);
}

TEST_F(Keeping, unsaved_edits_that_are_kept_come_back_with_their_deck) {
  const fs::path deck = folder_.sheet(), other = folder_.two_files();
  const std::string before = test::whole_file(deck);
  DocumentKeeper first = keeper();
  const auto keep = [&](const fs::path& path) {
    ipc::Open open = request(path);
    open.keep = true;
    const Result<bool> opened = first.open(open, {});
    ASSERT_TRUE(opened) << opened.error().text();
  };
  ASSERT_TRUE(first.open(request(deck), {}));
  ASSERT_TRUE(first.edit(move_edit(1313, 0.25)));
  ASSERT_TRUE(first.edit(move_edit(1313, 0.25)));
  const double moved = height(first, 1313);
  keep(other);
  EXPECT_EQ(first.state().path, other.string());
  EXPECT_EQ(test::whole_file(deck), before);
  ASSERT_TRUE(first.edit(move_edit(1, 0.5)));
  keep(deck);
  EXPECT_EQ(height(first, 1313), moved);
  EXPECT_EQ(first.state().recovered_edits, 2u);
  EXPECT_TRUE(first.changed());
  ASSERT_TRUE(first.close(false, true));
  EXPECT_FALSE(first.is_open());
  EXPECT_FALSE(*keeper().reopen({})) << "it was closed";
  first = keeper();
  ASSERT_TRUE(first.open(request(deck), {}));
  EXPECT_EQ(height(first, 1313), moved);
  ASSERT_TRUE(first.save(std::nullopt));
  EXPECT_EQ(first.state().recovered_edits, 0u) << "they are in the deck";
  ASSERT_TRUE(first.open(request(other), {}));
  EXPECT_EQ(height(first, 1), 0.5);
  EXPECT_EQ(first.state().recovered_edits, 1u);
}

TEST_F(Keeping, edits_whose_journal_is_gone_cant_be_kept) {
  const fs::path deck = folder_.sheet();
  DocumentKeeper first = keeper();
  ASSERT_TRUE(first.open(request(deck), {}));
  ASSERT_TRUE(first.edit(move_edit(1313, 0.25)));
  fs::remove(StateFolder(folder_.state()).journal(deck, first.document().deck->content));
  const Result<void> closed = first.close(false, true);
  ASSERT_FALSE(closed);
  EXPECT_NE(closed.error().message.find("the journal has been deleted"), std::string::npos) << closed.error().text();
  EXPECT_TRUE(first.changed()) << "they are still there";
}

TEST_F(Keeping, an_edit_that_cant_be_journalled_is_not_applied) {
  const fs::path deck = folder_.sheet();
  DocumentKeeper first = keeper();
  ASSERT_TRUE(first.open(request(deck), {}));
  ASSERT_TRUE(first.edit(move_edit(1313, 0.25)));
  const double before = height(first, 1313);

  // Simulates a full disk for this process.
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  ::getrlimit(RLIMIT_FSIZE, &limit);
  const rlimit tight{600, limit.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &tight);
  const Result<EditReport> edited = first.edit(move_edit(1313, 0.25));
  ::setrlimit(RLIMIT_FSIZE, &limit);
  ASSERT_FALSE(edited);
  EXPECT_NE(edited.error().file.find(".journal"), std::string::npos) << edited.error().text();
  EXPECT_EQ(height(first, 1313), before);

  EXPECT_TRUE(first.edit(move_edit(1313, 0.25))) << "there is room again";
  EXPECT_EQ(height(first, 1313), before + 0.25);
}

#if !defined(PRISMESH_ADDRESS_SANITIZER) && !defined(PRISMESH_THREAD_SANITIZER)
/// In a process of its own, because memory that other tests have returned to the heap counts too.
TEST_F(Keeping, a_deck_too_large_for_the_memory_keeps_the_open_document) {
  const auto in_little_memory = [this] {
    const fs::path large = folder_.path() / "large.k";
    std::ofstream out(large);
    out << "*KEYWORD\n*NODE\n";
    for (int i = 1; i <= 1'500'000; ++i) out << i << ",1.,2.,3.\n";
    out << "*END\n";
    out.close();
    DocumentKeeper first = keeper();
    if (!first.open(request(folder_.sheet()), {})) return 1;

    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    rlimit limit{};
    ::getrlimit(RLIMIT_AS, &limit);
    // enough for the text, not for the model
    const std::size_t room = pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) + fs::file_size(large) + 20'000'000;
    const rlimit tight{room, limit.rlim_max};
    ::setrlimit(RLIMIT_AS, &tight);
    const Result<bool> opened = first.open(request(large), {});
    ::setrlimit(RLIMIT_AS, &limit);
    if (opened) return 2;
    std::fprintf(stderr, "%s\n", opened.error().text().c_str());
    if (!first.edit(move_edit(1313, 0.25)) || !first.changed()) return 3;
    return 0;
  };
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  // That process runs this test from the start, with a folder of its own.
  const auto and_clean_up = [&] {
    const int outcome = in_little_memory();
    fs::remove_all(folder_.path());
    std::exit(outcome);
  };
  EXPECT_EXIT(and_clean_up(), ::testing::ExitedWithCode(0), "large.k: there isn't enough memory");
}
#endif

TEST_F(Keeping, a_deck_that_ends_the_daemon_every_time_is_not_opened_again) {
  const fs::path deck = folder_.sheet();
  const StateFolder state(folder_.state());
  ASSERT_TRUE(state.write_session({request(deck), 3}));
  DocumentKeeper first = keeper();
  const Result<bool> again = first.reopen({});
  ASSERT_FALSE(again);
  EXPECT_NE(again.error().message.find("ended the daemon 3 times"), std::string::npos);
  EXPECT_TRUE(first.open(request(deck), {}));
  EXPECT_EQ((*state.read_session())->attempts, 0u);
}

TEST_F(Keeping, of_a_damaged_journal_what_is_before_the_damage_is_shown_until_the_user_decides) {
  const fs::path deck = folder_.sheet();
  fs::path journal;
  std::string text;
  double good = 0;
  {
    DocumentKeeper first = keeper();
    ASSERT_TRUE(first.open(request(deck), {}));
    ASSERT_TRUE(first.edit(move_edit(1313, 0.25)));
    good = height(first, 1313);
    ASSERT_TRUE(first.edit(move_edit(1313, 0.25)));
    ASSERT_TRUE(first.edit(move_edit(1313, 0.25)));
    journal = StateFolder(folder_.state()).journal(deck, first.document().deck->content);
    text = test::whole_file(journal);
  }
  const std::size_t second_edit = text.find("translate", text.find("\"n\":2"));
  text[second_edit] = 'T';
  const auto damaged = [&] {
    std::ofstream(journal, std::ios::binary) << text;
    DocumentKeeper again = keeper();
    const Result<bool> opened = again.open(request(deck), {});
    EXPECT_TRUE(opened) << opened.error().text();
    EXPECT_EQ(height(again, 1313), good);
    EXPECT_EQ(again.state().recovered_edits, 1u);
    const auto warnings = again.state().warnings;
    EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const auto& w) { return w.kind == "damaged-journal" && w.line == 4; }));
    const auto refused = again.edit(move_edit(1313, 0.25));
    EXPECT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("save the deck to go on"), std::string::npos) << refused.error().message;
    EXPECT_EQ(test::whole_file(journal), text) << "the user hasn't decided yet";
    return again;
  };
  const std::string untouched = test::whole_file(deck);
  {
    DocumentKeeper given_up = damaged();
    ASSERT_TRUE(given_up.close(true));
    EXPECT_EQ(state_files(".damaged.").size(), 1u);
    ASSERT_TRUE(given_up.open(request(deck), {}));
    ASSERT_TRUE(given_up.edit(move_edit(1313, 0.5)));
    ASSERT_TRUE(given_up.close(true));
    EXPECT_EQ(state_files(".discarded.").size(), 1u) << "of a whole journal";
  }
  EXPECT_EQ(test::whole_file(deck), untouched);
  DocumentKeeper opened_again = damaged();
  ASSERT_TRUE(opened_again.save(std::nullopt));
  EXPECT_EQ(state_files(".damaged.").size(), 2u) << "it is kept";
  EXPECT_NE(test::whole_file(deck), untouched);
  ASSERT_TRUE(opened_again.edit(move_edit(1313, 0.5)));
  const double last = height(opened_again, 1313);
  opened_again = keeper();
  DocumentKeeper after = keeper();
  ASSERT_TRUE(after.reopen({}));
  EXPECT_EQ(height(after, 1313), last);
}

TEST_F(Keeping, a_damaged_journal_without_a_valid_edit_is_moved_aside_by_a_save) {
  const fs::path deck = folder_.sheet();
  fs::path journal;
  {
    DocumentKeeper first = keeper();
    ASSERT_TRUE(first.open(request(deck), {}));
    ASSERT_TRUE(first.edit(move_edit(1313, 0.25)));
    ASSERT_TRUE(first.edit(move_edit(1313, 0.25)));
    journal = StateFolder(folder_.state()).journal(deck, first.document().deck->content);
  }
  std::string text = test::whole_file(journal);
  text[text.find("translate")] = 'T';
  std::ofstream(journal, std::ios::binary) << text;
  {
    DocumentKeeper second = keeper();
    ASSERT_TRUE(second.reopen({}));
    EXPECT_FALSE(second.edit(move_edit(1313, 0.25)));
    ASSERT_TRUE(second.save(std::nullopt));
    ASSERT_TRUE(second.edit(move_edit(1313, 0.5)));
  }
  DocumentKeeper third = keeper();
  ASSERT_TRUE(third.reopen({}));
  EXPECT_EQ(third.state().recovered_edits, 1u);
  EXPECT_TRUE(third.changed());
}

TEST_F(Keeping, a_folder_that_may_be_written_but_not_read_is_saved_into) {
  if (::geteuid() != 0) GTEST_SKIP() << "SKIPPED ALOUD: becoming another user needs root";
  const fs::path folder = folder_.path() / "deck", deck = folder / "sheet.k";
  fs::create_directory(folder);
  fs::copy_file(folder_.sheet("whole.k"), deck);
  constexpr uid_t kNobody = 65534;
  for (const fs::path& path : {folder_.path(), folder_.state(), folder, deck}) ASSERT_EQ(::chown(path.c_str(), kNobody, kNobody), 0);
  ASSERT_EQ(::chmod(folder.c_str(), 0300), 0);
  ASSERT_EQ(::seteuid(kNobody), 0);
  double last = 0;
  {
    DocumentKeeper first = keeper();
    EXPECT_TRUE(first.open(request(deck), {}));
    EXPECT_TRUE(first.edit(move_edit(1313, 0.25)));
    const Result<ipc::Saved> saved = first.save(std::nullopt);
    EXPECT_TRUE(saved) << saved.error().text();
    EXPECT_TRUE(first.edit(move_edit(1313, 0.25)));
    EXPECT_TRUE(first.edit(move_edit(1313, 0.25)));
    last = height(first, 1313);
  }
  DocumentKeeper second = keeper();
  EXPECT_TRUE(second.reopen({}));
  ASSERT_EQ(::seteuid(0), 0);
  EXPECT_EQ(second.state().recovered_edits, 2u);
  EXPECT_EQ(height(second, 1313), last);
}

TEST_F(Keeping, generation_numbers_increase_though_the_clock_is_set_back) {
  const StateFolder state(folder_.state());
  std::uint64_t last = state.first_number();
  for (int life = 0; life < 5; ++life) {  // within a second: for the journal's numbers, the clock has been set back by hours
    const std::uint64_t first = state.first_number();
    EXPECT_GE(first, last + 1'000'000'000);
    last = first;
  }
  std::ofstream(folder_.state() / "numbers") << "99999999999999999\ncheck 0\n";
  EXPECT_LT(state.first_number(), 99'999'999'999'999'999u) << "it differs from what was written";
}

TEST_F(Keeping, reports_that_no_document_is_open) {
  DocumentKeeper first = keeper();
  EXPECT_EQ(first.edit(Undo{}).error().message, "no document is open");
  EXPECT_EQ(first.save(std::nullopt).error().message, "no document is open");
  EXPECT_FALSE(*first.reopen({}));
  EXPECT_FALSE(first.open(request("relative.k"), {}));
}

}  // namespace
}  // namespace prismesh::modeld
