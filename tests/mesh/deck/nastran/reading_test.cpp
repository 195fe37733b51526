// What each way of writing Nastran bulk data means, against values written down here; and the real decks, against an independent counter.
#include <cstdlib>
#include <iostream>

#include <nlohmann/json.hpp>

#include "mesh/deck/nastran/card.h"
#include "mesh/deck/open.h"
#include "mesh/deck/save.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

namespace fs = std::filesystem;
using Ids = std::vector<std::int64_t>;

std::size_t kind_count(const Deck& deck, std::string_view kind) {
  const auto at = deck.element_kinds.find(kind);
  return at == deck.element_kinds.end() ? 0 : at->second;
}

std::uint8_t hold_of(const Model& model, std::int64_t node) { return model.node_holds[model.find_node(node).value]; }

const ElementBlock& block_of(const Model& model, ElementClass element_class) {
  return *model.elements[static_cast<std::size_t>(element_class)];
}

Ids nodes_of(const Model& model, ElementClass element_class, std::size_t element) {
  const ElementBlock& block = block_of(model, element_class);
  Ids ids;
  for (std::uint32_t n = block.first_node[element]; n < block.first_node[element + 1]; ++n)
    ids.push_back(model.node_ids[block.nodes[n].value]);
  return ids;
}

const Part& part(const Model& model, std::int64_t id) { return (*model.parts)[model.find_part(id).value]; }

void expect_near(const Vec3& found, const Vec3& wanted) { EXPECT_LT((found - wanted).norm(), 1e-12) << found.transpose(); }

void expect_square(const Result<OpenedDeck>& opened) {
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  ASSERT_EQ(model.node_count(), 4u);
  EXPECT_EQ(position_of(model, 1), Vec3(0, 0, 0));
  EXPECT_EQ(position_of(model, 2), Vec3(10, 0, 0.5));
  EXPECT_EQ(position_of(model, 3), Vec3(10, 1.5e-3, -2.5));
  EXPECT_EQ(position_of(model, 4), Vec3(-100, 20, 3));
  ASSERT_EQ(model.shell_count(), 1u);
  EXPECT_EQ(corners_of(model, 10), (std::array<std::int64_t, 4>{1, 2, 3, 4}));
  EXPECT_EQ(part(model, 7).id, 7);
  EXPECT_TRUE(opened->deck->warnings.empty()) << opened->deck->warnings[0].message;
}

TEST(NastranLayout, small_field) {
  const DeckFolder folder;
  expect_square(
      folder.open("GRID           1              0.      0.      0.\n"
                  "GRID    2               10.             .5\n"
                  "GRID           3             10.   1.5-3    -2.5       0  123456        field ten, and beyond it\n"
                  "GRID           4           -1.+2   20.D0   3.0E0\n"
                  "CQUAD4        10       7       1       2       3       4      0.      0.\n"
                  "PSHELL,7\n"));
}

TEST(NastranLayout, large_field_and_mixtures) {
  const DeckFolder folder;
  expect_square(
      folder.open("BEGIN BULK\r\n"
                  "GRID*                  1                              0.              0.\r\n"
                  "*                     0.\r\n"
                  "grid*                  2                             10.                *A\r\n"
                  "$ a comment within the card\r\n"
                  "*A                    .5\r\n"
                  "Grid,3,,10.,1.5-3,-2.5 $ a comment, behind it\r\n"
                  "GRID*,4,,-100.,20.\r\n"
                  "*,3.\r\n"
                  "CQUAD4*               10               7               1               2*\r\n"
                  "*                      3               4\r\n"
                  "PSHELL,7\r\n"
                  "ENDDATA\r\n"
                  "GRID    rubbish\r\n"));
}

TEST(NastranLayout, tabs_and_leading_blanks_and_blanks_between_free_fields) {
  const DeckFolder folder;
  expect_square(
      folder.open("GRID\t1\t\t0.\t0.\t0.\n"
                  "  GRID         2             10.              .5\n"
                  "GRID, 3 , , 10. 1.5-3 , -2.5,\n"
                  "GRID    4       \t-100.\t20.     3.\n"
                  "CQUAD4,10,7,1\t,2,3,4\nPSHELL,7\n"));
}

TEST(NastranLayout, a_continuation_may_be_of_any_kind) {
  const DeckFolder folder;
  for (const char* card :
       {"CHEXA          1       2       1       2       3       4       5       6\n               7       8\n",
        "CHEXA          1       2       1       2       3       4       5       6+ABC\n+abc           7       8\n",
        "CHEXA          1       2       1       2       3       4       5       6\n\n$ 7\n+,7,8\n", "CHEXA,1,2,1,2,3,4,5,6\n,7,8\n",
        "CHEXA*                 1               2               1               2\n"
        "*                      3               4               5               6\n"
        "*                      7               8\n",
        "CHEXA*                 1               2               1               2\n"
        "*                      3               4               5               6\n"
        "               7       8\n"}) {
    std::string text;
    for (int n = 1; n <= 8; ++n) text += "GRID," + std::to_string(n) + ",," + std::to_string(n) + ".,0.,0.\n";
    const auto opened = folder.open(text + card + "CROD,2,5,1,2\n");
    ASSERT_OPENED(opened);
    ASSERT_EQ(block_of(opened->model, ElementClass::solid).size(), 1u) << card;
    EXPECT_EQ(nodes_of(opened->model, ElementClass::solid, 0), (Ids{1, 2, 3, 4, 5, 6, 7, 8})) << card;
    EXPECT_EQ(block_of(opened->model, ElementClass::beam).size(), 1u);
  }
}

TEST(NastranLayout, continuations_out_of_order_are_refused) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "GRID           1              0.      0.      0.\n"
      "CHEXA          1       2       1       1       1       1       1       1+A\n"
      "+B             1       1\n");
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().line, 3);
  EXPECT_NE(opened.error().message.find("continuations out of order"), std::string::npos) << opened.error().message;
}

