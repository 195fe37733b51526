// A part that gets the mesh of another deck: what takes which place, what stays connected, what is told, what is refused. The text of a
// whole exchange is checked by tests/checker/replace_proof.py.
#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/document/deck_relations.h"
#include "mesh/document/journal.h"
#include "mesh/model/topology_change.h"
#include "tests/mesh/document/format_decks.h"
#include "tests/mesh/document/weld_deck.h"

namespace prismesh::mesh::document {
namespace {

using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;

/// A sheet of part 7 in a plane, from `low`, its numbers from `first` on.
struct VariantSheet {
  int columns = 48, rows = 8;
  double side = 2.5;
  Vec3 low{0, 0, 1.5};
  int first = 1;
  double thickness = 1.5;
  double across = 1;  ///< sides in y, as a share of `side`
};

std::string variant_text(const VariantSheet& sheet, const std::string& more = "") {
  std::string text = "*KEYWORD\n*NODE\n";
  for (int j = 0; j <= sheet.rows; ++j)
    for (int i = 0; i <= sheet.columns; ++i)
      text += printed("%8d%16.6f%16.6f%16.6f\n", sheet.first + i + j * (sheet.columns + 1), sheet.low.x() + sheet.side * i,
                      sheet.low.y() + sheet.side * sheet.across * j, sheet.low.z());
  text += "*ELEMENT_SHELL\n";
  for (int j = 0; j < sheet.rows; ++j)
    for (int i = 0; i < sheet.columns; ++i) {
      const int corner = sheet.first + i + j * (sheet.columns + 1);
      text += printed("%8d%8d%8d%8d%8d%8d\n", sheet.first + i + j * sheet.columns, 7, corner, corner + 1, corner + sheet.columns + 2,
                      corner + sheet.columns + 1);
    }
  return text + "*PART\nupper, new\n         7         1         1\n*SECTION_SHELL\n         1         2\n" +
         printed("%10.2f%10.2f%10.2f%10.2f\n", sheet.thickness, sheet.thickness, sheet.thickness, sheet.thickness) +
         "*MAT_ELASTIC\n         1  7.85E-09    210000       0.3\n" + more + "*END\n";
}

const std::string kReplace = R"({"edit": "replace_part", "part": 2, "deck": "variant.k"})";

class ReplacePartEdit : public ::testing::Test {
 protected:
  ReplacePartEdit() {
    std::filesystem::create_directories(folder);
    variant({});
  }
  ~ReplacePartEdit() override { std::filesystem::remove_all(folder); }

  void variant(const VariantSheet& sheet, const std::string& more = "") const {
    put_content(folder / "variant.k", variant_text(sheet, more));
  }
  Document deck(const std::string& more = kOneWeld) const { return open_deck(folder / "flange.k", flange_deck(2, more)); }
  std::string saved(const Document& document) const {
    const auto report = save(document, folder / "saved.k");
    EXPECT_TRUE(report) << report.error().text();
    return content_of(folder / "saved.k");
  }
  /// The document that was saved, read again: its sets are those that the edit left.
  Document again(const Document& document) const {
    saved(document);
    return open(folder / "saved.k", {}).value();
  }
  /// The numbers that an expression of nodes or elements names.
  static std::set<std::int64_t> named(Document document, const std::string& expression, const std::string& kind) {
    must_apply(document, R"({"edit": "select", "kind": ")" + kind + R"(", "expr": ")" + expression + R"("})");
    std::set<std::int64_t> ids;
    const Generation& now = document.current();
    if (kind == "node")
      for (std::size_t n = 0; n < now.model.node_count(); ++n)
        if ((now.node_marks[n] & kSelected) != 0) ids.insert(now.model.node_ids[n]);
    if (kind == "element")
      for (std::size_t s = 0; s < now.model.shell_count(); ++s)
        if (now.shell_marks[s] != 0) ids.insert(now.model.shell_ids[s]);
    return ids;
  }
  static std::string refused(Document& document, const std::string& json) {
    const std::size_t before = document.generations.size();
    const Result<EditReport> report = try_apply(document, edit_of(json));
    EXPECT_EQ(document.generations.size(), before) << json;
    return report ? "it was applied" : report.error().text();
  }
  static std::size_t shells_of_part(const Model& model, std::int64_t part) {
    std::size_t count = 0;
    for (std::size_t s = 0; s < model.shell_count(); ++s)
      count += !model.is_removed(ShellIndex(s)) && (*model.parts)[model.shell_parts[s].value].id == part;
    return count;
  }

