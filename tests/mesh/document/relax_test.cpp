#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "tests/mesh/document/document_fixture.h"
#include "tests/support/real_deck.h"

namespace prismesh::mesh::document {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// A 20 x 10 sheet of which three nodes were slid by 4 of 5 mm.
Document slid_sheet() {
  Document document = make_sheet(20, 10);
  must_apply(document, R"({"edit":"slide","by":[3.2,2.4,0],"on":"95,116,137","grab":116,"falloff":{"profile":"constant"}})");
  return document;
}

bool same_bits(const Vec3& a, const Vec3& b) { return std::equal(a.data(), a.data() + 3, b.data()); }

std::size_t differing(const Model& a, const Model& b) {
  std::size_t count = 0;
  for (std::size_t n = 0; n < a.node_count(); ++n) count += same_bits(a.positions[n], b.positions[n]) ? 0 : 1;
  return count;
}

TEST(Relax, makes_what_a_slide_crushed_fine_again) {
  Document document = slid_sheet();
  ASSERT_GT(document.current().counts.fail, 0u);
  const auto surface = document.current().surface;
  const EditReport report = must_apply(document, R"({"edit":"relax","scope":"damaged"})");
  EXPECT_EQ(report.after.fail, 0u);
  EXPECT_LT(report.after.warn, report.before.warn + report.before.fail);
  EXPECT_GT(report.nodes_moved, 0u);
  EXPECT_THAT(report.notes, Contains(HasSubstr("at rest after")));
  EXPECT_EQ(document.current().surface, surface);  // relaxing doesn't shape
  EXPECT_EQ(document.current().counts, quality::count(quality::judge_model(document.current().model, judged_by(document))));
  for (std::size_t n = 0; n < document.current().model.node_count(); ++n) EXPECT_NEAR(document.current().model.positions[n].z(), 0, 1e-12);
  must_apply(document, R"({"edit":"undo"})");
  EXPECT_EQ(document.current().counts.fail, report.before.fail);
}

TEST(Relax, moves_selected_nodes_only) {
  Document document = slid_sheet();
  const Model before = document.current().model;
  must_apply(document, R"({"edit":"select","expr":"115-117"})");
  const EditReport report = must_apply(document, R"({"edit":"relax"})");
  EXPECT_LE(report.nodes_moved, 3u);
  EXPECT_GT(report.nodes_moved, 0u);
  EXPECT_EQ(differing(before, document.current().model), report.nodes_moved);
}

TEST(Relax, of_failing_elements_looks_one_ring_further) {
  Document document = slid_sheet();
  const Model before = document.current().model;
  const EditReport report = must_apply(document, R"({"edit":"relax","scope":"failed"})");
  EXPECT_GT(report.nodes_moved, 0u);
  EXPECT_LT(report.nodes_moved, before.node_count() / 2);
  EXPECT_LT(report.after.fail, report.before.fail);
}

TEST(Relax, of_damaged_elements_looks_one_ring_further_too) {
  Document document = slid_sheet();
  const Model before = document.current().model;
  const EditReport damaged = must_apply(document, R"({"edit":"relax","scope":"damaged"})");
  EXPECT_GT(damaged.nodes_moved, 0u);
  EXPECT_LT(damaged.nodes_moved, before.node_count() / 2);
  // All that moved stands beside a shell that failed or warned, or beside a neighbour of one.
  std::set<NodeIndex> near;
  const Generation& slid = *document.generations[document.cursor - 1];
  std::set<ShellIndex> touching;
  for (std::size_t s = 0; s < before.shell_count(); ++s)
    if (slid.quality[s].warn != 0)
      for (const NodeIndex corner : before.shell(ShellIndex(s)).node)
        for (const ShellIndex neighbour : before.adjacency->shells_of(corner)) touching.insert(neighbour);
  for (const ShellIndex shell : touching)
    for (const NodeIndex corner : before.shell(shell).node) near.insert(corner);
  bool beyond_the_damaged = false;
  for (const NodeIndex node : moved_nodes(before, document.current().model)) {
    EXPECT_TRUE(near.contains(node)) << before.node_ids[node.value];
    const auto shells = before.adjacency->shells_of(node);
    beyond_the_damaged |= std::all_of(shells.begin(), shells.end(), [&](ShellIndex s) { return slid.quality[s.value].warn == 0; });
  }
  EXPECT_TRUE(beyond_the_damaged);
}

TEST(Relax, leaves_what_else_hangs_on_nodes_in_place) {
  Document document = make_document(make_assembly());
  must_apply(document, R"({"edit":"slide","by":[3.5,0,0],"on":"111-137","grab":122})");
  const Vec3 beam = place_of(document, 100), solid = place_of(document, 148);
  const EditReport report = must_apply(document, R"({"edit":"relax","scope":"all"})");
  EXPECT_TRUE(same_bits(place_of(document, 100), beam));
  EXPECT_TRUE(same_bits(place_of(document, 148), solid));
  EXPECT_THAT(report.notes, Contains("2 nodes with elements other than shells stay"));
}

TEST(Relax, leaves_locked_and_held_nodes_and_says_so) {
  Model model = make_assembly();
  model.node_holds.set(model.find_node(112).value, kHeldByParameter);
  Document document = make_document(std::move(model));
  must_apply(document, R"({"edit":"slide","by":[3.5,0,0],"on":"121-128","grab":126})");
  must_apply(document, R"({"edit":"lock","on":"part:2"})");
  const Model before = document.current().model;
  const EditReport report = must_apply(document, R"({"edit":"relax","scope":"all"})");
  EXPECT_THAT(report.notes, Contains("1 node held by the deck stays"));
  EXPECT_THAT(report.notes, Contains("25 nodes of locked parts stay"));
  for (std::size_t n = 0; n < before.node_count(); ++n) {
    const bool stays = before.positions[n].x() >= 20 || before.node_ids[n] == 112;
    if (stays) {
      EXPECT_TRUE(same_bits(before.positions[n], document.current().model.positions[n])) << before.node_ids[n];
    }
  }
}

TEST(Relax, says_where_there_is_nothing_to_do) {
  Document document = make_sheet(6, 6);
  const Model before = document.current().model;
  EXPECT_THAT(must_apply(document, R"({"edit":"relax","scope":"damaged"})").notes,
              Contains("nothing to relax: no edit made an element fail or warn"));
  EXPECT_THAT(must_apply(document, R"({"edit":"relax","scope":"failed"})").notes, Contains("nothing to relax: no element in the scope"));
  EXPECT_THAT(must_apply(document, R"({"edit":"relax","scope":"all"})").notes,
              Contains("nothing to relax: every node is where it is best"));
  must_apply(document, R"({"edit":"lock","on":"part:1"})");
  EXPECT_THAT(must_apply(document, R"({"edit":"relax","scope":"all"})").notes, Contains("nothing to relax: every node in the scope stays"));
  EXPECT_EQ(differing(before, document.current().model), 0u);
  EXPECT_THAT(refusal(document, R"({"edit":"relax"})"), HasSubstr("nothing is selected"));
  EXPECT_THAT(refusal(document, R"({"edit":"relax","mode":"from","scope":"all"})"), HasSubstr("needs \"at\""));
  EXPECT_THAT(refusal(document, R"({"edit":"relax","mode":"from","at":99999,"scope":"all"})"), HasSubstr("99999"));
}

TEST(Relax, refuses_numbers_without_sense) {
  Document document = make_sheet(6, 6);
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN(), kMuch = std::numeric_limits<double>::infinity();
  constexpr const char* kMove = "relax: max_move must be greater than 0, or 0 on lines";
  constexpr const char* kDisplaced = "relax: the threshold must be greater than 0";
  constexpr const char* kTurn = "relax: the angle must be above 0 and at most 180 degrees";
  struct Case {
    void (*set)(Relax&, double);
    const char* words;
    std::vector<double> bad, good;
  };
  const Case cases[] = {
      {[](Relax& r, double v) { r.max_move.free = v; }, kMove, {-1, 0, kNothing, kMuch}, {1}},
      {[](Relax& r, double v) { r.max_move.line = v; }, kMove, {-1, kNothing, kMuch}, {0, 1}},
      {[](Relax& r, double v) { r.threshold = v; }, kDisplaced, {-1, 0, kNothing, kMuch}, {1}},
      {[](Relax& r, double v) { r.angle = v; }, kTurn, {-1, 0, 181, kNothing, kMuch}, {1, 180}},
  };
  for (const auto& [set, words, bad, good] : cases) {
    Relax relax;
    relax.scope = Scope::all;
    for (const double value : bad) {
      set(relax, value);
      const Result<EditReport> refused = try_apply(document, relax);
      ASSERT_FALSE(refused) << words << ", " << value;
      EXPECT_EQ(refused.error().text(), words);
    }
    for (const double value : good) {
      set(relax, value);
      EXPECT_TRUE(prepare(document, relax)) << words << ", " << value;
    }
  }
}

TEST(Relax, from_a_node_without_a_selection_goes_as_far_as_it_must) {
  Document document = make_sheet(20, 20);
  must_apply(document, R"({"edit":"translate","by":[2.5,1.5,0],"on":"221","falloff":{"profile":"constant"}})");
  const EditReport report = must_apply(document, R"({"edit":"relax","mode":"from","at":221,"threshold":0.25})");
  EXPECT_GT(report.nodes_moved, 1u);
  EXPECT_LT(report.nodes_moved, 100u);
  EXPECT_LT((place_of(document, 221) - Vec3(50, 50, 0)).norm(), 0.75);
}

TEST(Relax, keeps_to_its_limits) {
  Document document = slid_sheet();
  const Model before = document.current().model;
  const EditReport report = must_apply(document, R"({"edit":"relax","scope":"all","max_move":{"free":0.3,"line":0.1}})");
  EXPECT_THAT(report.notes, Contains(HasSubstr("stopped at max_move")));
  for (std::size_t n = 0; n < before.node_count(); ++n)
    EXPECT_LE((document.current().model.positions[n] - before.positions[n]).norm(), 0.3);
}

TEST(Relax, keeps_borders_in_place_where_lines_may_not_move) {
  Document document =
      make_document(test::make_grid(12, 12, [](int i, int j) { return Vec3(5.0 * i + (i > 0 && i < 12 ? j % 2 : 0), 5.0 * j, 0); }));
  const Model before = document.current().model;
  EXPECT_GT(must_apply(document, R"({"edit":"relax","scope":"all","max_move":{"line":0}})").nodes_moved, 0u);
  for (std::size_t n = 0; n < before.node_count(); ++n) {
    const Vec3& at = before.positions[n];
    if (at.y() == 0 || at.y() == 60 || at.x() == 0 || at.x() == 60) {
      EXPECT_TRUE(same_bits(document.current().model.positions[n], at)) << n;
    }
  }
}

TEST(Relax, leaves_the_document_as_it_was_when_stopped) {
  Document document = slid_sheet();
  const auto current = &document.current();
  int heard = 0;
  const Result<Prepared> stopped = prepare(document, edit_of(R"({"edit":"relax","scope":"all"})"), [&](double) { return ++heard < 4; });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().message, "cancelled");
  EXPECT_EQ(heard, 4);
  EXPECT_EQ(&document.current(), current);
}

