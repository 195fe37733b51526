// What an edit that adds, divides and removes does to the text of a keyword deck: each rule of docs/formats/editing.md.
#include <cmath>
#include <functional>

#include "mesh/deck/formats/formats.h"
#include "mesh/deck/open.h"
#include "mesh/deck/save.h"
#include "tests/mesh/deck/growing.h"

namespace prismesh::mesh::deck {
namespace {

/// Two quads side by side:   4 5 6
///                           1 2 3
const std::string kNodes =
    "*NODE\n"
    "       1             0.0             0.0             0.0\n"
    "       2             1.0             0.0             0.0\n"
    "       3             2.0             0.0             0.0\n"
    "       4             0.0             1.0             0.0\n"
    "       5             1.0             1.0             0.0\n"
    "       6             2.0             1.0             0.0\n";
const std::string kThreeShells =
    "*ELEMENT_SHELL\n"
    "      11       7       1       2       5       4\n"
    "      12       7       2       3       6       5\n";
const std::string kEnd = "*END\n";

class Editing : public ::testing::Test {
 protected:
  Growing& open(const std::string& text) {
    auto opened = folder_.open(text);
    if (!opened) throw std::runtime_error(opened.error().text());
    opened_ = std::move(*opened);
    edit_.emplace(opened_);
    return *edit_;
  }
  /// Saves, and reads again: the same model. Returns the main file's text.
  std::string saved() {
    auto report = save(*opened_.deck, opened_.model, edit_->model, folder_ / "out/deck.k");
    EXPECT_TRUE(report) << report.error().text();
    if (!report) return {};
    report_ = *report;
    const auto again = deck::open(folder_ / "out/deck.k");
    EXPECT_TRUE(again) << again.error().text();
    if (again) expect_same(again->model, edit_->model);
    const std::string text = content(folder_ / "out/deck.k");
    const LineDifference lines = line_difference(content(folder_ / "deck.k"), text);
    EXPECT_GE(report_.lines_changed, std::max(lines.gone.size(), lines.come.size()));
    EXPECT_LE(report_.lines_changed, lines.gone.size() + lines.come.size());
    return text;
  }
  Error refused() {
    const auto may = can_save(*opened_.deck, opened_.model, edit_->model);
    EXPECT_FALSE(may);
    const auto report = save(*opened_.deck, opened_.model, edit_->model, folder_ / "out/deck.k");
    EXPECT_FALSE(report);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
    return may ? Error{} : may.error();
  }