  std::filesystem::path folder = std::filesystem::temp_directory_path() / ("prismesh-replace-" + std::to_string(::getpid()));
};

TEST_F(ReplacePartEdit, brings_nodes_and_shells_with_their_numbers_and_takes_those_that_only_the_part_used) {
  Document document = deck();
  const EditReport report = must_apply(document, kReplace);
  EXPECT_EQ(report.elements_added, 384u);
  EXPECT_EQ(report.elements_removed, 96u);
  EXPECT_EQ(report.lost_connections, 0u) << report.lost[0];
  EXPECT_THAT(report.notes,
              Contains(HasSubstr("part:2 got the mesh of part 7 of variant.k: 441 nodes and 384 shells in place of 96 shells")));
  const Model& model = document.current().model;
  EXPECT_EQ(shells_of_part(model, 1), 96u);
  EXPECT_EQ(shells_of_part(model, 2), 384u);
  EXPECT_EQ(live_nodes(model), 125u + 441u + 2u);
  for (std::int64_t id = 1; id <= 441; ++id) {
    const NodeIndex node = model.find_node(id);
    ASSERT_TRUE(node.valid()) << id;
    const auto at = static_cast<double>(id - 1);
    EXPECT_EQ(model.position(node), Vec3(2.5 * std::fmod(at, 49), 2.5 * std::floor(at / 49), 1.5));
  }
  EXPECT_FALSE(model.find_node(2001).valid());
  EXPECT_EQ((*model.parts)[model.find_part(2).value].name, "upper");
  const Document read = again(document);
  EXPECT_EQ(live_nodes(read.current().model), live_nodes(model));
  EXPECT_EQ(shells_of_part(read.current().model, 2), 384u);
}

TEST_F(ReplacePartEdit, numbers_of_the_old_mesh_are_free_and_those_of_others_are_not) {
  variant({.first = 2101});  // 2101 to 2125 were the part's, 80001 is a weld's
  Document document = deck();
  EXPECT_THAT(must_apply(document, kReplace).notes, Each(testing::Not(HasSubstr("couldn't keep"))));
  variant({.first = 1101});
  Document other = deck();
  const EditReport report = must_apply(other, kReplace);
  EXPECT_THAT(report.notes, Contains(HasSubstr("25 nodes couldn't keep the variant's numbers; the first: 1101 became")));
  // Those of both parts of the deck: 1101 to 1125 are nodes of part 1, and no shells.
  EXPECT_EQ(named(again(other), "part:1", "node"), named(deck(), "part:1", "node"));
}

TEST_F(ReplacePartEdit, undone_leaves_the_deck_as_it_was_and_can_be_done_twice) {
  Document document = deck();
  const std::string before = content_of(folder / "flange.k");
  must_apply(document, kReplace);
  const std::string once = saved(document);
  variant({.columns = 24, .rows = 4, .side = 5, .first = 301});
  must_apply(document, kReplace);
  EXPECT_EQ(shells_of_part(document.current().model, 2), 96u);
  EXPECT_EQ(shells_of_part(again(document).current().model, 2), 96u);
  must_apply(document, R"({"edit": "undo"})");
  EXPECT_EQ(saved(document), once);
  must_apply(document, R"({"edit": "undo"})");
  EXPECT_EQ(saved(document), before);
}

TEST_F(ReplacePartEdit, a_weld_by_position_lies_on_the_new_sheet_and_follows_it) {
  Document document = deck();
  must_apply(document, kReplace);
  ASSERT_EQ(document.current().relations->dependents.on_sheets.size(), 2u);
  must_apply(document, R"({"edit": "translate", "by": [0, 0, 4], "on": "part:2", "falloff": {"profile": "constant"}})");
  EXPECT_EQ(document.current().model.position(document.current().model.find_node(80002)), Vec3(5, 10, 5.5));
  EXPECT_EQ(document.current().model.position(document.current().model.find_node(80001)), Vec3(5, 10, 0));
}

TEST_F(ReplacePartEdit, lists_a_weld_that_does_not_lie_on_the_part_any_more) {
  variant({.columns = 40, .low = {20, 0, 40}});
  Document document = deck();
  const EditReport report = must_apply(document, kReplace);
  EXPECT_THAT(report.lost, testing::ElementsAre("beam:90001 at node:80002 no longer lies on part:2"));
  EXPECT_THAT(report.notes, Contains(HasSubstr("1 connection lost")));
}

/// A rigid body of the four nodes at a corner, sets of some and of all, a constraint, an initial velocity.
const std::string kNamedNodes =
    "*SET_NODE_LIST\n         8\n      2001      2002      2026      2027\n*CONSTRAINED_NODAL_RIGID_BODY\n       500         0         8\n"
    "*SET_NODE_LIST_GENERATE\n         9\n      2001      2125\n*SET_SHELL_LIST_GENERATE\n        10\n      2001      2096\n"
    "*INITIAL_VELOCITY\n         9         0\n       5.0       0.0       0.0\n*BOUNDARY_SPC_NODE\n      2125         0         1         1 "
    "        1\n";

TEST_F(ReplacePartEdit, sets_of_the_whole_part_stay_so_and_others_go_by_position) {
  Document document = deck(kNamedNodes);
  const EditReport report = must_apply(document, kReplace);
  EXPECT_THAT(report.lost, IsEmpty());
  const Document read = again(document);
  EXPECT_EQ(named(read, "set:9", "node"), named(read, "part:2", "node"));
  EXPECT_EQ(named(read, "set:10", "element"), named(read, "part:2", "element"));
  const Model& model = read.current().model;
  std::set<std::pair<double, double>> body;
  for (const std::int64_t id : named(read, "set:8", "node")) {
    const Vec3& at = model.position(model.find_node(id));
    body.insert({at.x(), at.y()});
  }
  std::set<std::pair<double, double>> wanted;
  for (const double x : {0.0, 2.5, 5.0})
    for (const double y : {0.0, 2.5, 5.0}) wanted.insert({x, y});
  EXPECT_EQ(body, wanted);
  EXPECT_EQ(model.position(model.find_node(2125)), Vec3(120, 20, 1.5)) << "the constraint's node keeps its number";
  EXPECT_EQ(document.current().relations->dependents.joining_cards[0].nodes.size(), 9u);
}

TEST_F(ReplacePartEdit, lists_what_cards_name_where_no_new_node_is_near) {
  variant({.columns = 40, .low = {20, 0, 1.5}});
  Document document = deck(kNamedNodes);
  const EditReport report = must_apply(document, kReplace);
  ASSERT_EQ(report.lost.size(), 4u);
  EXPECT_THAT(report.lost[0],
              HasSubstr("node:2001, which *SET_NODE_LIST 8 names, is no longer connected: the nearest new node is 20 away, more than 1.8"));
  EXPECT_THAT(report.notes, Contains("4 nodes of the old mesh stay, since other elements or cards have them")) << "no set may be empty";
  EXPECT_EQ(named(again(document), "set:8", "node"), (std::set<std::int64_t>{2001, 2002, 2026, 2027}));
}

TEST_F(ReplacePartEdit, the_same_mesh_again_gives_the_same_bytes) {
  Document document = deck(kOneWeld + kNamedNodes + "*SET_SEGMENT\n        11\n      2001      2002      2027      2026\n");
  const std::string before = content_of(folder / "flange.k");
  for (const int part : {1, 2}) {
    const std::string number = std::to_string(part);
    const EditReport report =
        must_apply(document, R"({"edit": "replace_part", "part": )" + number + R"(, "deck": "flange.k", "with": )" + number + "}");
    EXPECT_THAT(report.lost, IsEmpty());
  }
  EXPECT_EQ(saved(document), before);
}

TEST_F(ReplacePartEdit, of_stretched_shells_takes_the_nearest_corner) {
  // The reach of a corner is longer than the short sides: the row at y = 15 must not take the one at 20 with it.
  const std::string held =
      "*SET_NODE_LIST\n         7\n        10        11        12\n*BOUNDARY_SPC_SET\n         7         0         1\n";
  const VariantSheet stretched{2, 8, 60, {0, 0, 0}, 1, 1.5, 1.0 / 12};
  variant(stretched, held);
  Document document = open_deck(folder / "stretched.k", variant_text(stretched, held));
  must_apply(document, R"({"edit": "replace_part", "part": 7, "deck": "variant.k"})");
  EXPECT_TRUE(saved(document) == content_of(folder / "stretched.k"));
}

TEST_F(ReplacePartEdit, tells_of_segments_and_ranges_of_shells_that_get_no_new_shell) {
  const std::string named =
      "*SET_SEGMENT\n        11\n      2002      2003      2028      2027\n*LOAD_SEGMENT_SET\n        11         1       1.0\n"
      "*SET_SHELL_LIST_GENERATE\n        12\n      2001      2002\n*LOAD_SHELL_SET\n        12         1       1.0\n";
  variant({6, 1, 20});  // its centres are at y = 10
  Document document = deck(named);
  const EditReport report = must_apply(document, kReplace);
  EXPECT_THAT(report.lost, Contains(HasSubstr("the segment at shell:2002 is gone")));
  EXPECT_THAT(report.notes, Contains(HasSubstr("gets no shell of the new mesh")));
}

TEST_F(ReplacePartEdit, says_that_a_mesh_is_nowhere_near_the_part) {
  variant({48, 8, 2.5, {0, 0, 31.5}});
  Document document = deck();
  EXPECT_THAT(must_apply(document, kReplace).notes, Contains(HasSubstr("no shell of the new mesh is within ")));
  variant({});
  Document near = deck();
  EXPECT_THAT(must_apply(near, kReplace).notes, Each(testing::Not(HasSubstr("no shell of the new mesh is within "))));
}

TEST_F(ReplacePartEdit, exchanged_again_is_as_exchanged_once) {
  Document document = deck(kOneWeld + kNamedNodes);
  must_apply(document, kReplace);
  const std::string once = saved(document);
  EXPECT_THAT(must_apply(document, kReplace).lost, IsEmpty());
  EXPECT_EQ(saved(document), once) << "the same variant";
  variant({.columns = 60, .rows = 10, .side = 2, .first = 5001});
  EXPECT_THAT(must_apply(document, kReplace).lost, IsEmpty());
  const Document read = again(document);
  EXPECT_EQ(named(read, "set:9", "node"), named(read, "part:2", "node"));
  EXPECT_EQ(named(read, "set:10", "element"), named(read, "part:2", "element"));
  EXPECT_EQ(named(read, "set:8", "node").size(), 9u) << "at 0, 2 and 4 on both axes";
}

TEST_F(ReplacePartEdit, a_row_inside_joins_what_lies_within_a_quarter_of_the_tolerance) {
  variant({.low = {0, 0.2, 1.5}});
  std::string row = "*SET_NODE_LIST\n         8";
  for (int i = 0; i <= 24; ++i) row += (i % 8 == 0 ? "\n" : "") + printed("%10d", 2051 + i);
  Document document = deck(row + "\n");
  must_apply(document, kReplace);
  EXPECT_EQ(named(again(document), "set:8", "node").size(), 49u);
}

TEST_F(ReplacePartEdit, a_coarser_row_takes_the_place_of_a_set_along_it) {
  variant({.columns = 12, .rows = 2, .side = 10});
  std::string row = "*SET_NODE_LIST\n         8";
  for (int i = 0; i <= 24; ++i) row += (i % 8 == 0 ? "\n" : "") + printed("%10d", 2001 + i);
  Document document = deck(row + "\n");
  const EditReport report = must_apply(document, kReplace);
  EXPECT_THAT(report.lost, IsEmpty());
  const Document read = again(document);
  EXPECT_EQ(named(read, "set:8", "node").size(), 13u);
}

TEST_F(ReplacePartEdit, the_tolerance_says_how_far_away_a_place_may_be) {
  variant({.low = {2.4, 0, 1.5}});
  Document document = deck("*BOUNDARY_SPC_NODE\n      2001         0         1         1         1\n");
  EXPECT_EQ(must_apply(document, kReplace).lost.size(), 1u);
  must_apply(document, R"({"edit": "undo"})");
  EXPECT_EQ(must_apply(document, R"({"edit": "replace_part", "part": 2, "deck": "variant.k", "tolerance": 2.5})").lost.size(), 0u);
  EXPECT_EQ(document.current().model.position(document.current().model.find_node(2001)), Vec3(2.4, 0, 1.5)) << "its place is the variant's";
}

TEST_F(ReplacePartEdit, a_node_that_another_element_has_stays_where_it_is) {
  variant({.low = {0.5, 0, 1.5}});
  Document document =
      deck("*NODE\n   80009             0.0             0.0            50.0\n*ELEMENT_BEAM\n     901      90    2001   80009\n");
  const EditReport report = must_apply(document, kReplace);
  EXPECT_THAT(report.notes, Contains(HasSubstr("1 node of other parts and elements joined to the new mesh")));
  const Model& model = document.current().model;
  const NodeIndex node = model.find_node(2001);
  EXPECT_EQ(model.position(node), Vec3(0, 0, 1.5));
  EXPECT_EQ(model.adjacency->shells_of(node).size(), 1u);
  variant({.columns = 40, .low = {20, 0, 1.5}});
  must_apply(document, R"({"edit": "undo"})");
  EXPECT_THAT(must_apply(document, kReplace).lost,
              testing::ElementsAre(HasSubstr("node:2001, which beam:901 has, is no longer connected")));
}

TEST_F(ReplacePartEdit, three_points_turn_and_move_the_variant) {
  // Standing on its edge: its x is the deck's -y, its z the deck's x.
  std::string text = "*KEYWORD\n*NODE\n";
  text +=
      "      11             0.0             7.0             0.0\n      12             0.0             7.0            10.0\n"
      "      13           -20.0             7.0             0.0\n      14           -20.0             7.0            10.0\n"
      "*ELEMENT_SHELL\n       5       7      11      12      14      13\n*PART\nx\n         7         1         1\n*END\n";
  put_content(folder / "variant.k", text);
  Document document = deck("");
  must_apply(document, R"({"edit": "replace_part", "part": 2, "deck": "variant.k", "units": "mm",
    "align": [[11, 12, [-20, 7, 0]], [2001, [9.5, 0, 1.5], 2101]]})");
  const Model& model = document.current().model;
  const std::vector<Vec3> wanted{{0, 0, 1.5}, {10, 0, 1.5}, {0, 20, 1.5}, {10, 20, 1.5}};
  for (int n = 0; n < 4; ++n) EXPECT_LT((model.position(model.find_node(11 + n)) - wanted[static_cast<std::size_t>(n)]).norm(), 1e-12) << n;
}

TEST_F(ReplacePartEdit, is_brought_back_by_the_journal_and_replayed_without_the_variants_file) {
  Document document = deck(kOneWeld + kNamedNodes);
  const std::string then = R"({"edit": "translate", "by": [0, 0, 4], "on": "part:2", "falloff": {"profile": "constant"}})";
  const std::filesystem::path path = folder / "session.journal";
  {
    Result<Journal> journal = Journal::create(path, document);
    ASSERT_TRUE(journal);
    for (const std::string& json : {kReplace, then}) {
      Result<Prepared> prepared = prepare(document, edit_of(json));
      ASSERT_TRUE(prepared) << prepared.error().text();
      ASSERT_TRUE(journal->append(document, edit_of(json), *prepared));
      commit(document, std::move(*prepared));
    }
  }
  const std::string wanted = saved(document);
  std::filesystem::remove(folder / "variant.k");
  Document recovered = open(folder / "flange.k", {}).value();
  ASSERT_TRUE(Journal::recover(path, recovered));
  EXPECT_EQ(saved(recovered), wanted);
  const Dependents &a = document.current().relations->dependents, &b = recovered.current().relations->dependents;
  ASSERT_EQ(a.on_sheets.size(), b.on_sheets.size());
  for (std::size_t i = 0; i < a.on_sheets.size(); ++i) EXPECT_EQ(a.on_sheets[i].shell, b.on_sheets[i].shell);
  EXPECT_EQ(a.joined_nodes, b.joined_nodes);
  Document replayed = open(folder / "flange.k", {}).value();
  const Result<JournalIntents> intents = read_intents(path);
  ASSERT_TRUE(intents) << intents.error().text();
  for (const ReplayStep& step : replay(replayed, *intents)) EXPECT_TRUE(step.applied) << step.message;
  EXPECT_EQ(saved(replayed), wanted);
}

TEST_F(ReplacePartEdit, thicknesses_on_cards_are_those_of_the_place) {
  std::string text = flange_deck(2, "");
  // The left half of part 2 is 1 thick, the right half 2.
  std::string thick = "*ELEMENT_SHELL_THICKNESS\n", rest;
  std::size_t at = text.find("*ELEMENT_SHELL\n") + 15;
  const std::size_t end = text.find("*PART\n");
  while (at < end) {
    const std::size_t next = text.find('\n', at) + 1;
    const std::string line = text.substr(at, next - at);
    if (line.substr(8, 8) == "       2") {
      const int column = (std::stoi(line.substr(0, 8)) - 2001) % 24;
      const char* t = column < 12 ? "             1.0" : "             2.0";
      thick += line + t + t + t + t + "\n";
    } else {
      rest += line;
    }
    at = next;
  }
  text = text.substr(0, text.find("*ELEMENT_SHELL\n") + 15) + rest + thick + text.substr(end);
  variant({.first = 2001});
  Document document = open_deck(folder / "flange.k", text);
  must_apply(document, kReplace);
  const Document read = again(document);
  const Model& model = read.current().model;
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    if ((*model.parts)[model.shell_parts[s].value].id != 2) continue;
    const double x = (model.position(model.shell_nodes[s].node[0]).x() + model.position(model.shell_nodes[s].node[2]).x()) / 2;
    EXPECT_EQ(model.shell_thickness[s], x < 60 ? 1.0f : 2.0f) << x;
  }
  EXPECT_EQ(shells_of_part(model, 2), 384u);
}

