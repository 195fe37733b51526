// The edit that moves shells apart: what of the document it heeds, and that it is an edit like the others. The method is tested with
// mesh/contact.
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <nlohmann/json.hpp>

#include "mesh/contact/find_penetrations.h"
#include "mesh/deck/sample.h"
#include "mesh/document/clear_regions.h"
#include "mesh/document/joined_sheets.h"
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
    return opened(deck);
  }
  Document opened(const DeckText& deck) {
    put_content(folder_ / "main.k", deck.text());
    Result<Document> document = open(folder_ / "main.k", {});
    if (!document) ADD_FAILURE() << document.error().text();
    return std::move(*document);
  }
  Folder folder_;
};

TEST_F(SeparateDeckTest, leaves_joined_parts_unless_they_are_meant) {
  Document free = sheets_with("");
  EXPECT_EQ(must_apply(free, R"({"edit":"separate"})").separated->regions_removed, 1u);
  Document welded = sheets_with("*CONSTRAINED_SPOTWELD\n        13       113\n");
  EXPECT_EQ(why_left(must_apply(welded, R"({"edit":"separate"})")), "the parts are joined there");
  EXPECT_EQ(must_apply(welded, R"({"edit":"separate","joined":true})").separated->regions_removed, 1u);
}

TEST_F(SeparateDeckTest, leaves_nodes_that_cards_join_without_welding) {
  Document hinged = sheets_with("*CONSTRAINED_JOINT_SPHERICAL\n        13       113\n");
  const EditReport left = must_apply(hinged, R"({"edit":"separate","joined":true})");
  EXPECT_EQ(why_left(left), "nodes of part 1 are joined by cards");
  EXPECT_EQ(left.nodes_moved, 0u);
}

/// The height of a sheet of DeckText at (12, 13), from its corners: `first` is its first node.
double height_at_weld(const Document& document, int first) {
  const auto z = [&](int i, int j) { return place_of(document, first + i + 5 * j).z(); };
  return 0.7 * z(1, 1) + 0.2 * z(2, 2) + 0.1 * z(1, 2);
}

TEST_F(SeparateDeckTest, takes_beams_along_with_both_flanges) {
  DeckText deck;
  deck.part(9);
  deck.sheet(1, 1, 0);
  deck.sheet(2, 101, 0.6);
  deck.node(901, 12, 13, 0);
  deck.node(902, 12, 13, 0.6);
  deck.beam(9, 9, 901, 902);
  deck.beam(10, 9, 19, 119);  // shares nodes of both sheets
  Document document = opened(deck);
  const Generation before = document.current();
  const EditReport report = must_apply(document, R"({"edit":"separate","joined":true})");
  EXPECT_EQ(report.separated->regions_removed, 1u) << why_left(report);
  EXPECT_EQ(contacts(document), 0u);
  EXPECT_EQ(report.lost_connections, 0u);
  EXPECT_THAT(report.notes, testing::Contains(HasSubstr("2 nodes of welds moved along")));
  EXPECT_NEAR(place_of(document, 901).z(), -0.2, 1e-6);
  EXPECT_NEAR(place_of(document, 902).z(), 0.8, 1e-6);
  EXPECT_NEAR(place_of(document, 901).z(), height_at_weld(document, 1), 1e-9);
  EXPECT_NEAR(place_of(document, 902).z(), height_at_weld(document, 101), 1e-9);
  must_apply(document, R"({"edit":"undo"})");
  expect_same(document.current(), before);
}

TEST_F(SeparateDeckTest, takes_a_beam_along_where_one_flange_goes_through_the_other) {
  DeckText deck;
  deck.part(9);
  deck.sheet(1, 1, 0);
  deck.sheet(2, 101, 1.1);
  deck.node(901, 12, 13, 0);
  deck.node(902, 12, 13, 1.1);
  deck.beam(9, 9, 901, 902);
  Document document = opened(deck);
  must_apply(document, R"({"edit":"translate","by":[0,0,-1.6],"on":"113","falloff":{"profile":"constant"}})");
  ASSERT_NEAR(place_of(document, 902).z(), 1.1 - 0.2 * 1.6, 1e-9) << "follows its sheet";
  const EditReport report = must_apply(document, R"({"edit":"separate","joined":true})");
  EXPECT_EQ(report.separated->regions_removed, report.separated->regions_before) << why_left(report);
  EXPECT_GT(report.separated->regions_before, 0u);
  EXPECT_EQ(contacts(document), 0u);
  EXPECT_EQ(report.lost_connections, 0u);
  EXPECT_NEAR(place_of(document, 901).z(), height_at_weld(document, 1), 1e-9);
  EXPECT_NEAR(place_of(document, 902).z(), height_at_weld(document, 101), 1e-9);
  EXPECT_GE(place_of(document, 902).z() - place_of(document, 901).z(), 0.99);
}

