// Element cards of every kind and option that is read.
#include "mesh/deck/lsdyna/keyword.h"
#include "mesh/deck/open.h"
#include "mesh/deck/save.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

/// Nodes 1 to 30 on the x axis.
std::string nodes() {
  std::string text = "*NODE\n";
  for (int i = 1; i <= 30; ++i) text += std::to_string(i) + "," + std::to_string(i) + ".,0.,0.\n";
  return text;
}

Result<OpenedDeck> open(const std::string& elements) {
  const DeckFolder folder;
  return folder.open(nodes() + elements);
}

std::vector<std::int64_t> nodes_of_element(const Model& model, ElementClass element_class, std::size_t element) {
  const ElementBlock& block = *model.elements[static_cast<std::size_t>(element_class)];
  std::vector<std::int64_t> ids;
  for (std::uint32_t n = block.first_node[element]; n < block.first_node[element + 1]; ++n)
    ids.push_back(model.node_ids[block.nodes[n].value]);
  return ids;
}

const ElementBlock& block_of(const Model& model, ElementClass element_class) {
  return *model.elements[static_cast<std::size_t>(element_class)];
}

using Ids = std::vector<std::int64_t>;

TEST(Shells, triangles_repeat_their_third_node_or_leave_the_fourth_blank) {
  const auto opened = open(
      "*ELEMENT_SHELL\n"
      "       1       5       1       2       3       4\n"
      "       2       5       1       2       3       3\n"
      "       3       5       1       2       3       0\n"
      "       4       5       1       2       3\n");
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  EXPECT_EQ(opened->deck->element_cards.quad, 1u);
  EXPECT_EQ(opened->deck->element_cards.tri, 3u);
  EXPECT_FALSE(model.shell_nodes[0].is_triangle());
  for (std::size_t s = 1; s < 4; ++s) EXPECT_TRUE(model.shell_nodes[s].is_triangle());
  EXPECT_EQ(corners_of(model, 3), (std::array<std::int64_t, 4>{1, 2, 3, 3}));
}

TEST(Shells, second_order_ones_keep_their_midside_nodes) {
  const auto opened = open(
      "*ELEMENT_SHELL\n"
      "       1       5       1       2       3       4       5       6       7       8\n"
      "       2       5       1       2       3       3       5       6       3       8\n"
      "       3       5       1       2       3       4\n"
      "       4       5       1       2       3       4       5       0       0       0\n");
  ASSERT_OPENED(opened);
  const ElementCounts& cards = opened->deck->element_cards;
  EXPECT_EQ(cards.quad8, 2u);
  EXPECT_EQ(cards.tri6, 1u);
  EXPECT_EQ(cards.quad, 1u);
  const std::vector<MidsideNodes>& midside = *opened->model.midside;
  ASSERT_EQ(midside.size(), 3u);
  EXPECT_EQ(midside[0].shell, ShellIndex(0));
  EXPECT_EQ(midside[0].node, (std::array{NodeIndex(4), NodeIndex(5), NodeIndex(6), NodeIndex(7)}));
  EXPECT_EQ(midside[1].node, (std::array{NodeIndex(4), NodeIndex(5), NodeIndex(), NodeIndex(7)}));
  EXPECT_EQ(midside[2].shell, ShellIndex(3));
  EXPECT_EQ(midside[2].node, (std::array{NodeIndex(4), NodeIndex(), NodeIndex(), NodeIndex()}));
}

