// Welds that an edit makes: where they are, what they are like, what follows, what is refused.
#include <algorithm>
#include <array>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/document/deck_relations.h"
#include "mesh/document/delta.h"
#include "mesh/document/journal.h"
#include "tests/mesh/document/weld_deck.h"

namespace prismesh::mesh::document {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class WeldEdit : public ::testing::Test {
 protected:
  WeldEdit() { std::filesystem::create_directories(folder); }
  ~WeldEdit() override { std::filesystem::remove_all(folder); }

  Document deck(int sheets = 2, const std::string& welds = kOneWeld) const {
    return open_deck(folder / "flange.k", flange_deck(sheets, welds));
  }
  std::string saved(const Document& document) const {
    const auto report = save(document, folder / "saved.k");
    EXPECT_TRUE(report) << report.error().text();
    return content_of(folder / "saved.k");
  }
  /// The lines of `after` that aren't in `before`; fails unless these are all of `before` in order.
  static std::vector<std::string> added_lines(const std::string& before, const std::string& after) {
    std::vector<std::string> added;
    std::istringstream old(before), now(after);
    std::string wanted, line;
    bool more = static_cast<bool>(std::getline(old, wanted));
    while (std::getline(now, line)) {
      if (more && line == wanted)
        more = static_cast<bool>(std::getline(old, wanted));
      else
        added.push_back(line);
    }
    EXPECT_FALSE(more) << "a line is gone: " << wanted;
    return added;
  }
  static EditReport weld(Document& document, const std::string& json) {
    const Result<EditReport> report = try_apply(document, edit_of(json));
    EXPECT_TRUE(report) << report.error().text();
    return report.value_or(EditReport{});
  }
  static std::string refusal(Document& document, const std::string& json) {
    const std::size_t before = document.generations.size();
    const Result<EditReport> report = try_apply(document, edit_of(json));
    EXPECT_EQ(document.generations.size(), before);
    return report ? "it was applied" : report.error().text();
  }
  static const ElementBlock& beams(const Document& document) {
    return *document.current().model.elements[static_cast<std::size_t>(ElementClass::beam)];
  }