TEST(NastranLayout, the_first_column_of_a_continuations_name_is_not_compared) {
  const DeckFolder folder;
  const std::string grids = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\n";
  const std::string quad = "CQUAD4         1       7       1       2       3       4                ";
  // Columns 73 to 80, and 1 to 8 of the next line: columns 74 to 80 name it.
  for (const auto& [next, own] : {std::pair("XABC    ", "+ABC    "),
                                  {" ABC    ", "+ABC    "},
                                  {"*ABC    ", "+ABC    "},
                                  {"+abc    ", "+ABC    "},
                                  {"X       ", "+       "},
                                  {"XABC    ", "        "},
                                  {"ABC     ", "+ABC    "},
                                  {"    +ABC", "+ABC    "}}) {
    const auto opened = folder.open(grids + quad + next + "\n" + own + "                      1.      1.      1.      1.\n");
    ASSERT_OPENED(opened);
    ASSERT_EQ(opened->model.shell_count(), 1u);
    EXPECT_EQ(opened->model.shell_thickness[0], 1.0f) << next << own;
  }
  const auto other = folder.open(grids + quad + "XABD    \n+ABC                          1.      1.      1.      1.\n");
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().line, 6);
}

TEST(NastranLayout, fields_are_counted_over_lines) {
  nastran::CardLines lines;
  nastran::Card card;
  const std::string text = "SPC1*                  5             123               1               2\n+              3       4\nGRID\n";
  lines.read(text, 0);
  card.cut(lines);
  EXPECT_EQ(card.name(), "SPC1");
  EXPECT_EQ(card.integer(3), 2);
  EXPECT_TRUE(card.blank(4));
  EXPECT_EQ(card.integer(8), 3);
  EXPECT_EQ(lines.next, text.size() - 5);
}

TEST(NastranSections, only_bulk_data_is_read) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "ID A,B\nSOL 101\nCEND\nTITLE = GRID\nGRID    x\nSET 1 = 1 THRU 1,\n 1\nDISP = 1\nBEGIN "
      "BULK\nGRID,1,,1.,2.,3.\nENDDATA\nGRID,2\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.node_count(), 1u);
  EXPECT_TRUE(opened->deck->warnings.empty()) << opened->deck->warnings[0].message;
}

TEST(NastranSections, optistruct_needs_no_cend) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "$$\n$$ Optistruct Input Deck\nSUBCASE 1\n  SPC = 1\nBEGIN BULK\n$$ Grids\nGRID,1,,1.,2.,3.\nGRID,2\nGRID,3,,,1.\n"
      "CTRIA3,1,4,1,2,3\n$HMNAME PROP         4\"floor panel\" 4\nPSHELL,4,1,1.5\nENDDATA\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.shell_count(), 1u);
  EXPECT_EQ(part(opened->model, 4).name, "floor panel");
  EXPECT_EQ(part(opened->model, 4).thickness, 1.5);
}

