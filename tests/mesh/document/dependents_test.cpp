// What hangs on nodes that move: welds that lie on sheets, cards that join nodes, contacts that tie them.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/document/deck_relations.h"
#include "mesh/document/dependents.h"
#include "mesh/document/drag.h"
#include "tests/mesh/document/document_fixture.h"
#include "tests/mesh/document/sheets_deck.h"

namespace prismesh::mesh::document {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// Two sheets, 1.6 apart (nodes 1-25 of part 1, 101-125 of part 2), joined by weld beams: 9 at (12, 13), 10 at (35, 35).
DeckText two_sheets() {
  DeckText deck;
  deck.sheet(1, 1, 0);
  deck.sheet(2, 101, 1.6);
  deck.part(9);
  deck.node(901, 12, 13, 0.1);
  deck.node(902, 12, 13, 1.5);
  deck.node(903, 35, 35, 0);
  deck.node(904, 35, 35, 1.6);
  deck.beam(9, 9, 901, 902);
  deck.beam(10, 9, 903, 904);
  return deck;
}

class HangingTest : public ::testing::Test {
 protected:
  Document open_text(const DeckText& deck) {
    put_content(folder_ / "main.k", deck.text());
    OpenOptions options;
    options.target_size = 10.0;
    Result<Document> document = open(folder_ / "main.k", options);
    if (!document) ADD_FAILURE() << document.error().text();
    return std::move(*document);
  }
  static Vec3 at(const Document& document, std::int64_t id) {
    const Model& model = document.current().model;
    return model.position(model.find_node(id));
  }
  Folder folder_;
};

TEST_F(HangingTest, welds_follow_the_sheet_they_lie_on) {
  Document document = open_text(two_sheets());
  const EditReport report = must_apply(document, R"({"edit":"translate","by":[1,2,3],"on":"part:1","falloff":{"profile":"constant"}})");
  EXPECT_EQ(report.nodes_moved, 27u);
  EXPECT_NEAR((at(document, 901) - Vec3(13, 15, 3.1)).norm(), 0, 1e-12);
  EXPECT_EQ(at(document, 902), Vec3(12, 13, 1.5));
  EXPECT_NEAR((at(document, 903) - Vec3(36, 37, 3)).norm(), 0, 1e-12);
  EXPECT_EQ(at(document, 904), Vec3(35, 35, 1.6));
  EXPECT_THAT(report.notes, Contains(HasSubstr("2 nodes of welds moved along with the sheets they lie on")));
  EXPECT_EQ(report.lost_connections, 0u);
}

TEST_F(HangingTest, a_weld_moves_by_the_shares_of_its_shells_corners) {
  Document document = open_text(two_sheets());
  // node 13 at (20, 20) alone: weld node 901 at (12, 13) lies in the shell from (10, 10) to (20, 20), in the triangle at the corner (10,
  // 20)
  must_apply(document, R"({"edit":"translate","by":[0,0,1],"on":"13","falloff":{"profile":"constant"}})");
  EXPECT_NEAR(at(document, 901).z(), 0.1 + 0.2, 1e-12);
  EXPECT_EQ(at(document, 903), Vec3(35, 35, 0));
}

TEST_F(HangingTest, a_drag_carries_what_its_edit_carries) {
  Document document = open_text(two_sheets());
  for (const char* json :
       {R"({"edit":"translate","by":[0,0,0],"on":"part:1"})",
        R"({"edit":"rotate","point":[0,0,0],"axis":[0,0,1],"degrees":0,"on":"part:1"})", R"({"edit":"slide","by":[0,0,0],"on":"part:1"})",
        R"({"edit":"lift","distance":0,"normals":"each","on":"part:1"})"}) {
    Document one = document;
    Result<Drag> drag = Drag::begin(one.generations[one.cursor], edit_of(json));
    ASSERT_TRUE(drag) << drag.error().text();
    Displacement far;
    far.by = Vec3(0.5, 0.25, 0.125);
    far.distance = 1.5;
    far.degrees = 10;
    drag->step(far);
    ASSERT_TRUE(try_apply(one, drag->edit()));
    const NodeIndex weld = one.current().model.find_node(901);
    ASSERT_THAT(drag->nodes(), Contains(weld)) << json;
    for (std::size_t i = 0; i < drag->nodes().size(); ++i)
      EXPECT_EQ(drag->positions()[i], one.current().model.position(drag->nodes()[i])) << json;
    EXPECT_GT((at(one, 901) - Vec3(12, 13, 0.1)).norm(), 1e-3) << json;
  }
}

TEST_F(HangingTest, symmetric_edits_carry_welds_on_both_sides) {
  DeckText deck;
  deck.part(9);
  deck.node(901, 12, 13, 0.1);  // before the sheet's nodes: those that follow come in between
  deck.node(902, 12, 13, 9);
  deck.sheet(1, 1, 0);
  deck.node(903, 28, 13, 0.1);
  deck.node(904, 28, 13, 9);
  deck.beam(9, 9, 901, 902);
  deck.beam(10, 9, 903, 904);
  Document document = open_text(deck);
  must_apply(document, R"({"edit":"translate","by":[1,0,2],"on":"part:1 & id<=25","grab":6,"falloff":{"profile":"constant"},)"
                       R"("symmetry":{"point":[20,0,0],"normal":[1,0,0]}})");
  const Vec3 left = at(document, 901) - Vec3(12, 13, 0.1);
  const Vec3 right = at(document, 903) - Vec3(28, 13, 0.1);
  EXPECT_NEAR(left.z(), 2, 1e-12);
  EXPECT_GT(left.x(), 0.1);
  EXPECT_NEAR(right.x(), -left.x(), 0.2);  // the diagonals of quads aren't mirrored
  EXPECT_NEAR(right.z(), left.z(), 1e-12);
  EXPECT_EQ(at(document, 902), Vec3(12, 13, 9));
}

TEST_F(HangingTest, what_is_carried_in_between_leaves_each_node_with_its_own_image) {
  DeckText deck;
  deck.part(9);
  for (int i = 0; i < 3; ++i) deck.node(901 + i, 12 + i, 13, 0.1 * i);  // before the sheet's nodes, as above
  deck.sheet(1, 1, 0);
  deck.beam(9, 9, 901, 902);
  deck.beam(10, 9, 902, 903);
  Document document = open_text(deck);
  must_apply(document, R"({"edit":"translate","by":[1,0.5,2],"on":"part:1 & id<=25","grab":12,"falloff":{"profile":"linear"},)"
                       R"("symmetry":{"point":[20,0,0],"normal":[1,0,0]}})");
  EXPECT_GT(at(document, 12).z(), 1.9);
  for (int j = 0; j <= 4; ++j)
    for (int i = 0; i <= 4; ++i) {
      const Vec3 one = at(document, 1 + i + 5 * j), other = at(document, 1 + (4 - i) + 5 * j);
      EXPECT_NEAR((one - Vec3(40 - other.x(), other.y(), other.z())).norm(), 0, 1e-9) << i << ", " << j;
    }
}

TEST_F(HangingTest, a_weld_that_is_acted_on_itself_is_reached_with_its_sheet) {
  Document document = open_text(two_sheets());
  const EditReport report = must_apply(document, R"({"edit":"translate","by":[0,0,1],"on":"1-25,901","grab":13})");
  EXPECT_GT(at(document, 901).z(), 0.2);
  for (const std::string& note : report.notes) EXPECT_THAT(note, Not(HasSubstr("can't be reached")));
}

TEST_F(HangingTest, relaxing_leaves_joined_nodes_in_place_and_weighs_anew) {
  DeckText deck = two_sheets();
  deck.cards("*CONSTRAINED_SPOTWELD\n        13       113\n");
  Document document = open_text(deck);
  must_apply(document, R"({"edit":"translate","by":[4,3,6],"on":"13","falloff":{"profile":"constant"}})");
  must_apply(document, R"({"edit":"translate","by":[-3,4,2],"on":"17","falloff":{"profile":"constant"}})");
  const Vec3 joined = at(document, 13), free = at(document, 17);
  const double before = document.current().weight.mass;
  const EditReport report = must_apply(document, R"({"edit":"relax","scope":"all"})");
  EXPECT_EQ(at(document, 13), joined);
  EXPECT_NE(at(document, 17), free);
  EXPECT_THAT(report.notes, Contains("2 nodes that cards join stay"));
  const double mass = quality::mass_properties(document.current().model).mass;
  EXPECT_NEAR(document.current().weight.mass, mass, 1e-12 * mass);
  EXPECT_GT(std::abs(mass - before), 1e-6 * mass) << "or this would show nothing";
  EXPECT_EQ(*report.mass_before, before);
  EXPECT_EQ(*report.mass_after, document.current().weight.mass);
}

TEST_F(HangingTest, undo_and_saving_bring_welds_along) {
  Document document = open_text(two_sheets());
  must_apply(document, R"({"edit":"translate","by":[0,0,4],"on":"part:1","falloff":{"profile":"constant"}})");
  ASSERT_TRUE(save(document, folder_ / "out.k"));
  OpenOptions options;
  options.target_size = 10.0;
  const Result<Document> again = open(folder_ / "out.k", options);
  ASSERT_TRUE(again);
  EXPECT_NEAR(at(*again, 901).z(), 4.1, 1e-9);
  must_apply(document, R"({"edit":"undo"})");
  EXPECT_EQ(at(document, 901), Vec3(12, 13, 0.1));
}

TEST_F(HangingTest, what_cannot_follow_is_left_and_listed_as_lost) {
  Document document = open_text(two_sheets());
  must_apply(document, R"({"edit":"lock","on":"9"})");
  const EditReport report = must_apply(document, R"({"edit":"translate","by":[0,0,-8],"on":"part:1","falloff":{"profile":"constant"}})");
  EXPECT_EQ(at(document, 901), Vec3(12, 13, 0.1));
  EXPECT_EQ(report.lost_connections, 2u);
  ASSERT_EQ(report.lost.size(), 2u);
  EXPECT_EQ(report.lost[0], "beam:9 at node:901 no longer lies on shell:6, it is 8.1 away (it belongs to a locked part)");
  // what is lost already isn't lost again
  EXPECT_EQ(must_apply(document, R"({"edit":"translate","by":[0,0,-1],"on":"part:1","falloff":{"profile":"constant"}})").lost_connections,
            0u);
}

TEST_F(HangingTest, welds_that_are_moved_away_by_themselves_are_lost) {
  Document document = open_text(two_sheets());
  const EditReport report = must_apply(document, R"({"edit":"translate","by":[0,0,30],"on":"902","falloff":{"profile":"constant"}})");
  EXPECT_EQ(report.nodes_moved, 1u);
  ASSERT_EQ(report.lost.size(), 1u);
  EXPECT_THAT(report.lost[0], HasSubstr("beam:9 at node:902 no longer lies on shell:106"));
  // along its sheet it stays on it, also on another shell
  EXPECT_EQ(must_apply(document, R"({"edit":"translate","by":[14,0,0],"on":"904","falloff":{"profile":"constant"}})").lost_connections, 1u);
  EXPECT_EQ(must_apply(document, R"({"edit":"translate","by":[-14,-9,0],"on":"903","falloff":{"profile":"constant"}})").lost_connections,
            0u);
}

TEST_F(HangingTest, frames_of_beams_and_far_things_are_no_welds) {
  DeckText deck = two_sheets();
  deck.part(8);
  for (int i = 0; i <= 20; ++i) deck.node(800 + i, 0.5 * i, 5, 0.2);  // a chain of twenty beams close to the sheet
  for (int i = 0; i < 20; ++i) deck.beam(20 + i, 8, 800 + i, 801 + i);
  deck.node(950, 5, 5, -4);  // farther from the sheet than a quarter of its shells
  deck.node(951, 5, 5, -9);
  deck.beam(60, 8, 950, 951);
  Document document = open_text(deck);
  const EditReport report = must_apply(document, R"({"edit":"translate","by":[0,0,1],"on":"part:1","falloff":{"profile":"constant"}})");
  EXPECT_EQ(report.nodes_moved, 27u);
  EXPECT_EQ(at(document, 801), Vec3(0.5, 5, 0.2));
}

TEST_F(HangingTest, cards_of_which_only_some_nodes_move_are_flagged) {
  DeckText deck = two_sheets();
  deck.cards("*SET_NODE_LIST_TITLE\nbracket\n         7\n         1         2         3       101       102\n");
  deck.cards("*CONSTRAINED_NODAL_RIGID_BODY\n        50         0         7\n");
  deck.cards("*CONSTRAINED_SPOTWELD\n        25       125\n        11        12\n");
  Document document = open_text(deck);
  const EditReport report = must_apply(document, R"({"edit":"translate","by":[0,0,0.2],"on":"part:1","falloff":{"profile":"constant"}})");
  EXPECT_THAT(report.notes, Contains("*CONSTRAINED_NODAL_RIGID_BODY 50: 3 of its 5 nodes moved; left in place: node:101, node:102"));
  EXPECT_THAT(report.notes, Contains("*CONSTRAINED_SPOTWELD: 1 of its 2 nodes moved; left in place: node:125"));
  // nothing of the spot weld that moved whole
  EXPECT_EQ(std::count_if(report.notes.begin(), report.notes.end(), [](const std::string& n) { return n.find("SPOTWELD") != n.npos; }), 1);
  // as a whole it moves without a word
  const EditReport whole = must_apply(document, R"({"edit":"translate","by":[0,0,0.2],"on":"all","falloff":{"profile":"constant"}})");
  for (const std::string& note : whole.notes) EXPECT_THAT(note, Not(HasSubstr("CONSTRAINED")));
}

TEST_F(HangingTest, of_many_nodes_and_cards_that_stay_behind_some_are_named_and_the_rest_counted) {
  constexpr auto kRaise = R"({"edit":"translate","by":[0,0,0.2],"on":"part:1","falloff":{"profile":"constant"}})";
  DeckText body = two_sheets();
  body.cards("*SET_NODE_LIST\n         7\n         1       101       102       103       104       105       106       107\n");
  body.cards("*CONSTRAINED_NODAL_RIGID_BODY\n        50         0         7\n");
  Document document = open_text(body);
  EXPECT_THAT(must_apply(document, kRaise).notes,
              Contains("*CONSTRAINED_NODAL_RIGID_BODY 50: 1 of its 8 nodes moved; left in place: node:101, node:102, "
                       "node:103, node:104, node:105 and 2 more"));

  DeckText welds = two_sheets();
  welds.cards("*CONSTRAINED_SPOTWELD\n");
  for (int i = 0; i < 7; ++i) welds.cards("        1" + std::to_string(i) + "       11" + std::to_string(i) + "\n");
  document = open_text(welds);
  const EditReport report = must_apply(document, kRaise);
  EXPECT_EQ(std::count_if(report.notes.begin(), report.notes.end(), [](const std::string& n) { return n.find("left in place") != n.npos; }),
            5);
  EXPECT_THAT(report.notes, Contains("so it is with 2 more cards that join nodes"));
}

TEST_F(HangingTest, tied_nodes_that_leave_their_master_are_lost) {
  DeckText deck = two_sheets();
  deck.cards("*SET_NODE_LIST\n         8\n       101       102       103\n");
  deck.cards("*CONTACT_TIED_NODES_TO_SURFACE\n         8         1         4         3\n\n\n");
  Document document = open_text(deck);
  const EditReport near = must_apply(document, R"({"edit":"translate","by":[1,0,0.3],"on":"part:2","falloff":{"profile":"constant"}})");
  EXPECT_EQ(near.lost_connections, 0u);
  const EditReport report = must_apply(document, R"({"edit":"translate","by":[0,0,9],"on":"101-102","falloff":{"profile":"constant"}})");
  EXPECT_EQ(report.lost_connections, 2u);
  ASSERT_FALSE(report.lost.empty());
  EXPECT_THAT(report.lost[0], HasSubstr("node:101, which *CONTACT_TIED_NODES_TO_SURFACE ties, no longer lies on shell:1"));
}

TEST_F(HangingTest, tells_mass_and_centre_before_and_after) {
  Document document = open_text(two_sheets());
  const EditReport report = must_apply(document, R"({"edit":"translate","by":[0,0,-6],"on":"part:1","falloff":{"profile":"constant"}})");
  const double sheet = 40.0 * 40.0 * 7.9e-9;
  ASSERT_TRUE(report.mass_before && report.mass_after && report.centre_before && report.centre_after);
  EXPECT_NEAR(*report.mass_before, 2 * sheet, 1e-15);
  EXPECT_NEAR(*report.mass_after, 2 * sheet, 1e-15);
  EXPECT_NEAR((*report.centre_before)[2], 0.8, 1e-12);
  EXPECT_NEAR((*report.centre_after)[2], -2.2, 1e-12);
  // stretched to twice its length it weighs twice as much
  must_apply(document, R"({"edit":"undo"})");
  for (int i = 1; i <= 4; ++i) {
    const std::string on = std::to_string(1 + i) + "-25:5";
    must_apply(document, R"({"edit":"translate","by":[)" + std::to_string(10 * i) + R"(,0,0],"on":")" + on +
                             R"(","falloff":{"profile":"constant"}})");
  }
  EXPECT_NEAR(document.current().weight.mass, 3 * sheet, 1e-14);
  EXPECT_NEAR(document.current().weight.mass, quality::mass_properties(document.current().model).mass, 1e-15);
}