  std::filesystem::path folder = std::filesystem::temp_directory_path() / ("prismesh-weld-" + std::to_string(::getpid()));
};

const std::string kAlongFlange = R"({"edit": "weld", "flange": {"at": [60, 10, 0]}, "pitch": 20, "like": "beam:90001"})";

TEST_F(WeldEdit, goes_along_a_flange_at_the_pitch_with_a_node_on_each_sheet) {
  Document document = deck(2, kOneWeld);
  const EditReport report = weld(document, kAlongFlange);
  ASSERT_TRUE(report.welded);
  // at 10, 30, .. 110; the one at 10 is 5 from the existing weld at 5
  EXPECT_EQ(report.welded->welds_added, 5u);
  EXPECT_EQ(report.elements_added, 5u);
  ASSERT_EQ(report.welded->left_out.size(), 1u);
  EXPECT_THAT(report.welded->left_out[0].why, HasSubstr("a weld is there already"));
  const Model& model = document.current().model;
  ASSERT_EQ(beams(document).size(), 6u);
  std::set<double> along;
  for (std::size_t e = 1; e < 6; ++e) {
    EXPECT_EQ(beams(document).part[e], beams(document).part[0]);
    std::set<double> heights;
    for (std::size_t n = 2 * e; n < 2 * e + 2; ++n) {
      const Vec3& at = model.position(beams(document).nodes[n]);
      heights.insert(at.z());
      along.insert(at.x());
      EXPECT_DOUBLE_EQ(at.y(), 10);
    }
    EXPECT_EQ(heights, (std::set<double>{0, 1.5}));
  }
  EXPECT_EQ(along, (std::set<double>{30, 50, 70, 90, 110}));
}

TEST_F(WeldEdit, is_written_behind_its_example_and_changes_no_other_line) {
  Document document = deck();
  const std::string before = content_of(folder / "flange.k");
  weld(document, kAlongFlange);
  const std::vector<std::string> added = added_lines(before, saved(document));
  ASSERT_EQ(added.size(), 15u);
  EXPECT_EQ(added[0], "   80003           110.0            10.0             0.0");
  EXPECT_EQ(added[10], "   90002      90   80003   80004       0       0       0       0       0       2");
  EXPECT_EQ(added[14], "   90006      90   80011   80012       0       0       0       0       0       2");
}

TEST_F(WeldEdit, is_read_back_as_it_was_made) {
  Document document = deck();
  weld(document, kAlongFlange);
  saved(document);
  const Document again = open(folder / "saved.k", {}).value();
  const Model &a = document.current().model, &b = again.current().model;
  ASSERT_EQ(beams(again).id, beams(document).id);
  for (std::size_t n = 0; n < beams(document).nodes.size(); ++n) {
    const NodeIndex here = beams(document).nodes[n], there = beams(again).nodes[n];
    EXPECT_EQ(a.node_ids[here.value], b.node_ids[there.value]);
    EXPECT_EQ(a.position(here), b.position(there));
  }
}

TEST_F(WeldEdit, undone_leaves_the_deck_as_it_was) {
  Document document = deck();
  const std::string before = content_of(folder / "flange.k");
  weld(document, kAlongFlange);
  weld(document, R"({"edit": "weld", "points": [[20, 5, 1]], "like": "beam:90003"})");
  weld(document, R"({"edit": "undo"})");
  const EditReport report = weld(document, R"({"edit": "undo"})");
  EXPECT_EQ(report.elements_removed, 5u);
  EXPECT_EQ(saved(document), before);
  weld(document, R"({"edit": "redo"})");
  EXPECT_EQ(beams(document).size(), 6u);
}

TEST_F(WeldEdit, joins_three_sheets_by_a_chain) {
  Document document = deck(3);
  const EditReport report = weld(document, R"({"edit": "weld", "points": [[60, 10, 0]], "like": "beam:90001"})");
  EXPECT_EQ(report.welded->welds_added, 1u);
  EXPECT_EQ(report.elements_added, 2u);
  EXPECT_EQ(beams(document).nodes[3], beams(document).nodes[4]);
  const EditReport two = weld(document, R"({"edit": "weld", "points": [[80, 10, 3]], "sheets": 2, "like": "beam:90001"})");
  EXPECT_EQ(two.elements_added, 1u);
  const Model& model = document.current().model;
  EXPECT_DOUBLE_EQ(std::min(model.position(beams(document).nodes[6]).z(), model.position(beams(document).nodes[7]).z()), 1.5);
  const EditReport outer = weld(document, R"({"edit": "weld", "points": [[100, 10, 0]], "parts": "1,2", "like": "beam:90001"})");
  EXPECT_EQ(outer.elements_added, 1u);
}

TEST_F(WeldEdit, joins_the_node_sets_of_its_example_and_not_those_of_the_sheet) {
  Document document = deck(2, kOneWeld + "*SET_NODE_LIST\n         8\n     80001     80002\n*SET_NODE_LIST\n         9\n     80001\n");
  const std::string before = content_of(folder / "flange.k");
  weld(document, R"({"edit": "weld", "points": [[2.5, 2.5, 0]], "like": "beam:90001"})");
  const std::string after = saved(document);
  EXPECT_THAT(after, HasSubstr("         8\n     80001     80002     80003     80004\n"));
  EXPECT_THAT(after, HasSubstr("         9\n     80001\n"));
  EXPECT_THAT(after, HasSubstr("         7\n      1001      1002      1026      1027\n"));
}

TEST_F(WeldEdit, follows_its_sheets) {
  Document document = deck();
  weld(document, kAlongFlange);
  const NodeIndex low = beams(document).nodes[2];
  const Vec3 before = document.current().model.position(low);
  const EditReport report =
      weld(document, R"({"edit": "translate", "by": [0, 0, 4], "on": "part:1,part:2", "falloff": {"profile": "constant"}})");
  EXPECT_EQ(report.lost_connections, 0u);
  EXPECT_NEAR(document.current().model.position(low).z(), before.z() + 4, 1e-12);
}

TEST_F(WeldEdit, is_brought_back_from_its_delta) {
  Document document = deck();
  weld(document, kAlongFlange);
  const Generation &before = *document.generations[0], &after = document.current();
  Generation next = before;
  const auto moved = apply_delta(encode_delta(before, after), next);
  ASSERT_TRUE(moved) << moved.error().text();
  EXPECT_TRUE(moved->empty());
  const std::size_t beam = static_cast<std::size_t>(ElementClass::beam);
  EXPECT_EQ(next.model.elements[beam]->id, after.model.elements[beam]->id);
  EXPECT_EQ(next.model.elements[beam]->nodes, after.model.elements[beam]->nodes);
  EXPECT_EQ(next.model.topology_change->placed_nodes, after.model.topology_change->placed_nodes);
  EXPECT_EQ(next.model.topology_change->element_examples, after.model.topology_change->element_examples);
  for (std::size_t n = before.model.node_count(); n < after.model.node_count(); ++n)
    EXPECT_EQ(next.model.positions[n], after.model.positions[n]);
}

TEST_F(WeldEdit, is_recovered_with_what_depends_on_it) {
  Document document = deck();
  const std::filesystem::path path = folder / "session.journal";
  {
    Result<Journal> journal = Journal::create(path, document);
    ASSERT_TRUE(journal);
    for (const std::string& json : {kAlongFlange, std::string(R"({"edit": "translate", "by": [0, 0, 1], "on": "part:1"})")}) {
      Result<Prepared> prepared = prepare(document, edit_of(json));
      ASSERT_TRUE(prepared) << prepared.error().text();
      ASSERT_TRUE(journal->append(document, edit_of(json), *prepared));
      commit(document, std::move(*prepared));
    }
  }
  Document again = open(folder / "flange.k", {}).value();
  ASSERT_TRUE(Journal::recover(path, again));
  const std::string wanted = saved(document);
  EXPECT_EQ(saved(again), wanted);
  EXPECT_EQ(again.current().relations->element_uses, document.current().relations->element_uses);
  EXPECT_EQ(again.current().relations->dependents.on_sheets_by_shell, document.current().relations->dependents.on_sheets_by_shell);
  weld(again, R"({"edit": "undo"})");
  weld(again, R"({"edit": "undo"})");
  EXPECT_EQ(saved(again), content_of(folder / "flange.k"));
}

TEST_F(WeldEdit, goes_through_points_of_a_table) {
  put_content(folder / "welds.csv", "id,X,Y,Z\n1,30,10,0.7\n2,60,10,0.7\n3,60,10.1,0.7\n4,300,10,0\n");
  Document document = deck();
  const EditReport report = weld(document, R"({"edit": "weld", "points_file": "welds.csv", "pitch": 4, "like": "beam:90001"})");
  EXPECT_EQ(report.welded->welds_added, 2u);
  EXPECT_EQ(report.welded->spots_left, 2u);
  EXPECT_THAT(report.welded->left_out[1].why, HasSubstr("no sheet is there; the nearest is 180 away"));
}

TEST_F(WeldEdit, keeps_the_distance_from_the_sides_of_a_flange) {
  Document document = deck();
  EXPECT_EQ(weld(document, R"({"edit": "weld", "flange": {"at": [60, 10, 0]}, "pitch": 40, "edge_distance": 9.9, "like": "beam:90001"})")
                .welded->welds_added,
            2u);  // at 60 and 100; the one at 20 is near the existing weld
  EXPECT_THAT(
      refusal(document, R"({"edit": "weld", "flange": {"at": [60, 10, 0]}, "pitch": 40, "edge_distance": 10.1, "like": "beam:90001"})"),
      HasSubstr("the edge distance, 10.1, is longer than half of the flange's width, 10"));
}

TEST_F(WeldEdit, is_refused_by_a_sentence_and_nothing_changes) {
  Document document = deck();
  const auto with = [](const std::string& fields) { return R"({"edit": "weld", )" + fields + "}"; };
  const std::string flange = R"("flange": {"at": [60, 10, 0]})", like = R"("like": "beam:90001")";
  const std::vector<std::array<std::string, 2>> wrong = {
      {with(like), "weld needs one of \"flange\", \"along\", \"points\" and \"points_file\""},
      {with(flange + R"(, "points": [[1, 1, 1]], )" + like), "several are given"},
      {with(flange + ", " + like), "\"pitch\" is missing"},
      {with(flange + R"(, "pitch": 121, )" + like), "the pitch, 121, is longer than the flange, 120"},
      {with(flange + R"(, "pitch": 10, "end_distance": 61, )" + like), "the end distance, 61, is longer than half of the flange, 60"},
      {with(flange + R"(, "pitch": 1e-9, )" + like), "over a million welds"},
      {with(R"("along": [[0, 10, 0], [0, 10, 0]], "pitch": 5, )" + like), "the line has no length"},
      {with(flange + R"(, "pitch": 20)"), "\"like\" or \"diameter\" is missing"},
      {with(flange + R"(, "pitch": 20, "diameter": 6, )" + like), "only one can be given"},
      {with(flange + R"(, "pitch": 20, "like": "beam:7")"), "there is no beam 7"},
      {with(flange + R"(, "pitch": 20, "like": "7")"), "must name an element that is a weld"},
      {with(flange + R"(, "pitch": 20, "as": "solid", )" + like), "makes no welds as \"solid\""},
      {with(flange + R"(, "pitch": 20, "parts": "1", )" + like), "at least two parts"},
      {with(R"("flange": {"at": 777777}, "pitch": 20, )" + like), "777777"},
      {with(R"("points": [[500, 500, 500]], )" + like), "no weld can be made at any of 1 spot: no sheet is there"},
      {with(R"("points_file": "nowhere.csv", )" + like), "nowhere.csv"},
  };
  for (const auto& [json, why] : wrong) EXPECT_THAT(refusal(document, json), HasSubstr(why)) << json;
  EXPECT_FALSE(parse_edit(with(flange + R"(, "pitch": 0, )" + like)));
  EXPECT_EQ(saved(document), content_of(folder / "flange.k"));
}

TEST_F(WeldEdit, is_refused_on_locked_parts) {
  Document document = deck();
  weld(document, R"({"edit": "lock", "on": "1"})");
  EXPECT_THAT(refusal(document, kAlongFlange), HasSubstr("part:1 is locked"));
  weld(document, R"({"edit": "unlock", "on": "1"})");
  weld(document, R"({"edit": "lock", "on": "90"})");
  EXPECT_THAT(refusal(document, kAlongFlange), HasSubstr("part:90 is locked"));
}

TEST_F(WeldEdit, is_refused_where_a_sheet_is_missing) {
  Document document = deck(1);
  EXPECT_THAT(refusal(document, R"({"edit": "weld", "points": [[60, 10, 0]], "like": "beam:90001"})"),
              HasSubstr("only a sheet of part:1 is there"));
}

TEST_F(WeldEdit, is_refused_with_an_example_whose_node_is_missing) {
  Document document = deck(2, kOneWeld + "*ELEMENT_BEAM\n   90009      90   80001   88888\n");
  EXPECT_THAT(refusal(document, R"({"edit": "weld", "points": [[60, 10, 0]], "like": "beam:90009"})"),
              HasSubstr("beam 90009 can't be the example: a node of it isn't defined"));
}

TEST_F(WeldEdit, is_refused_where_ids_run_out) {
  std::string welds = kOneWeld;
  // Every beam's number is within a range of another set.
  welds += "*SET_BEAM_GENERATE\n         5\n         1  90000\n     90002  99999999\n";
  Document document = deck(2, welds);
  const std::string why = refusal(document, kAlongFlange);
  EXPECT_THAT(why, AllOf(HasSubstr("flange.k"), HasSubstr("no id is left for a new beam"))) << why;
}

TEST_F(WeldEdit, a_beam_with_an_orientation_node_or_listed_parts_is_no_example) {
  Document document = deck(2, kOneWeld +
                                  "*ELEMENT_BEAM\n   90009      90   80001   80002    1001\n*ELEMENT_BEAM_PID\n   90010      90   80001   "
                                  "80002\n         1         2\n");
  EXPECT_THAT(refusal(document, R"({"edit": "weld", "points": [[60, 10, 0]], "like": "beam:90009"})"),
              HasSubstr("a node of its own for its orientation"));
  EXPECT_THAT(refusal(document, R"({"edit": "weld", "points": [[60, 10, 0]], "like": "beam:90010"})"),
              HasSubstr("names the parts that each beam joins"));
}

TEST_F(WeldEdit, keeps_the_layout_of_its_example) {
  const auto added = [&](const std::string& welds, const std::string& keyword) {
    std::string text = flange_deck(2, welds);
    if (!keyword.empty()) text.replace(0, 8, keyword);
    Document document = open_deck(folder / "flange.k", text);
    weld(document, R"({"edit": "weld", "points": [[60, 10, 0]], "like": "beam:90001"})");
    return added_lines(text, saved(document));
  };
  EXPECT_THAT(added("*NODE\n80001,5,10,0\n80002,5,10,1.5\n*ELEMENT_BEAM\n90001,90,80001,80002\n", ""),
              ElementsAre("80003,60.0,10.0,0.0", "80004,60.0,10.0,1.5", "90002,90,80003,80004"));
  EXPECT_THAT(added("*NODE +\n               80001                   5                  10                   0\n"
                    "               80002                   5                  10                 1.5\n"
                    "*ELEMENT_BEAM +\n               90001                  90               80001               80002\n",
                    ""),
              ElementsAre("               80003                60.0                10.0                 0.0",
                          "               80004                60.0                10.0                 1.5",
                          "               90002                  90               80003               80004"));
}

TEST_F(WeldEdit, refuses_a_diameter_larger_than_a_sheet) {
  Document document = deck(2, "");
  for (const char* diameter : {"1e30", "500"})
    EXPECT_THAT(refusal(document, R"({"edit": "weld", "points": [[60, 10, 0]], "diameter": )" + std::string(diameter) + "}"),
                AllOf(HasSubstr("is larger than the sheet part:1"), HasSubstr(" mm long")));
  EXPECT_EQ(beams(document).size(), 0u);
  weld(document, R"({"edit": "weld", "points": [[60, 10, 0]], "diameter": 8, "yield_stress": 300})");
}

TEST_F(WeldEdit, says_which_sheets_the_contact_of_its_example_does_not_name) {
  const std::string by_parts =
      kOneWeld.substr(0, kOneWeld.find("*SET_PART_LIST")) +
      "*SET_PART_LIST\n        91\n         1         2\n*CONTACT_SPOTWELD\n        90        91         3         2\n\n\n";
  Document document = deck(3, by_parts);
  const EditReport two = weld(document, R"({"edit": "weld", "points": [[60, 10, 0]], "parts": "1,2", "like": "beam:90001"})");
  EXPECT_THAT(two.notes, ElementsAre("1 weld added to part:90"));
  const EditReport three = weld(document, R"({"edit": "weld", "points": [[80, 10, 0]], "like": "beam:90001"})");
  ASSERT_EQ(three.notes.size(), 2u);
  EXPECT_THAT(three.notes[0], HasSubstr("part:3 isn't among the parts to which a contact ties part:90"));
}

// --- without an example ---

const std::string kNewPart = R"({"edit": "weld", "flange": {"at": [60, 10, 0]}, "pitch": 20, "diameter": 6, "yield_stress": 300})";

TEST_F(WeldEdit, makes_part_section_material_set_and_contact_where_there_is_no_example) {
  Document document = deck(2, "");
  const std::string before = content_of(folder / "flange.k");
  const EditReport report = weld(document, kNewPart);
  EXPECT_EQ(report.welded->welds_added, 6u);
  const std::vector<std::string> added = added_lines(before, saved(document));
  const auto is_from = [&](const std::string& keyword, std::vector<std::string> lines) {
    const auto at = std::find(added.begin(), added.end(), keyword);
    ASSERT_NE(at, added.end()) << keyword;
    ASSERT_GE(added.end() - at, static_cast<std::ptrdiff_t>(lines.size() + 1)) << keyword;
    EXPECT_EQ(std::vector<std::string>(at + 1, at + 1 + static_cast<std::ptrdiff_t>(lines.size())), lines) << keyword;
  };
  is_from("*PART", {"spot welds", "         4         4         4"});
  is_from("*SECTION_BEAM", {"         4         9       1.0       2.0       1.0", "       6.0       6.0       0.0       0.0"});
  is_from("*MAT_SPOTWELD", {"         4   7.85E-9  210000.0       0.3     300.0       0.0", ""});
  is_from("*SET_PART_LIST", {"         4", "         1         2"});
  is_from("*CONTACT_SPOTWELD", {"         4         4         3         2", "", ""});
  // twelve nodes behind those of the sheets, six beams behind all other elements
  EXPECT_EQ(
      std::count_if(added.begin(), added.end(), [](const std::string& line) { return line.size() == 40 && line.ends_with("       0"); }),
      6);
  const Document again = open(folder / "saved.k", {}).value();
  EXPECT_EQ(beams(again).size(), 6u);
  EXPECT_EQ((*again.current().model.parts)[beams(again).part[0].value].id, 4);
  EXPECT_EQ(again.current().relations->dependents.on_sheets.size(), 12u);
}

TEST_F(WeldEdit, says_which_sheets_the_contact_of_a_part_that_it_made_does_not_name) {
  Document document = deck(3, "");
  weld(document, R"({"edit": "weld", "points": [[60, 10, 0]], "parts": "1,2", "diameter": 6, "yield_stress": 300})");
  EXPECT_THAT(weld(document, R"({"edit": "weld", "points": [[80, 10, 0]], "parts": "1,2", "like": "beam:1"})").notes,
              ElementsAre("1 weld added to part:4"));
  EXPECT_THAT(weld(document, R"({"edit": "weld", "points": [[90, 10, 0]], "like": "beam:1"})").notes[0],
              HasSubstr("part:3 isn't among the parts to which a contact ties part:4"));
}

TEST_F(WeldEdit, takes_the_yield_stress_from_the_sheets_materials) {
  std::string text = flange_deck(2, "");
  const std::string elastic = "*MAT_ELASTIC\n         1  7.85E-09    210000       0.3\n";
  text.replace(text.find(elastic), elastic.size(),
               "*MAT_PIECEWISE_LINEAR_PLASTICITY\n         1  7.85E-09    210000       0.3     340.5\n\n\n\n");
  Document document = open_deck(folder / "flange.k", text);
  weld(document, R"({"edit": "weld", "points": [[60, 10, 0]], "diameter": 5})");
  EXPECT_THAT(saved(document), HasSubstr("*MAT_SPOTWELD\n         4   7.85E-9  210000.0       0.3     340.5       0.0\n"));
}

TEST_F(WeldEdit, asks_for_what_the_sheets_materials_do_not_say) {
  Document document = deck(2, "");
  EXPECT_THAT(refusal(document, R"({"edit": "weld", "points": [[60, 10, 0]], "diameter": 5})"),
              HasSubstr("the yield stress of the welds isn't known from the materials of the sheets: \"yield_stress\" must give it"));
}

TEST_F(WeldEdit, a_new_part_is_brought_back_undone_and_followed) {
  Document document = deck(2, "");
  const std::string before = content_of(folder / "flange.k");
  const std::filesystem::path path = folder / "session.journal";
  {
    Result<Journal> journal = Journal::create(path, document);
    ASSERT_TRUE(journal);
    for (const std::string& json :
         {kNewPart, std::string(R"({"edit": "lock", "on": "4"})"), std::string(R"({"edit": "unlock", "on": "4"})"),
          std::string(R"({"edit": "weld", "points": [[15, 15, 0]], "like": "beam:1"})"),
          std::string(R"({"edit": "weld", "points": [[25, 15, 0]], "diameter": 4, "yield_stress": 300})"),
          std::string(R"({"edit": "set_target_size", "size": 4, "on": "4"})")}) {
      Result<Prepared> prepared = prepare(document, edit_of(json));
      ASSERT_TRUE(prepared) << json << prepared.error().text();
      ASSERT_TRUE(journal->append(document, edit_of(json), *prepared));
      commit(document, std::move(*prepared));
    }
  }
  Document again = open(folder / "flange.k", {}).value();
  ASSERT_TRUE(Journal::recover(path, again));
  EXPECT_EQ(again.current().model.parts->size(), 5u);
  EXPECT_EQ(again.current().parts->size(), 5u);
  EXPECT_EQ(again.current().judging->parts.size(), 5u);
  const std::string wanted = saved(document);
  EXPECT_THAT(wanted, HasSubstr("         5         5         5\n"));
  EXPECT_EQ(saved(again), wanted);
  for (int step = 0; step < 6; ++step) weld(again, R"({"edit": "undo"})");
  EXPECT_EQ(again.current().parts->size(), 3u);
  EXPECT_EQ(saved(again), before);
}

TEST_F(WeldEdit, new_cards_have_the_columns_and_line_ends_of_the_main_file) {
  std::string text = flange_deck(2, "");
  // The sheets' cards are narrow by their own keywords.
  for (const char* keyword : {"*NODE\n", "*ELEMENT_SHELL\n", "*PART\n", "*SECTION_SHELL\n", "*MAT_ELASTIC\n", "*SET_NODE_LIST\n"})
    for (std::size_t at = 0; (at = text.find(keyword, at)) != std::string::npos; at += 3) text.insert(text.find('\n', at), " -");
  text.replace(0, 8, "*KEYWORD LONG=Y");
  std::string windows;
  for (const char each : text) windows += each == '\n' ? std::string("\r\n") : std::string(1, each);
  Document document = open_deck(folder / "flange.k", windows);
  weld(document, R"({"edit": "weld", "points": [[60, 10, 0]], "diameter": 5, "yield_stress": 300})");
  const std::string after = saved(document);
  EXPECT_EQ(std::count(after.begin(), after.end(), '\n'), std::count(after.begin(), after.end(), '\r'));
  EXPECT_THAT(after, HasSubstr("*PART\r\nspot welds\r\n                   4                   4                   4\r\n"));
  EXPECT_THAT(
      after,
      HasSubstr(
          "*ELEMENT_BEAM\r\n                   1                   4                2126                2127                   0\r\n"));
  const Document again = open(folder / "saved.k", {}).value();
  EXPECT_EQ(beams(again).size(), 1u);
}

// --- Radioss ---

/// Sheets as parts 1 and on, a spring of part 9 between them, whose ends two interfaces tie by a group each.
std::string radioss_deck(int sheets = 2) {
  std::string text =
      "#RADIOSS STARTER\n/BEGIN\nwelds\n      2020         0\n                  Mg                  mm                   s\n"
      "                  Mg                  mm                   s\n/NODE\n";
  char line[128];
  for (int part = 1; part <= sheets; ++part)
    for (int j = 0; j <= 4; ++j)
      for (int i = 0; i <= 24; ++i) {
        std::snprintf(line, sizeof line, "%10d%20.6f%20.6f%20.6f\n", 1000 * part + 1 + i + 25 * j, 5.0 * i, 5.0 * j, 1.5 * (part - 1));
        text += line;
      }
  text +=
      "      8001                 5.0                10.0                 0.0\n      8002                 5.0                10.0          "
      "       1.5\n";
  for (int part = 1; part <= sheets; ++part) {
    std::snprintf(line, sizeof line, "/SHELL/%d\n", part);
    text += line;
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 24; ++i) {
        const int corner = 1000 * part + 1 + i + 25 * j;
        std::snprintf(line, sizeof line, "%10d%10d%10d%10d%10d\n", 1000 * part + 1 + i + 24 * j, corner, corner + 1, corner + 26,
                      corner + 25);
        text += line;
      }
  }
  return text +
         "/SPRING/9\n      9001      8001      8002\n/PART/1\nlower\n         1         1\n/PART/2\nupper\n         1         1\n"
         "/PART/3\nthird\n         1         1\n/PART/9\nspot welds\n         9         0\n"
         "/PROP/SHELL/1\nsheet\n        24         0\n                 0.0\n         5         0                 1.5\n"
         "/GRNOD/NODE/55\nlower ends\n      8001\n/GRNOD/NODE/56\nupper ends\n      8002\n/GRNOD/NODE/57\nno tie\n      8002\n"
         "/INTER/TYPE2/1\nlower\n        55        61         0         1\n/INTER/TYPE2/2\nupper\n        56        62         0         "
         "1\n"
         "/SURF/PART/61\nlower\n         1\n/SURF/PART/62\nupper\n         2\n/END\n";
}

