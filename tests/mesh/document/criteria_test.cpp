// Criteria of parts: set by an edit, kept beside the deck and in the journal, which needs no criteria file any more.
#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/document/damage.h"
#include "mesh/document/deck_settings.h"
#include "mesh/document/delta.h"
#include "mesh/document/drag.h"
#include "mesh/document/edit_json.h"
#include "mesh/document/journal.h"
#include "mesh/document/self_contained.h"
#include "tests/mesh/document/two_plates.h"

namespace prismesh::mesh::document {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kNoLongEdges = "name = \"short\"\n[metrics.max_length]\nwarn_above = 0.3\nfail_above = 0.5\n";

/// A folder with the criteria file short.toml, by which all shells of the plates fail.
class SetCriteriaTest : public ::testing::Test {
 protected:
  void SetUp() override { put_content(file(), kNoLongEdges); }
  std::filesystem::path file() const { return folder_ / "short.toml"; }
  Document plates_here(std::vector<JudgingRule> rules = {}) const {
    OpenOptions options;
    options.rules = std::move(rules);
    return opened_with(options, folder_ / "model.k").value();
  }

  Folder folder_;
};

TEST_F(SetCriteriaTest, judges_the_named_parts_anew_and_can_be_undone) {
  Document document = plates_here();
  const EditReport report = must_apply(document, R"({"edit": "set_criteria", "criteria": "short.toml", "on": "2"})");
  EXPECT_THAT(report.notes, ElementsAre("part 2: criteria short, before default"));
  EXPECT_EQ(report.before.fail, 0u);
  EXPECT_EQ(report.after.fail, 30u);
  EXPECT_EQ(report.nodes_moved, 0u);
  EXPECT_THAT(criteria_of(document), ElementsAre("default", "short", "default"));
  EXPECT_THAT(sizes_of(document), ElementsAre(5, 60, 5)) << "sizes stay";
  expect_judged(document);
  EXPECT_THAT(must_apply(document, R"({"edit": "set_criteria", "criteria": "./short.toml", "on": "2"})").notes,
              ElementsAre("no part's criteria changed"));
  must_apply(document, R"({"edit": "undo"})");
  must_apply(document, R"({"edit": "undo"})");
  EXPECT_THAT(criteria_of(document), ElementsAre("default", "default", "default"));
  EXPECT_EQ(document.current().counts.fail, 0u);
  expect_judged(document);
  must_apply(document, R"({"edit": "redo"})");
  EXPECT_EQ(document.current().counts.fail, 30u);
}

TEST_F(SetCriteriaTest, acts_on_the_selections_parts_and_on_the_deck_without_a_selection) {
  Document document = plates_here();
  must_apply(document, R"({"edit": "select", "expr": "205"})");
  must_apply(document, R"({"edit": "set_criteria", "criteria": "strict"})");
  EXPECT_THAT(criteria_of(document), ElementsAre("default", "strict", "default"));
  must_apply(document, R"({"edit": "select", "expr": "1-3", "kind": "part", "mode": "subtract"})");
  EXPECT_THAT(must_apply(document, R"({"edit": "set_criteria", "criteria": "short.toml"})").notes,
              ElementsAre("deck: criteria short, before default", "part 1: criteria short, before default",
                          "part 2: criteria short, before strict", "part 3: criteria short, before default"));
  EXPECT_EQ(document.current().counts.fail, 61u);
  EXPECT_EQ(document.current().judging->criteria.criteria->name, "short");
  expect_judged(document);
  must_apply(document, R"({"edit": "set_criteria", "criteria": "default", "on": "1,3"})");
  EXPECT_THAT(criteria_of(document), ElementsAre("default", "short", "default"));
  EXPECT_THAT(must_apply(document, R"({"edit": "set_criteria", "criteria": "deck", "on": "3"})").notes,
              ElementsAre("part 3: criteria short, before default"));
  must_apply(document, R"({"edit": "set_criteria", "criteria": "deck", "on": "all"})");
  EXPECT_THAT(criteria_of(document), ElementsAre("short", "short", "short")) << "the deck's own stay";
  expect_judged(document);
}

TEST_F(SetCriteriaTest, a_file_that_changed_is_read_again) {
  Document document = plates_here();
  must_apply(document, R"({"edit": "set_criteria", "criteria": "short.toml", "on": "1"})");
  put_content(file(), "name = \"short\"\n");
  EXPECT_THAT(must_apply(document, R"({"edit": "set_criteria", "criteria": "short.toml", "on": "1"})").notes,
              ElementsAre("part 1: criteria short, read again"));
  EXPECT_EQ(document.current().counts.fail, 0u);
}

TEST_F(SetCriteriaTest, mistakes_are_told_and_change_nothing) {
  Document document = plates_here();
  put_content(folder_ / "wrong.toml", "[metrics.skew]\nfail_abov = 3\n");
  put_content(folder_ / "large.toml", std::string(quality::kMaxCriteriaBytes + 1, '\n'));
  const auto refused = [&](const std::string& fields) { return refusal(document, R"({"edit": "set_criteria", )" + fields + "}"); };
  EXPECT_EQ(refused(R"("criteria": "strickt")"),
            (folder_ / "strickt").string() +
                ": there is no such file, and no built-in criteria of this name; built in are default, "
                "strict, skew_and_thickness");
  EXPECT_EQ(refused(R"("criteria": "wrong.toml")"),
            (folder_ / "wrong.toml").string() + ":2: metrics.skew has no \"fail_abov\"; the nearest known is \"fail_above\"");
  EXPECT_EQ(refused(R"("criteria": "large.toml")"), (folder_ / "large.toml").string() + ": a criteria file has at most 1 MiB");
  EXPECT_EQ(refused(R"("criteria": "")"), R"(criteria must be a built-in set like "strict", a file, or "deck")");
  EXPECT_EQ(refused(R"("criteria": "strict", "text": "name = \"x\"")"), R"(a text belongs to a criteria file, not to "strict")");
  EXPECT_EQ(refused(R"("criteria": "deck", "text": "")"), R"(a text belongs to a criteria file, not to "deck")");
  EXPECT_THAT(refused(R"("criteria": "a.toml", "text": "x = 1")"), HasSubstr("a.toml:1: a criteria file has no \"x\""));
  EXPECT_THAT(refused(R"("criteria": "a.toml", "text": ")" + std::string(quality::kMaxCriteriaBytes + 1, ' ') + "\""),
              HasSubstr("a.toml: a criteria file has at most 1 MiB"));
  EXPECT_THAT(refused(R"("criteria": "strict", "on": "9")"), HasSubstr("9"));
  EXPECT_FALSE(self_contained(document, edit_of(R"({"edit": "set_criteria", "criteria": "strickt"})")));
  EXPECT_FALSE(self_contained(document, edit_of(R"({"edit": "set_criteria", "criteria": ""})")));
  EXPECT_EQ(document.generations.size(), 1u);
}

TEST_F(SetCriteriaTest, the_decks_limit_of_triangles_at_a_node_goes_with_the_decks_criteria) {
  std::vector<test::NodeSpec> nodes{{100, Vec3::Zero()}};
  std::vector<test::ShellSpec> shells;
  const double at[6][2] = {{2, 0}, {1, 2}, {-1, 2}, {-2, 0}, {-1, -2}, {1, -2}};
  for (int n = 0; n < 6; ++n) {
    nodes.push_back({101 + n, Vec3(at[n][0], at[n][1], 0)});
    shells.push_back({1 + n, n < 3 ? 1 : 2, {100, 101 + n, 101 + (n + 1) % 6, 101 + (n + 1) % 6}});
  }
  for (int q = 0; q < 4; ++q) {  // by themselves, so that neither part is a mesh of triangles
    const std::int64_t first = 201 + 4 * q;
    for (int n = 0; n < 4; ++n) nodes.push_back({first + n, Vec3(10 * q + (n == 1 || n == 2 ? 5 : 0), n > 1 ? 5 : 0, 50)});
    shells.push_back({11 + q, q < 2 ? 1 : 2, {first, first + 1, first + 2, first + 3}});
  }
  Document document = make_document(test::make_model(nodes, shells));
  ASSERT_EQ(document.current().clusters->size(), 1u);
  const std::string many = R"({"edit": "set_criteria", "criteria": "many.toml", "text": "[triangles]\nwarn_above_at_node = 6")";
  EXPECT_EQ(must_apply(document, many + R"(, "on": "1"})").clusters_after, 1u) << "it is a limit of the whole deck";
  EXPECT_EQ(must_apply(document, many + "}").clusters_after, 0u);
  must_apply(document, R"({"edit": "undo"})");
  EXPECT_EQ(document.current().clusters->size(), 1u);
}

TEST_F(SetCriteriaTest, makes_no_shell_worse_and_drags_judge_by_it) {
  Document document = plates_here();
  must_apply(document, R"({"edit": "set_criteria", "criteria": "short.toml", "on": "2"})");
  EXPECT_THAT(damaged_shells(document), IsEmpty());
  const Edit edit = edit_of(R"({"edit": "translate", "by": [0, 0, 0], "on": "201-242", "falloff": {"profile": "constant"}})");
  Result<Drag> drag = Drag::begin(document.generations[document.cursor], edit);
  ASSERT_TRUE(drag) << drag.error().text();
  drag->step({Vec3(1, 0, 0), 0, 0});
  EXPECT_EQ(drag->counts().fail, 30u);
}

TEST_F(SetCriteriaTest, repair_mends_what_fails_by_it) {
  put_content(folder_ / "square.toml", "name = \"square\"\n[metrics.aspect]\nwarn_above = 1.15\nfail_above = 1.2\n");
  put_content(folder_ / "plates.k", plate_and_larger_one());
  Document document = open(folder_ / "plates.k", OpenOptions{}).value();
  must_apply(document, R"({"edit": "translate", "by": [1, 0, 0], "on": "1048", "falloff": {"profile": "constant"}})");
  ASSERT_EQ(document.current().counts.warn + document.current().counts.fail, 0u);
  const Vec3 moved = place_of(document, 1048);
  must_apply(document, R"({"edit": "repair", "scope": "all"})");
  EXPECT_EQ(place_of(document, 1048), moved) << "by the default criteria nothing is wrong";
  must_apply(document, R"({"edit": "set_criteria", "criteria": "square.toml", "on": "2"})");
  must_apply(document, R"({"edit": "repair", "scope": "all"})");
  EXPECT_EQ(place_of(document, 1048), moved) << "another part's";
  must_apply(document, R"({"edit": "set_criteria", "criteria": "square.toml", "on": "1"})");
  const std::size_t fail = document.current().counts.fail;
  ASSERT_GT(fail, 0u);
  EXPECT_LT(must_apply(document, R"({"edit": "repair", "scope": "all"})").after.fail, fail);
}

/// Edits that a kiosk would send, and their journal.
void journalled(Document& live, const std::filesystem::path& path, const std::vector<std::string>& texts) {
  Result<Journal> journal = Journal::create(path, live);
  ASSERT_TRUE(journal);
  for (const std::string& json : texts) {
    const Result<Edit> edit = self_contained(live, edit_of(json));
    ASSERT_TRUE(edit) << json;
    Result<Prepared> prepared = prepare(live, *edit);
    ASSERT_TRUE(prepared && journal->append(live, *edit, *prepared)) << json;
    commit(live, std::move(*prepared));
  }
}

TEST_F(SetCriteriaTest, comes_back_with_the_journal_and_a_replay_when_the_file_has_gone) {
  const std::filesystem::path path = folder_ / "criteria.journal";
  Document live = plates_here({rule("3", std::nullopt, file().string())});
  journalled(
      live, path,
      {R"({"edit": "select", "expr": "205"})", R"({"edit": "set_criteria", "criteria": "short.toml"})",
       R"({"edit": "set_target_size", "size": 30, "on": "2"})", R"({"edit": "lift", "distance": 3, "on": "209"})",
       R"({"edit": "set_criteria", "criteria": "strict", "on": "all"})", R"({"edit": "set_criteria", "criteria": "deck", "on": "3"})",
       R"({"edit": "set_criteria", "criteria": "short.toml", "on": "1"})", R"({"edit": "undo"})"});
  std::filesystem::remove(file());
  Document recovered = plates_here();
  ASSERT_TRUE(Journal::recover(path, recovered));
  expect_same(live, recovered);
  EXPECT_EQ(criteria_of(recovered), criteria_of(live));
  EXPECT_EQ(deck_settings_text(recovered.current(), "x"), deck_settings_text(live.current(), "x"));
  expect_judged(recovered);
  while (live.can_undo()) {
    must_apply(live, R"({"edit": "undo"})");
    must_apply(recovered, R"({"edit": "undo"})");
    EXPECT_EQ(criteria_of(recovered), criteria_of(live));
    expect_judged(recovered);
  }
  EXPECT_THAT(criteria_of(recovered), ElementsAre("default", "default", "short")) << "as the deck was opened";
  while (live.can_redo()) must_apply(live, R"({"edit": "redo"})");
  must_apply(live, R"({"edit": "undo"})");
  Document replayed = plates_here();
  must_apply(replayed, R"({"edit": "set_criteria", "criteria": "short.toml", "on": "3", "text": ")"
                       R"([metrics.max_length]\nfail_above = 0.5"})");
  for (const ReplayStep& step : replay(replayed, read_intents(path).value())) EXPECT_TRUE(step.applied) << step.message;
  EXPECT_THAT(criteria_of(replayed), ElementsAre("strict", "strict", "strict"));
}