/// An 8 x 8 sheet with a node out of place, and a mid-side node beside it: node 1000 between 31 and 32.
Model sheet_with_middle() {
  Model model = test::make_grid(8, 8, [](int i, int j) { return Vec3(5.0 * i + (i == 3 && j == 3 ? 2 : 0), 5.0 * j, 0.0); });
  const NodeIndex middle(model.node_count());
  model.node_ids.resize(model.node_count() + 1);
  model.node_ids.set(middle.value, 1000);
  model.node_holds.resize(model.node_ids.size());
  model.positions.resize(model.node_ids.size(), Vec3(18, 15.5, 0));
  MidsideNodes midside{ShellIndex(std::size_t{3 + 8 * 3}), {}};
  midside.node[0] = middle;
  model.midside = std::make_shared<std::vector<MidsideNodes>>(1, midside);
  model.adjacency = std::make_shared<Adjacency>(build_adjacency(model));
  std::vector<std::int64_t> ids;
  for (std::size_t n = 0; n < model.node_count(); ++n) ids.push_back(model.node_ids[n]);
  model.node_index = std::make_shared<IdIndex>(ids);
  return model;
}

TEST(Relax, lets_mid_side_nodes_follow_the_ends_of_their_edge) {
  Document document = make_document(sheet_with_middle());
  const Vec3 middle = place_of(document, 1000), left = place_of(document, 31), right = place_of(document, 32);
  const EditReport report = must_apply(document, R"({"edit":"relax","scope":"all"})");
  EXPECT_THAT(report.notes, Not(Contains(HasSubstr("mid-side"))));
  const Vec3 by_left = place_of(document, 31) - left, by_right = place_of(document, 32) - right;
  EXPECT_GT(by_left.norm(), 1);
  EXPECT_LT((place_of(document, 1000) - middle - 0.5 * (by_left + by_right)).norm(), 1e-12);
  must_apply(document, R"({"edit":"undo"})");
  EXPECT_EQ(place_of(document, 1000), middle);
}

