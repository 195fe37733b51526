// Quads that become triangles where their part has no triangle yet, in formats whose keywords say how many corners a card has.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/deck/open.h"
#include "mesh/deck/save.h"
#include "tests/mesh/deck/deck_files.h"
#include "tests/mesh/deck/growing.h"

namespace prismesh::mesh::deck {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Quads 1 and 2 of part 1 side by side, in /SHELL cards with an angle and a thickness; `more` stands behind them.
std::string radioss(const std::string& more) {
  return "#RADIOSS STARTER\n/BEGIN\ntwo quads\n      2022         0\n                  kg                  mm                  ms\n"
         "                  kg                  mm                  ms\n/NODE\n"
         "         1                 0.0                 0.0                 0.0\n         2                 1.0                 0.0       "
         "          0.0\n"
         "         3                 2.0                 0.0                 0.0\n         4                 0.0                 1.0       "
         "          0.0\n"
         "         5                 1.0                 1.0                 0.0\n         6                 2.0                 1.0       "
         "          0.0\n"
         "/SHELL/1\n# a comment\n"
         "         1         1         2         5         4                          30.0                 1.5\n"
         "# another\n"
         "         2         2         3         6         5\n" +
         more + "/PART/1\nplate\n         1         1         0\n/END\n";
}

std::string abaqus(const std::string& keyword) {
  return "*HEADING\ntwo quads\n*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 2., 0., 0.\n4, 0., 1., 0.\n5, 1., 1., 0.\n6, 2., 1., 0.\n" +
         keyword +
         "\n1, 1, 2, 5, 4\n2, 2, 3, 6, 5\n*SHELL SECTION, ELSET=PLATE, MATERIAL=STEEL\n1.5,\n*MATERIAL, NAME=STEEL\n*ELASTIC\n210000., "
         "0.3\n";
}

/// Both quads into triangles.
void split_both(Growing& edit) {
  for (const std::int64_t id : {1, 2}) {
    const auto n = edit.model.shell(edit.shell(id)).node;
    set_shell_nodes(edit.model, edit.shell(id), {{n[0], n[1], n[2], n[2]}});
    edit.child(edit.shell(id), n[0], n[2], n[3], n[3]);
  }
}

std::string saved(const DeckFolder& folder, const Growing& edit, const std::string& name) {
  const auto report = save(edit.deck, edit.original, edit.model, folder / name);
  EXPECT_TRUE(report) << report.error().text();
  const auto again = open(folder / name);
  EXPECT_TRUE(again) << again.error().text();
  if (!report || !again) return "";
  const ByIds here = by_ids(edit.model), there = by_ids(again->model);
  EXPECT_EQ(here.nodes, there.nodes);
  EXPECT_EQ(here.shells, there.shells);
  return content(folder / name);
}

TEST(OtherKind, radioss_gets_a_block_of_triangles_behind_that_of_its_quads) {
  const DeckFolder folder;
  const auto opened = open(folder.write("a_0000.rad", radioss("")));
  ASSERT_TRUE(opened) << opened.error().text();
  Growing edit(*opened);
  split_both(edit);
  const std::string text = saved(folder, edit, "b_0000.rad");
  EXPECT_THAT(text,
              HasSubstr("/SH3N/1\n         1         1         2         5                                    30.0                 1.5\n"));
  EXPECT_THAT(text, HasSubstr("         3         1         5         4                                    30.0                 1.5\n"));
  EXPECT_THAT(text, HasSubstr("# another\n/SH3N/1\n")) << "behind the comments of the block";
}

TEST(OtherKind, radioss_keeps_the_quads_that_follow_a_comment) {
  const DeckFolder folder;
  const auto opened = open(folder.write("a_0000.rad", radioss("")));
  ASSERT_TRUE(opened);
  Growing edit(*opened);
  const auto n = edit.model.shell(edit.shell(1)).node;
  set_shell_nodes(edit.model, edit.shell(1), {{n[0], n[1], n[2], n[2]}});
  edit.child(edit.shell(1), n[0], n[2], n[3], n[3]);
  const std::string text = saved(folder, edit, "b_0000.rad");
  EXPECT_LT(text.find("         2         2         3         6         5\n"), text.find("/SH3N/1"));
}

TEST(OtherKind, radioss_refuses_to_leave_a_group_of_quads_empty) {
  const DeckFolder folder;
  const auto opened = open(folder.write("a_0000.rad", radioss("/GRSHEL/SHEL/29\nquads\n         2\n")));
  ASSERT_TRUE(opened);
  Growing edit(*opened);
  split_both(edit);
  const auto possible = can_save(edit.deck, edit.original, edit.model);
  ASSERT_FALSE(possible);
  EXPECT_THAT(possible.error().text(), HasSubstr("GRSHEL/SHEL 29 would be left without any"));
}

TEST(OtherKind, radioss_refuses_where_text_that_isnt_read_may_name_the_shell) {
  const DeckFolder folder;
  const auto opened = open(folder.write("a_0000.rad", radioss("/INISHE/STRS_F\n         2         1.5\n")));
  ASSERT_TRUE(opened);
  {
    Growing edit(*opened);
    split_both(edit);
    const auto possible = can_save(edit.deck, edit.original, edit.model);
    ASSERT_FALSE(possible);
    EXPECT_THAT(possible.error().text(), HasSubstr("INISHE/STRS_F isn't read"));
  }
  Growing edit(*opened);
  const auto n = edit.model.shell(edit.shell(2)).node;
  set_shell_nodes(edit.model, edit.shell(2), {{n[0], n[1], n[2], n[2]}});
  const auto possible = can_save(edit.deck, edit.original, edit.model);
  ASSERT_FALSE(possible) << "it may be named as a quad";
  EXPECT_THAT(possible.error().text(), HasSubstr("INISHE/STRS_F isn't read"));
}

TEST(OtherKind, abaqus_gets_a_keyword_like_that_of_its_quads) {
  const DeckFolder folder;
  for (const char* keyword : {"*ELEMENT, TYPE=S4R, ELSET=PLATE", "*element, elset=PLATE, type=S4"}) {
    const auto opened = open(folder.write("a.inp", abaqus(keyword)));
    ASSERT_TRUE(opened) << opened.error().text();
    Growing edit(*opened);
    split_both(edit);
    const std::string text = saved(folder, edit, "b.inp");
    EXPECT_THAT(text, testing::AnyOf(HasSubstr("*ELEMENT, TYPE=S3R, ELSET=PLATE\n1, 1, 2, 5\n"),
                                     HasSubstr("*element, elset=PLATE, type=S3\n1, 1, 2, 5\n")));
  }
}

TEST(OtherKind, a_block_behind_an_unended_last_line_ends_its_lines_as_the_deck_does) {
  const DeckFolder folder;
  const std::string unix_text =
      "*HEADING\ntwo quads\n*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 2., 0., 0.\n4, 0., 1., 0.\n5, 1., 1., 0.\n6, 2., 1., 0.\n"
      "*ELEMENT, TYPE=S4R, ELSET=PLATE\n1, 1, 2, 5, 4\n2, 2, 3, 6, 5";
  std::string text;
  for (const char c : unix_text) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  const auto opened = open(folder.write("a.inp", text));
  ASSERT_TRUE(opened) << opened.error().text();
  Growing edit(*opened);
  split_both(edit);
  const std::string out = saved(folder, edit, "b.inp");
  EXPECT_THAT(out, HasSubstr("*ELEMENT, TYPE=S3R, ELSET=PLATE\r\n1, 1, 2, 5\r\n"));
  for (std::size_t at = out.find('\n'); at != std::string::npos; at = out.find('\n', at + 1)) EXPECT_EQ(out[at - 1], '\r') << "at " << at;
}

TEST(OtherKind, abaqus_refuses_a_type_that_has_no_triangle) {
  const DeckFolder folder;
  const auto opened = open(folder.write("a.inp", abaqus("*ELEMENT, TYPE=S4R5, ELSET=PLATE")));
  ASSERT_TRUE(opened);
  Growing edit(*opened);
  split_both(edit);
  EXPECT_FALSE(can_save(edit.deck, edit.original, edit.model));
}

}  // namespace
}  // namespace prismesh::mesh::deck