TEST(NastranSections, superelements_are_said_to_be_unread) {
  const DeckFolder folder;
  const auto opened = folder.open("CEND\nBEGIN BULK\nGRID,1\nBEGIN SUPER=1\nGRID,1,,9.\nENDDATA\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.node_count(), 1u);
  EXPECT_GT(warning(*opened->deck, "unread-section").count, 0u);
  EXPECT_EQ(warning(*opened->deck, "unread-section").line, 4);
  EXPECT_EQ(opened->deck->references->unread().size(), 1u);
}

TEST(NastranIncludes, stand_where_they_are_named) {
  const DeckFolder folder;
  folder.write("sub/nodes.bdf", "GRID,2,,2.\nINCLUDE 'more.bdf'\n");
  folder.write("sub/more.bdf", "GRID,3,,3.\n");
  const auto opened = folder.open(
      "CEND\nBEGIN BULK\nGRID,1,,1.\nINCLUDE 'sub/\n   nodes.bdf'\nGRID,4,,4.\ninclude missing.bdf $ not there\nINCLUDE "
      "\"deck.k\"\nENDDATA\n");
  ASSERT_OPENED(opened);
  ASSERT_EQ(opened->model.node_count(), 4u);
  for (std::size_t n = 0; n < 4; ++n) EXPECT_EQ(opened->model.node_ids[n], static_cast<std::int64_t>(n + 1));
  EXPECT_EQ(opened->deck->missing_files, std::vector<std::string>{"missing.bdf"});
  EXPECT_GT(warning(*opened->deck, "missing-include").count, 0u);
  EXPECT_EQ(warning(*opened->deck, "missing-include").line, 7);
  EXPECT_GT(warning(*opened->deck, "circular-include").count, 0u);
}

TEST(NastranIncludes, names_over_lines_are_no_cards) {
  for (const char* second_line : {"nodes.bdf", "GRID,9", "INCLUDE nodes.bdf"}) {
    SCOPED_TRACE(second_line);
    const DeckFolder folder;
    folder.write("sub/" + std::string(second_line), "GRID,2,,2.\n");
    const auto opened = folder.open("GRID,1,,1.\nINCLUDE 'sub/\n" + std::string(second_line) + "'\nGRID,4,,4.\n");
    ASSERT_OPENED(opened);
    Ids ids;
    for (std::size_t n = 0; n < opened->model.node_count(); ++n) ids.push_back(opened->model.node_ids[n]);
    EXPECT_EQ(ids, (Ids{1, 2, 4}));
    EXPECT_TRUE(opened->deck->references->unread().empty()) << opened->deck->references->unread()[0].keyword;
    EXPECT_TRUE(opened->deck->warnings.empty()) << opened->deck->warnings[0].message;
  }
}

TEST(NastranIncludes, twice_is_once_and_held) {
  const DeckFolder folder;
  folder.write("a.bdf", "GRID,2,,2.\n");
  const auto opened = folder.open("GRID,1\nINCLUDE 'a.bdf'\nINCLUDE 'a.bdf'\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(hold_of(opened->model, 2), kHeldByInclude);
  EXPECT_EQ(hold_of(opened->model, 1), 0);
  EXPECT_GT(warning(*opened->deck, "repeated-include").count, 0u);
}

const char kGrids[] = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nGRID,5,,.5,0.,0.\nGRID,6,,1.,.5,0.\n";

TEST(NastranElements, shells_of_all_kinds) {
  const DeckFolder folder;
  const auto opened = folder.open(std::string(kGrids) +
                                  "CQUAD4,1,1,1,2,3,4\nCQUADR,2,1,1,2,3,4\nCTRIA3,3,1,1,2,3\nCTRIAR,4,1,1,2,3\n"
                                  "CQUAD8,5,1,1,2,3,4,5,6\nCTRIA6,6,1,1,2,3,5,6\nCSHEAR,7,2,1,2,3,4\nCQUAD4,8,,1,2,3,4\n");
  ASSERT_OPENED(opened);
  const ElementCounts& counts = opened->deck->element_cards;
  EXPECT_EQ(counts.quad, 3u);
  EXPECT_EQ(counts.tri, 2u);
  EXPECT_EQ(counts.quad8, 1u);
  EXPECT_EQ(counts.tri6, 1u);
  EXPECT_EQ(counts.other, 1u);
  ASSERT_EQ(opened->model.midside->size(), 2u);
  EXPECT_EQ(opened->model.node_ids[(*opened->model.midside)[0].node[1].value], 6);
  EXPECT_FALSE((*opened->model.midside)[0].node[2].valid());
  EXPECT_EQ(kind_count(*opened->deck, "CQUAD4"), 2u);
  EXPECT_EQ((*opened->model.parts)[opened->model.shell_parts[6].value].id, 8) << "a blank property is the element's id";
}

TEST(NastranElements, corner_thicknesses_and_shares_of_the_property) {
  const DeckFolder folder;
  const auto opened = folder.open(std::string(kGrids) +
                                  "CQUAD4,1,1,1,2,3,4\n,,,1.,2.,3.,4.\nCQUAD4,2,1,1,2,3,4\n,,1,.5,.5,.5,.5\nCTRIA3,3,1,1,2,3\n+,,,4.\n"
                                  "CQUAD4,4,1,1,2,3,4\nPSHELL,1,1,2.\n");
  ASSERT_OPENED(opened);
  EXPECT_FLOAT_EQ(opened->model.shell_thickness[0], 2.5f);
  EXPECT_FLOAT_EQ(opened->model.shell_thickness[1], 1.f);
  EXPECT_FLOAT_EQ(opened->model.shell_thickness[2], 8.f / 3);
  EXPECT_FLOAT_EQ(opened->model.shell_thickness[3], 0.f);
}

TEST(NastranElements, everything_else) {
  const DeckFolder folder;
  const auto opened = folder.open(
      std::string(kGrids) +
      "CROD,1,1,1,2\nCONROD,2,1,2,5,1.\nCBAR,3,2,1,2,3\nCBEAM,4,2,1,2,0.,0.,1.\nCBUSH,5,3,1,2\nCBUSH,6,3,4\nCELAS2,7,1.5,1,1,2,1\n"
      "CELAS1,8,4,1,1,900,0\nSPOINT,900\nCONM2,9,3,,1.5\nSPC1,1,0,900,4\nRBE2,10,1,123,2,3\nRBE3,11,,4,123,1.,123,1,2\n,3\nRBAR,12,1,"
      "2\nPLOTEL,13,1,2,,14,"
      "2,3\n"
      "CTETRA,15,5,1,2,3,4\nCELAS4,16,1.,5,6\nCAERO1,17,1\nRBE1,18,1,123\n,UM,2,123,3,123\nRBE3,19,,4,123,1.,123,1,2\n,UM,5,123\n");
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  EXPECT_EQ(block_of(model, ElementClass::beam).id, (Ids{1, 2, 3, 4}));
  EXPECT_EQ(nodes_of(model, ElementClass::beam, 2), (Ids{1, 2}));
  EXPECT_FALSE(block_of(model, ElementClass::beam).part[1].valid());
  EXPECT_EQ(block_of(model, ElementClass::discrete).id, (Ids{5, 6, 7, 8, 16}));
  EXPECT_EQ(nodes_of(model, ElementClass::discrete, 1), (Ids{4}));
  EXPECT_EQ(nodes_of(model, ElementClass::discrete, 3), (Ids{1}));
  EXPECT_EQ(nodes_of(model, ElementClass::mass, 0), (Ids{3}));
  EXPECT_EQ(block_of(model, ElementClass::other).id, (Ids{10, 11, 12, 13, 14, 18, 19}));
  EXPECT_EQ(nodes_of(model, ElementClass::other, 0), (Ids{1, 2, 3}));
  EXPECT_EQ(nodes_of(model, ElementClass::other, 1), (Ids{4, 1, 2, 3}));
  EXPECT_EQ(nodes_of(model, ElementClass::other, 5), (Ids{1, 2, 3}));
  EXPECT_EQ(nodes_of(model, ElementClass::other, 6), (Ids{4, 1, 2, 5}));
  EXPECT_EQ(nodes_of(model, ElementClass::solid, 0), (Ids{1, 2, 3, 4}));
  EXPECT_EQ(kind_count(*opened->deck, "CAERO1"), 1u);
  EXPECT_EQ(kind_count(*opened->deck, "PLOTEL"), 1u);
  EXPECT_TRUE(opened->deck->references->named(Referred::node, 3)) << "the CBAR's orientation";
  EXPECT_TRUE(opened->deck->references->named(Referred::node, 4));
  EXPECT_FALSE(opened->deck->references->named(Referred::node, 900)) << "a scalar point is no node";
}

TEST(NastranElements, scalar_points_are_defined) {
  const DeckFolder folder;
  const auto opened = folder.open("SOL 101\nCEND\nSET 1 = 101, 105\nDISP = 1\nBEGIN BULK\n" + std::string(kGrids) +
                                  "SPOINT,101,102\nSPOINT,103,THRU,105\nSPOINT,1100001\nSPC1,1,0,101,102,103\nSPC1,1,0,4,102,103,105,107\n"
                                  "SPC,1,1100001,0\nSPC1,2,0,101,102,103,106\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(warning(*opened->deck, "names-undefined-node").count, 2u) << "106 and 107 alone";
  EXPECT_TRUE(opened->deck->references->named(Referred::node, 4));
  EXPECT_FALSE(opened->deck->references->named(Referred::node, 103));
}

TEST(NastranIds, may_have_eighteen_digits) {
  const DeckFolder folder;
  EXPECT_TRUE(folder.open("GRID,123456789012345678"));
  for (const char* entry : {"GRID", "CQUAD4"}) {
    const auto refused = folder.open(std::string("GRID,1\n") + entry + ",1234567890123456789,1,1,1,1,1\nCROD,2,1,1,9\n");
    ASSERT_FALSE(refused) << "the rod may need that grid point";
    EXPECT_EQ(refused.error().message,
              std::string("the id of a ") + entry + " may have up to 18 digits, but this one has \"1234567890123456789\"");
    EXPECT_EQ(refused.error().line, 2);
  }
}

TEST(NastranSections, bulk_data_that_is_begun_is_ended) {
  const DeckFolder folder;
  const auto opened = folder.open("SOL 101\nCEND\nBEGIN BULK\nGRID,1\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(warning(*opened->deck, "no-end").count, 1u);
  for (const char* text : {"GRID,1\n", "SOL 101\nCEND\nBEGIN BULK\nGRID,1\nENDDATA\n"}) {
    const auto whole = folder.open(text);
    ASSERT_OPENED(whole);
    EXPECT_EQ(warning(*whole->deck, "no-end").count, 0u);
  }
}

TEST(NastranIncludes, a_quote_that_isnt_closed_is_told_as_such) {
  const DeckFolder folder;
  const auto opened = folder.open("GRID,1\nINCLUDE 'mesh.bdf\nGRID,2\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(warning(*opened->deck, "missing-include").line, 2);
  EXPECT_NE(warning(*opened->deck, "missing-include").message.find("isn't closed"), std::string::npos);
  EXPECT_EQ(opened->model.node_count(), 2u);
}

TEST(NastranElements, of_different_types_with_one_number_are_all_shown) {
  const DeckFolder folder;
  const auto opened =
      folder.open(std::string(kGrids) +
                  "CQUAD4,1,1,1,2,3,4\nCROD,1,1,1,2\nCROD,2,1,1,2\nCQUAD4,2,1,1,2,3,4\nCQUAD4,3,1,1,2,3,4\nCQUAD4,3,1,1,2,3,4\n"
                  "CONM2,2,1\nCONM2,2,1\nRBE2,2,1,123,2\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.shell_count(), 3u);
  EXPECT_TRUE(opened->model.find_shell(2).valid());
  EXPECT_EQ(block_of(opened->model, ElementClass::beam).id, (Ids{1, 2}));
  EXPECT_EQ(block_of(opened->model, ElementClass::mass).id, (Ids{2}));
  EXPECT_EQ(block_of(opened->model, ElementClass::other).id, (Ids{2}));
  EXPECT_EQ(warning(*opened->deck, "duplicate-element").count, 2u) << "a shell and a mass";
  EXPECT_EQ(warning(*opened->deck, "shared-element-number").count, 5u);
  EXPECT_EQ(opened->deck->hidden.size(), 2u);
  EXPECT_EQ(opened->deck->element_cards.quad, 4u);
}

TEST(NastranElements, old_ones_are_refused_by_name) {
  const DeckFolder folder;
  const auto opened =
      folder.open(std::string(kGrids) + "CQUAD1         1       1       1       2       3       4\nCQUAD1,2,1,1,2,3,4\nCTRIA1,3,1,1,2,3\n");
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().line, 7);
  EXPECT_NE(opened.error().message.find("CQUAD1"), std::string::npos);
  EXPECT_NE(opened.error().message.find("2 of them"), std::string::npos);
}

TEST(NastranElements, those_without_their_nodes_are_left_out_and_said) {
  const DeckFolder folder;
  const auto opened = folder.open(std::string(kGrids) + "CQUAD4,1,1,1,2,3,77\nCTRIA3,2,1,1,2\nGENEL,3\nCHBDYE,4\nMYCARD,5\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.shell_count(), 0u);
  EXPECT_GT(warning(*opened->deck, "undefined-node").count, 0u);
  EXPECT_GT(warning(*opened->deck, "incomplete-element").count, 0u);
  EXPECT_GT(warning(*opened->deck, "unread-elements").count, 0u);
  std::vector<std::string> unread;
  for (const UnreadText& text : opened->deck->references->unread()) unread.push_back(text.keyword);
  EXPECT_EQ(unread, (std::vector<std::string>{"GENEL", "CHBDYE", "MYCARD"}));
}

TEST(NastranDefinitions, of_three_elastic_constants_the_third_follows_where_it_is_missing) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "GRID,1\nPSHELL,1,1,1.\nPSHELL,2,2,1.\nPSHELL,3,3,1.\nPSHELL,4,4,1.\nMAT1,1,260.,100.\nMAT1,2,,100.,.25\nMAT1,3,260.,100.,.2\n"
      "MAT1,4,260.,0.\n");
  ASSERT_OPENED(opened);
  EXPECT_NEAR(part(opened->model, 1).poissons_ratio.value(), 0.3, 1e-12);
  EXPECT_NEAR(part(opened->model, 2).youngs_modulus.value(), 250, 1e-12);
  EXPECT_EQ(part(opened->model, 3).poissons_ratio, 0.2) << "what the card says counts";
  EXPECT_EQ(part(opened->model, 3).youngs_modulus, 260);
  EXPECT_FALSE(part(opened->model, 4).poissons_ratio);
}

TEST(NastranDefinitions, properties_and_materials) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "GRID,1\n$ Femap Property 1 : "
      "Skin\nPSHELL,1,5,2.5\nPCOMP,2,,,,,,,SYM\n,5,.5,0.,YES,,.25,90.\nPCOMPG,3\n,101,5,.5,0.\n,102,6,.5\nPSHELL,4,,1.,6\n"
      "PELAS,11,1.,,,12,2.\nPSHELL,1,5,9.\nMAT1,5,210000.,,.3,7.85-9\nMAT1*                  6                           1000.             "
      ".25\n"
      "*                  2.8-9\nMAT8,7,1.,1.,.3,1.,,,1.6-9\n$ANSA_NAME_COMMENT;4;PSHELL;deck plate;;NO;\n");
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  EXPECT_EQ(part(model, 1).name, "Skin");
  EXPECT_EQ(part(model, 1).thickness, 2.5);
  EXPECT_EQ(part(model, 1).density, 7.85e-9);
  EXPECT_EQ(part(model, 1).youngs_modulus, 210000);
  EXPECT_DOUBLE_EQ(*part(model, 2).thickness, 1.5);
  EXPECT_EQ(part(model, 2).youngs_modulus, 210000);
  EXPECT_DOUBLE_EQ(*part(model, 3).thickness, 1);
  EXPECT_DOUBLE_EQ(*part(model, 3).density, (7.85e-9 + 2.8e-9) / 2);
  EXPECT_FALSE(part(model, 3).youngs_modulus.has_value()) << "two materials have no one stiffness";
  EXPECT_EQ(part(model, 4).name, "deck plate");
  EXPECT_DOUBLE_EQ(*part(model, 4).youngs_modulus, 2500);
  EXPECT_TRUE(part(model, 11).defined && part(model, 12).defined);
  EXPECT_GT(warning(*opened->deck, "duplicate-property").count, 0u);
}

TEST(NastranFrames, of_every_kind_in_each_other) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "GRID,1,1,2.,90.,5.\nGRID,2,2,2.,90.,90.\nGRID,3,3,1.,0.,0.\nGRID,4,4,1.,2.,3.\nGRID,5,,1.,1.,1.\nGRID,6,0,1.,1.,1.\n"
      "CORD2C,1,0,10.,0.,0.,10.,0.,1.\n,11.,0.,0.\nCORD2S,2,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"
      "$ its points in the cylindrical system 1\nCORD2R,3,1,1.,90.,0.,1.,90.,1.\n,2.,90.,0.\n"
      "CORD1R,4,11,12,13\nGRID,11,1,0.,0.,0.\nGRID,12,0,10.,0.,7.\nGRID,13,0,10.,3.,0.\n");
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  expect_near(position_of(model, 1), {10, 2, 5});
  expect_near(position_of(model, 2), {0, 2, 0});
  expect_near(position_of(model, 3), {10, 2, 0});  // one further out along the radius
  expect_near(position_of(model, 4), {8, 1, 3});
  EXPECT_EQ(hold_of(model, 12), kHeldByFrame);
  EXPECT_EQ(hold_of(model, 1), 0);
  EXPECT_TRUE(opened->deck->warnings.empty()) << opened->deck->warnings[0].message;
}