TEST_F(ReplacePartEdit, says_that_the_section_stays) {
  variant({.thickness = 1.2});
  Document document = deck("");
  EXPECT_THAT(must_apply(document, kReplace).notes, Contains("its section stays: it is 1.5 thick, the variant is 1.2"));
}

TEST_F(ReplacePartEdit, refuses_with_a_reason_and_changes_nothing) {
  Document document = deck("");
  const auto of = [](const std::string& fields) { return R"({"edit": "replace_part", "deck": "variant.k", )" + fields + "}"; };
  EXPECT_THAT(refused(document, of(R"("part": 9)")), HasSubstr("there is no part:9"));
  EXPECT_THAT(refused(document, of(R"("part": 2, "with": 9)")), HasSubstr("the variant has no part 9, but 7"));
  EXPECT_THAT(refused(document, R"({"edit": "replace_part", "part": 2, "deck": "missing.k"})"), HasSubstr("missing.k"));
  EXPECT_THAT(refused(document, of(R"("part": 2, "units": "m")")), HasSubstr("Lengths aren't scaled"));
  EXPECT_THAT(refused(document, of(R"("part": 2, "units": "furlong")")), HasSubstr("\"units\" must be"));
  EXPECT_THAT(refused(document, of(R"("part": 2, "tolerance": 25)")), HasSubstr("the tolerance, 25, may be 22.5 at most"));
  EXPECT_THAT(refused(document, of(R"("part": 2, "align": [[1, 2, 3], [2001, 2002, 2101]])")), HasSubstr("lie on a line"));
  EXPECT_THAT(refused(document, of(R"("part": 2, "align": [[1, 49, 393], [2001, 2002, 2101]])")), HasSubstr("never scaled"));
  EXPECT_THAT(refused(document, of(R"("part": 2, "align": [[1, 49, 99999], [2001, 2002, 2101]])")),
              HasSubstr("the variant has no node 99999"));
  EXPECT_THAT(
      refused(document, of(R"("part": 2, "mesh": {"nodes": [[1, 0, 0, 0], [2, 1, 0, 0], [3, 1, 1, 0]], "shells": [[1, 1, 2, 4]]})")),
      HasSubstr("shell 1 of the mesh has the node 4, which it doesn't bring"));
  must_apply(document, R"({"edit": "lock", "on": "2"})");
  EXPECT_THAT(refused(document, of(R"("part": 2)")), HasSubstr("part:2 is locked"));
  EXPECT_EQ(parse_edit(of(R"("part": 2, "align": [[1, 2], [1, 2, 3]])")).has_value(), false);
}

