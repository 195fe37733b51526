// Cards of Nastran decks that can't be read: what the mesh needs is refused with its line, everything else is kept and said.
#include "mesh/deck/open.h"
#include "mesh/deck/save.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

const std::string kTriangle = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nCTRIA3,1,7,1,2,3\n";

/// Opens the triangle with these cards behind it, saves it untouched, and returns what is said of cards that can't be read.
Warning bad_card(const std::string& cards) {
  const DeckFolder folder;
  const std::string text = kTriangle + cards;
  const auto opened = folder.open(text);
  EXPECT_TRUE(opened) << cards << opened.error().text();
  if (!opened) return {};
  EXPECT_EQ(opened->model.shell_count(), 1u);
  const auto saved = save(*opened->deck, opened->model, opened->model, folder / "out" / "deck.k");
  EXPECT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(content(folder / "out" / "deck.k"), text);
  return warning(*opened->deck, "bad-card");
}

void expect_refused(const std::string& cards, long line, const std::string& words) {
  const DeckFolder folder;
  const auto opened = folder.open(kTriangle + cards);
  ASSERT_FALSE(opened) << cards;
  EXPECT_EQ(opened.error().line, line) << cards;
  EXPECT_NE(opened.error().message.find(words), std::string::npos) << opened.error().message;
}

TEST(NastranUnreadCards, that_no_mesh_needs_are_kept_and_said) {
  struct Case {
    std::string cards, words;
    long line;
  };
  const Case cases[] = {
      {"PSHELL,7,1,abc\n", "expected the thickness of PSHELL 7 but found \"abc\"", 5},
      {"PSHELL,7,x,1.\n", "expected the material of PSHELL 7 but found \"x\"", 5},
      {"PSHELL,y,1,1.\n", "expected the id of PSHELL y but found \"y\"", 5},
      {"PCOMP,7\n,1,.5,0.,,1,z\n", "expected the thickness of a ply of PCOMP 7 but found \"z\"", 5},
      {"MAT1,1,2.1+5,,0.3,7.x-9\n", "expected the density of MAT1 1 but found \"7.x-9\"", 5},
      {"MAT1,1,e,,0.3\n", "expected the modulus of MAT1 1 but found \"e\"", 5},
      {"GRID,9,,1.,abc\n", "expected coordinate 2 of GRID 9 but found \"abc\"", 5},
      {"GRID,9,-3\n", "expected the coordinate system of GRID 9 but found \"-3\"", 5},
      {"GRID,x,,1.\n", "a GRID needs an id above 0, but this one has \"x\"", 5},
      {"CONM2,a,1,,2.5\n", "expected the id of a CONM2 but found \"a\"", 5},
      {"RBE2          20       1     123       2                                +A\n+B             3\n",
       "the continuation of this RBE2 has another name", 6},
  };
  for (const Case& c : cases) {
    const Warning said = bad_card(c.cards);
    EXPECT_EQ(said.line, c.line) << c.cards;
    EXPECT_EQ(said.count, 1u) << c.cards;
    EXPECT_NE(said.message.find(c.words), std::string::npos) << said.message;
    EXPECT_NE(said.message.find("kept as it is"), std::string::npos) << said.message;
  }
}

TEST(NastranUnreadCards, are_told_by_their_number_and_first_lines) {
  const Warning said = bad_card("PSHELL,8,1,abc\nPSHELL,9,1,abc\nPSHELL,10,1,abc\nGRID,9,,x\n");
  EXPECT_EQ(said.count, 4u);
  EXPECT_EQ(said.line, 5);
  EXPECT_NE(said.message.find("also at line 6, line 7 and 1 more"), std::string::npos) << said.message;
}

TEST(NastranUnreadCards, that_the_mesh_needs_are_refused_with_their_lines) {
  expect_refused("GRID,4,,1.,abc\nCTRIA3,2,7,1,2,4\n", 5, "expected coordinate 2 of GRID 4 but found \"abc\"");
  expect_refused("CTRIA3,2,7,1,2,4\nGRID,4,-2\n", 6, "coordinate system of GRID 4");
  expect_refused("CTRIA3,2,7,1,2,4\nGRID,y,,1.,1.,1.\n", 6, "a GRID needs an id above 0");
  expect_refused("CTRIA3,2,7,1,2,4\nGRID*                  4                              1.              1.+A\n+B                    2.\n",
                 7, "the continuation of this GRID has another name");
  expect_refused("CBAR,2,7,1,4\nGRID,4,,x\n", 6, "coordinate 1 of GRID 4");
  expect_refused("CQUAD4,a,7,1,2,3,1\n", 5, "expected the id of a CQUAD4");
  expect_refused("CHEXA          5       2       1       1       1       1       1       1+A\n+B             1       1\n", 6,
                 "the continuation of this CHEXA");
}

TEST(NastranUnreadCards, keep_their_ids_and_thicknesses_arent_guessed) {
  const DeckFolder folder;
  const auto opened = folder.open(kTriangle + "PCOMP,7\n,1,.5,0.,,1,z\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ((*opened->model.parts)[0].thickness, std::nullopt) << "half a laminate is no laminate";
  // A second GRID of that id can be read, so the mesh needs no other.
  const auto defined = folder.open(kTriangle + "GRID,3,,x\n");
  ASSERT_OPENED(defined);
  EXPECT_EQ(position_of(defined->model, 3), Vec3(1, 1, 0));
}

TEST(NastranUnreadCards, too_many_of_them_are_no_deck) {
  std::string grids;
  for (int i = 0; i < 1001; ++i) grids += "GRID,x\n";
  expect_refused(grids, 1005, "a GRID needs an id above 0");
}

}  // namespace
}  // namespace prismesh::mesh::deck