TEST(Relax, a_mid_side_node_that_is_moved_with_its_edge_is_reached) {
  Document document = make_document(sheet_with_middle());
  const EditReport report =
      must_apply(document, R"({"edit":"translate","by":[0,0,1],"on":"all","grab":31,"falloff":{"profile":"linear"}})");
  EXPECT_THAT(report.notes, Not(Contains(HasSubstr("can't be reached"))));
  EXPECT_GT(place_of(document, 1000).z(), 0);
}

TEST(Relax, leaves_the_ends_of_an_edge_whose_middle_cannot_follow) {
  Model model = sheet_with_middle();
  model.node_holds.set(model.find_node(1000).value, kHeldByParameter);
  Document document = make_document(std::move(model));
  const EditReport report = must_apply(document, R"({"edit":"relax","scope":"all"})");
  EXPECT_THAT(report.notes, Contains("2 nodes beside mid-side nodes that can't follow stay"));
  EXPECT_EQ(place_of(document, 31), Vec3(17, 15, 0));
  EXPECT_EQ(place_of(document, 32), Vec3(20, 15, 0));
  EXPECT_EQ(place_of(document, 1000), Vec3(18, 15.5, 0));
  EXPECT_GT(report.nodes_moved, 0u);
}

TEST(Relax, keeps_mid_side_nodes_of_real_decks_in_their_places_on_the_edge) {
  const auto decks = test::real_decks();
  if (!decks) GTEST_SKIP() << "PRISMESH_MODELS names no folder of decks";
  Document document = make_document(test::open_real(*decks, "ccx_furnace"));  // 300 triangles of six nodes
  const Model before = document.current().model;
  must_apply(document, R"({"edit":"relax","scope":"all"})");
  const Model& after = document.current().model;
  std::size_t moved = 0;
  for (const MidsideNodes& midside : *before.midside) {
    const ShellNodes& corners = before.shell(midside.shell);
    for (int i = 0; i < corners.corners(); ++i) {
      const NodeIndex node = midside.node[i], a = corners.node[i], b = corners.node[(i + 1) % corners.corners()];
      if (!node.valid()) continue;
      const auto off = [&](const Model& model) { return Vec3(model.position(node) - 0.5 * (model.position(a) + model.position(b))); };
      EXPECT_LT((off(after) - off(before)).norm(), 1e-9) << before.node_ids[node.value];
      moved += same_bits(after.position(node), before.position(node)) ? 0 : 1;
    }
  }
  EXPECT_GT(moved, 0u);
}

}  // namespace
}  // namespace prismesh::mesh::document