  DeckFolder folder_;
  OpenedDeck opened_;
  std::optional<Growing> edit_;
  SaveReport report_;
};

TEST_F(Editing, new_cards_stand_behind_those_they_come_from) {
  Growing& edit = open(kNodes + kThreeShells + kEnd);
  edit.split_conforming(edit.shell(11));
  const std::string text = saved();
  EXPECT_EQ(text,
            "*NODE\n"
            "       1             0.0             0.0             0.0\n"
            "       2             1.0             0.0             0.0\n"
            "       7             0.5             0.0             0.0\n"
            "       3             2.0             0.0             0.0\n"
            "       4             0.0             1.0             0.0\n"
            "      10             0.0             0.5             0.0\n"
            "       5             1.0             1.0             0.0\n"
            "       8             1.0             0.5             0.0\n"
            "       9             0.5             1.0             0.0\n"
            "      11             0.5             0.5             0.0\n"
            "       6             2.0             1.0             0.0\n"
            "*ELEMENT_SHELL\n"
            "      11       7       1       7      11      10\n"
            "      13       7       7       2       8      11\n"
            "      14       7      11       8       5       9\n"
            "      15       7      10      11       9       4\n"
            "      12       7       5       8       6       6\n"
            "      16       7       8       2       3       3\n"
            "      17       7       8       3       6       6\n"
            "*END\n");
  EXPECT_EQ(report_.nodes_added, 5u);
  EXPECT_EQ(report_.shells_added, 5u);
  EXPECT_EQ(report_.shells_changed, 2u);
  EXPECT_EQ(report_.lines_changed, 12u);
}

TEST_F(Editing, keeps_commas_line_ends_and_a_last_line_without_one) {
  Growing& edit = open("*NODE\r\n1,0.,0.,0.,0,0\r\n2,1.,0.,0.,0,0\r\n3,1.,1.,0.,0,0\r\n4,0.,1.,0.,0,0\r\n*ELEMENT_SHELL\r\n5,1,1,2,3,4");
  edit.split_in_four(edit.shell(5));
  EXPECT_EQ(saved(),
            "*NODE\r\n1,0.,0.,0.,0,0\r\n2,1.,0.,0.,0,0\r\n5,0.5,0.0,0.0,0,0\r\n3,1.,1.,0.,0,0\r\n6,1.0,0.5,0.0,0,0\r\n4,0.,1.,0.,0,0\r\n"
            "7,0.5,1.0,0.0,0,0\r\n8,0.0,0.5,0.0,0,0\r\n9,0.5,0.5,0.0,0,0\r\n"
            "*ELEMENT_SHELL\r\n5,1,1,5,9,8\r\n6,1,5,2,6,9\r\n7,1,9,6,3,7\r\n8,1,8,9,7,4");
}

TEST_F(Editing, a_node_is_constrained_if_both_it_comes_from_are) {
  const auto node = [](const char* id, const char* x, bool fixed) {
    return "       " + std::string(id) + "             " + x + "             0.0             0.0" + (fixed ? "       7       7\n" : "\n");
  };
  const std::string rest =
      "       3             1.0             1.0             0.0\n*ELEMENT_SHELL\n       5       1       1       2       3       3\n";
  for (const auto& [first, second] : {std::pair(true, true), std::pair(true, false), std::pair(false, true), std::pair(false, false)}) {
    Growing& edit = open("*NODE\n" + node("1", "0.0", first) + node("2", "1.0", second) + rest);
    edit.split_at_edge(edit.shell(5), 0, edit.middle(edit.node(1), edit.node(2)));
    const std::string text = saved(), wanted = "       4             0.5             0.0             0.0";
    const std::size_t line = text.find(wanted);
    ASSERT_NE(line, std::string::npos) << text;
    const std::string constraints = text.substr(line + wanted.size(), text.find('\n', line) - line - wanted.size());
    EXPECT_EQ(constraints.find("7") != std::string::npos, first && second) << text;
  }
}

TEST_F(Editing, keeps_wide_columns) {
  const auto wide = [](std::initializer_list<const char*> fields) {
    std::string line;
    for (const std::string field : fields) line += std::string(20 - field.size(), ' ') + field;
    return line + "\n";
  };
  Growing& edit = open("*KEYWORD LONG=Y\n*NODE\n" + wide({"1", "0.0", "0.0", "0.0"}) + wide({"2", "1.0", "0.0", "0.0"}) +
                       wide({"3000000000", "1.0", "1.0", "0.0"}) + "*ELEMENT_SHELL\n" +
                       wide({"1", "1", "1", "2", "3000000000", "3000000000"}) + "*END\n");
  const NodeIndex middle = edit.middle(edit.node(1), edit.node(2));
  edit.split_at_edge(edit.shell(1), 0, middle);
  const std::string text = saved();
  EXPECT_NE(text.find(wide({"2", "1.0", "0.0", "0.0"}) + wide({"3000000001", "0.5", "0.0", "0.0"})), std::string::npos) << text;
  EXPECT_NE(text.find(wide({"2", "1", "3000000001", "2", "3000000000", "3000000000"})), std::string::npos) << text;
}

TEST_F(Editing, mixes_thicknesses_and_turns_angles_back) {
  Growing& edit = open(kNodes +
                       "*ELEMENT_SHELL_THICKNESS_BETA\n"
                       "      11       7       1       2       5       4\n"
                       "$ its thicknesses\n"
                       "             1.0             2.0             4.0             3.0            30.0\n"
                       "      12       7       2       3       6       5\n"
                       "             1.0             1.0             1.0             1.0\n" +
                       kEnd);
  edit.split_conforming(edit.shell(11));
  const std::string text = saved();
  const std::string wanted =
      "*ELEMENT_SHELL_THICKNESS_BETA\n"
      "      11       7       1       7      11      10\n"
      "$ its thicknesses\n"
      "             1.0             1.5             2.5             2.0            30.0\n"
      "      13       7       7       2       8      11\n"
      "             1.5             2.0             3.0             2.5            30.0\n"
      "      14       7      11       8       5       9\n"
      "             2.5             3.0             4.0             3.5            30.0\n"
      "      15       7      10      11       9       4\n"
      "             2.0             2.5             3.5             3.0            30.0\n"
      "      12       7       5       8       6       6\n"
      "             1.0             1.0             1.0             1.0\n"
      "      16       7       8       2       3       3\n"
      "             1.0             1.0             1.0             1.0\n"
      "      17       7       8       3       6       6\n"
      "             1.0             1.0             1.0             1.0\n";
  EXPECT_NE(text.find(wanted), std::string::npos) << text;
}

/// A piece that begins at another corner has its first edge elsewhere; in the second generation too.
TEST_F(Editing, turns_angles_through_several_generations) {
  Growing& edit = open(kNodes +
                       "*ELEMENT_SHELL_THICKNESS_BETA\n"
                       "      11       7       1       2       5       4\n"
                       "             1.0             2.0             4.0             3.0            30.0\n" +
                       kEnd);
  const ShellIndex parent = edit.shell(11);
  const NodeIndex low = edit.middle(edit.node(1), edit.node(2)), high = edit.middle(edit.node(5), edit.node(4));
  set_shell_nodes(edit.model, parent, {{edit.node(1), low, high, edit.node(4)}});
  const ShellIndex right = edit.child(parent, edit.node(2), edit.node(5), high, low);  // begins with the upright edge
  const NodeIndex inner = edit.middle(low, high), outer = edit.middle(edit.node(2), edit.node(5));
  set_shell_nodes(edit.model, right, {{edit.node(2), outer, inner, low}});
  edit.child(right, inner, outer, edit.node(5), high);
  const std::string text = saved();
  EXPECT_NE(text.find("      12       7       2      10       9       7\n"
                      "             2.0             3.0             2.5             1.5           -60.0\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("      13       7       9      10       5       8\n"
                      "             2.5             3.0             4.0             3.5            30.0\n"),
            std::string::npos)
      << text;
}

TEST_F(Editing, carries_layers_offset_and_coordinate_system) {
  const std::string layers =
      "             2.5\n"
      "         1       0.5      10.0                   1       0.5      20.0\n"
      "         1       0.5      15.0\n";
  Growing& edit = open(kNodes + "*ELEMENT_SHELL_OFFSET_COMPOSITE\n      11       7       1       2       5       4\n" + layers +
                       "*ELEMENT_SHELL_MCID\n" +
                       "      12       7       2       3       6       5\n             0.0             0.0             0.0             0.0 "
                       "              4\n" +
                       kEnd);
  const ShellIndex parent = edit.shell(11);
  set_shell_nodes(edit.model, parent, {{edit.node(1), edit.node(2), edit.node(4), edit.node(4)}});
  edit.child(parent, edit.node(2), edit.node(5), edit.node(4), edit.node(4));
  const ShellIndex other = edit.shell(12);
  set_shell_nodes(edit.model, other, {{edit.node(3), edit.node(6), edit.node(5), edit.node(5)}});
  edit.child(other, edit.node(5), edit.node(2), edit.node(3), edit.node(3));
  const std::string text = saved();
  EXPECT_NE(text.find("      11       7       1       2       4       4\n" + layers + "      13       7       2       5       4       4\n" +
                      "             2.5\n"
                      "         1       0.5     -80.0                   1       0.5     -70.0\n"
                      "         1       0.5     -75.0\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("      14       7       5       2       3       3\n             0.0             0.0             0.0             0.0  "
                      "             4\n"),
            std::string::npos)
      << text;
  ASSERT_EQ(report_.notes.size(), 1u);
  EXPECT_NE(report_.notes[0].find("angles of 1 shell"), std::string::npos) << report_.notes[0];
}

TEST_F(Editing, refuses_what_is_new_and_cant_be_written) {
  const auto because = [&](const std::function<void(Growing&)>& change) {
    Growing& edit = open(kNodes + kThreeShells + kEnd);
    change(edit);
    return refused().message;
  };
  const auto contains = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  EXPECT_TRUE(
      contains(because([](Growing& edit) { add_node(edit.model, 7, Vec3(0, std::nan(""), 0), edge_origin(edit.node(1), edit.node(2))); }),
               "a place that is no number"));
  EXPECT_TRUE(
      contains(because([](Growing& edit) { add_node(edit.model, 100000000, Vec3(0, 0, 0), edge_origin(edit.node(1), edit.node(2))); }),
               "doesn't fit the fields"));
  EXPECT_TRUE(contains(because([](Growing& edit) {
                         add_shell(edit.model, 100000000, {{edit.node(1), edit.node(2), edit.node(5), edit.node(5)}}, edit.shell(11));
                       }),
                       "doesn't fit the fields"));
}

TEST_F(Editing, takes_no_id_into_a_set_that_is_too_long_for_it_nor_into_a_set_of_sets) {
  Growing& edit =
      open(kNodes + kThreeShells + "*SET_NODE_LIST\n         1\n         1         2\n*SET_NODE_ADD\n         2\n         1\n" + kEnd);
  const auto writer = card_writer(Format::ls_dyna);
  const std::string_view text = edit.deck.files[0].bytes.text();
  const auto joined = [&](const char* keyword, std::int64_t id) {
    for (const Referrer& set : edit.deck.references->referrers())
      if (set.keyword == keyword) {
        const auto changed = writer->join(text, set, std::vector<std::int64_t>{id});
        return changed ? std::string() : changed.error().message;
      }
    return std::string("no such set");
  };
  EXPECT_EQ(joined("SET_NODE_LIST", 1234567890), "");
  EXPECT_NE(joined("SET_NODE_LIST", 12345678901), "");
  EXPECT_EQ(joined("SET_NODE_ADD", 3), "is made of other sets");
}

TEST_F(Editing, refuses_what_shells_cant_pass_on) {
  struct Case {
    std::string shells, why;
    long line;
  };
  const Case cases[] = {
      {"*ELEMENT_SHELL_THICKNESS\n11,7,1,2,5,4\n1.0,2.0,,1.0\n", "at some of its corners only", 9},
      {"*ELEMENT_SHELL_DOF\n11,7,1,2,5,4\n1,2,3,4\n", "_DOF", 9},
      {"*ELEMENT_SHELL\n11,7,1,2,5,4,3,6,3,6\n", "mid-side", 9},
      {"*ELEMENT_SHELL\n11,7,1,2,5,4,-3\n", "has mid-side nodes", 9},  // though none that the model has
      {"*ELEMENT_SHELL_THICKNESS\n11,7,1,2,5,4\n", "has no thickness card", 9},
      {"*PARAMETER\nRt,2.0\n*ELEMENT_SHELL_THICKNESS\n11,7,1,2,5,4\n1.0,&t,1.0,1.0\n", "parameter &t", 11},
      {"*PARAMETER\nIn,2\n*ELEMENT_SHELL\n11,7,1,&n,5,4\n", "parameter &n", 11},
  };
  for (const Case& c : cases) {
    Growing& edit = open(kNodes + c.shells + kEnd);
    edit.split_in_four(edit.shell(11));
    const Error error = refused();
    EXPECT_NE(error.message.find(c.why), std::string::npos) << error.text();
    EXPECT_EQ(error.line, c.line) << error.text();
  }
}

TEST_F(Editing, a_parameter_for_what_stays_the_same_is_kept) {
  Growing& edit = open("*PARAMETER\nIpart,7\nRt,2.0\n" + kNodes + "*ELEMENT_SHELL_THICKNESS\n11,&part,1,2,5,4\n&t,&t,&t,&t\n" + kEnd);
  edit.split_in_four(edit.shell(11));
  EXPECT_NE(saved().find("11,&part,1,7,11,10\n&t,&t,&t,&t\n12,&part,7,2,8,11\n&t,&t,&t,&t\n"), std::string::npos);
}

TEST_F(Editing, a_triangle_written_short_stays_short) {
  Growing& edit =
      open(kNodes + "*ELEMENT_SHELL\n      11       7       1       2       4\n      12       7       2       5       4       0\n" + kEnd);
  const NodeIndex middle = edit.middle(edit.node(2), edit.node(4));
  edit.split_at_edge(edit.shell(11), 1, middle);
  edit.split_at_edge(edit.shell(12), 2, middle);
  EXPECT_NE(saved().find("      11       7       2       7       1\n      13       7       7       4       1\n"
                         "      12       7       4       7       5       0\n      14       7       7       2       5       0\n"),
            std::string::npos);
}

}  // namespace
}  // namespace prismesh::mesh::deck