class RadiossWeld : public WeldEdit {
 protected:
  Document springs() const { return open_deck(folder / "welds_0000.rad", radioss_deck()); }
};

TEST_F(RadiossWeld, is_a_spring_of_the_same_part_whose_ends_are_tied_to_their_sheets) {
  Document document = springs();
  const EditReport report = weld(document, R"({"edit": "weld", "points": [[60, 10, 0], [80, 10, 1.5]], "like": "spring:9001"})");
  EXPECT_EQ(report.elements_added, 2u);
  const auto out = save(document, folder / "saved_0000.rad");
  ASSERT_TRUE(out) << out.error().text();
  const std::string after = content_of(folder / "saved_0000.rad");
  EXPECT_THAT(after, HasSubstr("      9001      8001      8002\n      9002      8003      8004\n      9003      8005      8006\n"));
  EXPECT_THAT(after, HasSubstr("lower ends\n      8001      8003      8005\n"));
  EXPECT_THAT(after, HasSubstr("upper ends\n      8002      8004      8006\n"));
  EXPECT_THAT(after, HasSubstr("no tie\n      8002\n"));
  const Document again = open(folder / "saved_0000.rad", {}).value();
  EXPECT_EQ(again.current().model.elements[static_cast<std::size_t>(ElementClass::discrete)]->size(), 3u);
  weld(document, R"({"edit": "undo"})");
  ASSERT_TRUE(save(document, folder / "undone_0000.rad"));
  EXPECT_EQ(content_of(folder / "undone_0000.rad"), radioss_deck());
}

