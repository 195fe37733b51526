// What edits carry along in Abaqus decks: which sets a new node is in by where its card stands, what is refused, what leaves a list.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/deck/open.h"
#include "mesh/deck/save.h"
#include "mesh/model/adjacency.h"
#include "tests/mesh/deck/growing.h"

namespace prismesh::mesh::deck {
namespace {

using testing::HasSubstr;

/// Quads 1 (1 2 5 4) and 2 (2 3 6 5) and a triangle 3 (3 7 6) of one part; nodes 1, 2, 4 and 5 are in the set that their keyword names.
const std::string kMesh =
    "*HEADING\nsheet\n*NODE, SYSTEM=R, NSET=\"left, clamped\"\n1, 0., 0., 0.\n2, 1., 0., 0.\n4, 0., 1., 0.\n5, 1., 1., 0.\n"
    "** the others\n*NODE\n3, 2., 0., 0.\n6, 2., 1., 0.\n7, 3., 0., 0.\n"
    "*ELEMENT, TYPE=S4R, ELSET=QUADS\n1, 1, 2, 5, 4\n2, 2, 3, 6, 5\n*ELEMENT, TYPE=S3R, ELSET=TRIANGLES\n3, 3, 7, 6\n"
    "*ELSET, ELSET=PLATE\nQUADS, TRIANGLES\n*SHELL SECTION, ELSET=PLATE, MATERIAL=STEEL\n1.5,\n*MATERIAL, NAME=STEEL\n*ELASTIC\n210000., "
    "0.3\n";

class AbaqusGrowing : public ::testing::Test {
 protected:
  Growing& open(const std::string& more) {
    auto opened = deck::open(folder_.write("a.inp", kMesh + more));
    if (!opened) throw std::runtime_error(opened.error().text());
    opened_ = std::move(*opened);
    edit_.emplace(opened_);
    return *edit_;
  }
  std::string saved() {
    const auto report = save(*opened_.deck, opened_.model, edit_->model, folder_ / "out/a.inp");
    EXPECT_TRUE(report) << report.error().text();
    const auto again = deck::open(folder_ / "out/a.inp");
    EXPECT_TRUE(again) << again.error().text();
    if (!report || !again) return "";
    expect_same(again->model, edit_->model);
    return content(folder_ / "out/a.inp");
  }
  std::string refused() {
    const auto may = can_save(*opened_.deck, opened_.model, edit_->model);
    EXPECT_FALSE(may);
    return may ? "" : may.error().text();
  }