TEST(Shells, thickness_cards_belong_to_their_shell) {
  const auto opened = open(
      "*ELEMENT_SHELL_THICKNESS\n"
      "       1       5       1       2       3       4\n"
      "$ between\n"
      "             1.0             2.0             3.0             2.0             0.0\n"
      "2,5,2,3,4,5\n"
      "0.000000E+00,0.,0.,0.\n"
      "*ELEMENT_SHELL\n"
      "       3       5       1       2       3       4\n"
      "*ELEMENT_SHELL_BETA\n"
      "       4       5       1       2       3       4\n"
      "             1.5             1.5             1.5             1.5            45.0\n");
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  ASSERT_EQ(model.shell_count(), 4u);
  EXPECT_EQ(model.shell_thickness[0], 2.0f);
  EXPECT_EQ(model.shell_thickness[1], 0.0f);
  EXPECT_EQ(model.shell_thickness[2], 0.0f);
  EXPECT_EQ(model.shell_thickness[3], 1.5f);
}

TEST(Shells, second_order_ones_have_a_second_thickness_card) {
  const auto opened = open(
      "*ELEMENT_SHELL_THICKNESS_OFFSET\n"
      "       1       5       1       2       3       4       5       6       7       8\n"
      "             2.0             2.0             2.0             2.0             0.0\n"
      "             9.0             9.0             9.0             9.0\n"
      "             0.5\n"
      "       2       5       1       2       3       4\n"
      "             3.0             3.0             3.0             3.0             0.0\n"
      "             0.5\n");
  ASSERT_OPENED(opened);
  ASSERT_EQ(opened->model.shell_count(), 2u);
  EXPECT_EQ(opened->model.shell_thickness[0], 2.0f);
  EXPECT_EQ(opened->model.shell_thickness[1], 3.0f);
}