/// A solid with these heights of its lower and its upper nodes, 911 to 918, about (x, x).
void add_nugget(DeckText& deck, double x, double lower, double upper) {
  deck.part(9);
  for (int k = 0; k < 2; ++k)
    for (int n = 0; n < 4; ++n) deck.node(911 + 4 * k + n, x + (n == 1 || n == 2 ? 1 : -1), x + (n > 1 ? 1 : -1), k == 0 ? lower : upper);
  deck.cards("*ELEMENT_SOLID\n       9       9     911     912     913     914     915     916     917     918\n");
}

TEST_F(SeparateDeckTest, takes_a_solid_nugget_along_with_both_flanges) {
  DeckText deck;
  deck.sheet(1, 1, 0);
  deck.sheet(2, 101, 0.6);
  add_nugget(deck, 15, 0, 0.6);
  Document document = opened(deck);
  const EditReport report = must_apply(document, R"({"edit":"separate","joined":true})");
  EXPECT_EQ(report.separated->regions_removed, 1u) << why_left(report);
  EXPECT_EQ(report.lost_connections, 0u);
  EXPECT_EQ(contacts(document), 0u);
  for (int n = 0; n < 4; ++n) {
    EXPECT_NEAR(place_of(document, 911 + n).z(), -0.2, 1e-6);
    EXPECT_NEAR(place_of(document, 915 + n).z(), 0.8, 1e-6);
  }
}

TEST_F(SeparateDeckTest, takes_constrained_welds_and_small_rigid_bodies_along) {
  Document document = sheets_with(
      "*CONSTRAINED_SPOTWELD\n        13       113\n*SET_NODE_LIST\n         5\n         7         8       107       108\n"
      "*CONSTRAINED_NODAL_RIGID_BODY\n         5         0         5\n");
  const EditReport report = must_apply(document, R"({"edit":"separate","joined":true})");
  EXPECT_EQ(report.separated->regions_removed, 1u) << why_left(report);
  EXPECT_EQ(contacts(document), 0u);
  for (const int node : {13, 7, 8}) EXPECT_NEAR(place_of(document, node + 100).z() - place_of(document, node).z(), 1, 1e-6);
  const auto joined = joints(document.current());
  const auto& parts = document.current().model.shell_parts;
  EXPECT_GE(joined.size(), 2u);
  for (const auto& [a, b] : joined) EXPECT_NE(parts[a.value], parts[b.value]);
}

TEST_F(SeparateDeckTest, leaves_what_would_lose_a_weld_or_tie) {
  const auto why = [](Document document, double gap) {
    const EditReport report = must_apply(document, R"({"edit":"separate","joined":true,"gap":)" + std::to_string(gap) + "}");
    EXPECT_EQ(report.nodes_moved == 0, !why_left(report).empty());
    EXPECT_EQ(report.lost_connections, 0u);
    return why_left(report);
  };
  // A tied node lies on its sheet up to half of a side: 5.
  const std::string tie =
      "*CONTACT_TIED_NODES_TO_SURFACE\n         5         1         4         3\n\n\n*SET_NODE_LIST\n         5\n       113\n";
  EXPECT_EQ(why(sheets_with(tie), 3.9), "");
  EXPECT_THAT(why(sheets_with(tie), 4.1), HasSubstr("a weld or tie would be lost: node:113, which *CONTACT_TIED_NODES_TO_SURFACE"));
  // A joint is at most two sides long: 20.
  const std::string spot = "*CONSTRAINED_SPOTWELD\n        13       113\n";
  EXPECT_EQ(why(sheets_with(spot), 18.9), "");
  EXPECT_THAT(why(sheets_with(spot), 19.1), HasSubstr("a weld would be lost: *CONSTRAINED_SPOTWELD"));
  // A weld of a locked part can't follow, and lies on its sheet up to a quarter of a side: 2.5.
  DeckText deck;
  deck.part(9);
  deck.sheet(1, 1, 0);
  deck.sheet(2, 101, 0.6);
  deck.node(901, 12, 13, 0);
  deck.node(902, 12, 13, 0.6);
  deck.beam(9, 9, 901, 902);
  Document locked = opened(deck);
  must_apply(locked, R"({"edit":"lock","on":"9"})");
  EXPECT_EQ(why(locked, 4.5), "");
  EXPECT_THAT(why(locked, 4.7), HasSubstr("(it belongs to a locked part)"));
}