  DeckFolder folder_;
  OpenedDeck opened_;
  std::optional<Growing> edit_;
};

TEST_F(AbaqusGrowing, a_node_is_in_the_set_of_its_keyword_only_if_all_it_comes_from_are) {
  Growing& edit = open("");
  edit.middle(edit.node(1), edit.node(4));
  edit.middle(edit.node(3), edit.node(2));
  edit.middle(edit.node(6), edit.node(5));
  edit.middle(edit.node(3), edit.node(6));
  const std::string text = saved();
  EXPECT_THAT(text, HasSubstr("4, 0., 1., 0.\n8, 0.0, 0.5, 0.0\n5, 1., 1., 0.\n"));
  EXPECT_THAT(text,
              HasSubstr("*NODE\n3, 2., 0., 0.\n9, 1.5, 0.0, 0.0\n6, 2., 1., 0.\n10, 1.5, 1.0, 0.0\n11, 2.0, 0.5, 0.0\n7, 3., 0., 0.\n"));
  // Where the last of those it comes from is in the set, but not all.
  Growing& other = open("*NODE, NSET=tip\n20, 4., 0., 0.\n21, 4., 1., 0.\n*ELEMENT, TYPE=S4R, ELSET=QUADS\n4, 7, 20, 21, 6\n");
  other.middle(other.node(7), other.node(20));
  other.middle(other.node(6), other.node(21));
  other.middle(other.node(20), other.node(21));
  other.add({{other.node(4), other.node(21)}, {0.5, 0.5}});
  EXPECT_THAT(saved(), HasSubstr("20, 4., 0., 0.\n21, 4., 1., 0.\n24, 4.0, 0.5, 0.0\n*NODE\n22, 3.5, 0.0, 0.0\n23, 3.0, 1.0, 0.0\n"
                                 "25, 2.0, 1.0, 0.0\n*ELEMENT"))
      << "25 lies between two different sets";
}

TEST_F(AbaqusGrowing, a_quad_becomes_triangles_beside_those_that_the_part_has) {
  Growing& edit = open("");
  const auto n = edit.model.shell(edit.shell(1)).node;
  set_shell_nodes(edit.model, edit.shell(1), {{n[0], n[1], n[2], n[2]}});
  edit.child(edit.shell(1), n[0], n[2], n[3], n[3]);
  EXPECT_THAT(saved(),
              HasSubstr("2, 2, 3, 6, 5\n*ELEMENT, TYPE=S3R, ELSET=QUADS\n1, 1, 2, 5\n4, 1, 5, 4\n*ELEMENT, TYPE=S3R, ELSET=TRIANGLES"))
      << "they stay in the set that their quad's keyword names";
}

TEST_F(AbaqusGrowing, what_cards_say_of_one_alone_cant_be_divided) {
  const std::pair<std::string, std::string> of_nodes[] = {
      {"*BOUNDARY\n1, 1, 3\n2, 1, 3\n", "*BOUNDARY"},
      {"*INITIAL CONDITIONS, TYPE=TEMPERATURE\n1, 20.\n2, 20.\n", "*INITIAL CONDITIONS"},
      {"*NODAL THICKNESS\n1, 1.\n2, 1.\n", "*NODAL THICKNESS"},
      {"*CLOAD\n1, 3, 5.\n2, 3, 5.\n", "*CLOAD"},
      {"*CARD OF TOMORROW\n1, 2\n", "isn't read"},
  };
  for (const auto& [text, why] : of_nodes) {
    SCOPED_TRACE(text);
    Growing& edit = open(text);
    edit.middle(edit.node(1), edit.node(2));
    EXPECT_THAT(refused(), HasSubstr(why));
  }
  const std::pair<std::string, std::string> of_shells[] = {
      {"*DLOAD\n2, P, 5.\n", "*DLOAD"},
      {"*INITIAL CONDITIONS, TYPE=STRESS\n2, 1., 1., 1.\n", "*INITIAL CONDITIONS"},
      {"*SURFACE, NAME=top\n2, SPOS\n", "*SURFACE"},
      {"*CARD OF TOMORROW\n2, 1.5\n", "isn't read"},
  };
  for (const auto& [text, why] : of_shells) {
    SCOPED_TRACE(text);
    Growing& edit = open(text);
    const auto n = edit.model.shell(edit.shell(2)).node;
    set_shell_nodes(edit.model, edit.shell(2), {{n[0], n[1], n[2], n[2]}});
    edit.child(edit.shell(2), n[0], n[2], n[3], n[3]);
    EXPECT_THAT(refused(), HasSubstr(why));
  }
}

TEST_F(AbaqusGrowing, what_goes_leaves_its_sets) {
  Growing& edit = open("*NSET, NSET=a\n  1, 7,3,\n 7\n*NSET, NSET=b, GENERATE\n1, 7, 1\n*ELSET, ELSET=c\n3, QUADS\n");
  remove_shell(edit.model, edit.shell(3));
  remove_node(edit.model, edit.node(7));
  EXPECT_THAT(refused(), HasSubstr("twice"));
  Growing& once =
      open("*NSET, NSET=a\n  1, 7,3,\n 4\n*NSET, NSET=b, GENERATE\n1, 7, 1\n*ELSET, ELSET=c\n3, QUADS\n*NSET, NSET=d\n7\n5,6\n");
  remove_shell(once.model, once.shell(3));
  remove_node(once.model, once.node(7));
  EXPECT_THAT(saved(),
              HasSubstr("*NSET, NSET=a\n  1,3,\n 4\n*NSET, NSET=b, GENERATE\n1, 7, 1\n*ELSET, ELSET=c\nQUADS\n*NSET, NSET=d\n5,6\n"));
  Growing& last = open("*NSET, NSET=a\n7\n");
  remove_shell(last.model, last.shell(3));
  remove_node(last.model, last.node(7));
  EXPECT_THAT(refused(), HasSubstr("left empty"));
}

}  // namespace
}  // namespace prismesh::mesh::deck
