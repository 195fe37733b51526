// Includes: where they are searched for, what is held, which warnings a missing one gives; and parameters across includes.
#include "mesh/deck/lsdyna/parameters.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

std::string node(int id) { return "*NODE\n" + std::to_string(id) + "," + std::to_string(id) + ".,0.,0.\n"; }

TEST(Includes, are_read_where_they_stand) {
  const DeckFolder folder;
  folder.write("a.k", "*KEYWORD\n" + node(2) + "*END\n" + node(99));
  folder.write("sub/b.k", node(4) + "*INCLUDE\n../c.k\n");
  folder.write("c.k", node(5));
  const auto opened = folder.open("*KEYWORD\n" + node(1) + "*INCLUDE\na.k\n" + node(3) + "*include\nsub/b.k\n" + node(6) + "*END\n");
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  ASSERT_EQ(model.node_count(), 6u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(model.node_ids[i], static_cast<std::int64_t>(i + 1));
  const Deck& deck = *opened->deck;
  ASSERT_EQ(deck.files.size(), 4u);
  EXPECT_EQ(deck.files[0].relative, "deck.k");
  EXPECT_EQ(deck.files[1].relative, "a.k");
  EXPECT_EQ(deck.files[2].relative, "sub/b.k");
  EXPECT_EQ(deck.files[3].relative, "c.k");
  EXPECT_EQ(deck.run_of(model.find_node(5)).file, 3u);
  EXPECT_TRUE(deck.warnings.empty());
}

TEST(Includes, names_go_on_after_a_plus_and_comments_dont_count) {
  const DeckFolder folder;
  folder.write("a long name.k", node(1));
  folder.write("win/b.k", node(2));
  const auto opened = folder.open("*INCLUDE\n$ a comment\na lo +\nng name.k\n*INCLUDE\nwin\\b.k\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.node_count(), 2u);
}

TEST(Includes, names_may_have_quotes_tabs_and_parameters) {
  const DeckFolder folder;
  folder.write("it's.k", node(1));
  folder.write("longname.k", node(2));
  folder.write("win/sub/c.k", node(3));
  folder.write("left7_x.k", node(4));
  folder.write("at_&half.k", node(5));
  const auto opened = folder.open(
      "*PARAMETER\nCside           left\nInumber          7.9\nRhalf           0.5\n*INCLUDE\n'it's.k'\n*INCLUDE\nlong\t+\n name.k\n"
      "*INCLUDE_PATH\nwin\\sub\n*INCLUDE\nc.k\n*INCLUDE\n&side&number_x.k\n*INCLUDE\nat_&half.k\n");
  ASSERT_OPENED(opened);
  for (const Warning& warning : opened->deck->warnings) ADD_FAILURE() << warning.message;
  EXPECT_EQ(opened->model.node_count(), 5u) << "\"long\" and \"name.k\" are put together without a blank";
}

TEST(Includes, of_no_nodes_may_be_repeated_and_those_by_other_keywords_count) {
  const DeckFolder folder;
  folder.write("values.k", "*PARAMETER_MUTABLE\nRv          1.0\n");
  folder.write("mesh.k", node(1));
  const auto opened = folder.open("*INCLUDE\nvalues.k\n*INCLUDE\nvalues.k\n*INCLUDE_NASTRAN\nmesh.k\n*INCLUDE\nmesh.k\n" + node(2));
  ASSERT_OPENED(opened);
  EXPECT_EQ(warning(*opened->deck, "repeated-include").count, 0u);
  EXPECT_EQ(opened->model.node_holds[opened->model.find_node(1).value], kHeldByInclude);
  EXPECT_EQ(opened->model.node_holds[opened->model.find_node(2).value], 0);
}

TEST(Includes, are_found_along_the_paths) {
  const DeckFolder folder;
  folder.write("models/door.k", node(1));
  folder.write("more/hood.k", node(2));
  const auto opened = folder.open("*INCLUDE_PATH_RELATIVE\nmodels\n*INCLUDE_PATH\nnowhere\n" + (folder / "more").string() +
                                  "\n*INCLUDE\ndoor.k\n*INCLUDE\nhood.k\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.node_count(), 2u);
  EXPECT_EQ(opened->deck->files[1].relative, "models/door.k");
}

TEST(Includes, missing_ones_are_warned_of_one_by_one) {
  const DeckFolder folder;
  const auto opened = folder.open("*KEYWORD\n*INCLUDE\nlost.k\n*INCLUDE\ngone.k\nlost.k\n" + node(1) + "*END\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->deck->missing_files, (std::vector<std::string>{"lost.k", "gone.k", "lost.k"}));
  const std::vector<Warning>& missing = opened->deck->warnings;
  ASSERT_EQ(missing.size(), 2u);
  EXPECT_EQ(missing[0].message, "the include file lost.k isn't there");
  EXPECT_EQ(missing[0].line, 3);
  EXPECT_EQ(missing[0].count, 2u);
  EXPECT_EQ(missing[1].message, "the include file gone.k isn't there");
  EXPECT_EQ(missing[1].line, 5);
  EXPECT_EQ(missing[1].count, 1u);
}

TEST(Includes, very_many_missing_ones_are_counted_in_the_end) {
  const DeckFolder folder;
  std::string text = "*KEYWORD\n*INCLUDE\n";
  for (int i = 0; i < 150; ++i) text += "lost" + std::to_string(i) + ".k\n";
  const auto opened = folder.open(text + "*END\n");
  ASSERT_OPENED(opened);
  ASSERT_EQ(opened->deck->warnings.size(), 101u);
  EXPECT_EQ(opened->deck->warnings[99].message, "the include file lost99.k isn't there");
  EXPECT_EQ(opened->deck->warnings[100].count, 50u);
}

TEST(Includes, circles_end_and_hold_their_nodes) {
  const DeckFolder folder;
  folder.write("a.k", node(1) + "*INCLUDE\nb.k\n");
  folder.write("b.k", node(2) + "*INCLUDE\na.k\n*INCLUDE\ndeck.k\n");
  const auto opened = folder.open("*INCLUDE\na.k\n" + node(3));
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.node_count(), 3u);
  EXPECT_EQ(warning(*opened->deck, "circular-include").count, 2u);
}

TEST(Includes, nodes_of_a_file_used_twice_are_held) {
  const DeckFolder folder;
  folder.write("twice.k", node(1) + "*INCLUDE\ninner.k\n");
  folder.write("inner.k", node(2));
  folder.write("once.k", node(3));
  const auto opened = folder.open("*INCLUDE\ntwice.k\n*INCLUDE\nonce.k\n*INCLUDE\ntwice.k\n" + node(4));
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  ASSERT_EQ(model.node_count(), 4u);
  EXPECT_EQ(model.node_holds[model.find_node(1).value], kHeldByInclude);
  EXPECT_EQ(model.node_holds[model.find_node(2).value], kHeldByInclude);
  EXPECT_EQ(model.node_holds[model.find_node(3).value], 0);
  EXPECT_EQ(model.node_holds[model.find_node(4).value], 0);
  EXPECT_EQ(warning(*opened->deck, "repeated-include").count, 1u);
}

TEST(Includes, deep_nesting_ends_with_a_warning) {
  const DeckFolder folder;
  for (int i = 0; i < 100; ++i) folder.write("f" + std::to_string(i) + ".k", node(i + 2) + "*INCLUDE\nf" + std::to_string(i + 1) + ".k\n");
  const auto opened = folder.open(node(1) + "*INCLUDE\nf0.k\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(warning(*opened->deck, "deep-include").count, 1u);
  EXPECT_EQ(opened->model.node_count(), 65u);
}

TEST(Includes, a_transformation_that_does_nothing_is_a_plain_include) {
  const DeckFolder folder;
  folder.write("same.k", node(2));
  const auto opened = folder.open(
      "*INCLUDE_TRANSFORM\nsame.k\n         0         0         0\n         0\n       1.0       1.0       1.0                   1\n        "
      " 0\n");
  ASSERT_OPENED(opened);
  EXPECT_TRUE(opened->model.find_node(2).valid());
  EXPECT_TRUE(opened->deck->warnings.empty());
  EXPECT_EQ(opened->deck->frames.size(), 1u);
}

TEST(Parameters, stand_where_a_number_is_expected) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "*PARAMETER\n"
      "R    width      12.5I    first         7\n"
      "rheight,3.25,iPart,9\n"
      "*NODE\n"
      "  &first          &WIDTH         -&width             1.0\n"
      "8,&height,0.,&width\n"
      "       9             1.0\n"
      "*ELEMENT_SHELL\n"
      "       1   &part  &first       8       9\n");
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  EXPECT_EQ(position_of(model, 7), Vec3(12.5, -12.5, 1));
  EXPECT_EQ(position_of(model, 8), Vec3(3.25, 0, 12.5));
  EXPECT_EQ(model.node_holds[0], kHeldByParameter);
  EXPECT_EQ(model.node_holds[2], 0);
  EXPECT_EQ((*model.parts)[model.shell_parts[0].value].id, 9);
}

TEST(Parameters, local_ones_end_with_their_file) {
  const DeckFolder folder;
  folder.write("a.k", "*PARAMETER_LOCAL\nRv          5.0\n*NODE\n1,&v,&g\n*PARAMETER\nRlate       8.0\n");
  folder.write("b.k", "*NODE\n2,&v,&g,&late\n");
  const auto opened = folder.open("*PARAMETER\nRg          2.0\nRv          1.0\n*INCLUDE\na.k\n*INCLUDE\nb.k\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(position_of(opened->model, 1), Vec3(5, 2, 0));
  EXPECT_EQ(position_of(opened->model, 2), Vec3(1, 2, 8));
}

TEST(Parameters, that_lack_leave_the_card_out_and_are_warned_of) {
  const DeckFolder folder;
  const auto opened = folder.open("*NODE\n1,&nowhere,0.,0.\n2,1.,0.,0.\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.node_count(), 1u);
  EXPECT_EQ(warning(*opened->deck, "undefined-parameter").count, 1u);
  EXPECT_EQ(warning(*opened->deck, "undefined-parameter").line, 2);
}

TEST(Parameters, expressions_are_arithmetic) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "*PARAMETER\nR    tEnd       5.0\n"
      "*PARAMETER_EXPRESSION\n"
      "R     one  TEnd/100.0\n"
      "R     two  tEnd*2./3.\n"
      "R   three  -(1.5+&one)**2 + max(2,\n"
      "           sqrt(16.0))\n"
      "*NODE\n1,&one,&two,&three\n");
  ASSERT_OPENED(opened);
  EXPECT_DOUBLE_EQ(position_of(opened->model, 1).x(), 0.05);
  EXPECT_DOUBLE_EQ(position_of(opened->model, 1).y(), 10.0 / 3);
  EXPECT_DOUBLE_EQ(position_of(opened->model, 1).z(), 1.55 * 1.55 + 4);
}

TEST(Parameters, keep_their_first_value_unless_they_may_change) {
  const auto x = [](const std::string& first, const std::string& between, const std::string& second) {
    const DeckFolder folder;
    const auto opened = folder.open(between + first + "\nRv          1.0\n" + second + "\nRv          2.0\n*NODE\n1,&v\n");
    EXPECT_TRUE(opened);
    return std::pair(position_of(opened->model, 1).x(), warning(*opened->deck, "duplicate-parameter").count);
  };
  const std::string plain = "*PARAMETER";
  EXPECT_EQ(x(plain, "", plain), std::pair(1.0, std::size_t{1}));
  EXPECT_EQ(x("*PARAMETER_MUTABLE", "", plain), std::pair(2.0, std::size_t{0}));
  EXPECT_EQ(x(plain, "", "*PARAMETER_MUTABLE"), std::pair(1.0, std::size_t{1}));
  EXPECT_EQ(x(plain, "", "*PARAMETER_LOCAL"), std::pair(2.0, std::size_t{0}));
  EXPECT_EQ(x(plain, "*PARAMETER_DUPLICATION\n         2\n", plain), std::pair(2.0, std::size_t{1}));
  EXPECT_EQ(x(plain, "*PARAMETER_DUPLICATION\n         4\n*PARAMETER_DUPLICATION\n         1\n", plain), std::pair(2.0, std::size_t{0}));
  EXPECT_EQ(x(plain, "*PARAMETER_DUPLICATION\n         5\n", plain), std::pair(1.0, std::size_t{0}));
}

TEST(Parameters, of_includes_side_by_side_see_each_others_global_ones) {
  const DeckFolder folder;
  folder.write("a.k", "*PARAMETER\nRscale        1.0\n*NODE\n1,&scale\n");
  folder.write("b.k", "*PARAMETER\nRscale        2.0\n*NODE\n2,&scale\n");
  folder.write("c.k", "*NODE\n3,&scale\n");
  folder.write("d.k", "*PARAMETER_LOCAL\nRscale        4.0\n*INCLUDE\ne.k\n*NODE\n5,&scale\n");
  folder.write("e.k", "*PARAMETER_LOCAL\nRscale        5.0\n*NODE\n4,&scale\n");
  const auto opened = folder.open("*INCLUDE\na.k\nb.k\nd.k\nc.k\n");
  ASSERT_OPENED(opened);
  const auto x = [&](std::int64_t id) { return position_of(opened->model, id).x(); };
  EXPECT_EQ(x(1), 1);
  EXPECT_EQ(x(2), 1);
  EXPECT_EQ(x(4), 5);
  EXPECT_EQ(x(5), 4);
  EXPECT_EQ(x(3), 1);
}

TEST(Parameters, of_text_and_expressions_stand_in_names_and_fields) {
  const DeckFolder folder;
  folder.write("door_left7.k", "*NODE\n1,1.\n2,<2*&w+1>\n");
  const auto opened = folder.open(
      "*PARAMETER\nCside           leftInumber          7.9\nR        w       3.0\n*PARAMETER_TYPE\nIpart     "
      "        42PART\n*INCLUDE\ndoor_&side&number.k\n"
      "*NODE\n3,0.,1.\n*ELEMENT_SHELL\n1,&part,1,2,3\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(warning(*opened->deck, "bad-parameter").count, 0u);
  EXPECT_EQ(opened->model.node_count(), 3u);
  EXPECT_EQ(position_of(opened->model, 2).x(), 7);
  EXPECT_EQ(opened->model.node_holds[1], kHeldByParameter);
  EXPECT_TRUE(opened->model.find_part(42).valid());
}

TEST(Parameters, that_may_change_once_may_change_again) {
  const DeckFolder folder;
  const auto opened =
      folder.open("*PARAMETER_MUTABLE\nRv          1.0\n*PARAMETER\nRv          2.0\n*PARAMETER\nRv          3.0\n*NODE\n1,&v\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(position_of(opened->model, 1).x(), 3);
  EXPECT_EQ(warning(*opened->deck, "duplicate-parameter").count, 0u);
}

TEST(Parameters, of_whole_numbers_are_cut_and_expressions_hold_their_node) {
  const DeckFolder folder;
  const auto opened = folder.open("*PARAMETER\nIn,7.9\n*PARAMETER_EXPRESSION\nI        m 7/2.0\n*NODE\n1,&n,&m\n2,<2*3>\n3,1.\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(position_of(opened->model, 1), Vec3(7, 3, 0));
  EXPECT_EQ(position_of(opened->model, 2), Vec3(6, 0, 0));
  EXPECT_EQ(opened->model.node_holds[1], kHeldByParameter);
  EXPECT_EQ(opened->model.node_holds[2], 0);
}

TEST(Parameters, that_cannot_be_read_are_told) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "*PARAMETER\nRv             x\nQv           1.0\n*PARAMETER_EXPRESSION\nR        w 1/0\n*SECTION_SHELL\n1,2\n&v\n*NODE\n1\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(warning(*opened->deck, "bad-parameter").count, 3u);
  EXPECT_EQ(warning(*opened->deck, "undefined-parameter").line, 6);
}

TEST(Expressions, that_are_none_have_no_value) {
  const lsdyna::Parameters none;
  for (const char* text : {"", "1+", "(1", "1)", "foo", "foo(1)", "1 2", "1/0", "sqrt(-1)", "&"})
    EXPECT_FALSE(lsdyna::evaluate(text, none)) << text;
  EXPECT_FALSE(lsdyna::evaluate(std::string(100000, '('), none));
  EXPECT_FALSE(lsdyna::evaluate("1" + std::string(100000, '*') + "1", none));
  const auto value = [&](const char* text) {
    const auto found = lsdyna::evaluate(text, none);
    EXPECT_TRUE(found.has_value()) << text;
    return found.value_or(lsdyna::ParameterValue()).value;
  };
  EXPECT_EQ(value("2**3**2"), 512);
  EXPECT_EQ(value(" 1.5E+1 - 2*3 "), 9);
  // Whole numbers stay whole, and a sign binds tighter than a power.
  EXPECT_EQ(value("2/5"), 0);
  EXPECT_EQ(value("2.0/5"), 0.4);
  EXPECT_EQ(value("-3**2"), 9);
  EXPECT_EQ(value("2**-1"), 0.5);
  EXPECT_EQ(value("7/2*2.0"), 6);
  EXPECT_EQ(value("2**-1*3/2"), 0.75);
  EXPECT_EQ(value("dim(2,5)"), 0);
  EXPECT_EQ(value("dim(5,2)"), 3);
  EXPECT_EQ(value("atan2(1.0,0.0)"), 1.5707963267948966);
  EXPECT_EQ(value("floor(-1.5)+ceiling(-1.5)+int(-1.5)"), -4);
  for (const char* whole : {"(5-2)/2", "(1+2)/2", "int(3.9)/2", "abs(-3)/2"}) EXPECT_EQ(value(whole), 1) << whole;
  for (const char* real : {"(5-2.0)/2", "(5.0-2)/2", "(1+2.0)/2", "(1.0+2)/2", "float(3)/2", "real(3)/2", "aint(3.9)/2", "abs(-3.0)/2"})
    EXPECT_EQ(value(real), 1.5) << real;
  EXPECT_EQ(value("max(1,5,3) - mod(7,4) + sign(2,-1) + nint(2.6)/2"), 1);
}

}  // namespace
}  // namespace prismesh::mesh::deck