TEST(NastranFrames, grdset_speaks_for_blanks_only) {
  const DeckFolder folder;
  const auto opened = folder.open("GRID,1,,2.,90.,5.\nGRID,2,0,2.,90.,5.\nGRDSET,,1\nCORD2C,1,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n");
  ASSERT_OPENED(opened);
  expect_near(position_of(opened->model, 1), {0, 2, 5});
  expect_near(position_of(opened->model, 2), {2, 90, 5});
}

TEST(NastranFrames, that_cant_be_worked_out_hold_their_nodes) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "GRID,1,1,1.,2.,3.\nGRID,2,2,1.,2.,3.\nGRID,3,3,1.,2.,3.\nGRID,4,9,1.,2.,3.\nGRID,5,,1.,2.,3.\n"
      "CORD2R,1,2,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nCORD2R,2,1,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nCORD2R,3,0,0.,0.,0.,0.,0.,1.\n,0.,0.,2.\n");
  ASSERT_OPENED(opened);
  for (const int node : {1, 2, 3, 4}) EXPECT_EQ(hold_of(opened->model, node), kHeldByFrame) << node;
  EXPECT_EQ(hold_of(opened->model, 5), 0);
  EXPECT_GT(warning(*opened->deck, "bad-coordinate-system").count, 0u);
  EXPECT_EQ(warning(*opened->deck, "bad-coordinate-system").count, 3u);
  EXPECT_EQ(warning(*opened->deck, "undefined-coordinate-system").line, 4);
}

