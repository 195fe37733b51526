// Each column layout of node and element cards, and mixtures of them, against positions written down here.
#include "mesh/deck/lsdyna/mesh_cards.h"
#include "mesh/deck/open.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

const char kShells[] =
    "*ELEMENT_SHELL\n"
    "      10       1       1       2       3       4\n";

void expect_square(const Result<OpenedDeck>& opened) {
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  ASSERT_EQ(model.node_count(), 4u);
  EXPECT_EQ(position_of(model, 1), Vec3(0, 0, 0));
  EXPECT_EQ(position_of(model, 2), Vec3(10, 0, 0.5));
  EXPECT_EQ(position_of(model, 3), Vec3(10, 1e-3, -2.5));
  EXPECT_EQ(position_of(model, 4), Vec3(-100, 20, 3));
  ASSERT_EQ(model.shell_count(), 1u);
  EXPECT_EQ(corners_of(model, 10), (std::array<std::int64_t, 4>{1, 2, 3, 4}));
  EXPECT_EQ((*model.parts)[model.shell_parts[0].value].id, 1);
  // The decks are short of a part, and of nothing else.
  for (const Warning& w : opened->deck->warnings) EXPECT_EQ(w.kind, "undefined-part") << w.message;
}

TEST(Columns, standard) {
  const DeckFolder folder;
  expect_square(folder.open(std::string("*KEYWORD\n*NODE\n"
                                        "$#   nid               x               y               z      tc      rc\n"
                                        "       1             0.0             0.0             0.0       0       0\n"
                                        "       2            10.0                             0.5\n"
                                        "       3       1.0000E+1           1.0-3           -2.50       7       7\n"
                                        "       4         -1.D+02             +20              3.\n") +
                            kShells + "*END\n"));
}

TEST(Columns, filled_to_the_last_column) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "*NODE\n"
      "12345678-2.416931689E-01-3.286990896E-02 5.876007080E-01       0       0\n"
      "12345679-2.475307435E-01-1.784761623E-02-5.820254087E-01       0       0\n"
      "12345680-2.498186529E-01-1.089885016E-03 5.798402429E-01       0       0\n"
      "*ELEMENT_SHELL\n"
      "1000000110000001123456781234567912345680\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(position_of(opened->model, 12345679), Vec3(-2.475307435E-01, -1.784761623E-02, -5.820254087E-01));
  EXPECT_EQ(corners_of(opened->model, 10000001), (std::array<std::int64_t, 4>{12345678, 12345679, 12345680, 12345680}));
  EXPECT_EQ((*opened->model.parts)[0].id, 10000001);
}

TEST(Columns, wide_by_keyword) {
  const DeckFolder folder;
  expect_square(folder.open(
      "*KEYWORD LONG=Y\n*NODE\n"
      "                   1                 0.0                 0.0                 0.0                   0\n"
      "                   2                10.0                                     0.5\n"
      "                   3                10.0               1.0-3                -2.5\n"
      "                   4              -100.0                20.0                 3.0\n"
      "*ELEMENT_SHELL\n"
      "                  10                   1                   1                   2                   3                   4\n*END\n"));
}

TEST(Columns, wide_and_i10_and_standard_by_suffix) {
  const DeckFolder folder;
  expect_square(
      folder.open("*KEYWORD LONG=S\n*NODE+\n"
                  "                   1                 0.0                 0.0                 0.0\n"
                  "*NODE %\n"
                  "         2            10.0             0.0             0.5         0         0\n"
                  "*NODE\n"
                  "       3            10.0           0.001            -2.5\n"
                  "*node +\n"
                  "                   4              -100.0                20.0                 3.0\n"
                  "*ELEMENT_SHELL%\n"
                  "        10         1         1         2         3         4\n*END\n"));
}

TEST(Columns, i10_by_keyword_and_standard_by_suffix) {
  const DeckFolder folder;
  expect_square(
      folder.open("*keyword  i10 = y\n*NODE\n"
                  "         1             0.0             0.0             0.0         0         0\n"
                  "         2            10.0             0.0             0.5         0         0\n"
                  "*NODE-\n"
                  "       3            10.0           0.001            -2.5\n"
                  "       4          -100.0              20               3\n"
                  "*ELEMENT_SHELL -\n"
                  "      10       1       1       2       3       4\n*END\n"));
}

/// Fields of twenty columns that lean right.
std::string twenty(std::initializer_list<std::string> texts) {
  std::string line;
  for (const std::string& text : texts) line += std::string(20 - text.size(), ' ') + text;
  return line + "\n";
}

