// What edits carry along in the cards that name nodes and shells, and which ids they give: each rule of docs/formats/editing.md.
#include "mesh/deck/open.h"
#include "mesh/deck/save.h"
#include "tests/mesh/deck/growing.h"

namespace prismesh::mesh::deck {
namespace {

/// Two quads, 11 (1 2 5 4) and 12 (2 3 6 5).
const std::string kMesh =
    "*NODE\n1,0.,0.,0.\n2,1.,0.,0.\n3,2.,0.,0.\n4,0.,1.,0.\n5,1.,1.,0.\n6,2.,1.,0.\n"
    "*ELEMENT_SHELL\n11,7,1,2,5,4\n12,7,2,3,6,5\n";

class Carrying : public ::testing::Test {
 protected:
  Growing& open(const std::string& cards, const std::string& mesh = kMesh) {
    auto opened = folder_.open(mesh + cards + "*END\n");
    if (!opened) throw std::runtime_error(opened.error().text());
    opened_ = std::move(*opened);
    edit_.emplace(opened_);
    return *edit_;
  }
  /// What stands behind the mesh after saving.
  std::string cards() {
    const auto report = save(*opened_.deck, opened_.model, edit_->model, folder_ / "out/deck.k");
    EXPECT_TRUE(report) << report.error().text();
    if (!report) return {};
    const auto again = deck::open(folder_ / "out/deck.k");
    EXPECT_TRUE(again) << again.error().text();
    if (again) expect_same(again->model, edit_->model);
    const std::string text = content(folder_ / "out/deck.k");
    const std::size_t begin = text.find('*', text.find("*ELEMENT_SHELL") + 1);
    return text.substr(begin, text.find("*END") - begin);
  }
  std::string refused() {
    const auto may = can_save(*opened_.deck, opened_.model, edit_->model);
    EXPECT_FALSE(may);
    EXPECT_FALSE(save(*opened_.deck, opened_.model, edit_->model, folder_ / "out/deck.k"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
    return may ? "" : may.error().text();
  }

  DeckFolder folder_;
  OpenedDeck opened_;
  std::optional<Growing> edit_;
};

struct SetCase {
  const char* what;
  std::string before, after;
};

/// 7 lies between 1 and 2, 8 between 2 and 5, 9 between 5 and 4, 10 between 4 and 1, 11 in the middle; shells 13, 14 and 15 come from 11.
TEST_F(Carrying, what_all_come_from_is_in_the_new_ones_join) {
  const SetCase cases[] = {
      {"a new node joins where both ends are", "*SET_NODE_LIST\n1\n1,2,3\n", "*SET_NODE_LIST\n1\n1,2,3,7\n"},
      {"one end isn't enough", "*SET_NODE_LIST\n1\n1,3\n", "*SET_NODE_LIST\n1\n1,3\n"},
      {"all corners", "*SET_NODE_LIST_TITLE\nall\n1\n1,2,4,5\n", "*SET_NODE_LIST_TITLE\nall\n1\n1,2,4,5,7,8,9,10\n11,\n"},
      {"columns, zeros filled first",
       "*SET_NODE_LIST\n         1\n         1         2         3         0         0         0         0         0\n",
       "*SET_NODE_LIST\n         1\n         1         2         3         7         0         0         0         0\n"},
      {"a full line", "*SET_NODE_LIST\n         1\n         1         2         3       901       902       903       904       905\n",
       "*SET_NODE_LIST\n         1\n         1         2         3       901       902       903       904       905\n         7\n"},
      {"a column with attributes", "*SET_NODE_COLUMN\n1\n1,0.5\n2,0.5\n", "*SET_NODE_COLUMN\n1\n1,0.5\n2,0.5\n7,0.5\n"},
      {"general", "*SET_NODE_GENERAL\n1\nNODE,1,2\nPART,7\n", "*SET_NODE_GENERAL\n1\nNODE,1,2\nPART,7\nNODE,7\n"},
      {"pieces of a shell", "*SET_SHELL_LIST\n1\n12,11\n", "*SET_SHELL_LIST\n1\n12,11,13,14,15\n"},
      {"not those of others", "*SET_SHELL_LIST\n1\n12\n", "*SET_SHELL_LIST\n1\n12\n"},
      {"a range that has them anyway", "*SET_SHELL_LIST_GENERATE\n1\n10,40\n", "*SET_SHELL_LIST_GENERATE\n1\n10,40\n"},
      {"a range that ends", "*SET_SHELL_LIST_GENERATE\n1\n11,12\n", "*SET_SHELL_LIST_GENERATE\n1\n11,12,13,15\n"},
      {"ranges with steps", "*SET_SHELL_LIST_GENERATE_INCREMENT\n1\n11,12,1\n",
       "*SET_SHELL_LIST_GENERATE_INCREMENT\n1\n11,12,1\n13,15,1\n"},
      {"a history stays", "*DATABASE_HISTORY_SHELL\n11\n", "*DATABASE_HISTORY_SHELL\n11\n"},
      {"a pressure follows", "*LOAD_SHELL_ELEMENT\n11,3,2.5\n12,3,1.5\n",
       "*LOAD_SHELL_ELEMENT\n11,3,2.5\n13,3,2.5\n14,3,2.5\n15,3,2.5\n12,3,1.5\n"},
      {"an initial stress follows", "*INITIAL_STRESS_SHELL\n11,1,1\n0.0,1.0,2.0,3.0,4.0,5.0,6.0,0.5\n12,1,1\n0.0,0.,0.,0.,0.,0.,0.,0.\n",
       "*INITIAL_STRESS_SHELL\n11,1,1\n0.0,1.0,2.0,3.0,4.0,5.0,6.0,0.5\n13,1,1\n0.0,1.0,2.0,3.0,4.0,5.0,6.0,0.5\n"
       "14,1,1\n0.0,1.0,2.0,3.0,4.0,5.0,6.0,0.5\n15,1,1\n0.0,1.0,2.0,3.0,4.0,5.0,6.0,0.5\n12,1,1\n0.0,0.,0.,0.,0.,0.,0.,0.\n"},
      {"a constraint of both ends", "*BOUNDARY_SPC_NODE\n1,0,1,1,1\n2,0,1,1,1\n", "*BOUNDARY_SPC_NODE\n1,0,1,1,1\n7,0,1,1,1\n2,0,1,1,1\n"},
      {"a constraint of one end", "*BOUNDARY_SPC_NODE\n1,0,1,1,1\n", "*BOUNDARY_SPC_NODE\n1,0,1,1,1\n"},
      {"a force stays where it is", "*LOAD_NODE_POINT\n1,1,1,1.0\n2,1,1,1.0\n", "*LOAD_NODE_POINT\n1,1,1,1.0\n2,1,1,1.0\n"},
      {"segments", "*SET_SEGMENT\n1\n1,2,5,4,0.5\n", "*SET_SEGMENT\n1\n1,7,11,10,0.5\n7,2,8,11,0.5\n11,8,5,9,0.5\n10,11,9,4,0.5\n"},
      {"segments the other way", "*SET_SEGMENT\n1\n2,1,4,5\n", "*SET_SEGMENT\n1\n1,10,11,7\n7,11,8,2\n11,9,5,8\n10,4,9,11\n"},
      {"segments elsewhere", "*SET_SEGMENT\n1\n2,3,6,5\n", "*SET_SEGMENT\n1\n2,3,6,5\n"},
  };
  for (const SetCase& c : cases) {
    SCOPED_TRACE(c.what);
    Growing& edit = open(c.before);
    edit.split_in_four(edit.shell(11));
    EXPECT_EQ(cards(), c.after);
  }
}

TEST_F(Carrying, a_segments_triangle_may_leave_its_fourth_corner_blank) {
  const std::string mesh = "*NODE\n1,0.,0.,0.\n2,1.,0.,0.\n3,0.,1.,0.\n*ELEMENT_SHELL\n11,7,1,2,3,3\n";
  for (const char* const before : {"*SET_SEGMENT\n1\n1,2,3,3\n", "*SET_SEGMENT\n1\n1,2,3\n", "*SET_SEGMENT\n1\n1,2,3,0\n"}) {
    Growing& edit = open(before, mesh);
    const NodeIndex middle = edit.middle(edit.node(1), edit.node(2));
    edit.split_at_edge(edit.shell(11), 0, middle);
    EXPECT_EQ(cards(), "*SET_SEGMENT\n1\n1,4,3,3\n4,2,3,3\n") << before;
  }
}

TEST_F(Carrying, ranges_hold_the_new_ones_and_no_others) {
  Growing& edit = open("*SET_NODE_LIST_GENERATE\n1\n1,3,6,6\n");
  edit.middle(edit.node(1), edit.node(2));
  edit.middle(edit.node(2), edit.node(5));
  edit.middle(edit.node(3), edit.node(6));
  EXPECT_EQ(cards(), "*SET_NODE_LIST_GENERATE\n1\n1,3,6,6,7,7,9,9\n") << "8 comes from 5 too, which isn't in it";
}

TEST_F(Carrying, refuses_what_cant_be_passed_on) {
  const std::pair<std::string, std::string> cases[] = {
      {"*BOUNDARY_SPC_NODE\n1,0,1,1,1\n2,0,1,1,0\n", "in different ways"},
      {"*INITIAL_FOAM_REFERENCE_GEOMETRY\n1,0.,0.,0.\n2,1.,0.,0.\n", "can't be passed on"},
      {"*SET_NODE_COLUMN\n1\n1,0.5\n2,0.7\n", "different attributes"},
      {"*AIRBAG_REFERENCE_GEOMETRY\n1,0.,0.,0.\n2,1.,0.,0.\n", "can't be passed on"},
      {"*LOAD_THERMAL_VARIABLE_NODE\n1,20.,0.,1\n2,20.,0.,1\n", "can't be passed on"},
      {"*SET_NODE_GENERAL\n1\nPART,7\nDNODE,1,2\n", "can't be passed on"},
      {"*NOBODY_KNOWS_THIS\n         2         1\n", "isn't read in this version, and may say"},
      {"*SET_NODE_LIST\n1\n1,2\n-----BEGIN PGP MESSAGE-----\nabc\n-----END PGP MESSAGE-----\n", "is encrypted in part"},
  };
  for (const auto& [text, why] : cases) {
    Growing& edit = open(text);
    edit.middle(edit.node(1), edit.node(2));
    const std::string error = refused();
    EXPECT_NE(error.find(why), std::string::npos) << error;
    EXPECT_NE(error.find("deck.k:"), std::string::npos) << error;
  }
}

TEST_F(Carrying, refuses_to_divide_a_shell_of_which_more_is_said_than_can_be_passed_on) {
  const std::pair<std::string, std::string> cases[] = {
      {"*DEFINE_ELEMENT_DEATH_SHELL\n11,0.5\n", "*DEFINE_ELEMENT_DEATH_SHELL names it"},
      {"*INITIAL_STRESS_SHELL\n11,1,2\n0,0,0,0,0,0,0,0\n0,0,0,0,0,0,0,0\n", "without a point"},
      {"*NOBODY_KNOWS_THIS\n        11       1.5\n", "*NOBODY_KNOWS_THIS isn't read"},
      {"*PARAMETER\nI ID, 11\n*LOAD_SHELL_ELEMENT\n&ID,3,2.5\n", "names it by the parameter &ID"},
      {"*PARAMETER\nI ID, 11\n*NOBODY_KNOWS_THIS\n&ID,1.5\n", "*NOBODY_KNOWS_THIS isn't read"},
  };
  for (const auto& [text, why] : cases) {
    SCOPED_TRACE(text);
    Growing& edit = open(text);
    edit.split_in_four(edit.shell(11));
    const std::string error = refused();
    EXPECT_NE(error.find(why), std::string::npos) << error;
    EXPECT_NE(error.find("deck.k:"), std::string::npos) << error;
  }
  Growing& other = open("*NOBODY_KNOWS_THIS\n        12         1\n");
  other.split_in_four(other.shell(11));
  EXPECT_EQ(cards(), "*NOBODY_KNOWS_THIS\n        12         1\n") << "one end of an edge isn't enough, and 12 stays whole";
}

TEST_F(Carrying, what_goes_leaves_its_sets) {
  const SetCase cases[] = {
      {"shells", "*SET_SHELL_LIST\n1\n11,12,90\n", "*SET_SHELL_LIST\n1\n11,90\n"},
      {"a line of its own", "*SET_SHELL_LIST\n1\n11\n12\n90\n", "*SET_SHELL_LIST\n1\n11\n90\n"},
      {"nodes in columns", "*SET_NODE_LIST\n         1\n         1         3         6         2\n",
       "*SET_NODE_LIST\n         1\n         1         2\n"},
      {"segments", "*SET_SEGMENT\n1\n1,2,5,4\n2,3,6,5\n", "*SET_SEGMENT\n1\n1,2,5,4\n"},
      {"general, behind the word", "*SET_NODE_GENERAL\n1\nNODE,3,1,6,2\nPART,7\n", "*SET_NODE_GENERAL\n1\nNODE,1,2\nPART,7\n"},
  };
  for (const SetCase& c : cases) {
    SCOPED_TRACE(c.what);
    Growing& edit = open(c.before);
    remove_shell(edit.model, edit.shell(12));
    remove_node(edit.model, edit.node(3));
    remove_node(edit.model, edit.node(6));
    EXPECT_EQ(cards(), c.after);
  }
}

TEST_F(Carrying, refuses_to_remove_what_is_named_or_used) {
  const std::pair<std::string, std::string> cases[] = {
      {"*DATABASE_HISTORY_SHELL\n12\n", "*DATABASE_HISTORY_SHELL names it"},
      {"*CONSTRAINED_SPOTWELD\n3,99\n", "*CONSTRAINED_SPOTWELD names it"},
      {"*SET_SEGMENT\n1\n1,2,6,3\n", "a segment of *SET_SEGMENT 1 names it"},
      {"*ELEMENT_BEAM\n70,8,3,1,0\n", "beam 70 has it"},
      {"*ELEMENT_PLOTEL\n      70       1       3\n", "other 70 has it"},
      {"*NOBODY_KNOWS_THIS\n       12\n", "isn't read"},
      {"*SET_SHELL_LIST\n1\n12\n", "left empty"},
  };
  for (const auto& [text, why] : cases) {
    Growing& edit = open(text);
    remove_shell(edit.model, edit.shell(12));
    remove_node(edit.model, edit.node(3));
    const std::string error = refused();
    EXPECT_NE(error.find(why), std::string::npos) << error;
  }
  Growing& edit = open("");
  remove_node(edit.model, edit.node(5));
  EXPECT_NE(refused().find("shell 11 has it"), std::string::npos);
}

TEST_F(Carrying, ids_stay_out_of_ranges_of_others) {
  Growing& edit = open("*SET_SHELL_LIST_GENERATE\n1\n12,5000\n*SET_SHELL_LIST_GENERATE\n2\n5001,6000\n");
  EXPECT_EQ(edit.ids.shell(edit.shell(11)), 6001) << "11 is in neither range";
  EXPECT_EQ(edit.ids.shell(edit.shell(12)), 13) << "the range holds its parent too";
  EXPECT_EQ(edit.ids.shell(edit.shell(12)), 14);
  add_shell(edit.model, 100, edit.model.shell(edit.shell(11)), edit.shell(11));
  EXPECT_NE(refused().find("*SET_SHELL_LIST_GENERATE 1"), std::string::npos);
}

TEST_F(Carrying, ids_are_never_given_twice) {
  Growing& edit = open("*SET_NODE_LIST\n1\n7,8\n*NOBODY_KNOWS_THIS\n        9\n");
  const NodeIndex first = edit.middle(edit.node(1), edit.node(2));
  EXPECT_EQ(edit.model.node_ids[first.value], 10) << "7 and 8 are named though they aren't there, 9 may be";
  remove_node(edit.model, first);
  NewIds again(edit.deck, edit.model);
  EXPECT_EQ(again.node(edge_origin(edit.node(1), edit.node(2))), 11);
}

TEST_F(Carrying, ids_fit_the_fields) {
  const std::string mesh =
      "*NODE\n       1             0.0\n       2             1.0\n99999999             1.0             1.0\n"
      "*ELEMENT_SHELL\n99999998       7       1       299999999\n";
  Growing& edit = open("", mesh);
  EXPECT_EQ(edit.ids.node(edge_origin(edit.node(1), edit.node(2))), 3) << "from the lowest free one, since the file's own end";
  EXPECT_EQ(edit.ids.shell(edit.shell(99999998)), 99999999);
  EXPECT_EQ(edit.ids.shell(edit.shell(99999998)), 1);
  Growing& full = open("*SET_NODE_LIST_GENERATE\n1\n3,999999999999999999\n", mesh);
  const auto none = full.ids.node(edge_origin(full.node(1), full.node(2)));
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("no id is left"), std::string::npos) << none.error().text();
}

TEST_F(Carrying, a_set_in_an_include_is_changed_there) {
  folder_.write("sets.k", "*SET_NODE_LIST\r\n1\r\n1,2\r\n");
  Growing& edit = open("*INCLUDE\nsets.k\n");
  edit.middle(edit.node(1), edit.node(2));
  cards();
  EXPECT_EQ(content(folder_ / "out/sets.k"), "*SET_NODE_LIST\r\n1\r\n1,2,7\r\n");
}

TEST_F(Carrying, an_include_used_twice_stays_as_it_is) {
  folder_.write("mesh.k", kMesh);
  Growing& edit = open("", "*INCLUDE\nmesh.k\n*INCLUDE\nmesh.k\n");
  set_shell_nodes(edit.model, edit.shell(11), {{edit.node(1), edit.node(2), edit.node(5), edit.node(5)}});
  EXPECT_NE(refused().find("used twice"), std::string::npos);
}

}  // namespace
}  // namespace prismesh::mesh::deck