TEST(NastranFrames, a_hundred_thousand_in_each_other) {
  const DeckFolder folder;
  std::string text = "GRID,1,1,0.,0.,0.\n";
  const int count = 100000;
  for (int i = 1; i <= count; ++i)
    text += "CORD2R," + std::to_string(i) + "," + std::to_string(i < count ? i + 1 : 0) + ",1.,0.,0.,1.,0.,1.\n,2.,0.,0.\n";
  const auto opened = folder.open(text);
  ASSERT_OPENED(opened);
  expect_near(position_of(opened->model, 1), {count, 0, 0});
}

TEST(NastranReplication, makes_cards_that_cant_be_moved_singly) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "GRID,1,,0.,1.,2.\n=,*(1),=,*(.5),==\n=(3)\nGRID,9,,0.,0.,0.\n"
      "CTRIA3         1       1       1       2       3\n=       *1      =       *1      *1      *1\n");
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  ASSERT_EQ(model.node_count(), 6u);
  EXPECT_EQ(position_of(model, 2), Vec3(0.5, 1, 2));
  EXPECT_EQ(position_of(model, 5), Vec3(2, 1, 2));
  for (const int node : {1, 2, 5}) EXPECT_EQ(hold_of(model, node), kHeldByMaking) << node;
  EXPECT_EQ(hold_of(model, 9), 0);
  ASSERT_EQ(model.shell_count(), 2u);
  EXPECT_EQ(corners_of(model, 2), (std::array<std::int64_t, 4>{2, 3, 4, 4}));
  const auto moved = save(*opened->deck, model, with_node_at(model, 2, {0, 0, 0}), folder / "out.k");
  ASSERT_FALSE(moved);
  EXPECT_EQ(moved.error().line, 2);
}

