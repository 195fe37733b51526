// What parts are judged by: guessed and chosen at opening, set by an edit, kept beside the deck, brought back by the journal.
#include "mesh/document/judging.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/document/damage.h"
#include "mesh/document/deck_settings.h"
#include "mesh/document/delta.h"
#include "mesh/document/drag.h"
#include "mesh/document/journal.h"
#include "mesh/document/make_field.h"
#include "tests/mesh/document/two_plates.h"

namespace prismesh::mesh::document {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(Judging, without_settings_each_part_has_its_own_median_edge) {
  const Document document = plates();
  EXPECT_THAT(sizes_of(document), ElementsAre(5, 60, 5));
  EXPECT_EQ(document.current().judging->by_part.of(PartIndex(2)).size_from, quality::SizeFrom::deck) << "four edges say too little";
  EXPECT_EQ(document.current().counts, (quality::Counts{61, 0, 0}));
  EXPECT_EQ(document.settings.target_size, 5);
  EXPECT_TRUE(document.settings.target_size_guessed);
}

TEST(Judging, one_size_for_all_stays_possible) {
  OpenOptions options;
  options.target_size = 5.0;
  const Document given = opened_with(options).value();
  EXPECT_THAT(sizes_of(given), ElementsAre(5, 5, 5));
  EXPECT_EQ(given.current().counts, (quality::Counts{31, 0, 30}));
  options.target_size = SizeGuess::deck;
  const Document guessed = opened_with(options).value();
  EXPECT_THAT(sizes_of(guessed), ElementsAre(5, 5, 5));
  EXPECT_EQ(guessed.current().counts, given.current().counts);
  EXPECT_TRUE(guessed.settings.target_size_guessed);
}

TEST(Judging, the_last_rule_that_names_a_part_counts) {
  EXPECT_THAT(sizes_of(plates({rule("1,2", 8.0), rule("part:2", 9.0)})), ElementsAre(8, 9, 5));
  EXPECT_THAT(sizes_of(plates({rule("2", 9.0), rule(std::nullopt, 7.0)})), ElementsAre(7, 7, 7)) << "a size for all replaces those before";
  EXPECT_THAT(sizes_of(plates({rule(std::nullopt, 7.0), rule("2", SizeGuess::part)})), ElementsAre(7, 60, 7));
  EXPECT_THAT(sizes_of(plates({rule("2", SizeGuess::deck)})), ElementsAre(5, 5, 5));
  const Document strict = plates({rule("2", std::nullopt, "strict")});
  EXPECT_THAT(criteria_of(strict), ElementsAre("default", "strict", "default"));
  EXPECT_THAT(sizes_of(strict), ElementsAre(5, 60, 5));
  EXPECT_THAT(criteria_of(plates({rule("2", std::nullopt, "strict"), rule(std::nullopt, std::nullopt, "default")})),
              ElementsAre("default", "default", "default"));
}

TEST(Judging, a_rule_that_cant_be_applied_is_refused) {
  const auto refused = [](const JudgingRule& wrong) {
    OpenOptions options;
    options.rules = {wrong};
    const Result<Document> document = opened_with(options);
    return document ? std::string() : document.error().text();
  };
  EXPECT_THAT(refused(rule("7", 5.0)), HasSubstr("expression:1: "));
  EXPECT_THAT(refused(rule("1", 0.0)), HasSubstr("the target size must be greater than 0"));
  EXPECT_THAT(refused(rule("1", std::nullopt, "gone.toml")), HasSubstr("gone.toml"));
  JudgingRule in_file = rule("7", 5.0);
  in_file.file = "deck.k.prismesh.toml";
  in_file.line = 4;
  EXPECT_THAT(refused(in_file), testing::StartsWith("deck.k.prismesh.toml:4: \"7\", column 1: "));
}

TEST(SetTargetSize, judges_the_named_parts_anew_and_can_be_undone) {
  Document document = plates();
  const EditReport report = must_apply(document, R"({"edit": "set_target_size", "size": 5, "on": "2"})");
  EXPECT_THAT(report.notes, ElementsAre("part 2: target size 5, before 60"));
  EXPECT_EQ(report.before.fail, 0u);
  EXPECT_EQ(report.after.fail, 30u);
  EXPECT_EQ(report.nodes_moved, 0u);
  EXPECT_THAT(sizes_of(document), ElementsAre(5, 5, 5));
  expect_judged(document);
  must_apply(document, R"({"edit": "undo"})");
  EXPECT_THAT(sizes_of(document), ElementsAre(5, 60, 5));
  expect_judged(document);
  must_apply(document, R"({"edit": "redo"})");
  EXPECT_EQ(document.current().counts.fail, 30u);
}

TEST(SetTargetSize, acts_on_the_selections_parts_and_on_all_without_a_selection) {
  Document document = plates();
  must_apply(document, R"({"edit": "select", "expr": "205"})");
  must_apply(document, R"({"edit": "set_target_size", "size": 50})");
  EXPECT_THAT(sizes_of(document), ElementsAre(5, 50, 5));
  must_apply(document, R"({"edit": "select", "expr": "1-3", "kind": "part", "mode": "subtract"})");
  ASSERT_EQ(document.current().selected_nodes, 0u);
  must_apply(document, R"({"edit": "set_target_size", "size": 7})");
  EXPECT_THAT(sizes_of(document), ElementsAre(7, 7, 7));
  must_apply(document, R"({"edit": "set_target_size", "size": "part", "on": "all"})");
  EXPECT_THAT(sizes_of(document), ElementsAre(5, 60, 5));
  EXPECT_THAT(must_apply(document, R"({"edit": "set_target_size", "size": "part", "on": "1"})").notes,
              ElementsAre("no part's target size changed"));
  EXPECT_THAT(refusal(document, R"({"edit": "set_target_size", "size": 5, "on": "8"})"), HasSubstr("8"));
  EXPECT_FALSE(parse_edit(R"({"edit": "set_target_size", "size": -1})"));
  EXPECT_FALSE(parse_edit(R"({"edit": "set_target_size", "size": "guess"})"));
  EXPECT_FALSE(parse_edit(R"({"edit": "set_target_size"})"));
}

TEST(SetTargetSize, makes_no_shell_worse_but_what_edits_did_is_still_seen) {
  Document document = plates();
  must_apply(document, R"({"edit": "set_target_size", "size": 5, "on": "2"})");
  EXPECT_THAT(damaged_shells(document), IsEmpty()) << "30 shells fail since the size was set, none since it was moved";
  must_apply(document, R"({"edit": "translate", "by": [0, 0, 40], "on": "217", "falloff": {"profile": "constant"}})");
  EXPECT_FALSE(damaged_shells(document).empty());
  for (const ShellIndex shell : damaged_shells(document)) EXPECT_EQ(document.current().model.shell_parts[shell.value], PartIndex(1));
  EXPECT_THAT(must_apply(document, R"({"edit": "relax", "scope": "damaged"})").notes.front(), testing::Not(HasSubstr("no edit made")));
}

TEST(SetTargetSize, drags_and_fields_judge_by_it) {
  Document document = plates();
  must_apply(document, R"({"edit": "set_target_size", "size": 20, "on": "2"})");
  const Edit edit = edit_of(R"({"edit": "translate", "by": [0, 0, 0], "on": "201-242", "falloff": {"profile": "constant"}})");
  Result<Drag> drag = Drag::begin(document.generations[document.cursor], edit);
  ASSERT_TRUE(drag) << drag.error().text();
  drag->step({Vec3(1, 0, 0), 0, 0});
  EXPECT_EQ(drag->counts(), document.current().counts);
  EXPECT_EQ(drag->counts().fail, 30u);
  const Result<Field> composite = make_field(*field_wish("composite"), document.current(), document, nullptr);
  ASSERT_TRUE(composite);
  EXPECT_EQ(composite->values[0], 1);
  EXPECT_LT(composite->values[30], 0);
  const Result<Field> lengths = make_field(*field_wish("metric:max_length"), document.current(), document, nullptr);
  ASSERT_TRUE(lengths);
  EXPECT_EQ(lengths->limits.full, 60) << "parts have different limits: the range of the values is shown";
}

TEST(SetTargetSize, comes_back_with_the_journal_and_with_a_replay) {
  const std::vector<std::string> edits{R"({"edit": "select", "expr": "205"})",
                                       R"({"edit": "set_target_size", "size": 5})",
                                       R"({"edit": "lift", "distance": 3, "on": "209"})",
                                       R"({"edit": "set_target_size", "size": "deck", "on": "all"})",
                                       R"({"edit": "undo"})",
                                       R"({"edit": "set_target_size", "size": 0.125, "on": "1,3"})"};
  const Folder folder;
  const std::filesystem::path path = folder / "sizes.journal";
  Document live = plates();
  {
    Result<Journal> journal = Journal::create(path, live);
    ASSERT_TRUE(journal);
    for (const std::string& json : edits) {
      const Edit edit = edit_of(json);
      Result<Prepared> prepared = prepare(live, edit);
      ASSERT_TRUE(prepared) << json;
      ASSERT_TRUE(journal->append(live, edit, *prepared));
      commit(live, std::move(*prepared));
    }
  }
  EXPECT_THAT(sizes_of(live), ElementsAre(0.125, 5, 0.125));
  Document recovered = plates();
  ASSERT_TRUE(Journal::recover(path, recovered));
  expect_same(live, recovered);
  EXPECT_EQ(sizes_of(recovered), sizes_of(live));
  EXPECT_EQ(deck_settings_text(recovered.current(), "x"), deck_settings_text(live.current(), "x"));
  Document replayed = plates();
  for (const ReplayStep& step : replay(replayed, read_intents(path).value())) EXPECT_TRUE(step.applied) << step.message;
  EXPECT_TRUE(same_bytes(replayed.current().quality, live.current().quality));
}

TEST(SetTargetSize, a_recovery_takes_the_sizes_that_the_journal_was_begun_with) {
  const Folder folder;
  const std::filesystem::path path = folder / "sizes.journal";
  const auto begin = [&](const Document& document) {
    std::filesystem::remove(path);
    ASSERT_TRUE(Journal::create(path, document));
  };
  begin(plates({rule("2", 30.0), rule("3", SizeGuess::part)}));
  Document guessed = plates();
  ASSERT_TRUE(Journal::recover(path, guessed));
  EXPECT_THAT(sizes_of(guessed), ElementsAre(5, 30, 5));
  expect_judged(guessed);
  Document told = plates({rule("1", 9.0)});
  ASSERT_TRUE(Journal::recover(path, told));
  EXPECT_THAT(sizes_of(told), ElementsAre(9, 60, 5)) << "what the user says now counts";
}

/// What the parts look like after the same edits: a part's shells by corners, in the smaller one's coordinates.
std::vector<std::vector<double>> shapes_of(const Document& document, std::size_t part) {
  const Model& model = document.current().model;
  const double by = part == 0 ? 1 : 16;
  std::vector<std::vector<double>> shapes;
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    if (model.is_removed(ShellIndex(s)) || model.shell_parts[s] != PartIndex(part)) continue;
    std::vector<double> shape;
    for (const NodeIndex node : model.shell_nodes[s].node)
      for (int k = 0; k < 3; ++k) shape.push_back(model.position(node)[k] / by);
    shapes.push_back(shape);
  }
  std::sort(shapes.begin(), shapes.end());
  return shapes;
}

