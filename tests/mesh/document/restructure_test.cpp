// Edits that add, remove and reshape shells, through the whole document: figures, marks, history, journal, saving.
#include "mesh/document/restructure.h"
#include "mesh/deck/save.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/document/deck_relations.h"
#include "mesh/document/delta.h"
#include "mesh/document/edit_targets.h"
#include "mesh/document/journal.h"
#include "mesh/document/part_marks.h"
#include "mesh/document/selection.h"
#include "mesh/quality/mass.h"
#include "tests/mesh/document/restructuring.h"

namespace prismesh::mesh::document {
namespace {

using testing::HasSubstr;

/// Everything that is kept up with each edit is what it would be if it were worked out from the model alone.
void expect_sound(const Document& document) {
  const Generation& now = document.current();
  const Model& model = now.model;
  ASSERT_TRUE(model.adjacency);
  const Adjacency fresh = build_adjacency(model);
  EXPECT_EQ(model.adjacency->node_shells, fresh.node_shells);
  EXPECT_EQ(model.adjacency->edge_high, fresh.edge_high);
  EXPECT_EQ(model.adjacency->edge_shells, fresh.edge_shells);
  ASSERT_EQ(now.node_marks.size(), model.node_count());
  ASSERT_EQ(now.shell_marks.size(), model.shell_count());
  ASSERT_EQ(now.quality.size(), model.shell_count());
  std::size_t nodes = 0, shells = 0;
  for (std::size_t n = 0; n < model.node_count(); ++n) {
    if ((now.node_marks[n] & kSelected) != 0) ++nodes;
    if (model.is_removed(NodeIndex(n))) {
      EXPECT_EQ(now.node_marks[n], 0);
    }
  }
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    if ((now.shell_marks[s] & kSelected) != 0) ++shells;
    if (model.is_removed(ShellIndex(s))) {
      EXPECT_EQ(now.shell_marks[s], 0);
    }
  }
  EXPECT_EQ(now.selected_nodes, nodes);
  EXPECT_EQ(now.selected_shells, shells);
  EXPECT_EQ(now.counts.ok + now.counts.warn + now.counts.fail, live_shells(model));
  quality::Counts counts;
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    if (model.is_removed(ShellIndex(s))) continue;
    const quality::Grade grade = now.quality[s].grade();
    ++(grade == quality::Grade::fail ? counts.fail : grade == quality::Grade::warn ? counts.warn : counts.ok);
  }
  EXPECT_EQ(now.counts, counts);
  const quality::MassProperties weight = quality::mass_properties(model);
  EXPECT_NEAR(now.weight.mass, weight.mass, 1e-9 * weight.mass);
  EXPECT_EQ(now.weight.shells, weight.shells);
  ASSERT_TRUE(now.weight.centre() && weight.centre());
  EXPECT_NEAR((*now.weight.centre() - *weight.centre()).norm(), 0, 1e-7);
  // marks that follow from the parts' states
  ChunkedArray<std::uint8_t> marks(model.node_count());
  mark_parts(model, *now.parts, marks);
  for (std::size_t n = 0; n < model.node_count(); ++n)
    if (!model.is_removed(NodeIndex(n))) {
      EXPECT_EQ(now.node_marks[n] & (kLocked | kHidden), marks[n]) << "node " << n;
    }
}

/// The entities by id.
struct ByIds {
  std::map<std::int64_t, std::array<double, 3>> nodes;
  std::map<std::int64_t, std::pair<std::array<std::int64_t, 4>, std::int64_t>> shells;
  std::map<std::int64_t, quality::ShellState> states;
};
ByIds by_ids(const Generation& generation) {
  const Model& model = generation.model;
  ByIds out;
  for (std::size_t n = 0; n < model.node_count(); ++n)
    if (!model.is_removed(NodeIndex(n)))
      out.nodes[model.node_ids[n]] = {model.positions[n][0], model.positions[n][1], model.positions[n][2]};
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    if (model.is_removed(ShellIndex(s))) continue;
    auto& [corners, part] = out.shells[model.shell_ids[s]];
    for (std::size_t c = 0; c < 4; ++c) corners[c] = model.node_ids[model.shell_nodes[s].node[c].value];
    part = (*model.parts)[model.shell_parts[s].value].id;
    out.states[model.shell_ids[s]] = generation.quality[s];
  }
  return out;
}