TEST(Shells, wide_thickness_fields_are_twenty_columns) {
  const auto opened = open(
      "*ELEMENT_SHELL_THICKNESS+\n"
      "                   1                   5                   1                   2                   3                   4\n"
      "                 4.0                 4.0                 4.0                 4.0\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.shell_thickness[0], 4.0f);
}

TEST(Shells, composite_layers_add_up) {
  const auto opened = open(
      "*ELEMENT_SHELL_OFFSET_COMPOSITE\n"
      "     702       1       1       2       3       3\n"
      "          2.5000\n"
      "         7    0.5000   116.722                   7    0.5000    26.722          \n"
      "         7    0.2500   116.722                   \n"
      "     703       1       2       3       4       5\n"
      "          2.5000\n"
      "         7    1.0000\n"
      "*ELEMENT_SHELL_COMPOSITE_LONG\n"
      "     704       1       2       3       4       5\n"
      "         7    0.5000       0.0         1\n"
      "         8    0.7500      90.0         2\n");
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  ASSERT_EQ(model.shell_count(), 3u);
  EXPECT_EQ(model.shell_thickness[0], 1.25f);
  EXPECT_EQ(model.shell_thickness[1], 1.0f);
  EXPECT_EQ(model.shell_thickness[2], 1.25f);
  EXPECT_EQ(corners_of(model, 703), (std::array<std::int64_t, 4>{2, 3, 4, 5}));
}

TEST(Shells, an_option_that_is_not_known_is_left_alone_and_said) {
  const auto opened = open("*ELEMENT_SHELL_NURBS_PATCH\n       1       5       1       2       3       4\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.shell_count(), 0u);
  EXPECT_EQ(warning(*opened->deck, "unread-elements").count, 1u);
  EXPECT_EQ(warning(*opened->deck, "unread-elements").line, 32);
}

TEST(Beams, have_two_ends_and_any_options) {
  const auto opened = open(
      "*ELEMENT_BEAM\n"
      "       1       6       1       2       3       0       0       0       0       2\n"
      "*ELEMENT_BEAM_ORIENTATION_OFFSET\n"
      "       2       6       3       4\n"
      "       1.0       0.0       0.0\n"
      "       0.0       0.0       0.0\n"
      "       3       6       4       5      99\n"
      "       1.0       0.0       0.0\n"
      "       0.0       0.0       0.0\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->deck->element_cards.beam, 3u);
  EXPECT_EQ(block_of(opened->model, ElementClass::beam).id, (Ids{1, 2, 3}));
  EXPECT_EQ(nodes_of_element(opened->model, ElementClass::beam, 2), (Ids{4, 5}));
}

TEST(Solids, on_one_card_or_two) {
  const auto opened = open(
      "*ELEMENT_SOLID\n"
      "       1       4       1       2       3       4       5       6       7       8\n"
      "       2       4       1       2       3       4       5       5       6       6\n"
      "       3       4\n"
      "       1       2       3       4       4       4       4       4\n"
      "       4       4\n"
      "       1       2       3       4       5       6       7       8       9      10\n"
      "       5       4       1       2       3       4\n"
      "*ELEMENT_SOLID_ORTHO\n"
      "       6       4       1       2       3       4       5       6       7       8\n"
      "             1.0             0.0             0.0\n"
      "             0.0             1.0             0.0\n"
      "       7       4       1       2       3       4       5       6       7       8\n"
      "             1.0             0.0             0.0\n"
      "             0.0             1.0             0.0\n"
      "*ELEMENT_SOLID_H20\n"
      "       8       4\n"
      "       1       2       3       4       5       6       7       8       9      10\n"
      "      11      12      13      14      15      16      17      18      19      20\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->deck->element_cards.solid, 8u);
  const Model& model = opened->model;
  EXPECT_EQ(block_of(model, ElementClass::solid).id, (Ids{1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(nodes_of_element(model, ElementClass::solid, 0), (Ids{1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(nodes_of_element(model, ElementClass::solid, 1), (Ids{1, 2, 3, 4, 5, 5, 6, 6}));
  EXPECT_EQ(nodes_of_element(model, ElementClass::solid, 2), (Ids{1, 2, 3, 4, 4, 4, 4, 4}));
  EXPECT_EQ(nodes_of_element(model, ElementClass::solid, 3).size(), 10u);
  EXPECT_EQ(nodes_of_element(model, ElementClass::solid, 4), (Ids{1, 2, 3, 4, 4, 4, 4, 4}));
  EXPECT_EQ(nodes_of_element(model, ElementClass::solid, 7).size(), 20u);
}

TEST(OtherElements, are_what_they_are) {
  const auto opened = open(
      "*ELEMENT_TSHELL\n"
      "       1       4       1       2       3       4       5       6       7       8\n"
      "*ELEMENT_DISCRETE\n"
      "       1     101       1      29       1  0.00000000E+00       1\n"
      "       2     101       1       0       1\n"
      "*ELEMENT_MASS\n"
      "       7       5        0.000125       3\n"
      "*ELEMENT_MASS_PART\n"
      "       9             0.0             5.0       0\n"
      "*ELEMENT_SPH\n"
      "      12       8        0.000125\n"
      "*ELEMENT_SEATBELT\n"
      "       1      20       1       2       0             0.0\n");
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  EXPECT_EQ(opened->deck->element_cards.tshell, 1u);
  EXPECT_EQ(opened->deck->element_cards.other, 6u);
  EXPECT_EQ(nodes_of_element(model, ElementClass::tshell, 0).size(), 8u);
  EXPECT_EQ(nodes_of_element(model, ElementClass::discrete, 0), (Ids{1, 29}));
  EXPECT_EQ(nodes_of_element(model, ElementClass::discrete, 1), (Ids{1}));
  EXPECT_EQ(block_of(model, ElementClass::mass).id, (Ids{7, 9}));
  EXPECT_EQ(nodes_of_element(model, ElementClass::mass, 0), (Ids{5}));
  EXPECT_TRUE(nodes_of_element(model, ElementClass::mass, 1).empty());
  EXPECT_EQ(nodes_of_element(model, ElementClass::sph, 0), (Ids{12}));
  EXPECT_EQ(nodes_of_element(model, ElementClass::other, 0), (Ids{1, 2}));
  EXPECT_EQ(model.elements[static_cast<std::size_t>(ElementClass::shell)], nullptr);
}

TEST(Elements, of_kinds_that_are_not_read_are_told_by_name_and_number_of_lines) {
  for (const char* keyword : {"ELEMENT_SEATBELT_ACCELEROMETER",
                              "ELEMENT_SEATBELT_PRETENSIONER",
                              "ELEMENT_SEATBELT_RETRACTOR",
                              "ELEMENT_SEATBELT_SENSOR",
                              "ELEMENT_SEATBELT_SLIPRING",
                              "ELEMENT_INERTIA_OF_THE_FUTURE",

                              "ELEMENT_LANCING",
                              "ELEMENT_GENERALIZED_SHELL",
                              "ELEMENT_GENERALIZED_SOLID",
                              "ELEMENT_SHELL_NURBS_PATCH",
                              "ELEMENT_SOLID_NURBS_PATCH",
                              "ELEMENT_SHELL_SOURCE_SINK",
                              "ELEMENT_SOLID_PERI",
                              "ELEMENT_BEAM_SOURCE",
                              "ELEMENT_BEAM_PULLEY",
                              "ELEMENT_DIRECT_MATRIX_INPUT",
                              "ELEMENT_DISCRETE_SPHERE",
                              "ELEMENT_DISCRETE_SPHERE_VOLUME",
                              "ELEMENT_MASS_MATRIX_NODE_SET",
                              "ELEMENT_BLANKING",
                              "ELEMENT_TRIM",
                              "ELEMENT_BEARING",
                              "ELEMENT_INTERPOLATION_SHELL",
                              "ELEMENT_OF_THE_FUTURE",
                              "IGA_SHELL",
                              "MESH_SURFACE_ELEMENT"}) {
    const auto opened =
        open(std::string("*") + keyword + "\n       1       2       3       4\n$ between\n       5       6       7       8\n*" + keyword +
             "\n       9       2       3       4\n*ELEMENT_BEAM\n       1       6       1       2\n");
    ASSERT_OPENED(opened);
    const Warning unread = warning(*opened->deck, "unread-elements");
    EXPECT_EQ(unread.count, 1u) << keyword;
    EXPECT_EQ(unread.line, 32) << keyword;
    EXPECT_NE(unread.message.find(keyword), std::string::npos) << unread.message;
    EXPECT_NE(unread.message.find("(3 lines)"), std::string::npos) << unread.message;
    EXPECT_EQ(opened->deck->element_cards.beam, 1u);
  }
}

TEST(OtherElements, masses_may_belong_to_a_part) {
  const auto opened = open("*ELEMENT_MASS\n       7       5        0.000125       3\n       8       6        0.000125\n*PART\np\n3\n");
  ASSERT_OPENED(opened);
  const ElementBlock& masses = block_of(opened->model, ElementClass::mass);
  EXPECT_EQ(masses.part[0], opened->model.find_part(3));
  EXPECT_FALSE(masses.part[1].valid());
}

TEST(OtherElements, inertias_have_two_cards_or_three) {
  const auto opened = open(
      "*ELEMENT_INERTIA\n"
      "       7       5       0\n"
      "       1.0       0.0       0.0       1.0       0.0       1.0      14.8\n"
      "       8       6\n"
      "       1.0       0.0       0.0       1.0       0.0       1.0      14.8\n"
      "*ELEMENT_INERTIA_OFFSET\n"
      "       9       7       3\n"
      "       1.0       0.0       0.0       1.0       0.0       1.0      14.8\n"
      "       0.5       0.5       0.5\n"
      "      10       8\n"
      "       1.0       0.0       0.0       1.0       0.0       1.0      14.8\n"
      "       0.5       0.5       0.5\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(block_of(opened->model, ElementClass::mass).id, (Ids{7, 8, 9, 10}));
  EXPECT_EQ(nodes_of_element(opened->model, ElementClass::mass, 1), (Ids{6}));
  EXPECT_EQ(nodes_of_element(opened->model, ElementClass::mass, 3), (Ids{8}));
  EXPECT_EQ(opened->deck->element_cards.other, 4u);
}

TEST(Nodes, of_other_keywords_are_told) {
  const auto opened = open(
      "*NODE_SCALAR\n     101       2\n     102       2\n"
      "*NODE_SCALAR_VALUE\n     103             1.0\n"
      "*NODE_RIGID_SURFACE\n     104             1.0             2.0             3.0\n"
      "*NODE_MERGE_SET\n         5\n"
      "*NODE_MERGE_TOLERANCE\n     0.001\n"
      "*NODE_THICKNESS\n         5       1.5\n"
      "*NODE\n     105             1.0             2.0             3.0\n");
  ASSERT_OPENED(opened);
  const Deck& deck = *opened->deck;
  EXPECT_EQ(opened->model.node_count(), 31u);
  EXPECT_EQ(position_of(opened->model, 105), Vec3(1, 2, 3));
  std::vector<std::string> unread;
  for (const Warning& w : deck.warnings)
    if (w.kind == "unread-nodes") unread.push_back(w.message.substr(0, w.message.find(' ')) + w.message.substr(w.message.rfind(" (")));
  EXPECT_EQ(unread, (std::vector<std::string>{"*NODE_RIGID_SURFACE (1 line)", "*NODE_SCALAR (2 lines)", "*NODE_SCALAR_VALUE (1 line)"}));
  EXPECT_EQ(warning(deck, "merged-at-start").line, 39);
  EXPECT_EQ(warning(deck, "overridden-thickness").line, 43);
}

TEST(Text, around_the_cards_may_be_anything) {
  const DeckFolder folder;
  folder.write("a name.k", "*NODE\n4,4.,0.,0.\n");
  folder.write("sub/folder.k", "*NODE\n5,5.,0.,0.\n");
  const std::string text =
      "*KEYWORD   \t\n"
      "*COMMENT\nanything, even -1 2 3\n"
      "*VENDOR\n4f9a02bc7d\n0a 1f $ &x\n"
      "*node \t  $ behind\n"
      "       1             1.0             0.0             0.0       0       0     beyond the last field and far beyond eighty columns\n"
      "\f\n"
      "       2             2.0             0.0             0.0\t\t\n"
      "$ a comment\n"
      "       3             3.0             1.0             0.0  \f\n"
      "*INCLUDE\n\"a name.k\"\n"
      "*INCLUDE\nsub/ +\n$ between\nfolder.k   \n"
      "*ELEMENT_SHELL_THICKNESS\t\n"
      "       1       1       1       2       3       3   \t\n"
      "$ between the cards of one shell\n"
      "             1.5             1.5             1.5             1.5             0.0             0.0             9.0             9.0\n"
      "*CASE_BEGIN_2\n*NODE\n       6             6.0             0.0             0.0\n*CASE_END_2\n"
      "*END\n*NODE\nwhat stands behind the end: not read\n\xff\xfe";
  const auto opened = folder.open(text);
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.node_count(), 6u);
  EXPECT_EQ(position_of(opened->model, 3), Vec3(3, 1, 0));
  EXPECT_EQ(position_of(opened->model, 4), Vec3(4, 0, 0));
  EXPECT_EQ(position_of(opened->model, 5), Vec3(5, 0, 0));
  ASSERT_EQ(opened->model.shell_count(), 1u);
  EXPECT_EQ(opened->model.shell_thickness[0], 1.5f);
  EXPECT_EQ(warning(*opened->deck, "only-in-case").count, 1u);
  EXPECT_EQ(warning(*opened->deck, "missing-include").count, 0u);
  // One node moves: its card changes, and all the rest stays.
  const Model moved = with_node_at(opened->model, 1, Vec3(1.5, 0, 0));
  ASSERT_TRUE(save(*opened->deck, opened->model, moved, folder / "deck.k"));
  std::string expected = text;
  expected.replace(expected.find("       1             1.0"), 24, "       1             1.5");
  EXPECT_EQ(content(folder / "deck.k"), expected);
}

TEST(Text, in_utf_16_is_refused_with_the_reason) {
  const DeckFolder folder;
  const auto opened = folder.open(std::string_view("\xff\xfe*\0N\0O\0D\0E\0\n\0", 14));
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().text().find("UTF-16"), std::string::npos) << opened.error().text();
}

TEST(Elements, ids_are_unique_within_their_class_only) {
  const auto opened = open(
      "*ELEMENT_SHELL\n       1       5       1       2       3       4\n"
      "*ELEMENT_BEAM\n       1       6       1       2\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.shell_count(), 1u);
  EXPECT_EQ(block_of(opened->model, ElementClass::beam).size(), 1u);
  EXPECT_EQ(warning(*opened->deck, "duplicate-element").count, 0u);
}

TEST(Elements, of_equal_ids_the_first_counts) {
  const auto opened = open(
      "*ELEMENT_SHELL_THICKNESS\n       1       5       1       2       3       4\n             1.0             1.0             1.0        "
      "     1.0\n"
      "       1       5       5       6       7       8\n             2.0             2.0             2.0             2.0\n"
      "       2       5       5       6       7       8\n             3.0             3.0             3.0             3.0\n"
      "*ELEMENT_BEAM\n       1       6       1       2\n       1       6       3       4\n");
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  ASSERT_EQ(model.shell_count(), 2u);
  EXPECT_EQ(corners_of(model, 1), (std::array<std::int64_t, 4>{1, 2, 3, 4}));
  EXPECT_EQ(model.shell_thickness[1], 3.0f);
  EXPECT_EQ(block_of(model, ElementClass::beam).size(), 1u);
  EXPECT_EQ(nodes_of_element(model, ElementClass::beam, 0), (Ids{1, 2}));
  const Warning duplicate = warning(*opened->deck, "duplicate-element");
  EXPECT_EQ(duplicate.count, 2u);
  EXPECT_EQ(duplicate.line, 35);
}

TEST(Elements, masses_of_nodes_and_of_parts_are_numbered_apart) {
  const auto opened = open(
      "*ELEMENT_MASS\n       1       1             0.5\n       2       2             0.5\n       1       3             0.7\n"
      "*ELEMENT_MASS_PART\n       1             0.5\n*ELEMENT_PLOTEL\n       1       1       2\n       1       2       3\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(block_of(opened->model, ElementClass::mass).size(), 3u);
  EXPECT_EQ(nodes_of_element(opened->model, ElementClass::mass, 0), (Ids{1}));
  EXPECT_EQ(block_of(opened->model, ElementClass::other).size(), 1u);
  const Warning duplicate = warning(*opened->deck, "duplicate-element");
  EXPECT_EQ(duplicate.count, 2u);
  EXPECT_EQ(duplicate.message.substr(0, 54), "mass 1 is defined again; its first definition counts; ") << duplicate.message;
  EXPECT_EQ(opened->deck->left_out_cards.other, 2u);
}

TEST(Elements, duplicates_of_any_class_are_told_where_they_stand) {
  const auto opened =
      open("*ELEMENT_BEAM\n       1       6       1       2\n       2       6       3       4\n       1       6       3       4\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(warning(*opened->deck, "duplicate-element").line, 35);
  EXPECT_EQ(warning(*opened->deck, "duplicate-element").message, "beam 1 is defined again; its first definition counts");
}

TEST(Elements, with_an_undefined_node_are_left_out_and_counted) {
  const auto opened = open(
      "*ELEMENT_SHELL\n"
      "       1       5       1       2       3       4\n"
      "       2       5       1       2       3      99\n"
      "       3       5      98       2       3      99\n"
      "       4       5       5       6       7       8       9      10      11      97\n"
      "       5       5       5       6       7       8\n"
      "*ELEMENT_BEAM\n"
      "       6       5       5      96\n");
  ASSERT_OPENED(opened);
  ASSERT_EQ(opened->model.shell_count(), 2u);
  EXPECT_EQ(corners_of(opened->model, 5), (std::array<std::int64_t, 4>{5, 6, 7, 8}));
  EXPECT_TRUE(opened->model.midside->empty());
  EXPECT_EQ(opened->deck->element_cards.shells(), 5u);
  const Warning undefined = warning(*opened->deck, "undefined-node");
  EXPECT_EQ(undefined.count, 4u);
  EXPECT_EQ(undefined.line, 34);
  EXPECT_EQ(undefined.message, "shell 2 names node 99, which isn't defined; it is left out; also at line 35, line 36 and 1 more");
}

TEST(Elements, that_are_left_out_hold_the_nodes_they_have) {
  const auto opened = open(
      "*ELEMENT_SHELL\n"
      "       1       5       1       2       3       4\n"
      "       2       5       3       4      12      99\n"
      "       4       5       5       6       7       8       9      10      11      97\n"
      "*ELEMENT_BEAM\n"
      "       6       5      96      20\n"
      "       7       5      21      22\n");
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  std::vector<std::int64_t> held;
  for (std::size_t n = 0; n < model.node_count(); ++n)
    if (model.node_holds[n] == kHeldByMissing) held.push_back(model.node_ids[n]);
  EXPECT_EQ(held, (Ids{3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 20}));
}

TEST(Elements, with_too_few_nodes_are_left_out_and_counted) {
  const auto opened = open(
      "*ELEMENT_SHELL\n      10       1       1       2\n      11       1\n      13       1       0       2       3       4\n"
      "      14       1       1       0       3       4\n*ELEMENT_BEAM\n      12       1       4\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.shell_count(), 0u);
  EXPECT_EQ(warning(*opened->deck, "incomplete-element").count, 5u);
}

TEST(Elements, of_other_classes_with_too_few_nodes_are_left_out_and_told) {
  const std::pair<const char*, long> cases[] = {
      {"*ELEMENT_DISCRETE\n1,1,0,0\n", 33},        // both ends are the ground
      {"*ELEMENT_SOLID\n1,4,1,2,0,3\n", 33},       // a corner that none can stand for
      {"*ELEMENT_SOLID\n1,4,1,2,3,4\n2,4\n", 34},  // its nodes would be on the next card
      {"*ELEMENT_SOLID_H20\n1,4\n1,2\n", 33},     {"*ELEMENT_TSHELL\n1,4,1,2,3,4,5,6,7\n", 33},
  };
  for (const auto& [cards, line] : cases) {
    const auto opened = open(cards);
    ASSERT_OPENED(opened);
    const Warning incomplete = warning(*opened->deck, "incomplete-element");
    EXPECT_EQ(incomplete.count, 1u) << cards;
    EXPECT_EQ(incomplete.line, line) << cards;
  }
}

TEST(Elements, have_the_cards_of_their_options_behind_them) {
  const auto opened = open(
      "*ELEMENT_DISCRETE_LCO\n1,101,1,2\n30,31\n2,101,3,4\n30,31\n"
      "*ELEMENT_TSHELL_BETA\n1,4,1,2,3,4,5,6,7,8\n45.0\n2,4,1,2,3,4,5,6,7,8\n45.0\n"
      "*ELEMENT_TSHELL_COMPOSITE\n3,4,1,2,3,4,5,6,7,8\n7,1,45\n4,4,1,2,3,4,5,6,7,8\n7,1,45\n"
      "*ELEMENT_SOLID_DOF\n1,4,1,2,3,4,5,6,7,8\n9,10,11\n2,4,1,2,3,4,5,6,7,8\n9,10,11\n"
      "*ELEMENT_SOLID\n3,4\n1,2,3,&gone,5,6,7,8\n4,4\n1,2,3,4,5,6,7,8\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(block_of(opened->model, ElementClass::discrete).id, (Ids{1, 2}));
  EXPECT_EQ(nodes_of_element(opened->model, ElementClass::discrete, 1), (Ids{3, 4}));
  EXPECT_EQ(block_of(opened->model, ElementClass::tshell).id, (Ids{1, 2, 3, 4}));
  EXPECT_EQ(block_of(opened->model, ElementClass::solid).id, (Ids{1, 2, 4}));
  EXPECT_EQ(warning(*opened->deck, "incomplete-element").count, 0u);
  EXPECT_EQ(warning(*opened->deck, "undefined-parameter").count, 1u);
}

TEST(Shells, layers_of_whole_numbers_are_no_elements) {
  const auto opened = open(
      "*ELEMENT_SHELL_COMPOSITE\n1,5,1,2,3,4\n7,1,45,,8,2,90\n7,1,45\n2,5,2,3,4,5\n7,3,45\n"
      "*ELEMENT_SHELL_COMPOSITE_LONG\n3,5,1,2,3,4\n7,1.0,45.,,,9.0\n*ELEMENT_SHELL\n4,5,1,2,3,4\n5,5,2,3,4,5\n");
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  ASSERT_EQ(model.shell_count(), 5u);
  const float wanted[] = {4, 3, 1, 0, 0};
  for (std::size_t s = 0; s < 5; ++s) EXPECT_EQ(model.shell_thickness[s], wanted[s]) << s;
}

TEST(Elements, whose_fields_cant_be_read_are_named_by_line) {
  const std::pair<const char*, const char*> cases[] = {
      {"*ELEMENT_MASS\n1,x\n", "expected an id but found \"x\""},
      {"*ELEMENT_MASS_NODE_SET\n1,2 3\n", "expected an id but found \"2 3\""},
      {"*ELEMENT_SPH\nm,1\n", "expected an element id but found \"m\""},
      {"*ELEMENT_BEAM\n1,1,1,y\n", "expected an id but found \"y\""},
      {"*ELEMENT_SOLID\nz,1\n", "expected an element id but found \"z\""},
      {"*ELEMENT_SOLID\n-1,1,1,2,3,4\n", "an element needs an id above 0"},
      {"*ELEMENT_BEAM\n0,1,1,2\n", "an element needs an id above 0"},
      {"*ELEMENT_SHELL\n,1,1,2,3\n", "an element needs an id above 0"},
  };
  for (const auto& [cards, message] : cases) {
    const auto opened = open(cards);
    ASSERT_FALSE(opened) << cards;
    EXPECT_EQ(opened.error().message, message);
    EXPECT_EQ(opened.error().line, 33) << cards;
  }
}

TEST(Nodes, of_equal_ids_the_first_counts) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "*NODE\n3,1.,0.,0.\n1,2.,0.,0.\n3,9.,9.,9.\n2,3.,0.,0.\n*NODE+\n                   1                 9.0\n                   4       "
      "          4.0\n");
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  ASSERT_EQ(model.node_count(), 4u);
  EXPECT_EQ(position_of(model, 3), Vec3(1, 0, 0));
  EXPECT_EQ(position_of(model, 1), Vec3(2, 0, 0));
  EXPECT_EQ(position_of(model, 4), Vec3(4, 0, 0));
  const Deck& deck = *opened->deck;
  EXPECT_EQ(deck.run_of(model.find_node(2)).style, static_cast<std::uint16_t>(lsdyna::Columns::standard));
  EXPECT_EQ(deck.run_of(model.find_node(4)).style, static_cast<std::uint16_t>(lsdyna::Columns::wide));
  const Warning duplicate = warning(deck, "duplicate-node");
  EXPECT_EQ(duplicate.count, 2u);
  EXPECT_EQ(duplicate.line, 4);
}

}  // namespace
}  // namespace prismesh::mesh::deck