TEST_F(ReplacePartEdit, refuses_a_variant_that_names_what_it_does_not_bring) {
  Document document = deck("");
  variant({}, "*ELEMENT_SHELL\n    9001       7       1       2   77777       3\n");
  EXPECT_THAT(refused(document, kReplace), testing::AllOf(HasSubstr("variant.k:"), HasSubstr("names what it doesn't bring: shell 9001")));
  variant({}, "*INCLUDE\nrest.k\n");
  EXPECT_THAT(refused(document, kReplace), HasSubstr("names the include file rest.k, which isn't there"));
  variant({}, "*ELEMENT_SHELL\n    9001       8       1       2      51      50\n");
  EXPECT_THAT(refused(document, kReplace), HasSubstr("\"with\" is missing: the variant has the parts 7, 8"));
}

TEST_F(ReplacePartEdit, asks_about_other_units_and_never_scales) {
  // In metres and kilograms: the density tells.
  std::string text = variant_text({.side = 0.0025, .low = {0, 0, 0.0015}, .thickness = 0.0015});
  text.replace(text.find("  7.85E-09    210000"), 20, "    7850.0   2.1E+11");
  put_content(folder / "variant.k", text);
  Document document = deck("");
  EXPECT_THAT(refused(document, kReplace),
              testing::AllOf(HasSubstr("seem to be in m, the deck's are in mm"), HasSubstr("\"units\": \"same\"")));
  must_apply(document, R"({"edit": "replace_part", "part": 2, "deck": "variant.k", "units": "same"})");
  const Model& model = document.current().model;
  EXPECT_DOUBLE_EQ(model.position(model.find_node(49)).x(), 0.12);
}