TEST(Judging, a_part_is_relaxed_and_repaired_as_a_smaller_one_of_the_same_shape) {
  for (const char* mend : {R"({"edit": "repair", "scope": "all"})", R"({"edit": "relax", "scope": "all"})"}) {
    const Folder folder;
    put_content(folder / "plates.k", plate_and_larger_one());
    Document document = open(folder / "plates.k", OpenOptions{}).value();
    ASSERT_THAT(sizes_of(document), ElementsAre(5, 80));
    must_apply(document, R"({"edit": "translate", "by": [4.5, 0.5, 0], "on": "1048", "falloff": {"profile": "constant"}})");
    must_apply(document, R"({"edit": "translate", "by": [72, 8, 0], "on": "2048", "falloff": {"profile": "constant"}})");
    ASSERT_GT(document.current().counts.fail, 0u);
    ASSERT_EQ(shapes_of(document, 0), shapes_of(document, 1));
    const EditReport report = must_apply(document, mend);
    EXPECT_LT(report.after.fail, report.before.fail) << mend;
    EXPECT_EQ(shapes_of(document, 0), shapes_of(document, 1)) << mend;
  }
}

TEST(SetTargetSize, a_delta_with_wrong_sizes_is_refused) {
  Document document = plates();
  must_apply(document, R"({"edit": "set_target_size", "size": 20, "on": "2"})");
  const Generation &before = *document.generations[0], &after = *document.generations[1];
  const std::vector<std::byte> good = encode_delta(before, after);
  const auto is_taken = [&](const std::vector<std::byte>& delta) {
    Generation next = before;
    return apply_delta(delta, next).has_value() && next.judging->by_part.of(PartIndex(1)).target_size > 0;
  };
  ASSERT_TRUE(is_taken(good));
  // It ends with the size of all, one changed part, its place, the kind of its size, and the size.
  ASSERT_GT(good.size(), 12u);
  const std::size_t of_all = good.size() - 12, place = of_all + 2, kind = of_all + 3, length = of_all + 4;
  ASSERT_EQ(good[of_all], std::byte{1});
  ASSERT_EQ(good[kind], std::byte{3});
  const auto with = [&](std::size_t at, int value) {
    std::vector<std::byte> wrong = good;
    wrong[at] = static_cast<std::byte>(value);
    return wrong;
  };
  EXPECT_FALSE(is_taken(with(of_all, 0))) << "all parts have some size";
  EXPECT_FALSE(is_taken(with(of_all, 4)));
  EXPECT_FALSE(is_taken(with(place, 3))) << "there are three parts";
  EXPECT_FALSE(is_taken(with(kind, 4)));
  EXPECT_FALSE(is_taken(with(length + 7, 0xc0))) << "a negative size";
  std::vector<std::byte> endless = with(length + 7, 0x7f);
  endless[length + 6] = std::byte{0xf0};
  EXPECT_FALSE(is_taken(endless));
  for (std::size_t bytes = of_all; bytes < good.size(); ++bytes)
    EXPECT_FALSE(is_taken({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(bytes)})) << bytes;
}