TEST_F(SetCriteriaTest, a_recovery_takes_the_criteria_that_the_journal_was_begun_with) {
  const std::filesystem::path path = folder_ / "criteria.journal";
  ASSERT_TRUE(Journal::create(path, plates_here({rule(std::nullopt, std::nullopt, "strict"), rule("2", std::nullopt, file().string())})));
  put_content(folder_ / "model.k.prismesh.toml", "criteria = \"skew_and_thickness\"\ntarget_size = 9\n");
  std::filesystem::remove(file());
  Document usual = plates_here();
  ASSERT_THAT(sizes_of(usual), ElementsAre(9, 9, 9));
  ASSERT_TRUE(Journal::recover(path, usual));
  EXPECT_THAT(criteria_of(usual), ElementsAre("strict", "short", "strict")) << "not what an edit wrote beside the deck since";
  EXPECT_THAT(sizes_of(usual), ElementsAre(5, 60, 5));
  expect_judged(usual);
  Document told = plates_here({rule("1", std::nullopt, "default")});
  ASSERT_TRUE(Journal::recover(path, told));
  EXPECT_THAT(criteria_of(told), ElementsAre("default", "skew and thickness", "skew and thickness")) << "what the user says now counts";
}

TEST_F(SetCriteriaTest, a_document_opens_without_a_file_if_its_journal_has_it) {
  put_content(folder_ / "model.k.prismesh.toml", "[[parts]]\non = \"2\"\ncriteria = \"gone.toml\"\n");
  OpenOptions options;
  ASSERT_FALSE(opened_with(options, folder_ / "model.k"));
  std::vector<Error> unread;
  options.unread_criteria = &unread;
  const Result<Document> document = opened_with(options, folder_ / "model.k");
  ASSERT_TRUE(document);
  EXPECT_FALSE(document->settings.criteria_given);
  EXPECT_THAT(criteria_of(*document), ElementsAre("default", "default", "default"));
  ASSERT_EQ(unread.size(), 1u);
  EXPECT_THAT(unread[0].text(), HasSubstr("gone.toml"));
}