TEST(NastranReplication, a_card_may_take_fields_from_the_one_before) {
  const DeckFolder folder;
  const std::string text =
      "GRID           1              1.      2.      3.\nGRID           2      ==\nGRID,3,=,4.,==\nGRID,4,,*(.5),=,7.\n"
      "$ a comment between\nGRID,5,==\nGRID,9,,0.,0.,0.\nCTRIA3,1,7,1,2,3\nCTRIA3,2,=,*(1),*(1),4\nCTRIA3,3,7,1,2,5\n";
  const auto opened = folder.open(text);
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  EXPECT_EQ(position_of(model, 2), Vec3(1, 2, 3));
  EXPECT_EQ(position_of(model, 3), Vec3(4, 2, 3));
  EXPECT_EQ(position_of(model, 4), Vec3(4.5, 2, 7));
  EXPECT_EQ(position_of(model, 5), Vec3(4.5, 2, 7));
  // One that is moved alone would move those that copy it.
  for (const int node : {1, 2, 3, 4, 5}) EXPECT_EQ(hold_of(model, node), kHeldByMaking) << node;
  EXPECT_EQ(hold_of(model, 9), 0);
  EXPECT_EQ(corners_of(model, 2), (std::array<std::int64_t, 4>{2, 3, 4, 4}));
  ASSERT_TRUE(save(*opened->deck, model, with_node_at(model, 9, {0, 0, 1}), folder / "out.k"));
  EXPECT_EQ(content(folder / "out.k"), std::string(text).replace(text.find("GRID,9,,0.,0.,0."), 16, "GRID,9,,0.,0.,1.0"));
  EXPECT_TRUE(opened->deck->warnings.size() <= 2u) << opened->deck->warnings[2].message;
}

TEST(NastranReplication, of_single_fields_goes_on_from_a_copy_and_over_a_million_bytes) {
  const DeckFolder folder;
  const auto copies = folder.open("GRID,1,,0.,1.,2.\n=,*1,=,*1.,==\n=(2)\nGRID,9,==\n");
  ASSERT_OPENED(copies);
  EXPECT_EQ(position_of(copies->model, 9), Vec3(3, 1, 2));
  std::string text = "GRID,1,,1.,2.,3.\n";
  for (int i = 2; text.size() < std::size_t{3} << 20; ++i) text += "GRID," + std::to_string(i) + ",==$" + std::string(70, '-') + "\n";
  const auto many = folder.open(text);
  ASSERT_OPENED(many);
  EXPECT_GT(many->model.node_count(), 30000u);
  EXPECT_EQ(many->model.positions[many->model.node_count() - 1], Vec3(1, 2, 3));
}

TEST(NastranReplication, of_single_fields_needs_a_card_of_the_same_name) {
  const DeckFolder folder;
  const std::string triangle = "GRID,1,,1.,2.,3.\nGRID,2,,1.,0.,3.\n";
  for (const auto& [cards, line] :
       {std::pair<std::string, long>("CTRIA3,1,7,1,2,3\nGRID,3,==\n", 4), {"GRID,3,,=7\nCTRIA3,1,7,1,2,3\n", 3}}) {
    const auto opened = folder.open(triangle + cards);
    ASSERT_FALSE(opened) << cards;
    EXPECT_EQ(opened.error().line, line);
    EXPECT_NE(opened.error().message.find("GRID 3 but found \"="), std::string::npos) << opened.error().message;
  }
}

TEST(NastranReplication, asks_for_too_much_or_makes_no_sense) {
  const DeckFolder folder;
  const auto many = folder.open("GRID,1,,0.,1.,2.\n=,*(1),==\n=(999999999)\n");
  ASSERT_FALSE(many);
  EXPECT_EQ(many.error().line, 3);
  const auto stray = folder.open("=,*(1),==\nGRID,1,,0.,1.,2.\nGRID,2,,1.\n=(5)\n");
  ASSERT_OPENED(stray);
  EXPECT_EQ(warning(*stray->deck, "unread-replication").count, 2u);
}