TEST_F(RadiossWeld, is_left_out_where_the_ties_of_its_example_hold_other_sheets) {
  Document document = open_deck(folder / "welds_0000.rad", radioss_deck(3));
  EXPECT_THAT(refusal(document, R"({"edit": "weld", "points": [[60, 10, 0]], "like": "spring:9001"})"),
              HasSubstr("the ties of the existing weld hold part:1 and part:2, not part:3"));
  EXPECT_EQ(weld(document, R"({"edit": "weld", "points": [[60, 10, 0]], "sheets": 2, "like": "spring:9001"})").elements_added, 1u);
}

TEST_F(RadiossWeld, without_an_example_is_refused_by_name) {
  Document document = springs();
  EXPECT_THAT(refusal(document, R"({"edit": "weld", "points": [[60, 10, 0]], "diameter": 5})"),
              HasSubstr("this version makes no part of welds in radioss decks"));
}

TEST_F(WeldEdit, no_point_gets_a_weld_twice) {
  Document document = deck();
  const EditReport report =
      must_apply(document, R"({"edit": "weld", "points": [[40, 10, 0], [40, 10, 0], [60, 10, 0.7], [5, 10, 0]], "like": "beam:90001"})");
  EXPECT_EQ(report.welded->welds_added, 2U);
  ASSERT_EQ(report.welded->spots_left, 2U) << "one is there twice, one is on the deck's own weld";
  EXPECT_EQ(report.welded->left_out[0].why, "a weld is there already");
}