/// Saved and read again it is the same model, of the same quality.
void expect_saved(const Document& document, const std::filesystem::path& target) {
  const Result<deck::SaveReport> saved = save(document, target);
  ASSERT_TRUE(saved) << saved.error().text();
  OpenOptions options;
  options.length_unit = LengthUnit::mm;
  options.target_size = 5.0;
  const Result<Document> again = open(target, options);
  ASSERT_TRUE(again) << again.error().text();
  const ByIds here = by_ids(document.current()), there = by_ids(again->current());
  ASSERT_EQ(here.nodes.size(), there.nodes.size());
  for (const auto& [id, at] : here.nodes) {
    ASSERT_TRUE(there.nodes.contains(id)) << id;
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(at[k], there.nodes.at(id)[k], 1e-4);
  }
  EXPECT_EQ(here.shells, there.shells);
  EXPECT_EQ(document.current().counts, again->current().counts);
}

ShellIndex shell(std::size_t i) { return ShellIndex(i); }

TEST(Restructure, splitting_counts_marks_and_saves) {
  const Folder folder;
  Document document = open_text(folder / "a.k", sheet_deck(6, 4));
  must_apply(document, R"({"edit":"select","expr":"1,2","kind":"element"})");
  const quality::MassProperties weight = document.current().weight;
  Change change{document.current().model, {}};
  change.split(shell(0));
  change.star(shell(3));
  const EditReport report = must_change(document, change.finish());
  EXPECT_EQ(report.elements_added, 4u);
  EXPECT_EQ(report.elements_removed, 0u);
  EXPECT_EQ(report.nodes_moved, 0u);
  const Generation& now = document.current();
  EXPECT_EQ(now.selected_shells, 3u) << "both halves are selected";
  EXPECT_EQ(now.selected_nodes, document.generations[1]->selected_nodes) << "the star's shells aren't, so neither is its middle";
  EXPECT_EQ(live_shells(now.model), 28u);
  EXPECT_NEAR(now.weight.mass, weight.mass, 0.02 * weight.mass);
  expect_sound(document);
  expect_saved(document, folder / "b.k");
  const EditReport undone = must_apply(document, R"({"edit":"undo"})");
  EXPECT_EQ(undone.elements_removed, 4u);
  EXPECT_EQ(undone.elements_added, 0u);
  expect_sound(document);
  const EditReport redone = must_apply(document, R"({"edit":"redo"})");
  EXPECT_EQ(redone.elements_added, 4u);
  expect_sound(document);
}

TEST(Restructure, a_middle_of_selected_corners_is_selected) {
  const Folder folder;
  Document document = open_text(folder / "a.k", sheet_deck(6, 4));
  must_apply(document, R"({"edit":"select","expr":"1,2,8,9"})");
  Change change{document.current().model, {}};
  change.star(shell(0));
  must_change(document, change.finish());
  EXPECT_EQ(document.current().selected_nodes, 5u);
  expect_sound(document);
}

TEST(Restructure, collapsing_takes_nodes_and_shells_out_of_all) {
  const Folder folder;
  Document document = open_text(folder / "a.k", sheet_deck(6, 6));
  must_apply(document, R"({"edit":"select","expr":"all","kind":"node"})");
  const std::size_t all = document.current().selected_nodes;
  const Model& model = document.current().model;
  Change change{model, {}};
  change.collapse(model.find_node(17), model.find_node(18));
  const EditReport report = must_change(document, change.finish());
  EXPECT_EQ(report.elements_removed, 0u);
  EXPECT_EQ(document.current().selected_nodes, all - 1);
  EXPECT_FALSE(document.current().model.find_node(18).valid());
  expect_sound(document);
  expect_saved(document, folder / "b.k");
}