TEST(NastranReferences, cards_that_name_nodes_and_elements) {
  const DeckFolder folder;
  const auto opened = folder.open(std::string("CEND\nSET 3 = 1 THRU 3, 5\nSTRESS = 3\nBEGIN BULK\n") + kGrids +
                                  "CQUAD4,1,1,1,2,3,4\nSPC1,7,123,1,THRU,3\nSPC1,7,123,5,6\nSPC,8,4,123,0.\nFORCE,9,6,,1.,0.,0.,1.\n"
                                  "PLOAD4,9,1,1.5\nRBE2,20,1,123,2,3\nMPC,4,2,1,1.,3,1,-1.\n,,4,1,1.\nPARAM,POST,-1\nEIGRL,1\n");
  ASSERT_OPENED(opened);
  const References& references = *opened->deck->references;
  const auto keywords = [&](Referred referred, std::int64_t id) {
    std::vector<std::string> out;
    for (const Reference& reference : references.naming(referred, id)) out.push_back(references.referrers()[reference.referrer].keyword);
    std::sort(out.begin(), out.end());
    return out;
  };
  EXPECT_EQ(keywords(Referred::node, 2), (std::vector<std::string>{"MPC", "RBE2", "SPC1"}));
  EXPECT_EQ(keywords(Referred::node, 4), (std::vector<std::string>{"MPC", "SPC"}));
  EXPECT_EQ(keywords(Referred::node, 5), (std::vector<std::string>{"SPC1"}));
  EXPECT_EQ(keywords(Referred::node, 6), (std::vector<std::string>{"FORCE", "SPC1"}));
  EXPECT_EQ(keywords(Referred::shell, 1), (std::vector<std::string>{"PLOAD4", "SET"}));
  EXPECT_TRUE(references.unread().empty());
}

/// Text longer than a piece is read by several threads: the order must be the deck's all the same.
TEST(NastranPieces, keep_their_order) {
  const DeckFolder folder;
  std::string text = "BEGIN BULK\n";
  const int count = 60000;
  char line[200];
  for (int i = 1; i <= count; ++i) {
    if (i % 3 == 0)
      std::snprintf(line, sizeof line, "GRID*   %16d                %16.6f%16.6f\n*       %16.6f\n", i, i * .5, i % 1000 * -.25, 7.);
    else if (i % 3 == 1)
      std::snprintf(line, sizeof line, "GRID    %8d        %8.1f%8.2f%8.1f\n", i, i * .5, i % 1000 * -.25, 7.);
    else
      std::snprintf(line, sizeof line, "GRID,%d,,%f,%f,7.\n", i, i * .5, i % 1000 * -.25);
    text += line;
    if (i % 1000 == 0) text += "$ a comment\n";
  }
  const auto opened = folder.open(text);
  ASSERT_OPENED(opened);
  ASSERT_EQ(opened->model.node_count(), static_cast<std::size_t>(count));
  for (int i = 1; i <= count; ++i) {
    const auto n = static_cast<std::size_t>(i - 1);
    ASSERT_EQ(opened->model.node_ids[n], i);
    ASSERT_EQ(opened->model.positions[n], Vec3(i * .5, i % 1000 * -.25, 7));
  }
}

TEST(NastranBadInput, is_told_with_its_line) {
  const DeckFolder folder;
  for (const auto& [text, line, words] :
       {std::tuple("GRID,1\nGRID,x\nCROD,1,1,1,2\n", 2, "id above 0"),
        std::tuple("GRID,1\nGRID           2             1.x\nCROD,1,1,1,2\n", 2, "coordinate 1 of GRID 2"),
        std::tuple("GRID,1\nGRID,2,-3\nCROD,1,1,1,2\n", 2, "coordinate system"), std::tuple("GRID,1\nCQUAD4,a\n", 2, "id of a CQUAD4")}) {
    const auto opened = folder.open(text);
    ASSERT_FALSE(opened) << text;
    EXPECT_EQ(opened.error().line, line);
    EXPECT_NE(opened.error().message.find(words), std::string::npos) << opened.error().message;
  }
}

TEST(NastranBadInput, takes_no_time_or_memory_out_of_proportion) {
  const DeckFolder folder;
  const std::string grid = "BEGIN BULK\nGRID,1\n";
  for (const std::string& text :
       {grid + "SPC1,1,123,1,THRU,999999999999999999\nSPOINT,1,THRU,999999999999999999\n", grid + std::string(3000000, ','),
        grid + std::string(3000000, 'x'), grid + "CHEXA,1" + std::string(300000, '\n') + "+", grid + std::string(1000, '\0'),
        grid + "INCLUDE '" + std::string(10000, 'y'), grid + "INCLUDE", grid + "GRID*", grid + "GRID*,2\n*", grid + "GRID    ", [] {
          std::string many = "BEGIN BULK\nRBE2,1,1,123,1\n";
          for (int i = 0; i < 200000; ++i) many += "+\n";
          return many;
        }()}) {
    const auto opened = folder.open(text);
    if (opened) {
      EXPECT_EQ(opened->model.find_node(1).valid() || text.find("RBE2") != std::string::npos, true);
    }
  }
}

TEST(NastranReading, corner_thicknesses_may_lack_or_be_shares_of_the_propertys) {
  const DeckFolder folder;
  const auto thickness = [&](const std::string& fields) {
    const auto opened =
        folder.open("GRID,1,,0.,0.\nGRID,2,,1.,0.\nGRID,3,,1.,1.\nGRID,4,,0.,1.\nCQUAD4,1,1,1,2,3,4\n" + fields + "PSHELL,1,1,2.\n");
    EXPECT_TRUE(opened) << opened.error().text();
    return opened ? static_cast<double>(opened->model.shell_thickness[0]) : -1.0;
  };
  EXPECT_EQ(thickness(""), 0) << "the property's own";
  EXPECT_EQ(thickness(",,,1.,2.,3.,6.\n"), 3);
  EXPECT_EQ(thickness(",,,1.,,3.,\n"), 2) << "a missing thickness is the property's";
  EXPECT_EQ(thickness(",,1,.5,.5,.5,.5\n"), 1) << "shares";
  EXPECT_EQ(thickness(",,1,.5,,.5,\n"), 1.5);
}