TEST_F(WeldEdit, a_flange_shorter_than_the_pitch_doesnt_refuse_the_others) {
  // Beside the flange of 120 another one of 50 of the same parts, at x = 300.
  std::string nodes, shells;
  char line[128];
  for (int part = 1; part <= 2; ++part) {
    for (int j = 0; j <= 4; ++j)
      for (int i = 0; i <= 10; ++i) {
        std::snprintf(line, sizeof line, "%8d%16.6f%16.6f%16.6f\n", 1000 * part + 501 + i + 11 * j, 300 + 5.0 * i, 5.0 * j,
                      1.5 * (part - 1));
        nodes += line;
      }
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 10; ++i) {
        const int corner = 1000 * part + 501 + i + 11 * j;
        std::snprintf(line, sizeof line, "%8d%8d%8d%8d%8d%8d\n", 1000 * part + 501 + i + 10 * j, part, corner, corner + 1, corner + 12,
                      corner + 11);
        shells += line;
      }
  }
  Document document = deck(2, kOneWeld + "*NODE\n" + nodes + "*ELEMENT_SHELL\n" + shells);
  const EditReport report = must_apply(document, R"({"edit": "weld", "flange": {"between": "1,2"}, "pitch": 60, "like": "beam:90001"})");
  EXPECT_EQ(report.welded->welds_added, 1U) << "at 90; the deck's weld at 5 is nearer to 30 than half the pitch";
  EXPECT_THAT(report.notes, testing::Contains("1 flange shorter than the pitch got no weld"));
  EXPECT_THAT(refusal(document, R"({"edit": "weld", "flange": {"between": "1,2"}, "pitch": 500, "like": "beam:90001"})"),
              HasSubstr("is longer than the flange"));
}

}  // namespace
}  // namespace prismesh::mesh::document