TEST(Restructure, new_nodes_belong_to_parts_in_sight_hidden_or_locked) {
  const Folder folder;
  Document document = open_text(folder / "a.k", sheet_deck(6, 4));
  must_apply(document, R"({"edit":"hide","on":"1"})");
  Change change{document.current().model, {}};
  change.star(shell(0));
  change.star(shell(5));
  must_change(document, change.finish());
  const Generation& now = document.current();
  EXPECT_EQ(now.node_marks[now.model.node_count() - 2] & kHidden, kHidden);
  EXPECT_EQ(now.node_marks[now.model.node_count() - 1] & kHidden, 0);
  expect_sound(document);
  must_apply(document, R"({"edit":"show","on":"1"})");
  expect_sound(document);
  must_apply(document, R"({"edit":"lock","on":"1"})");
  expect_sound(document);
}

TEST(Restructure, nodes_around_it_stay_selected_where_a_part_is_hidden_or_locked) {
  for (const char* state : {"hide", "lock"}) {
    SCOPED_TRACE(state);
    const Folder folder;
    Document document = open_text(folder / "a.k", sheet_deck(6, 4));
    must_apply(document, R"({"edit":"select","expr":"1-9"})");
    must_apply(document, std::string(R"({"edit":")") + state + R"(","on":"2"})");
    const std::size_t selected = document.current().selected_nodes;
    ASSERT_GT(selected, 4u);
    Change change{document.current().model, {}};
    change.split(shell(0));
    must_change(document, change.finish());
    EXPECT_EQ(document.current().selected_nodes, selected);
    for (const std::size_t corner : {0, 1, 7, 8}) EXPECT_NE(document.current().node_marks[corner] & kSelected, 0) << corner;
    expect_sound(document);
  }
}

TEST(Restructure, a_new_node_between_parts_is_hidden_with_both_and_locked_with_either) {
  // The edge from node 4 to node 11 lies between the parts.
  for (const auto& [edit, marks] :
       {std::pair(R"({"edit":"hide","on":"1"})", 0), {R"({"edit":"hide","on":"2"})", 0}, {R"({"edit":"hide","on":"1-2"})", int{kHidden}}}) {
    const Folder folder;
    Document document = open_text(folder / "a.k", sheet_deck(6, 4));
    must_apply(document, edit);
    Change change{document.current().model, {}};
    const Model& model = document.current().model;
    change.cut_across(model.find_shell(3), model.find_shell(4), model.find_node(4), model.find_node(11));
    must_change(document, change.finish());
    const Generation& now = document.current();
    EXPECT_EQ(now.node_marks[now.model.node_count() - 1] & (kHidden | kLocked), marks) << edit;
    expect_sound(document);
  }
}

TEST(Restructure, beams_and_mid_side_nodes_keep_their_say_over_the_nodes_they_share) {
  const Folder folder;
  std::string text = sheet_deck(6, 4);
  // A beam up from node 9, a corner of shells of part 1; shell 902 of part 2, whose mid-side node 924 is a corner of shell 903 of part 1.
  text.insert(text.find("*END"),
              "*NODE\n     901             5.0             5.0           500.0\n"
              "     921            22.5            15.0             0.1\n     922            25.0            17.5             0.1\n"
              "     923            22.5            20.0             0.1\n     924            20.0            17.5             0.1\n"
              "     931            20.0            17.5            10.0\n     932            15.0            17.5            10.0\n"
              "     933            15.0            17.5             0.1\n"
              "*ELEMENT_SHELL\n     902       2      26      27      34      33     921     922     923     924\n"
              "     903       1     924     931     932     933\n"
              "*ELEMENT_BEAM\n     900       9       9     901       0\n*PART\nframe\n         9         9         9\n"
              "*SECTION_BEAM\n         9         9\n       6.0       6.0       0.0       0.0\n*MAT_ELASTIC\n         9  7.85E-09    210000 "
              "      0.3\n");
  struct Case {
    const char* edit;
    std::int64_t split, node;
    int marks;
  };
  const Case cases[] = {
      {R"({"edit":"lock","on":"9"})", 8, 9, kLocked},   {R"({"edit":"hide","on":"1"})", 8, 9, 0},
      {R"({"edit":"hide","on":"1,9"})", 8, 9, kHidden}, {R"({"edit":"lock","on":"2"})", 903, 924, kLocked},
      {R"({"edit":"hide","on":"1"})", 903, 924, 0},     {R"({"edit":"hide","on":"1-2"})", 903, 924, kHidden},
  };
  for (const auto& [edit, split, node, marks] : cases) {
    Document document = open_text(folder / "a.k", text);
    must_apply(document, edit);
    const auto marks_of = [&](std::int64_t id) {
      return document.current().node_marks[document.current().model.find_node(id).value] & (kLocked | kHidden);
    };
    EXPECT_EQ(marks_of(node), marks) << edit;
    Change change{document.current().model, {}};
    change.split(document.current().model.find_shell(split));
    must_change(document, change.finish());
    EXPECT_EQ(marks_of(node), marks) << edit << ", after shell " << split << " was split";
    expect_sound(document);
  }
  Document document = open_text(folder / "a.k", text);
  must_apply(document, R"({"edit":"lock","on":"2"})");
  EXPECT_THAT(refusal(document, R"({"edit":"translate","by":[0,0,1],"on":"922"})"),
              HasSubstr("node 922 would move but belongs to the locked part 2"));
}

TEST(Restructure, without_a_free_id_nothing_is_added) {
  for (const char* ranges :
       {"*SET_NODE_LIST_GENERATE\n         3\n        30  99999999\n", "*SET_SHELL_LIST_GENERATE\n         3\n        20  99999999\n"}) {
    const Folder folder;
    std::string text = sheet_deck(6, 4);
    text.insert(text.find("*END"), ranges);
    const Document document = open_text(folder / "a.k", text);
    Change change{document.current().model, {}};
    change.star(shell(0));
    const Result<Prepared> prepared = prepare_change(document, change.finish());
    ASSERT_FALSE(prepared);
    EXPECT_THAT(prepared.error().text(), HasSubstr(std::string("no id is left for a new ") + (ranges[5] == 'N' ? "node" : "shell")));
    EXPECT_EQ(prepared.error().file, (folder / "a.k").string());
    expect_sound(document);
  }
}

/// What a user does with a model after its structure changed.
TEST(Restructure, every_other_edit_works_on_what_has_grown) {
  const Folder folder;
  Document document = open_text(folder / "a.k", sheet_deck(12, 10));
  std::mt19937 random(4);
  must_change(document, any_change(document.current().model, random, 40));
  must_change(document, any_change(document.current().model, random, 40));
  for (int i = 0; i < 20 && document.current().model.topology_change->removed_shells.empty(); ++i)
    must_change(document, any_change(document.current().model, random, 40));
  ASSERT_GT(document.current().model.topology_change->removed_shells.size(), 0u);
  ASSERT_GT(document.current().model.topology_change->node_origins.size(), 0u);
  ASSERT_GT(document.current().model.topology_change->removed_nodes.size(), 0u);
  const auto view = R"([0.02,0,0,0, 0,0.02,0,0, 0,0,-0.01,0, -0.6,-0.5,0,1])";
  for (const std::string& edit : {
           std::string(R"({"edit":"select","expr":"all","kind":"node"})"),
           std::string(R"({"edit":"select","expr":"all","kind":"element"})"),
           std::string(R"({"edit":"select","expr":"1","kind":"part"})"),
           std::string(R"({"edit":"select","expr":"part:1","kind":"node"})"),
           std::string(R"({"edit":"select","expr":"part:1-2","kind":"element"})"),
           std::string(R"({"edit":"lock","on":"all"})"),
           std::string(R"({"edit":"unlock","on":"1"})"),
           std::string(R"({"edit":"unlock"})"),
           std::string(R"({"edit":"select_region","at":[20,20,0],"by":"features","angle":60})"),
           std::string(R"({"edit":"select_region","at":[20,20,0],"by":"piece"})"),
           std::string(R"({"edit":"select_region","at":[0,0,0],"by":"free_edge"})"),
           R"({"edit":"select_lasso","outline":[[-1,-1],[0.2,-1],[0.2,1],[-1,1]],"view":)" + std::string(view) + "}",
           R"({"edit":"select_lasso","visible":true,"outline":[[-1,-1],[0.2,-1],[0.2,1],[-1,1]],"view":)" + std::string(view) + "}",
           std::string(R"({"edit":"grow","rings":1})"),
           std::string(R"({"edit":"shrink","rings":1})"),
           std::string(R"({"edit":"invert"})"),
           std::string(R"({"edit":"hide","on":"2"})"),
           std::string(R"({"edit":"show","on":"2"})"),
           std::string(R"({"edit":"lift","distance":0.2,"on":{"edit":"select_region","at":[20,20,0],"by":"part"}})"),
           std::string(R"({"edit":"translate","by":[0.1,0.1,0],"on":"all"})"),
           std::string(R"({"edit":"slide","by":[0.1,0,0],"on":"30-60"})"),
           std::string(R"({"edit":"rotate","point":[30,25,0],"axis":[0,0,1],"degrees":3,"on":"all"})"),
       }) {
    SCOPED_TRACE(edit);
    must_apply(document, edit);
    expect_sound(document);
    if (::testing::Test::HasFailure()) return;
  }
  expect_saved(document, folder / "b.k");
  while (document.can_undo()) must_apply(document, R"({"edit":"undo"})");
  expect_sound(document);
  EXPECT_EQ(&document.current(), document.opened.get());
}

TEST(Restructure, rules_say_what_is_to_be_left_alone) {
  const Folder folder;
  std::string text = sheet_deck(6, 4);
  text.insert(text.find("*END"),
              "*ELEMENT_BEAM\n      99       3      17      18       0\n*PART\nbar\n         3         1         1\n"
              "*BOUNDARY_SPC_NODE\n        25         0         1         1         1         0         0         0\n"
              "*LOAD_SHELL_ELEMENT\n        20         1       1.0\n");
  Document document = open_text(folder / "a.k", text);
  must_apply(document, R"({"edit":"lock","on":"2"})");
  const Model& model = document.current().model;
  const repair::Rules rules = rules_for(document, document.current());
  const auto node = [&](std::int64_t id) { return int{rules.node(model.find_node(id))}; };
  EXPECT_EQ(node(9), 0) << "inside the left part, named by nobody";
  EXPECT_EQ(node(2), 0) << "a set lists it: it can be taken out of that";
  EXPECT_EQ(node(17), repair::kStays | repair::kNeeded) << "a beam ends there";
  EXPECT_EQ(node(25), repair::kStays | repair::kNeeded) << "on the border to the locked part";
  EXPECT_EQ(node(7), repair::kStays | repair::kNeeded) << "of the locked part";
  EXPECT_FALSE(rules.may_divide(model.find_node(17), model.find_node(18))) << "the beam lies along this edge";
  EXPECT_TRUE(rules.may_divide(model.find_node(9), model.find_node(10)));
  EXPECT_EQ(rules.shell(model.find_shell(1)), 0);
  EXPECT_EQ(rules.shell(model.find_shell(20)) & repair::kLasting, repair::kLasting) << "a pressure acts on it";
  EXPECT_NE(rules.shell(model.find_shell(6)) & repair::kKeepsNodes, 0) << "of the locked part";
  must_apply(document, R"({"edit":"unlock","on":"2"})");
  EXPECT_EQ(int{rules_for(document, document.current()).node(model.find_node(25))}, int{repair::kNeeded}) << "a constraint names it";
}

TEST(Restructure, rules_keep_welded_shells_and_shells_with_mid_side_nodes_whole) {
  const Folder folder;
  std::string text = sheet_deck(6, 4);
  // A second sheet above the first, a weld between them, and one shell of the first with mid-side nodes.
  text.insert(
      text.find("*END"),
      "*NODE\n     901             7.5             7.5             0.1\n     902             7.5             7.5             1.1\n"
      "     911             5.0             5.0             1.0\n     912            10.0             5.0             1.0\n"
      "     913            10.0            10.0             1.0\n     914             5.0            10.0             1.0\n"
      "     921            22.5            15.0             0.1\n     922            25.0            17.5             0.1\n"
      "     923            22.5            20.0             0.1\n     924            20.0            17.5             0.1\n"
      "*ELEMENT_SHELL\n     901       1     911     912     913     914\n"
      "*ELEMENT_SHELL\n     902       2      26      27      34      33     921     922     923     924\n"
      "*ELEMENT_BEAM\n     900       9     901     902       0\n*PART\nweld\n         9         9         9\n"
      "*SECTION_BEAM\n         9         9\n       6.0       6.0       0.0       0.0\n*MAT_SPOTWELD\n         9  7.85E-09    210000\n");
  Document document = open_text(folder / "a.k", text);
  const Model& model = document.current().model;
  const repair::Rules rules = rules_for(document, document.current());
  const auto shell = [&](std::int64_t id) { return int{rules.shell(model.find_shell(id))}; };
  const auto node = [&](std::int64_t id) { return int{rules.node(model.find_node(id))}; };
  constexpr int kEveryShellRule = repair::kKeepsNodes | repair::kLasting | repair::kIndivisible | repair::kNoTriangle;
  EXPECT_EQ(shell(8), kEveryShellRule) << "the weld ends on it";
  EXPECT_EQ(shell(901), kEveryShellRule) << "its other end";
  EXPECT_EQ(shell(902), kEveryShellRule) << "its middles would lie beside its edges";
  EXPECT_EQ(shell(3), 0);
  EXPECT_EQ(node(26), repair::kStays | repair::kNeeded) << "a corner of the shell with middles";
  EXPECT_EQ(node(921), repair::kStays | repair::kNeeded) << "a middle";
  EXPECT_EQ(node(13), 0) << "an inner node elsewhere";
}

TEST(Restructure, what_cards_join_stays_in_place) {
  const Folder folder;
  std::string text = sheet_deck(6, 4);
  text.insert(text.find("*END"), "*CONSTRAINED_SPOTWELD\n        10        13\n");
  const Document document = open_text(folder / "a.k", text);
  const repair::Rules rules = rules_for(document, document.current());
  for (const std::int64_t id : {10, 13})
    EXPECT_EQ(int{rules.node(document.current().model.find_node(id))}, repair::kStays | repair::kNeeded) << id;
  EXPECT_EQ(int{rules.node(document.current().model.find_node(11))}, 0);
}

TEST(Restructure, what_text_that_isnt_read_may_name_stays_whole) {
  const Folder folder;
  std::string text = sheet_deck(6, 4);
  text.insert(text.find("*END"), "*NOBODY_KNOWS_THIS\n        16        17\n*DEFINE_ELEMENT_DEATH_SHELL\n         8       0.5\n");
  Document document = open_text(folder / "a.k", text);
  const Model& model = document.current().model;
  const repair::Rules rules = rules_for(document, document.current());
  for (const std::int64_t id : {8, 16, 17}) EXPECT_NE(rules.shell(model.find_shell(id)) & repair::kIndivisible, 0) << id;
  EXPECT_EQ(rules.shell(model.find_shell(9)) & repair::kIndivisible, 0);
  EXPECT_FALSE(rules.may_divide(model.find_node(16), model.find_node(17)));
  EXPECT_TRUE(rules.may_divide(model.find_node(17), model.find_node(18))) << "one end isn't enough";
  const std::string why = refusal(document, R"({"edit":"split","at":["shell:16"]})");
  EXPECT_THAT(why, HasSubstr("*NOBODY_KNOWS_THIS"));
  EXPECT_THAT(why, HasSubstr("a.k:"));
  EXPECT_EQ(document.generations.size(), 1u);
  must_apply(document, R"({"edit":"split","at":["shell:9"]})");
}

TEST(Restructure, what_cannot_be_saved_is_refused_and_nothing_changes) {
  const Folder folder;
  std::string text = sheet_deck(6, 6);
  text.insert(text.find("*END"), "*BOUNDARY_SPC_NODE\n        18         0         1         1         1         0         0         0\n");
  const Document document = open_text(folder / "a.k", text);
  const Model& model = document.current().model;
  Change change{model, {}};
  change.collapse(model.find_node(17), model.find_node(18));
  const Result<Prepared> prepared = prepare_change(document, change.finish());
  ASSERT_FALSE(prepared);
  EXPECT_THAT(prepared.error().text(), HasSubstr("BOUNDARY_SPC_NODE"));
  expect_sound(document);
}

// --- journal ---------------------------------------------------------------------------------------------------------

void expect_same_growth(const Model& a, const Model& b) {
  EXPECT_TRUE(same_bytes(a.node_ids, b.node_ids));
  EXPECT_TRUE(same_bytes(a.node_holds, b.node_holds));
  EXPECT_TRUE(same_bytes(a.shell_ids, b.shell_ids));
  EXPECT_TRUE(same_bytes(a.shell_nodes, b.shell_nodes));
  EXPECT_TRUE(same_bytes(a.shell_parts, b.shell_parts));
  EXPECT_TRUE(same_bytes(a.shell_thickness, b.shell_thickness));
  ASSERT_EQ(a.topology_change != nullptr, b.topology_change != nullptr);
  if (!a.topology_change) return;
  EXPECT_EQ(a.topology_change->removed_nodes, b.topology_change->removed_nodes);
  EXPECT_EQ(a.topology_change->removed_shells, b.topology_change->removed_shells);
  ASSERT_EQ(a.topology_change->node_origins.size(), b.topology_change->node_origins.size());
  for (std::size_t i = 0; i < a.topology_change->node_origins.size(); ++i)
    EXPECT_EQ(a.topology_change->node_origins[i], b.topology_change->node_origins[i]);
  EXPECT_TRUE(same_bytes(a.topology_change->shell_parents, b.topology_change->shell_parents));
  EXPECT_EQ(changes_between(a, b).empty(), true);
}

void append(Document& document, Journal& journal, const Edit& edit, Result<Prepared> prepared) {
  ASSERT_TRUE(prepared) << prepared.error().text();
  const Result<void> kept = journal.append(document, edit, *prepared);
  ASSERT_TRUE(kept) << kept.error().text();
  commit(document, std::move(*prepared));
}

/// A session of edits of all kinds by chance; ends after `steps` records.
void work_at_random(Document& document, Journal& journal, std::mt19937& random, int steps) {
  const Edit split = edit_of(R"({"edit":"split","at":["shell:1"]})");
  for (int step = 0; step < steps; ++step) {
    switch (random() % 8) {
      case 0: {
        const Edit edit = edit_of(R"({"edit":"select","expr":"all","kind":"element"})");
        append(document, journal, edit, prepare(document, edit));
        break;
      }
      case 1: {
        const Edit edit = edit_of(R"({"edit":"lift","distance":0.3,"on":")" + std::to_string(1 + random() % 40) + R"("})");
        if (Result<Prepared> prepared = prepare(document, edit)) append(document, journal, edit, std::move(prepared));
        break;
      }
      case 2:
      case 3: {
        const Edit edit = random() % 3 != 0 ? Edit(Undo{}) : Edit(Redo{});
        if (Result<Prepared> prepared = prepare(document, edit)) append(document, journal, edit, std::move(prepared));
        break;
      }
      default: {
        const repair::Restructuring change = any_change(document.current().model, random, 6);
        if (Result<Prepared> prepared = prepare_change(document, change)) append(document, journal, split, std::move(prepared));
      }
    }
    if (::testing::Test::HasFailure()) return;
  }
}

TEST(RestructureJournal, brings_back_the_same_bytes_after_any_session) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    const Folder folder;
    const std::string text = sheet_deck(8, 7);
    Document document = open_text(folder / "a.k", text);
    std::mt19937 random(seed);
    {
      Result<Journal> journal = Journal::create(folder / "j", document);
      ASSERT_TRUE(journal);
      work_at_random(document, *journal, random, 40);
    }
    ASSERT_TRUE(document.current().model.topology_change);
    for (int life = 0; life < 2; ++life) {  // what was brought back goes on and is brought back again
      Document recovered = open_text(folder / "a.k", text);
      Result<Journal> journal = Journal::recover(folder / "j", recovered);
      ASSERT_TRUE(journal) << journal.error().text();
      expect_same(document, recovered);
      for (std::size_t g = 0; g < document.generations.size(); ++g) {
        expect_same_growth(document.generations[g]->model, recovered.generations[g]->model);
        EXPECT_TRUE(same_bytes(document.generations[g]->surface->positions, recovered.generations[g]->surface->positions));
        EXPECT_EQ(document.generations[g]->weight.mass, recovered.generations[g]->weight.mass);
        EXPECT_EQ(document.generations[g]->own_bytes, recovered.generations[g]->own_bytes);
      }
      expect_sound(recovered);
      ASSERT_FALSE(HasFailure());
      document = recovered;
      if (life == 0) work_at_random(document, *journal, random, 10);
    }
    expect_saved(document, folder / "b.k");
  }
}

