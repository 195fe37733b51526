// Texts that are no decks, and decks that aren't the one to open: refused by name.
#include "mesh/deck/open.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

std::string refusal(const std::string& name, const std::string& text) {
  const DeckFolder folder;
  const auto opened = deck::open(folder.write(name, text));
  return opened ? "opens as " + std::string(deck::name(opened->deck->format)) : opened.error().message;
}

TEST(OtherTexts, prose_is_no_deck) {
  for (const char* text : {
           "The quick brown fox\njumps.\nInclude another one\nand so on\n",
           "Dear all,\nGrid lines are drawn in grey.\nInclude 3 copies.\nMaterial and load cases follow.\n",
           "Include what you use.\n\nSet the table: 1, 2 or 3.\n",
           "Begin with the roof.\nInclude the pillars, 2 of them.\n",
           "# Notes\n\n**Bold** words begin a line.\n\n* one item\n* another\n\n**Note.** More.\n",
           "*Emphasis* and **more**\n**of it**\n",
       })
    EXPECT_EQ(refusal("text.md", text).substr(0, 29), "is no deck: it looks like tex") << text << refusal("text.md", text);
}

TEST(OtherTexts, decks_with_few_cards_are_decks) {
  const DeckFolder folder;
  const auto opens = [&](const std::string& text) {
    const auto opened = folder.open(text);
    return opened ? std::string(deck::name(opened->deck->format)) : opened.error().message;
  };
  EXPECT_EQ(opens("INCLUDE 'bulk.bdf'\n"), "nastran") << "a main file of nothing but includes";
  EXPECT_EQ(opens("SOL 101\nCEND\nBEGIN BULK\nENDDATA\n"), "nastran");
  EXPECT_EQ(opens("MAT1,1,2.1+5,,0.3\n"), "nastran");
  EXPECT_EQ(opens("INCLUDE 'a'\nFORCE,1,2,,1.5\n"), "nastran") << "loads alone";
  EXPECT_EQ(opens("** a plate\n** by hand\n** of three\n*NODE\n1, 0., 0., 0.\n"), "abaqus") << "the comments tell it from LS-DYNA";
  EXPECT_EQ(opens("** a plate\n*BOUNDARY\n1, 1\n"), "abaqus");
}

TEST(OtherTexts, a_long_list_of_nodes_does_not_decide) {
  std::string nodes = "*NODE\n";
  for (int id = 1; id <= 20'000; ++id)
    nodes += std::to_string(id) + ", " + std::to_string(id % 100) + ".5, " + std::to_string(id / 100) + ".25, 0.\n";
  ASSERT_GT(nodes.size(), std::size_t{300'000});
  const DeckFolder folder;
  const auto opened = folder.open(nodes + "*ELEMENT, TYPE=S4, ELSET=sheet\n1, 1, 2, 102, 101\n");
  ASSERT_TRUE(opened) << opened.error().text();
  EXPECT_EQ(deck::name(opened->deck->format), "abaqus");
  EXPECT_EQ(opened->model.shell_count(), 1u);
  const auto other = folder.open(nodes + "*ELEMENT_SHELL\n1,1,1,2,102,101\n*END\n");
  ASSERT_TRUE(other) << other.error().text();
  EXPECT_EQ(deck::name(other->deck->format), "ls-dyna");
  EXPECT_EQ(other->model.shell_count(), 1u);
}

TEST(OtherTexts, input_of_the_radioss_engine_is_named) {
  for (const char* text : {"/VERS/2022\n/RUN/deck/1\n10.\n", "#RADIOSS ENGINE\n/RUN/deck/1\n10.\n/TFILE\n0.1\n",
                           "/ANIM/DT\n0 1\n/ANIM/ELEM/EPSP\n", "/STOP\n 0 0 0\n/PRINT/-100\n", "/H3D/DT\n0 1\n", "/RFILE\n1000\n"}) {
    const std::string said = refusal("deck_0001.rad", text);
    EXPECT_NE(said.find("is input of the Radioss engine"), std::string::npos) << text << said;
    EXPECT_NE(said.find("_0000.rad"), std::string::npos) << said;
  }
}

TEST(OtherTexts, two_bytes_of_a_packed_file_are_a_packed_file_cut_off) {
  EXPECT_EQ(refusal("deck.k.gz", "\x1f\x8b"), "is cut off: its gzip data end too early");
  EXPECT_EQ(refusal("deck.k.gz", "\x1f\x8b\x08"), "is cut off: its gzip data end too early");
}

}  // namespace
}  // namespace prismesh::mesh::deck