TEST(Columns, of_an_include_are_those_of_the_deck_unless_it_says_otherwise) {
  const std::string wide = twenty({"2", "10.0", "0.0", "0.5"}), i10 = "         2            10.0             0.0             0.5\n";
  const std::string standard = "       2 1.000000000E+01             0.0             0.5\n";
  const std::tuple<const char*, const char*, std::string> cases[] = {
      {"*KEYWORD LONG=Y\n", "", wide},
      {"*KEYWORD LONG=K\n", "", wide},
      {"*KEYWORD_ID LONG=Y\n", "", wide},
      {"*KEYWORD LONG=Y\n", "*KEYWORD\n", wide},
      {"*KEYWORD LONG=Y\n", "*KEYWORD LONG=S\n", standard},
      {"*KEYWORD LONG=Y\n", "*KEYWORD LONG=N\n", standard},
      {"*KEYWORD LONG=Y\n", "*KEYWORD I10=Y\n", i10},
      {"*KEYWORD I10=Y\n", "", i10},
      {"*KEYWORD I10=Y\n", "*KEYWORD I10=N\n", standard},
      {"*KEYWORD I10=Y\n", "*KEYWORD MEMORY=20M\n", i10},
      {"*KEYWORD\n", "*KEYWORD LONG=Y\n", wide},
  };
  for (const auto& [main, own, card] : cases) {
    const DeckFolder folder;
    folder.write("inc.k", std::string(own) + "*NODE\n" + card + "*END\n");
    const auto opened = folder.open(std::string(main) + "*INCLUDE\ninc.k\n*NODE-\n       3             1.0\n*END\n");
    ASSERT_OPENED(opened);
    EXPECT_EQ(position_of(opened->model, 2), Vec3(10, 0, 0.5)) << main << own;
    EXPECT_EQ(position_of(opened->model, 3), Vec3(1, 0, 0)) << main << own;
  }
}

TEST(Columns, of_a_wide_deck_hold_for_every_keyword) {
  const DeckFolder folder;
  folder.write("inc.k", "*NODE\n" + twenty({"1", "1.0", "2.0", "3.0"}) + "*SET_NODE_LIST\n" + twenty({"7"}) + twenty({"1", "9"}));
  const auto opened = folder.open(
      "*KEYWORD LONG=Y\n*PARAMETER\n" + twenty({"Rthick", "1.5", "Iconst", "30"}) + "*PARAMETER_EXPRESSION\nRtwice_as_much      2*thick\n" +
      "*PART\npart\n" + twenty({"3", "20", "&const"}) + "*SECTION_SHELL\n" + twenty({"20", "2"}) +
      twenty({"&twice_as_much", "&twice_as_much", "&twice_as_much", "&twice_as_much"}) + "*MAT_ELASTIC\n" +
      twenty({"30", "7.85E-9", "210000.0", "0.3"}) + "*CONTROL_TIMESTEP\n" + twenty({"0.0", "0.67", "1"}) + "*DEFINE_TRANSFORMATION\n" +
      twenty({"5"}) + twenty({"TRANSL", "10.0", "20.0", "30.0"}) + "*INCLUDE_TRANSFORM\ninc.k\n" +
      twenty({"100", "0", "0", "0", "1000", "0", "0"}) + twenty({"0"}) + twenty({"1.0", "1.0", "2.0"}) + twenty({"5"}) +
      "*CONTACT_TIED_NODES_TO_SURFACE_ID\n                   8all of it\n" + twenty({"3", "4", "4", "0"}) + "*END\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(warning(*opened->deck, "bad-parameter").count + warning(*opened->deck, "bad-include-transform").count, 0u);
  const Part& part = (*opened->model.parts)[opened->model.find_part(3).value];
  EXPECT_EQ(part.thickness, 3.0);
  EXPECT_EQ(part.density, 7.85e-9);
  EXPECT_EQ(opened->deck->time_step.scale, 0.67);
  EXPECT_EQ(position_of(opened->model, 101), Vec3(12, 24, 36));
  const References& references = *opened->deck->references;
  ASSERT_EQ(references.naming(Referred::node, 109).size(), 1u);
  EXPECT_EQ(references.referrers()[references.naming(Referred::node, 109)[0].referrer].id, 1007);
  const auto contact = references.naming(Referred::node_set, 3);
  ASSERT_EQ(contact.size(), 1u);
  EXPECT_EQ(references.referrers()[contact[0].referrer].id, 8);
  EXPECT_EQ(references.referrers()[contact[0].referrer].title, "all of it");
}

TEST(Columns, i10_holds_ten_digits) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "*KEYWORD I10=Y\n*NODE\n"
      "9876543210             1.0             2.0             3.0\n*END\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(position_of(opened->model, 9876543210), Vec3(1, 2, 3));
}