TEST(RestructureJournal, delta_that_is_none_is_refused) {
  const Folder folder;
  Document document = open_text(folder / "a.k", sheet_deck(6, 6));
  std::mt19937 random(3);
  const Result<Prepared> prepared = prepare_change(document, any_change(document.current().model, random, 20));
  ASSERT_TRUE(prepared);
  ASSERT_GT(prepared->report.elements_added, 0u);
  const std::vector<std::byte> delta = encode_delta(document.current(), *prepared->next);
  Generation good = document.current();
  ASSERT_TRUE(apply_delta(delta, good));
  for (std::size_t cut = 0; cut < delta.size(); ++cut) {
    Generation next = document.current();
    EXPECT_FALSE(apply_delta(std::span(delta).first(cut), next)) << cut;
  }
  std::size_t refused = 0;
  for (std::size_t at = 0; at < delta.size(); ++at)
    for (const int flip : {1, 0x40, 0x80, 0xff}) {
      std::vector<std::byte> other = delta;
      other[at] ^= static_cast<std::byte>(flip);
      Generation next = document.current();
      if (!apply_delta(other, next)) {
        ++refused;
        continue;
      }
      // Taken for another change: then all it names must be there.
      for (std::size_t s = 0; s < next.model.shell_count(); ++s)
        if (!next.model.is_removed(shell(s)))
          for (const NodeIndex node : next.model.shell(shell(s)).node) {
            ASSERT_LT(node.value, next.model.node_count());
          }
      static_cast<void>(build_adjacency(next.model));
    }
  EXPECT_GT(refused, delta.size());
}

TEST(RestructureJournal, what_an_older_program_wrote_is_still_read) {
  const Folder folder;
  Document document = open_text(folder / "a.k", sheet_deck(3, 3));
  const std::vector<std::byte> old{std::byte{1}, std::byte{0}, std::byte{1}, std::byte{2}, std::byte{1},
                                   std::byte{1}, std::byte{0}, std::byte{0}, std::byte{0}};
  Generation next = document.current();
  ASSERT_TRUE(apply_delta(old, next));
  EXPECT_EQ(next.node_marks[2], kSelected);
  EXPECT_EQ(next.selected_nodes, 1u);
}

}  // namespace
}  // namespace prismesh::mesh::document