TEST_F(SetCriteriaTest, settings_beside_the_deck_have_it) {
  Document document = plates_here();
  put_content(folder_ / "strict", kNoLongEdges);
  must_apply(document, R"({"edit": "set_criteria", "criteria": "short.toml", "on": "all"})");
  must_apply(document, R"({"edit": "set_criteria", "criteria": "strict", "on": "2"})");
  must_apply(document, R"({"edit": "set_criteria", "criteria": "./strict", "on": "3"})");
  EXPECT_THAT(criteria_of(document), ElementsAre("short", "strict", "short")) << "a file of such a name is ./strict";
  ASSERT_TRUE(keep_deck_settings(document, folder_ / "model.k"));
  EXPECT_EQ(content_of(folder_ / "model.k.prismesh.toml"),
            "# What the shells of this deck are judged by: docs/quality/criteria.md. Prismesh writes this file anew.\n"
            "target_size = \"part\"\ncriteria = \"short.toml\"\n\n[[parts]]\non = \"3\"\ncriteria = \"./strict\"\n\n[[parts]]\non = \"2\"\n"
            "criteria = \"strict\"\n");
  EXPECT_EQ(criteria_of(plates_here()), criteria_of(document));
}

TEST_F(SetCriteriaTest, a_delta_with_wrong_criteria_is_refused) {
  Document document = plates_here();
  must_apply(document, R"({"edit": "set_criteria", "criteria": "short.toml", "on": "2"})");
  const Generation &before = *document.generations[0], &after = *document.generations[1];
  const std::vector<std::byte> good = encode_delta(before, after);
  const auto is_taken = [&](const std::vector<std::byte>& delta) {
    Generation next = before;
    return apply_delta(delta, next).has_value();
  };
  ASSERT_TRUE(is_taken(good));
  // It ends with: one file, its name, its text, the deck's criteria (none), one changed part, its place, its criteria.
  const std::size_t own = good.size() - 1, place = own - 1, of_deck = own - 3, text = of_deck - std::string(kNoLongEdges).size();
  ASSERT_EQ(good[of_deck], std::byte{0});
  ASSERT_EQ(good[text], std::byte{'n'});
  const auto with = [&](std::size_t at, int value) {
    std::vector<std::byte> wrong = good;
    wrong[at] = static_cast<std::byte>(value);
    return wrong;
  };
  EXPECT_FALSE(is_taken(with(own, 2))) << "there is one file";
  EXPECT_FALSE(is_taken(with(of_deck, 2)));
  EXPECT_FALSE(is_taken(with(place, 3))) << "there are three parts";
  EXPECT_FALSE(is_taken(with(text, '='))) << "no criteria";
  EXPECT_FALSE(is_taken(with(0, 3))) << "what follows the sizes has no place in version 3";
  EXPECT_FALSE(is_taken(with(0, 5)));
  for (std::size_t bytes = text - 20; bytes < good.size(); ++bytes)
    EXPECT_FALSE(is_taken({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(bytes)})) << bytes;
}

}  // namespace
}  // namespace prismesh::mesh::document