TEST(Columns, commas_mixed_with_fixed_and_tabs_and_crlf) {
  const DeckFolder folder;
  expect_square(
      folder.open("*KEYWORD\r\n*Node\r\n"
                  "1,0.000000000E+00,0.000000000E+00,0.000000000E+00,0,0\r\n"
                  "$ a comment, with a comma\r\n"
                  "       2            10.0             0.0             0.5       0       0\r\n"
                  " 3 , 10. ,\t1.0-3 , -2.5\r\n"
                  "       4\t  -100.0\t    20.0\t     3.0\r\n"
                  "*ELEMENT_SHELL\r\n"
                  "10,1,1,2,3,4\r\n"
                  "*END\r\n"));
}

TEST(Columns, comma_card_with_few_fields_and_empty_ones) {
  const DeckFolder folder;
  const auto opened = folder.open("*NODE\n7,1.5\n8,,2.5\n9,,,3.5,0,0\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(position_of(opened->model, 7), Vec3(1.5, 0, 0));
  EXPECT_EQ(position_of(opened->model, 8), Vec3(0, 2.5, 0));
  EXPECT_EQ(position_of(opened->model, 9), Vec3(0, 0, 3.5));
}

TEST(Columns, blank_lines_and_a_missing_last_line_end_dont_matter) {
  const DeckFolder folder;
  const auto opened = folder.open("*NODE\n\n       1     1.0\n   \n\t\n       2             2.0\n\n*NODE\n       3             3.0");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.node_count(), 3u);
  EXPECT_EQ(position_of(opened->model, 3), Vec3(3, 0, 0));
}

TEST(Columns, a_fragment_needs_neither_keyword_nor_end) {
  const DeckFolder folder;
  const auto opened = folder.open("*NODE\n       1             1.0\n");
  ASSERT_OPENED(opened);
  EXPECT_TRUE(opened->deck->warnings.empty());
}

TEST(Columns, a_byte_order_mark_before_the_first_keyword_is_no_hindrance) {
  const DeckFolder folder;
  const auto opened = folder.open("\xef\xbb\xbf*KEYWORD LONG=Y\n*NODE\n                   1                 4.0\n*END\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(position_of(opened->model, 1), Vec3(4, 0, 0));
}

TEST(Columns, what_follows_end_is_not_read) {
  const DeckFolder folder;
  const auto opened = folder.open("*KEYWORD\n*NODE\n       1             1.0\n*END\n*NODE\n       2 rubbish\n*NODE\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.node_count(), 1u);
}

/// Blocks longer than a piece are read by several threads: the order must be the deck's all the same.
TEST(Columns, long_blocks_keep_their_order) {
  const DeckFolder folder;
  std::string text = "*KEYWORD\n*NODE\n";
  const int count = 100000;
  char line[128];
  for (int i = 1; i <= count; ++i) {
    if (i % 1000 == 0) text += "$ a comment\n";
    if (i == 60000) text += "*NODE %\n";
    std::snprintf(line, sizeof line, i < 60000 ? "%8d%16.3f%16.3f%16.3f\n" : "%10d%16.3f%16.3f%16.3f\n", i, i * 0.5, -i * 0.25, 7.0);
    text += i % 777 ? line : std::to_string(i) + "," + std::to_string(i * 0.5) + "," + std::to_string(-i * 0.25) + ",7\n";
  }
  text += "*ELEMENT_SHELL\n";
  for (int i = 1; i + 3 <= count; ++i) {
    std::snprintf(line, sizeof line, "%8d%8d%8d%8d%8d%8d\n", i, 1 + i % 3, i, i + 1, i + 2, i + 3);
    text += line;
  }
  text += "*END\n";
  const auto opened = folder.open(text);
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  ASSERT_EQ(model.node_count(), static_cast<std::size_t>(count));
  for (int i = 1; i <= count; ++i) {
    const auto n = static_cast<std::size_t>(i - 1);
    ASSERT_EQ(model.node_ids[n], i);
    ASSERT_EQ(model.positions[n], Vec3(i * 0.5, -i * 0.25, 7.0));
    // The card of every node can be found again.
    const Deck& deck = *opened->deck;
    const std::string_view card = deck.files[0].bytes.text().substr(deck.node_line[n], 40);
    ASSERT_EQ(std::atoi(std::string(card.substr(0, i < 60000 ? 8 : 10)).c_str()), i) << card;
    const lsdyna::Columns columns = lsdyna::columns_of(deck.run_of(NodeIndex(n)).style);
    ASSERT_EQ(columns, i < 60000 ? lsdyna::Columns::standard : lsdyna::Columns::i10);
  }
  ASSERT_EQ(model.shell_count(), static_cast<std::size_t>(count - 3));
  for (int i = 1; i + 3 <= count; ++i) {
    ASSERT_EQ(corners_of(model, i), (std::array<std::int64_t, 4>{i, i + 1, i + 2, i + 3}));
    ASSERT_EQ((*model.parts)[model.shell_parts[static_cast<std::size_t>(i - 1)].value].id, 1 + i % 3);
  }
}

}  // namespace
}  // namespace prismesh::mesh::deck