TEST_F(ReplacePartEdit, refuses_where_no_numbers_are_left) {
  put_content(folder / "variant.k", variant_text({.columns = 4, .rows = 4, .side = 10, .low = {0, 0, 0}, .first = 1}));
  Document document =
      open_deck(folder / "sheet.k", lsdyna_text(written_sheet(6, 3), "*CONTROL_FORMING_BLANKMESH\n\n         3        29        19\n"));
  variant({.columns = 12, .rows = 6, .side = 5, .low = {0, 0, 0}, .first = 101});
  EXPECT_THAT(refused(document, R"({"edit": "replace_part", "part": 1, "deck": "variant.k"})"), HasSubstr("no id is left"));
}

TEST_F(ReplacePartEdit, exchanges_parts_of_radioss_decks_and_names_the_formats_that_it_does_not) {
  WrittenMesh sheet = written_sheet(6, 3), fine;
  for (int j = 0; j <= 6; ++j)
    for (int i = 0; i <= 12; ++i) fine.nodes.emplace_back(501 + i + 13 * j, Vec3(5.0 * i, 5.0 * j, 0));
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 12; ++i) {
      const int corner = 501 + i + 13 * j;
      if ((i + j) % 5 != 0) {
        fine.shells.push_back({501 + i + 12 * j, {corner, corner + 1, corner + 14, corner + 13}});
        continue;
      }
      fine.shells.push_back({701 + i + 12 * j, {corner, corner + 1, corner + 14}});
      fine.shells.push_back({801 + i + 12 * j, {corner, corner + 14, corner + 13}});
    }
  const std::string groups = "/GRNOD/NODE/5\nedge\n         1         2         3         4         5         6         7\n";
  for (std::size_t format = 0; format < kDeckNames.size(); ++format) {
    SCOPED_TRACE(kDeckNames[format]);
    put_content(folder / kDeckNames[format], deck_text(format, sheet, format == 2 ? groups : ""));
    put_content(folder / ("fine-" + std::string(kDeckNames[format])), deck_text(format, fine));
    OpenOptions options;
    options.length_unit = LengthUnit::mm;
    Document document = open(folder / kDeckNames[format], options).value();
    const std::string json =
        R"({"edit": "replace_part", "part": 1, "units": "same", "deck": "fine-)" + std::string(kDeckNames[format]) + R"("})";
    if (format == 1 || format == 3) {
      EXPECT_THAT(refused(document, json), HasSubstr(format == 1 ? "not of nastran decks" : "not of abaqus decks"));
      continue;
    }
    const EditReport report = must_apply(document, json);
    EXPECT_THAT(report.lost, IsEmpty());
    const std::filesystem::path path = folder / "out" / kDeckNames[format];
    const auto written = save(document, path);
    ASSERT_TRUE(written) << written.error().text();
    const Document read = open(path, options).value();
    EXPECT_EQ(read.current().model.shell_count(), fine.shells.size());
    EXPECT_EQ(live_nodes(read.current().model), fine.nodes.size());
    EXPECT_EQ(shells_of_part(read.current().model, 1), fine.shells.size());
    if (format == 2) {
      EXPECT_EQ(named(read, "set:5", "node").size(), 13u) << "the row along the edge";
    }
    must_apply(document, R"({"edit": "undo"})");
    ASSERT_TRUE(save(document, path));
    EXPECT_EQ(content_of(path), content_of(folder / kDeckNames[format]));
  }
}

}  // namespace
}  // namespace prismesh::mesh::document