TEST(DeckSettings, what_is_written_is_read_again) {
  const Folder folder;
  const std::filesystem::path deck = folder / "car.k";
  Document document = plates({rule("1", 4.5), rule("2", SizeGuess::deck, "strict"), rule("3", 4.5)});
  ASSERT_TRUE(write_deck_settings(document.current(), deck));
  EXPECT_EQ(content_of(folder / "car.k.prismesh.toml"),
            "# What the shells of this deck are judged by: docs/quality/criteria.md. Prismesh writes this file anew.\n"
            "target_size = \"part\"\n\n[[parts]]\non = \"2\"\ntarget_size = \"deck\"\ncriteria = \"strict\"\n\n[[parts]]\non = \"1,3\"\n"
            "target_size = 4.5\n");
  const Document again = opened_with({}, deck).value();
  EXPECT_EQ(sizes_of(again), sizes_of(document));
  EXPECT_EQ(criteria_of(again), criteria_of(document));
  OpenOptions all;
  all.target_size = 8.0;
  EXPECT_THAT(sizes_of(opened_with(all, deck).value()), ElementsAre(8, 8, 8)) << "the command line counts more";
  all.target_size.reset();
  all.rules = {rule("3", 2.0)};
  EXPECT_THAT(sizes_of(opened_with(all, deck).value()), ElementsAre(4.5, 5, 2));
}