TEST(NastranReading, comments_and_blank_lines_between_a_card_and_its_continuation_dont_end_it) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "GRID,1,,0.,0.\nGRID,2,,1.,0.\nGRID,3,,1.,1.\nGRID,4,,0.,1.\nGRID,5,,2.,2.\nGRID,6,,3.,3.\n"
      "CQUAD8,1,1,1,2,3,4,5\n   \n    $ indented\n$ not indented\n,,6\nPSHELL,1,1,2.\n");
  ASSERT_OPENED(opened);
  ASSERT_EQ(opened->model.shell_count(), 1u);
  EXPECT_EQ(corners_of(opened->model, 1), (std::array<std::int64_t, 4>{1, 2, 3, 4}));
  EXPECT_EQ(opened->deck->warnings.size(), 0u);
}

TEST(NastranReading, of_the_constants_of_a_material_the_third_follows_from_two) {
  const DeckFolder folder;
  const auto material = [&](const std::string& card) {
    const auto opened = folder.open("GRID,1,,0.,0.\nGRID,2,,1.,0.\nGRID,3,,1.,1.\nCTRIA3,1,7,1,2,3\nPSHELL,7,9,1.\n" + card);
    EXPECT_TRUE(opened);
    return opened ? part(opened->model, 7) : Part();
  };
  const Part by_e_and_g = material("MAT1,9,200.,80.\n");
  ASSERT_TRUE(by_e_and_g.poissons_ratio);
  EXPECT_NEAR(*by_e_and_g.poissons_ratio, 0.25, 1e-12);
  const Part by_g_and_nu = material("MAT1,9,,80.,.25\n");
  ASSERT_TRUE(by_g_and_nu.youngs_modulus);
  EXPECT_NEAR(*by_g_and_nu.youngs_modulus, 200, 1e-9);
  // in plane stress: G11 = E / (1 - nu2), G12 = nu G11
  const Part by_plane = material("MAT2,9,100.,25.,,100.\n");
  ASSERT_TRUE(by_plane.youngs_modulus && by_plane.poissons_ratio);
  EXPECT_NEAR(*by_plane.poissons_ratio, 0.25, 1e-12);
  EXPECT_NEAR(*by_plane.youngs_modulus, 93.75, 1e-12);
  EXPECT_FALSE(material("MAT2,9,100.,25.,,90.\n").youngs_modulus) << "the directions differ";
}

TEST(NastranReading, corner_thicknesses_of_zero_are_no_surprise) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "BEGIN "
      "BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nCQUAD4,5,1,1,2,3,4\n,,,0.0,0.0,0.0,0.0\nENDDATA\n");
  ASSERT_OPENED(opened);
  ASSERT_EQ(opened->model.shell_count(), 1u);
  EXPECT_EQ(opened->model.shell_thickness[0], 0.0f);
}

class NastranRealDecks : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* models = std::getenv("PRISMESH_MODELS");
    if (!models || !fs::exists(fs::path(models) / "counts.json")) {
      std::cout << "PRISMESH_MODELS doesn't point to the real decks: THE TESTS ON THEM ARE SKIPPED\n";
      GTEST_SKIP();
    }
    models_ = models;
    std::ifstream in(models_ / "counts.json");
    counts_ = nlohmann::json::parse(in);
  }
  fs::path models_;
  nlohmann::json counts_;
};

/// The counter doesn't know every kind of element and property, and takes what stands in a property's place for one on cards that have
/// none (RBE2, CONM2); of properties it misses those behind tabs, and those of springs, dampers, masses, shear panels and the like.
TEST_F(NastranRealDecks, have_the_counts_of_the_independent_counter) {
  const std::map<std::string, std::size_t> more_properties{{"bwb_saero", 67}, {"cqra00366", 54}, {"d200obus", 28}};
  const std::map<std::string, std::size_t> used_properties{{"aero2728_dfem", 95}, {"bwb_saero", 63},   {"cqra00366", 54},
                                                           {"d200obus", 28},      {"isat_launch", 33}, {"wingbox_stitched", 5}};
  std::size_t decks = 0;
  for (const auto& [id, wanted] : counts_.items()) {
    if (wanted["format"] != "nastran") continue;
    SCOPED_TRACE(id);
    ++decks;
    const auto opened = deck::open(models_ / wanted["main"].get<std::string>());
    if (id == "nastran95_d08012a") {
      ASSERT_FALSE(opened);
      EXPECT_EQ(opened.error().line, 17);
      EXPECT_NE(opened.error().message.find("CQUAD1"), std::string::npos);
      EXPECT_NE(opened.error().message.find("400 of them"), std::string::npos);
      continue;
    }
    ASSERT_OPENED(opened);
    EXPECT_EQ(opened->model.node_count(), wanted["nodes"]);
    EXPECT_EQ(opened->deck->element_cards.shells(), wanted["shells"]);
    for (const auto& [kind, count] : wanted["elements"].items()) EXPECT_EQ(kind_count(*opened->deck, kind), count) << kind;
    std::size_t defined = 0;
    for (const Part& p : *opened->model.parts) defined += p.defined;
    EXPECT_EQ(defined, more_properties.contains(id) ? more_properties.at(id) : wanted["parts_defined"].get<std::size_t>());
    std::vector<bool> used(opened->model.parts->size());
    for (std::size_t s = 0; s < opened->model.shell_count(); ++s) used[opened->model.shell_parts[s].value] = true;
    for (const auto& block : opened->model.elements)
      if (block)
        for (const PartIndex p : block->part)
          if (p.valid()) used[p.value] = true;
    EXPECT_EQ(static_cast<std::size_t>(std::count(used.begin(), used.end(), true)),
              used_properties.contains(id) ? used_properties.at(id) : wanted["parts_with_elements"].get<std::size_t>());
    EXPECT_EQ(opened->deck->missing_files, wanted["missing_includes"].get<std::vector<std::string>>());
  }
  EXPECT_EQ(decks, 19u);
}

}  // namespace
}  // namespace prismesh::mesh::deck
