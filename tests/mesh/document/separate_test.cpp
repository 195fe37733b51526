// The edit that moves shells apart: what of the document it heeds, and that it is an edit like the others. The method is tested with
// mesh/contact.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "mesh/contact/find_penetrations.h"
#include "mesh/deck/sample.h"
#include "tests/mesh/document/document_fixture.h"
#include "tests/mesh/document/journal_session.h"
#include "tests/mesh/document/sheets_deck.h"

namespace prismesh::mesh::document {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Part 1: 10 x 10 shells of 5 mm; part 2: 4 x 4 `height` above it. 1 mm thick. Nodes of part 1 from 1, of part 2 from 1001.
Model close_sheets(double height, double thickness = 1) {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  const auto add = [&](std::int64_t part, int count, std::int64_t first, double from, double z) {
    for (int j = 0; j <= count; ++j)
      for (int i = 0; i <= count; ++i) nodes.push_back({first + i + j * (count + 1), Vec3(from + 5 * i, from + 5 * j, z)});
    for (int j = 0; j < count; ++j)
      for (int i = 0; i < count; ++i) {
        const std::int64_t corner = first + i + j * (count + 1);
        shells.push_back({first + i + j * count, part, {corner, corner + 1, corner + count + 2, corner + count + 1}});
      }
  };
  add(1, 10, 1, 0, 0);
  add(2, 4, 1001, 16.5, height);
  const Model model = test::make_model(nodes, shells);
  return thickness > 0 ? test::with_thickness(model, thickness) : model;
}

std::string why_left(const EditReport& report) {
  return report.separated && !report.separated->regions_left.empty() ? report.separated->regions_left.front().why : "";
}

std::size_t contacts(const Document& document) {
  const Model& model = document.current().model;
  const spatial::BoxTree tree(model);
  const auto crossings = contact::find_shell_crossings(model, tree);
  return crossings.size() + contact::find_penetrations(model, tree, contact::section_thickness(model), crossings).size();
}

TEST(SeparateEdit, reports_what_it_did_and_undo_gives_the_bytes_back) {
  Document document = make_document(close_sheets(0.4));
  const Generation before = document.current();
  const EditReport report = must_apply(document, R"({"edit":"separate"})");
  ASSERT_TRUE(report.separated);
  EXPECT_EQ(report.separated->regions_before, 1u);
  EXPECT_EQ(report.separated->regions_removed, 1u);
  EXPECT_TRUE(report.separated->regions_left.empty());
  EXPECT_NEAR(report.separated->depth_before, 0.6, 1e-9);
  EXPECT_EQ(report.separated->depth_after, 0);
  EXPECT_NEAR(report.separated->largest_move, 0.3, 1e-6);
  EXPECT_GT(report.nodes_moved, 25u);
  EXPECT_THAT(report.notes.front(), HasSubstr("removed 1 of 1 region"));
  EXPECT_EQ(contacts(document), 0u);
  EXPECT_EQ(document.current().counts.fail, before.counts.fail);
  EXPECT_TRUE(same_bytes(document.current().surface->positions, document.current().model.positions)) << "relaxing keeps the new shape";
  must_apply(document, R"({"edit":"undo"})");
  expect_same(document.current(), before);
}

TEST(SeparateEdit, heeds_locks_and_sides) {
  Document document = make_document(close_sheets(0.4));
  must_apply(document, R"({"edit":"lock","on":"1"})");
  must_apply(document, R"({"edit":"separate"})");
  EXPECT_EQ(contacts(document), 0u);
  EXPECT_EQ(place_of(document, 61), Vec3(25, 25, 0)) << "locked";
  EXPECT_NEAR(place_of(document, 1013).z(), 1, 1e-6);
  must_apply(document, R"({"edit":"undo"})");
  EXPECT_EQ(why_left(must_apply(document, R"({"edit":"separate","on":"part:1","move":"on"})")), "nodes of part 1 are locked");
  must_apply(document, R"({"edit":"lock","on":"2"})");
  const EditReport report = must_apply(document, R"({"edit":"separate"})");
  EXPECT_EQ(report.nodes_moved, 0u);
  EXPECT_THAT(why_left(report), HasSubstr("are locked"));
  EXPECT_THAT(report.notes, testing::Contains(HasSubstr("left part:1 and part:2: nodes of part 1 are locked")));
}

TEST(SeparateEdit, takes_its_fields) {
  Document document = make_document(close_sheets(0.4));
  EXPECT_EQ(why_left(must_apply(document, R"({"edit":"separate","max_move":0.1})")), "max_move is too small: it takes 0.3");
  EXPECT_EQ(must_apply(document, R"({"edit":"separate","kinds":["perforation"]})").separated->regions_before, 0u);
  EXPECT_EQ(must_apply(document, R"({"edit":"separate","on":"part:1","against":"part:1"})").separated->regions_before, 0u);
  EXPECT_EQ(why_left(must_apply(document, R"({"edit":"separate","allowed_depth":0.7})")), "no deeper than allowed_depth");
  must_apply(document, R"({"edit":"separate","on":"part:2","move":"against","gap":0.5,"direction":[0,0,1],"at":[25,25,0]})");
  EXPECT_NEAR(place_of(document, 61).z(), -1.1, 1e-6);
  EXPECT_EQ(place_of(document, 1013).z(), 0.4);
}

TEST(SeparateEdit, refuses_what_it_cannot_do) {
  Document document = make_document(close_sheets(0.4));
  const std::size_t generations = document.generations.size();
  EXPECT_THAT(refusal(document, R"({"edit":"separate","follow":"relax","gap":0.5})"), HasSubstr("not by a gap"));
  EXPECT_FALSE(parse_edit(R"({"edit":"separate","follow":"smooth"})"));
  EXPECT_THAT(refusal(document, R"({"edit":"separate","on":"part:77"})"), HasSubstr("77"));
  EXPECT_THAT(refusal(document, R"({"edit":"separate","against":"part:77"})"), HasSubstr("\"against\""));
  EXPECT_FALSE(parse_edit(R"({"edit":"separate","gap":-1})"));
  EXPECT_FALSE(parse_edit(R"({"edit":"separate","kinds":[]})"));
  EXPECT_FALSE(parse_edit(R"({"edit":"separate","kinds":["contact"]})"));
  EXPECT_FALSE(parse_edit(R"({"edit":"separate","direction":[0,0,0]})"));
  EXPECT_FALSE(parse_edit(R"({"edit":"separate","max_move":0})"));
  EXPECT_EQ(document.generations.size(), generations);
}

TEST(SeparateEdit, can_be_followed_by_relaxing_what_moved_without_a_contact) {
  // A row of the upper sheet is uneven, so that there is something to relax.
  const auto sheets = [] {
    Model model = close_sheets(0.4);
    for (const std::int64_t id : {1006, 1011, 1016}) {
      const std::size_t node = model.find_node(id).value;
      model.positions.set(node, model.positions[node] + Vec3(0, 0, 0.01));
    }
    for (const std::int64_t id : {1007, 1012, 1017}) {
      const std::size_t node = model.find_node(id).value;
      model.positions.set(node, model.positions[node] + Vec3(2, 0, 0));
    }
    return make_document(std::move(model));
  };
  Document alone = sheets(), followed = sheets();
  must_apply(alone, R"({"edit":"separate"})");
  must_apply(followed, R"({"edit":"select","expr":"3,1013"})");
  const EditReport report = must_apply(followed, R"({"edit":"separate","follow":"relax"})");
  EXPECT_EQ(report.separated->regions_removed, 1u);
  EXPECT_THAT(report.notes, testing::Contains(HasSubstr("relaxed: ")));
  EXPECT_EQ(contacts(followed), 0u);
  EXPECT_GT(place_of(alone, 1012).x() - place_of(followed, 1012).x(), 0.5) << "the row is evened out";
  EXPECT_EQ(place_of(alone, 1).x(), place_of(followed, 1).x());
  EXPECT_THAT(selected_ids(followed), ElementsAre(3, 1013));
  must_apply(followed, R"({"edit":"undo"})");
  EXPECT_EQ(place_of(followed, 1013).z(), 0.4);
}

TEST(SeparateEdit, finds_nothing_too_close_without_thickness) {
  Document document = make_document(close_sheets(0.4, 0));
  const EditReport report = must_apply(document, R"({"edit":"separate"})");
  EXPECT_EQ(report.separated->regions_before, 0u);
  EXPECT_THAT(report.notes, ElementsAre(HasSubstr("nothing to separate")));
}

TEST(SeparateEdit, can_be_cancelled) {
  Document document = make_document(close_sheets(0.4));
  const auto prepared = prepare(document, edit_of(R"({"edit":"separate"})"), [](double) { return false; });
  ASSERT_FALSE(prepared);
  EXPECT_TRUE(is_cancelled(prepared.error()));
}

TEST(SeparateEdit, survives_its_json) {
  const std::string text =
      R"({"against":"part:2","allowed_depth":0.25,"at":[1.0,2.0,3.0],"direction":[0.0,0.0,1.0],"edit":"separate","gap":0.5,"joined":true,"kinds":["penetration"],"max_move":2.0,"move":"against","on":"part:1"})";
  EXPECT_EQ(edit_to_json(edit_of(edit_to_json(edit_of(text)).dump())), edit_to_json(edit_of(text)));
  EXPECT_EQ(edit_to_json(edit_of(text)).at("move"), "against");
  EXPECT_EQ(edit_to_json(edit_of(text)).at("at").size(), 3u);
}

TEST(SeparateEdit, pushes_a_bead_of_the_sample_back_that_goes_through_its_neighbour) {
  const Folder folder;
  ASSERT_TRUE(deck::write_sample(folder / "sample.k", 2000));
  Result<Document> document = open(folder / "sample.k", {});
  ASSERT_TRUE(document) << document.error().text();
  must_apply(*document, R"({"edit":"select","expr":"5000104"})");
  must_apply(*document, R"({"edit":"grow","rings":2})");
  must_apply(*document, R"({"edit":"translate","by":[0.09,77.24,-0.02],"grab":5000104})");
  const std::size_t failing = document->current().counts.fail, before = contacts(*document);
  const EditReport report = must_apply(*document, R"({"edit":"separate","at":[347,15,146],"joined":true})");
  EXPECT_EQ(report.separated->regions_removed, 1u) << why_left(report);
  EXPECT_NEAR(report.separated->depth_before, 13.6, 0.1);
  EXPECT_EQ(report.separated->depth_after, 0);
  EXPECT_LE(report.separated->largest_move, report.separated->depth_before + (1.8 + 1.5) / 2 + 0.05 * 32);
  EXPECT_EQ(report.lost_connections, 0u);
  EXPECT_LE(document->current().counts.fail, failing);
  EXPECT_LT(contacts(*document), before);
}

TEST(SeparateEdit, can_be_followed_by_repairing_what_moved) {
  const Folder folder;
  ASSERT_TRUE(deck::write_sample(folder / "sample.k", 2000));
  Result<Document> document = open(folder / "sample.k", {});
  ASSERT_TRUE(document) << document.error().text();
  must_apply(*document, R"({"edit":"select","expr":"5000104"})");
  must_apply(*document, R"({"edit":"grow","rings":2})");
  must_apply(*document, R"({"edit":"translate","by":[0.09,77.24,-0.02],"grab":5000104})");
  const std::string separate = R"({"edit":"separate","at":[347,15,146],"joined":true)";
  Document alone = *document;
  must_apply(alone, separate + "}");
  const EditReport report = must_apply(*document, separate + R"(,"follow":"repair"})");
  EXPECT_EQ(report.separated->regions_removed, 1u) << why_left(report);
  EXPECT_THAT(report.notes, testing::Contains(HasSubstr("repaired: ")));
  EXPECT_LT(document->current().counts.fail, alone.current().counts.fail);
  EXPECT_LE(contacts(*document), contacts(alone));
  EXPECT_EQ(selected_ids(*document).size(), selected_ids(alone).size());
}

class SeparateDeckTest : public ::testing::Test {
 protected:
  /// Two sheets of 16 shells, 0.6 apart and 1 thick (nodes 1-25 of part 1, 101-125 of part 2), and these cards.
  Document sheets_with(const std::string& cards, double apart = 0.6) {
    DeckText deck;
    deck.sheet(1, 1, 0);
    deck.sheet(2, 101, apart);
    deck.cards(cards);
    put_content(folder_ / "main.k", deck.text());
    Result<Document> document = open(folder_ / "main.k", {});
    if (!document) ADD_FAILURE() << document.error().text();
    return std::move(*document);
  }
  Folder folder_;
};

TEST_F(SeparateDeckTest, leaves_joined_parts_and_nodes_that_cards_join) {
  Document free = sheets_with("");
  EXPECT_EQ(must_apply(free, R"({"edit":"separate"})").separated->regions_removed, 1u);
  Document welded = sheets_with("*CONSTRAINED_SPOTWELD\n        13       113\n");
  EXPECT_EQ(why_left(must_apply(welded, R"({"edit":"separate"})")), "the parts are joined there");
  const EditReport joined = must_apply(welded, R"({"edit":"separate","joined":true})");
  EXPECT_EQ(why_left(joined), "nodes of part 1 are joined by cards");
  EXPECT_EQ(joined.nodes_moved, 0u);
  EXPECT_EQ(joined.lost_connections, 0u);
}

TEST(SeparateEdit, comes_back_with_the_journal_and_replays_on_a_variant) {
  const Session session({R"({"edit":"separate","on":"part:2"})"}, make_document(close_sheets(0.4)));
  Document recovered = make_document(close_sheets(0.4));
  ASSERT_TRUE(Journal::recover(session.path, recovered));
  expect_same(recovered, session.after.back());
  EXPECT_TRUE(same_bytes(recovered.current().surface->positions, session.after.back().current().surface->positions));
  const Result<JournalIntents> intents = read_intents(session.path);
  ASSERT_TRUE(intents) << intents.error().text();
  Document variant = make_document(close_sheets(0.7), std::size_t{1} << 30, 8);
  for (const ReplayStep& step : replay(variant, *intents)) {
    EXPECT_TRUE(step.applied) << step.message;
    EXPECT_NEAR(step.report.separated->largest_move, 0.15, 1e-6);
  }
  EXPECT_EQ(contacts(variant), 0u);
}

}  // namespace
}  // namespace prismesh::mesh::document