TEST_F(SeparateDeckTest, turns_no_solid_inside_out) {
  // The second sheet goes through the first at one node, and the nugget is right side up as it stands.
  DeckText deck;
  deck.sheet(1, 1, 0);
  for (int j = 0; j <= 4; ++j)
    for (int i = 0; i <= 4; ++i) deck.node(101 + i + 5 * j, 10 * i, 10 * j, i == 2 && j == 2 ? -0.5 : 1.1);
  std::string shells = "*ELEMENT_SHELL\n";
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) {
      char line[64];
      const int corner = 101 + i + 5 * j;
      std::snprintf(line, sizeof line, "%8d%8d%8d%8d%8d%8d\n", 101 + i + 4 * j, 2, corner, corner + 1, corner + 6, corner + 5);
      shells += line;
    }
  deck.part(2);
  deck.cards(shells);
  add_nugget(deck, 20, -0.34, 0);
  Document document = opened(deck);
  const EditReport report = must_apply(document, R"({"edit":"separate","joined":true})");
  EXPECT_EQ(why_left(report), "solid:9 would turn inside out");
  EXPECT_EQ(report.nodes_moved, 0u);
}

TEST_F(SeparateDeckTest, gives_the_same_with_any_number_of_threads_and_from_the_journal) {
  DeckText deck;
  deck.part(9);
  deck.sheet(1, 1, 0);
  deck.sheet(2, 101, 0.6);
  for (int n = 0; n < 8; ++n) {
    deck.node(901 + 2 * n, 3 + 4.4 * n, 13 + 2.1 * n, 0.03 * n);
    deck.node(902 + 2 * n, 3 + 4.4 * n, 13 + 2.1 * n, 0.6 - 0.01 * n);
    deck.beam(9 + n, 9, 901 + 2 * n, 902 + 2 * n);
  }
  const Document before = opened(deck);
  std::vector<Document> after;
  for (const int threads : {1, 7}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    after.push_back(before);
    EXPECT_EQ(must_apply(after.back(), R"({"edit":"separate","joined":true})").separated->regions_removed, 1u);
  }
  expect_same(after[0], after[1]);
  const Session session({R"({"edit":"separate","joined":true})"}, before);
  Document recovered = before;
  ASSERT_TRUE(Journal::recover(session.path, recovered));
  expect_same(recovered, session.after.back());
  expect_same(recovered, after[0]);
}

/// Three regions: of parts 1 and 2, which a weld joins; 3 and 4; 5 and 6, which go through each other half.
DeckText three_places() {
  DeckText deck;
  deck.sheet(1, 1, 0);
  deck.sheet(2, 101, 0.6);
  deck.sheet(3, 201, 50);
  deck.sheet(4, 301, 50.7);
  deck.part(5), deck.part(6);
  for (int n = 0; n < 4; ++n) {
    deck.node(401 + n, n == 1 || n == 2 ? 10 : 0, n > 1 ? 10 : 0, 100);
    deck.node(411 + n, n == 1 || n == 2 ? 15 : 5, 5, n > 1 ? 105 : 95);
  }
  deck.shell(401, 5, 401);
  deck.shell(411, 6, 411);
  deck.cards("*CONSTRAINED_SPOTWELD\n        13       113\n");
  return deck;
}

TEST_F(SeparateDeckTest, says_beforehand_what_it_would_remove) {
  Document document = opened(three_places());
  const auto found = [&](const ContactWish& wish) {
    ContactSearch search;
    Result<Contacts> contacts = find_contacts(document.current(), search, wish);
    EXPECT_TRUE(find_clear(document, wish, *contacts));
    return contacts->regions;
  };
  const auto why_of = [&](const std::vector<ContactRegion>& regions) {
    std::map<std::string, std::string> why;
    for (const ContactRegion& region : regions) {
      EXPECT_EQ(region.clear, region.why.empty());
      why[region.a] = region.clear ? "clear" : region.why;
    }
    return why;
  };
  using Why = std::map<std::string, std::string>;
  EXPECT_EQ(why_of(found({})), (Why{{"part:1", "clear"}, {"part:3", "clear"}, {"part:5", "half through: nothing is cut off"}}));
  EXPECT_EQ(why_of(found({.select = "part:4 & 301-302"})), (Why{{"part:3", "clear"}}));
  const auto far = why_of(found({.select = "part:1", .gap = 19.5}));
  EXPECT_THAT(far.at("part:1"), HasSubstr("a weld would be lost: *CONSTRAINED_SPOTWELD"));
  must_apply(document, R"({"edit":"lock","on":"1"})");
  must_apply(document, R"({"edit":"lock","on":"3"})");
  must_apply(document, R"({"edit":"lock","on":"4"})");
  const std::vector<ContactRegion> locked = found({});
  EXPECT_EQ(why_of(locked),
            (Why{{"part:1", "clear"}, {"part:3", "nodes of part 3 are locked"}, {"part:5", "half through: nothing is cut off"}}));
  for (const ContactRegion& region : locked) {
    Document tried = document;
    const EditReport report = must_apply(tried, R"({"edit":"separate","joined":true,"on":")" + region.a + R"("})");
    EXPECT_EQ(report.separated->regions_removed == 1, region.clear) << region.a;
    EXPECT_EQ(why_left(report), region.why);
  }
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