TEST(DeckSettings, a_criteria_file_is_found_from_the_settings_folder) {
  const Folder folder;
  const std::filesystem::path deck = folder / "car.k";
  put_content(folder / "ours.toml", "name = \"ours\"\n[metrics.aspect]\nfail_above = 3\n");
  Document document = plates({rule(std::nullopt, std::nullopt, (folder / "ours.toml").string())});
  ASSERT_TRUE(write_deck_settings(document.current(), deck));
  EXPECT_THAT(content_of(folder / "car.k.prismesh.toml"), HasSubstr("criteria = \"ours.toml\"\n"));
  EXPECT_THAT(criteria_of(opened_with({}, deck).value()), ElementsAre("ours", "ours", "ours"));
}

TEST(DeckSettings, nothing_chosen_writes_no_file) {
  const Folder folder;
  const Document document = plates();
  ASSERT_TRUE(write_deck_settings(document.current(), folder / "car.k"));
  EXPECT_FALSE(std::filesystem::exists(folder / "car.k.prismesh.toml"));
}

TEST(DeckSettings, mistakes_are_told_with_file_line_and_nearest_key) {
  const auto told = [](const std::string& text) {
    const Result<std::vector<JudgingRule>> rules = parse_deck_settings(text, "car.k.prismesh.toml");
    return rules ? std::string() : rules.error().text();
  };
  EXPECT_EQ(told("target_size = 5\n"), "");
  EXPECT_EQ(told("\ntarget_sise = 5\n"),
            "car.k.prismesh.toml:2: a deck's settings file has no \"target_sise\"; the nearest known is \"target_size\"");
  EXPECT_EQ(told("[[parts]]\non = \"1\"\ncriterion = \"strict\"\n"),
            "car.k.prismesh.toml:3: parts has no \"criterion\"; the nearest known is \"criteria\"");
  EXPECT_THAT(told("target_size = \"large\"\n"), HasSubstr("car.k.prismesh.toml:1: target_size must be a length, \"part\""));
  EXPECT_THAT(told("target_size = 0\n"), HasSubstr("car.k.prismesh.toml:1: the target size must be greater than 0"));
  EXPECT_THAT(told("criteria = 5\n"), HasSubstr("car.k.prismesh.toml:1: criteria must be a name or a file"));
  EXPECT_THAT(told("[[parts]]\ntarget_size = 5\n"), HasSubstr("car.k.prismesh.toml:1: parts needs \"on\""));
  EXPECT_THAT(told("[[parts]]\non = 3\ntarget_size = 5\n"), HasSubstr("car.k.prismesh.toml:2: on must be an expression"));
  EXPECT_THAT(told("[[parts]]\non = \"3\"\n"), HasSubstr("car.k.prismesh.toml:1: parts needs \"target_size\", \"criteria\" or both"));
  EXPECT_THAT(told("parts = 5\n"), HasSubstr("car.k.prismesh.toml:1: parts must be a list of tables"));
  EXPECT_THAT(told("parts = [5]\n"), HasSubstr("car.k.prismesh.toml:1: parts must be a list of tables"));
  EXPECT_THAT(told("[[parts]\n"), HasSubstr("car.k.prismesh.toml:1: not TOML"));
}

}  // namespace
}  // namespace prismesh::mesh::document
