// Element cards of every kind and option that is read.
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

TEST(Elements, ids_are_unique_within_their_class_only) {
  const auto opened = open(
      "*ELEMENT_SHELL\n       1       5       1       2       3       4\n"
      "*ELEMENT_BEAM\n       1       6       1       2\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.shell_count(), 1u);
  EXPECT_EQ(block_of(opened->model, ElementClass::beam).size(), 1u);
  EXPECT_TRUE(opened->deck->warnings.empty());
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
  EXPECT_EQ(undefined.message, "shell 2 names node 99, which isn't defined; it is left out");
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
  const auto opened = open("*ELEMENT_SHELL\n      10       1       1       2\n      11       1\n*ELEMENT_BEAM\n      12       1       4\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.shell_count(), 0u);
  EXPECT_EQ(warning(*opened->deck, "incomplete-element").count, 3u);
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
  EXPECT_EQ(deck.node_runs[deck.run_of(model.find_node(2))].columns, Columns::standard);
  EXPECT_EQ(deck.node_runs[deck.run_of(model.find_node(4))].columns, Columns::wide);
  const Warning duplicate = warning(deck, "duplicate-node");
  EXPECT_EQ(duplicate.count, 2u);
  EXPECT_EQ(duplicate.line, 4);
}

}  // namespace
}  // namespace prismesh::mesh::deck