TEST_F(HangingTest, counts_what_a_move_turns_over) {
  Document document = open_text(two_sheets());
  EXPECT_EQ(must_apply(document, R"({"edit":"translate","by":[0,0,5],"on":"13","falloff":{"profile":"constant"}})").inverted, 0u);
  must_apply(document, R"({"edit":"undo"})");
  // the inner node far beyond its neighbours folds the shells on that side
  const EditReport folded = must_apply(document, R"({"edit":"translate","by":[25,0,0],"on":"13","falloff":{"profile":"constant"}})");
  EXPECT_EQ(folded.inverted, 2u);
  EXPECT_THAT(folded.notes, Contains(HasSubstr("2 elements turned over or folded: shell:7, shell:11")));
  must_apply(document, R"({"edit":"undo"})");
  // a turn as a whole turns nothing over, whatever its angle
  EXPECT_EQ(must_apply(document,
                       R"({"edit":"rotate","point":[0,0,0],"axis":[1,0,0],"degrees":170,"on":"part:1","falloff":{"profile":"constant"}})")
                .inverted,
            0u);
}

/// The welds of a real car in a file of their own, and a small sheet of ours under each end of each beam, across the beam.
TEST_F(HangingTest, welds_of_a_real_car_follow_the_sheets_under_them) {
  const char* models = std::getenv("PRISMESH_MODELS");
  if (models == nullptr) GTEST_SKIP() << "PRISMESH_MODELS isn't set";
  const std::filesystem::path welds = std::filesystem::path(models) / "camry_weld7_beams/weld7.k";
  const Result<Document> alone = open(welds, OpenOptions{});
  ASSERT_TRUE(alone) << alone.error().text();
  const Model& model = alone->current().model;
  std::filesystem::copy_file(welds, folder_ / "weld7.k");
  const ElementBlock& beams = *model.elements[static_cast<std::size_t>(ElementClass::beam)];
  std::vector<std::uint8_t> has_sheet(model.node_count(), 0);
  DeckText deck;
  deck.part(1);
  deck.cards("*INCLUDE\nweld7.k\n");
  int next = 1;
  for (std::size_t e = 0; e < beams.size(); ++e) {
    const NodeIndex a = beams.nodes[beams.first_node[e]], b = beams.nodes[beams.first_node[e] + 1];
    const Vec3 along = (model.position(b) - model.position(a)).normalized();
    const Vec3 x = along.unitOrthogonal();
    const Vec3 y = along.cross(x);
    for (const NodeIndex node : {a, b}) {
      if (std::exchange(has_sheet[node.value], 1) != 0) continue;
      const Vec3 middle = model.position(node) + (node == a ? -0.05 : 0.05) * along;
      for (const auto& [u, v] : {std::pair(-4, -4), std::pair(4, -4), std::pair(4, 4), std::pair(-4, 4)}) {
        const Vec3 corner = middle + u * 0.25 * x + v * 0.25 * y;
        deck.node(next++, corner.x(), corner.y(), corner.z());
      }
      deck.shell(next - 4, 1, next - 4);
    }
  }
  Document document = open_text(deck);
  const EditReport report = must_apply(document, R"({"edit":"translate","by":[3,-2,5],"on":"shell:all","falloff":{"profile":"constant"}})");
  const Model& after = document.current().model;
  std::size_t carried = 0;
  for (std::size_t n = 0; n < model.node_count(); ++n) {
    if (has_sheet[n] == 0) continue;
    const Vec3 way = after.position(after.find_node(model.node_ids[n])) - model.position(NodeIndex(n));
    EXPECT_NEAR((way - Vec3(3, -2, 5)).norm(), 0, 1e-9) << model.node_ids[n];
    ++carried;
  }
  EXPECT_GT(carried, 4000u);
  EXPECT_EQ(report.nodes_moved, 5 * carried);
  EXPECT_EQ(report.lost_connections, 0u);
}

}  // namespace
}  // namespace prismesh::mesh::document
