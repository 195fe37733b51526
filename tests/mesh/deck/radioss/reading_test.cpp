// What is read of starter decks: refusals with their line, warnings, groups, units, parts, parameters and submodels.
#include "mesh/deck/open.h"
#include "mesh/deck/radioss/context.h"
#include "mesh/deck/radioss/definitions.h"
#include "tests/mesh/deck/radioss/starter_deck.h"

namespace prismesh::mesh::deck {
namespace {

const std::string kBlankId(10, ' ');

TEST_F(Radioss, says_what_it_takes_for_granted) {
  const auto without = open("#RADIOSS STARTER\n" + kSquare + "/END\n");
  ASSERT_OPENED(without);
  EXPECT_EQ(warning(*without->deck, "no-begin").message,
            "the deck has no /BEGIN, which tells its version; it is read as one of version 51 or later");
  EXPECT_EQ(position_of(without->model, 3), Vec3(1, 1, 0));
  const auto merging = open(std::string(kHead) + kSquare + "/CNODE\n" + node(5, "1", "2", "3") + "/END\n");
  ASSERT_OPENED(merging);
  const Warning said = warning(*merging->deck, "merging-nodes");
  EXPECT_EQ(said.line, 12);
  EXPECT_EQ(said.message, "nodes of /CNODE are put together with nodes at the same place when the solver starts; they are shown apart");
  EXPECT_EQ(position_of(merging->model, 5), Vec3(1, 2, 3));
  EXPECT_EQ(warning(*merging->deck, "no-begin").count, 0u);
}

TEST_F(Radioss, names_each_card_that_cant_be_read) {
  const std::string quad = "/SHELL/1\n" + card({1, 1, 2, 3, 4}), behind_quad = quad.substr(0, quad.size() - 1) + std::string(30, ' ');
  struct Case {
    std::string cards, message;
    long line;
  };
  const Case cases[] = {
      {"/NODE\n" + node(1, "0", "0", "0") + node(-3, "0", "0", "0"), "a node needs an id above 0, but this card has \"        -3\"", 9},
      {"/NODE\n" + kBlankId + reals({"1", "2", "3"}) + "\n", "a node needs an id above 0, but this card has \"          \"", 8},
      {"/NODE\n" + node(1, "0", "0", "1.2.3"), "expected the z coordinate of node 1 but found \"               1.2.3\"", 8},
      {"/SHELL/1\n" + right("1", 10) + right("x", 10) + card({2, 3, 4}), "expected an id but found \"         x\"", 8},
      {"/SHELL/1\n" + right("y", 10) + card({1, 2, 3, 4}), "expected an element id but found \"         y\"", 8},
      {"/BRIC20/1\n" + card({1, 1, 2, 3, 4, 5, 6, 7, 8}) + right("z", 10) + "\n", "expected an id but found \"         z\"", 9},
      {"/BEAM/1\n" + card({-1, 1, 2}), "an element needs an id above 0", 8},
      {behind_quad + right("thick", 20) + "\n", "expected the thickness of shell 1 but found \"               thick\"", 8},
      {"/UNIT/1\nu\n" + reals({"1", "1e200", "1"}) + "\n/NODE/1\n" + node(1, "1e200", "0", "0"), "node 1 lies too far away for a number",
       11},
  };
  for (const Case& c : cases) {
    const auto opened = open(std::string(kHead) + c.cards + "/END\n");
    ASSERT_FALSE(opened) << c.cards;
    EXPECT_EQ(opened.error().message, c.message);
    EXPECT_EQ(opened.error().line, c.line) << c.message;
    EXPECT_NE(opened.error().file.find("deck_0000.rad"), std::string::npos);
  }
}

TEST_F(Radioss, keeps_a_node_of_id_0_that_no_card_can_name) {
  const std::string text = std::string(kHead) + kSquare + "/NODE\n" + node(0, "5", "5", "5") + node(0, "6", "5", "5") + "/SHELL/1\n" +
                           card({1, 1, 2, 3, 4}) + card({2, 1, 2, 3, 0}) + "/END\n";
  const auto opened = open(text);
  ASSERT_OPENED(opened);
  EXPECT_FALSE(opened->model.find_node(0).valid());
  EXPECT_EQ(opened->model.shell_count(), 2u);
  EXPECT_EQ(opened->deck->element_cards.tri, 1u) << "0 as a fourth node makes a triangle";
  const Warning said = warning(*opened->deck, "unnamed-node");
  EXPECT_EQ(said.count, 2u);
  EXPECT_NE(said.message.find("a node has the id 0"), std::string::npos) << said.message;
}

TEST_F(Radioss, leaves_out_what_an_undefined_parameter_gives) {
  const std::string quad = card({3, 1, 2, 3, 4});
  const auto opened = open(std::string(kHead) + kSquare + "/SHELL/1\n" + card({1, 1, 2, 3, 4}) + right("2", 10) + right("&gone", 10) +
                           card({2, 3, 4}) + quad.substr(0, quad.size() - 1) + std::string(30, ' ') + right("&gone", 20) + "\n/END\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.shell_ids[0], 1);
  EXPECT_EQ(opened->model.shell_ids[1], 3);
  EXPECT_EQ(opened->model.shell_count(), 2u);
  EXPECT_EQ(opened->model.shell_thickness[1], 0.0f);
  EXPECT_EQ(warning(*opened->deck, "undefined-parameter").count, 1u);
  EXPECT_EQ(warning(*opened->deck, "undefined-parameter").line, 14);
}

TEST_F(Radioss, says_which_submodel_of_a_transformation_has_no_nodes) {
  const auto opened = open(std::string(kHead) + kSquare + "/TRANSFORM/TRA/1\nt\n" + kBlankId + reals({"10", "20", "30"}) +
                           std::string(20, ' ') + right("9", 10) + "\n/END\n");
  ASSERT_OPENED(opened);
  const Warning said = warning(*opened->deck, "empty-transform");
  EXPECT_EQ(said.message, "a transformation names submodel 9, which has no nodes");
  EXPECT_EQ(said.line, 12);
  EXPECT_EQ(position_of(opened->model, 2), Vec3(1, 0, 0));
}

// --- includes -------------------------------------------------------------------------------------------------------

TEST_F(Radioss, ends_includes_that_are_nested_too_deep) {
  for (int i = 0; i < 100; ++i)
    folder_.write("f" + std::to_string(i), "/NODE\n" + node(i + 1, "1", "0", "0") + "#include f" + std::to_string(i + 1) + "\n");
  const auto opened = open(std::string(kHead) + "#include f0\n/END\n");
  ASSERT_OPENED(opened);
  const Warning said = warning(*opened->deck, "deep-include");
  EXPECT_EQ(said.count, 1u);
  EXPECT_EQ(said.message, "the include file f64 is nested more than 64 deep; it isn't read");
  EXPECT_EQ(std::filesystem::path(said.file).filename(), "f63");
  EXPECT_EQ(said.line, 3);
  EXPECT_EQ(opened->model.node_count(), 64u);
}

TEST_F(Radioss, holds_what_is_included_twice) {
  folder_.write("twice.inc", "/NODE\n" + node(1, "1", "0", "0") + "#include inner.inc\n");
  folder_.write("inner.inc", node(2, "2", "0", "0"));
  const auto opened = open(std::string(kHead) + "#include twice.inc\n/NODE\n" + node(3, "3", "0", "0") + "#include twice.inc\n/END\n");
  ASSERT_OPENED(opened);
  const Warning said = warning(*opened->deck, "repeated-include");
  EXPECT_EQ(said.count, 1u);
  EXPECT_EQ(said.message, "the include file twice.inc is included twice; its nodes can't be moved");
  EXPECT_EQ(said.line, 10);
  ASSERT_EQ(opened->model.node_count(), 3u);
  for (const std::int64_t id : {1, 2}) EXPECT_EQ(opened->model.node_holds[opened->model.find_node(id).value], kHeldByInclude) << id;
  EXPECT_EQ(opened->model.node_holds[opened->model.find_node(3).value], 0);
}

TEST_F(Radioss, ends_includes_that_are_repeated_too_often) {
  const std::string repeated = "/NODE\n" + node(1, "1", "0", "0") + "#" + std::string(8'000'000, 'x') + "\n";
  const std::size_t most = (std::size_t{1} << 27) / repeated.size();
  folder_.write("large.inc", repeated);
  std::string text(kHead);
  for (std::size_t i = 0; i < most + 4; ++i)
    text += "//SUBMODEL/" + std::to_string(i + 1) + "\ns\n" + card({static_cast<std::int64_t>(100 * i)}) + "#include large.inc\n//ENDSUB\n";
  const auto opened = open(text + "/END\n");
  ASSERT_OPENED(opened);
  const Warning said = warning(*opened->deck, "repeated-include");
  EXPECT_EQ(said.count, 3u);
  EXPECT_EQ(said.message.substr(0, said.message.find(';')), "the include file large.inc is used too often");
  EXPECT_EQ(opened->model.node_count(), most + 1);
}

// --- groups that a transformation moves ------------------------------------------------------------------------------

TEST_F(Radioss, moves_the_members_of_each_kind_of_group) {
  std::string nodes = "/NODE\n";
  for (int i = 1; i <= 9; ++i) nodes += node(i, std::to_string(i).c_str(), "0", "0");
  nodes += "/SHELL/3\n" + card({1, 1, 2, 3}) + "/BEAM/4\n" + card({1, 5, 6}) + "/SHELL/5\n" + card({2, 7, 8, 9});
  const std::string inner = "/GRNOD/NODE/6\ng\n" + card({1}) + "/GRNOD/GENE/7\ng\n" + card({3, 4});
  struct Case {
    std::string group;
    std::vector<std::int64_t> moved;
  };
  const Case cases[] = {
      {"/GRNOD/NODE/5\ng\n" + card({1, 3}) + card({8}), {1, 3, 8}},
      {"/GRNOD/NODENS/5\ng\n" + card({9, 2}), {2, 9}},
      {"/GRNOD/NODE/5\ng\n" + card({1, 2, -2, 0, 4}), {1, 4}},
      {"/GRNOD/GENE/5\ng\n" + card({2, 4, 7, 8}), {2, 3, 4, 7, 8}},
      {"/GRNOD/GEN_INCR/5\ng\n" + card({1, 7, 3}) + card({2, 2, 1}), {1, 2, 4, 7}},
      {"/GRNOD/GEN_INCR/5\ng\n" + card({1, 2, 0, 7, 9, 2}), {1, 2, 7, 9}},
      {"/GRNOD/GENE/5\ng\n" + card({0, 0, 2, 3}) + card({5, 6}), {2, 3, 5, 6}},
      {"/GRNOD/PART/5\ng\n" + card({3, 4}), {1, 2, 3, 5, 6}},
      {"/GRNOD/GRNOD/5\ng\n" + card({6, 7}) + inner, {1, 3, 4}},
      {"/GRNOD/NODE/5\ng\n" + card({1}) + "/GRNOD/NODE/5\nlater\n" + card({2}), {1}},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.group);
    const auto opened =
        open(std::string(kHead) + nodes + c.group + "/TRANSFORM/TRA/1\nt\n" + right("5", 10) + reals({"0", "100", "0"}) + "\n/END\n");
    ASSERT_OPENED(opened);
    EXPECT_EQ(warning(*opened->deck, "unread-transform").count, 0u);
    std::vector<std::int64_t> moved;
    for (std::int64_t id = 1; id <= 9; ++id) {
      const Vec3 at = position_of(opened->model, id);
      EXPECT_EQ(at.x(), static_cast<double>(id));
      if (at.y() == 100) moved.push_back(id);
    }
    EXPECT_EQ(moved, c.moved);
  }
}

TEST_F(Radioss, holds_all_where_the_members_of_a_group_cant_be_told) {
  const std::pair<const char*, std::string> cases[] = {
      {"a group in itself", "/GRNOD/GRNOD/5\ng\n" + card({5})},
      {"all but a group", "/GRNOD/GRNOD/5\ng\n" + card({6, -7}) + "/GRNOD/NODE/6\ng\n" + card({1}) + "/GRNOD/NODE/7\ng\n" + card({2})},
      {"no such group", "/GRNOD/NODE/6\ng\n" + card({1})},
      {"an inner one that isn't there", "/GRNOD/GRNOD/5\ng\n" + card({6})},
      {"of a surface", "/GRNOD/SURF/5\ng\n" + card({6})},
      {"a parameter that isn't there", "/GRNOD/NODE/5\ng\n" + right("&gone", 10) + "\n"},
  };
  for (const auto& [what, group] : cases) {
    SCOPED_TRACE(what);
    const auto opened =
        open(std::string(kHead) + kSquare + group + "/TRANSFORM/TRA/1\nt\n" + right("5", 10) + reals({"0", "100", "0"}) + "\n/END\n");
    ASSERT_OPENED(opened);
    EXPECT_EQ(warning(*opened->deck, "unread-transform").count, 1u);
    for (std::size_t n = 0; n < 4; ++n) EXPECT_EQ(opened->model.node_holds[n], kHeldByFrame);
    EXPECT_EQ(position_of(opened->model, 1), Vec3(0, 0, 0));
  }
}

TEST_F(Radioss, takes_the_groups_and_nodes_of_a_submodel_with_its_offsets) {
  const auto opened = open(std::string(kHead) + kSquare + "/GRNOD/NODE/5\nouter\n" + card({4}) + "//SUBMODEL/1\ns\n" +
                           card({1000, 100, 0, 300}) + kSquare + "/SHELL/3\n" + card({1, 3, 4, 1}) + "/GRNOD/NODE/5\ninner\n" + card({2}) +
                           "/GRNOD/PART/6\npart\n" + card({3}) + "/TRANSFORM/TRA/1\nt\n" + right("5", 10) + reals({"0", "10", "0"}) +
                           "\n/TRANSFORM/TRA/2\nt\n" + right("6", 10) + reals({"9", "9", "9"}) + card({1, 4}) + "//ENDSUB\n/END\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(warning(*opened->deck, "unread-transform").count, 0u);
  EXPECT_EQ(position_of(opened->model, 102), Vec3(1, 10, 0));
  EXPECT_EQ(position_of(opened->model, 2), Vec3(1, 0, 0));
  EXPECT_EQ(position_of(opened->model, 4), Vec3(0, 1, 0));
  // Along 101 to 104, as they stand: nodes 101, 103 and 104 are those of part 303.
  EXPECT_EQ(position_of(opened->model, 101), Vec3(0, 1, 0));
  EXPECT_EQ(position_of(opened->model, 103), Vec3(1, 2, 0));
  EXPECT_EQ(position_of(opened->model, 104), Vec3(0, 2, 0));
  EXPECT_EQ(opened->model.node_holds[opened->model.find_node(104).value], kHeldByFrame);
  EXPECT_EQ(opened->model.node_holds[opened->model.find_node(4).value], 0);
}

TEST_F(Radioss, positions_by_six_nodes) {
  const std::string axes = "/NODE\n" + node(11, "0", "0", "0") + node(12, "1", "0", "0") + node(13, "0", "1", "0") +
                           node(14, "1", "1", "1") + node(15, "1", "2", "1") + node(16, "1", "1", "2");
  const auto opened = open(std::string(kHead) + "//SUBMODEL/1\ns\n\n" + kSquare + "//ENDSUB\n" + axes + "/TRANSFORM/POSITION/1\np\n" +
                           card({0, 11, 12, 13, 14, 15, 16, 1}) + "/END\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(warning(*opened->deck, "unread-transform").count, 0u);
  EXPECT_LT((position_of(opened->model, 2) - Vec3(1, 2, 1)).norm(), 1e-12);
  EXPECT_LT((position_of(opened->model, 4) - Vec3(1, 1, 2)).norm(), 1e-12);
  EXPECT_EQ(opened->model.node_holds[opened->model.find_node(16).value], kHeldByFrame);
}

TEST_F(Radioss, holds_what_cards_without_sense_or_end_move) {
  const std::string of_submodel = std::string(20, ' ') + "         1\n";
  const std::pair<const char*, std::string> cases[] = {
      {"no factor", "/TRANSFORM/SCA/1\nt\n" + kBlankId + reals({"1", "0", "1"}) + of_submodel},
      {"an absurd factor", "/TRANSFORM/SCA/1\nt\n" + kBlankId + reals({"1", "1e7", "1"}) + of_submodel},
      {"a matrix that shears", "/TRANSFORM/MATRIX/1\nt\n" + kBlankId + reals({"1", "0.1", "0", "0"}) + "         1\n" + kBlankId +
                                   reals({"0", "1", "0", "0"}) + "\n" + kBlankId + reals({"0", "0", "1", "0"}) + "\n"},
      {"a matrix without its last row", "/TRANSFORM/MATRIX/1\nt\n" + kBlankId + reals({"1", "0", "0", "0"}) + "         1\n" + kBlankId +
                                            reals({"0", "1", "0", "0"}) + "\n"},
      {"a mirror without a direction",
       "/TRANSFORM/SYM/1\nt\n" + kBlankId + reals({"1", "2", "3"}) + of_submodel + kBlankId + reals({"1", "2", "3"}) + "\n"},
      {"a rotation without its second card", "/TRANSFORM/ROT/1\nt\n" + kBlankId + reals({"1", "2", "3"}) + of_submodel},
      {"a kind that isn't known", "/TRANSFORM/BEND/1\nt\n" + kBlankId + reals({"1", "2", "3"}) + of_submodel},
      {"a node that isn't there", "/TRANSFORM/TRA/1\nt\n" + kBlankId + reals({"1", "2", "3"}) + card({77, 78, 1})},
      {"a submodel and a group",
       "/GRNOD/NODE/5\ng\n" + card({1}) + "/TRANSFORM/TRA/1\nt\n" + right("5", 10) + reals({"1", "2", "3"}) + of_submodel},
      {"a unit that isn't defined", "/TRANSFORM/TRA/1/44\nt\n" + kBlankId + reals({"1", "2", "3"}) + of_submodel},
      {"a point of two numbers",
       "/TRANSFORM/POSITION/1\np\n" + card({0, 0, 0, 0, 0, 0, 0, 1}) + " 0 0 0\n 1 0\n 0 1 0\n 1 1 1\n 1 2 1\n 1 1 2\n"},
      {"a point of four",
       "/TRANSFORM/POSITION/1\np\n" + card({0, 0, 0, 0, 0, 0, 0, 1}) + " 0 0 0\n 1 0 0 0\n 0 1 0\n 1 1 1\n 1 2 1\n 1 1 2\n"},
  };
  for (const auto& [what, transform] : cases) {
    SCOPED_TRACE(what);
    const auto opened = open(std::string(kHead) + "//SUBMODEL/1\ns\n\n" + kSquare + "//ENDSUB\n" + transform + "/END\n");
    ASSERT_OPENED(opened);
    EXPECT_EQ(warning(*opened->deck, "unread-transform").count, 1u);
    EXPECT_EQ(opened->model.node_holds[opened->model.find_node(2).value] & kHeldByFrame, kHeldByFrame);
    EXPECT_EQ(position_of(opened->model, 2), Vec3(1, 0, 0));
  }
}

// --- units, parts, parameters ---------------------------------------------------------------------------------------

TEST(RadiossUnits, are_words_or_numbers) {
  const std::tuple<const char*, char, double> cases[] = {{"kg", 'g', 1},      {"g", 'g', 1e-3},       {"Mg", 'g', 1e3},  {"mg", 'g', 1e-6},
                                                         {" mm ", 'm', 1e-3}, {"m", 'm', 1},          {"cm", 'm', 1e-2}, {"dm", 'm', 0.1},
                                                         {"mum", 'm', 1e-6},  {"s", 's', 1},          {"ms", 's', 1e-3}, {"mus", 's', 1e-6},
                                                         {"us", 's', 1e-6},   {"0.0254", 'm', 0.0254}};
  for (const auto& [code, base, wanted] : cases) {
    const auto factor = radioss::unit_factor(code, base);
    ASSERT_TRUE(factor) << code;
    EXPECT_DOUBLE_EQ(*factor, wanted) << code;
  }
  for (const auto& [code, base] :
       {std::pair("", 'm'), std::pair("ft", 'm'), std::pair("kg", 'm'), std::pair("xm", 'm'), std::pair("0", 'm'), std::pair("-1", 's')})
    EXPECT_EQ(radioss::unit_factor(code, base), std::nullopt) << code;
}

TEST_F(Radioss, finds_the_thickness_where_each_property_keeps_it) {
  // The first card has 1.5 in its first number and 2.5 in its second, the third 3.5 and 4.5.
  const std::string cards = reals({"1.5", "2.5"}) + "\n" + reals({"9", "9"}) + "\n" + reals({"3.5", "4.5"}) + "\n";
  const std::pair<const char*, std::optional<double>> cases[] = {
      {"VOID", 1.5},    {"TYPE0", 1.5},  {"SHELL", 4.5},          {"TYPE1", 4.5},        {"SH_ORTH", 4.5}, {"TYPE9", 4.5},
      {"SH_COMP", 4.5}, {"TYPE10", 4.5}, {"SH_SANDW", 4.5},       {"TYPE11", 4.5},       {"SH_FABR", 4.5}, {"TYPE16", 4.5},
      {"PLY", 2.5},     {"TYPE19", 2.5}, {"SOLID", std::nullopt}, {"BEAM", std::nullopt}};
  for (const auto& [type, wanted] : cases) {
    const auto opened = open(std::string(kHead) + kPart + "/PROP/" + type + "/7\nprop\n" + cards + "/PROP/" + type + "/7\nagain\n" +
                             reals({"8", "8"}) + "\n" + reals({"8", "8"}) + "\n" + reals({"8", "8"}) + "\n/END\n");
    ASSERT_OPENED(opened);
    EXPECT_EQ((*opened->model.parts)[0].thickness, wanted) << type;
    EXPECT_EQ((*opened->model.parts)[0].section, 7);
  }
}

TEST_F(Radioss, finds_the_constants_where_each_material_keeps_them) {
  struct Case {
    const char* law;
    std::optional<double> density, modulus, poisson;
    bool limits;
  };
  // The first card holds 11, 12, 13, the second 21 to 24, each number twenty columns wide.
  const Case cases[] = {{"ELAST", 11, 21, 22, true},
                        {"LAW1", 11, 21, 22, true},
                        {"LAW2", 11, 21, 22, true},
                        {"PLAS_TAB", 11, 21, 22, true},
                        {"LAW36", 11, 21, 22, true},
                        {"COMPSH", 11, 21, 23, true},
                        {"LAW19", 11, 21, 23, true},
                        {"FOAM_PLAS", 11, 21, std::nullopt, true},
                        {"RIGID", 11, 21, 22, false},
                        {"LAW13", 11, 21, 22, false},
                        {"VOID", 11, 12, 13, false},
                        {"LAW0", 11, 12, 13, false},
                        {"LAW93", 11, std::nullopt, std::nullopt, true},
                        {"LAW999", 11, std::nullopt, std::nullopt, true}};
  for (const Case& c : cases) {
    const std::string cards = reals({"11", "12", "13"}) + "\n" + reals({"21", "22", "23", "24"}) + "\n";
    const auto opened = open(std::string(kHead) + kPart + "/MAT/" + c.law + "/8\nmat\n" + cards + "/MAT/ELAST/8\nagain\n" + reals({"1"}) +
                             "\n" + reals({"1", "1"}) + "\n/END\n");
    ASSERT_OPENED(opened);
    const Part& part = (*opened->model.parts)[0];
    EXPECT_EQ(part.density, c.density) << c.law;
    EXPECT_EQ(part.youngs_modulus, c.modulus) << c.law;
    EXPECT_EQ(part.poissons_ratio, c.poisson) << c.law;
    EXPECT_EQ(part.limits_time_step, c.limits) << c.law;
    EXPECT_EQ(part.material, 8);
    EXPECT_EQ(part.name, "plate");
  }
}

TEST_F(Radioss, puts_what_a_block_says_into_the_main_units) {
  const std::string quad = card({1, 1, 2, 3, 4});
  const auto opened =
      open(std::string(kHead) + "/UNIT/3\nSI\n" + reals({"kg", "m", "s"}) + "\n/NODE/3\n" + node(1, "1", "2", "3") + kSquare +
           "/SHELL/1/3\n" + quad.substr(0, quad.size() - 1) + std::string(30, ' ') + right("0.002", 20) + "\n" + kPart +
           "/PROP/SHELL/7/3\np\n\n\n" + reals({"5", "0.003"}) + "\n/MAT/ELAST/8/3\nm\n" + reals({"7800"}) + "\n" + reals({"210e9", "0.3"}) +
           "\n/PROP/SHELL/9/44\np\n\n\n" + reals({"5", "0.003"}) + "\n/PART/2\nq\n" + card({9, 0}) + "/END\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(position_of(opened->model, 1), Vec3(1000, 2000, 3000));
  EXPECT_EQ(position_of(opened->model, 2), Vec3(1, 0, 0));
  EXPECT_FLOAT_EQ(opened->model.shell_thickness[0], 2.0f);
  const Part& part = (*opened->model.parts)[0];
  EXPECT_DOUBLE_EQ(part.thickness.value_or(0), 3);
  EXPECT_DOUBLE_EQ(part.density.value_or(0), 7800e-9);
  EXPECT_DOUBLE_EQ(part.youngs_modulus.value_or(0), 210);
  EXPECT_DOUBLE_EQ(part.poissons_ratio.value_or(0), 0.3);
  EXPECT_EQ((*opened->model.parts)[1].thickness, std::nullopt) << "its unit isn't defined";
}

TEST_F(Radioss, reads_parts_in_the_columns_of_old_versions) {
  const auto opened = open("#RADIOSS STARTER\n/BEGIN\nold\n      44       0\n" + std::string("/PART/1\nplate\n") + card({7, 8, 0}, 8) +
                           "/PROP/SHELL/7\np\n\n\n" + reals({"5", "1.25"}, 16) + "\n/MAT/ELAST/8\nm\n" + reals({"7.8"}, 16) + "\n" +
                           reals({"210", "0.3"}, 16) + "\n/END\n");
  ASSERT_OPENED(opened);
  const Part& part = (*opened->model.parts)[0];
  EXPECT_EQ(part.thickness, 1.25);
  EXPECT_EQ(part.density, 7.8);
  EXPECT_EQ(part.poissons_ratio, 0.3);
}

TEST_F(Radioss, knows_parameters_where_they_hold) {
  const auto parameter = [](const std::string& scope, const std::string& name, const char* value) {
    return "/PARAMETER/" + scope + "/1\nparameter\n" + name + std::string(10 - name.size(), ' ') + right(value, 20) + "\n";
  };
  const auto opened =
      open(std::string(kHead) + parameter("GLOBAL/REAL", "x", "2.5") + parameter("GLOBAL/INTEGER", "id", "7") +
           parameter("GLOBAL/TEXT", "words", "9") + parameter("GLOBAL/REAL", "half", "0.5") + "/NODE\n" + node(1, "&x", "-&x", "0") +
           right("&id", 10) + reals({"1", "2", "3"}) + "\n" + right("&half", 10) + reals({"1", "2", "3"}) + "\n" +
           node(2, "&words", "0", "0") + node(3, "&y", "0", "0") + "//SUBMODEL/1\ns\n" + card({0, 100}) +
           parameter("LOCAL/REAL", "x", "4.5") + parameter("LOCAL/REAL", "y", "6.5") + parameter("GLOBAL/REAL", "later", "8.5") +
           "/NODE\n" + node(1, "&x", "&y", "&id") + "//ENDSUB\n/NODE\n" + node(4, "&later", "0", "0") + "/END\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(position_of(opened->model, 1), Vec3(2.5, -2.5, 0));
  EXPECT_EQ(position_of(opened->model, 7), Vec3(1, 2, 3));
  EXPECT_EQ(position_of(opened->model, 101), Vec3(4.5, 6.5, 7));
  EXPECT_EQ(position_of(opened->model, 4), Vec3(8.5, 0, 0));
  EXPECT_EQ(opened->model.node_count(), 4u) << "a half is no id, a text no number, and y is known in the submodel only";
  EXPECT_EQ(warning(*opened->deck, "undefined-parameter").count, 3u);
  EXPECT_EQ(warning(*opened->deck, "unread-parameter").count, 0u);
  EXPECT_EQ(opened->model.node_holds[opened->model.find_node(101).value], kHeldByParameter);
}

TEST_F(Radioss, reads_a_submodel_by_its_own_version_and_units) {
  const std::string centimetres = "/BEGIN\nsub\n      44         0\n" + reals({"kg", "cm", "s"}, 16) + "\n";
  const auto opened = open(
      std::string(kHead) + "//SUBMODEL/1/V44\nold\n" + card({0, 100}, 8) + "/NODE\n" + node(1, "1", "2", "3", 8) + "//SUBMODEL/3\ninner\n" +
      card({0, 1000}, 8) + "/NODE\n" + node(2, "4.00000000000000", "5.00000000000000", "6", 8) + "//ENDSUB\n//ENDSUB\n//SUBMODEL/2\nnew\n" +
      card({0, 200}) + centimetres + "/NODE\n" + node(1, "1", "2", "3", 8) + "//ENDSUB\n/NODE\n" + node(1, "1", "2", "3") + "/END\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(position_of(opened->model, 101), Vec3(1, 2, 3));
  EXPECT_EQ(position_of(opened->model, 1102), Vec3(4, 5, 6));
  EXPECT_EQ(position_of(opened->model, 201), Vec3(10, 20, 30));
  EXPECT_EQ(position_of(opened->model, 1), Vec3(1, 2, 3));
  EXPECT_EQ(warning(*opened->deck, "nested-submodel").count, 1u);
}

TEST_F(Radioss, names_ids_with_the_offsets_of_their_kind) {
  const auto opened = open(std::string(kHead) + "//SUBMODEL/1\ns\n" + card({1000, 100, 200, 300, 400, 500}) + "/GRNOD/NODE/1\nn\n" +
                           card({1}) + "/GRNOD/PART/2\np\n" + card({2}) + "/GRSHEL/SHEL/3\ns\n" + card({3}) + "/GRNOD/GENE/4\nr\n" +
                           card({4, 6}) + "/SURF/SEG/5\ns\n" + card({1, 7, 8, 9}) + "//ENDSUB\n/END\n");
  ASSERT_OPENED(opened);
  const References& references = *opened->deck->references;
  for (const auto& [referred, id, card_id] :
       {std::tuple(Referred::node, 101, 1001), std::tuple(Referred::part, 302, 1002), std::tuple(Referred::shell, 203, 1003),
        std::tuple(Referred::node, 105, 1004), std::tuple(Referred::node, 109, 1005)}) {
    const auto naming = references.naming(referred, id);
    ASSERT_EQ(naming.size(), 1u) << id;
    EXPECT_EQ(references.referrers()[naming[0].referrer].id, card_id);
  }
  for (const std::int64_t id : {1, 4, 5, 7, 103}) EXPECT_FALSE(references.named(Referred::node, id)) << id;
}

// --- several cards together -----------------------------------------------------------------------------------------

TEST_F(Radioss, moves_by_nodes_where_earlier_cards_have_put_them) {
  const std::string along = "/TRANSFORM/TRA/2\nt\n" + kBlankId + reals({"0", "0", "0"}) + card({1, 12, 1});
  const auto opened =
      open(std::string(kHead) + "//SUBMODEL/1\ns\n\n" + kSquare + "//ENDSUB\n/NODE\n" + node(12, "5", "0", "0") + "/TRANSFORM/TRA/1\nt\n" +
           kBlankId + reals({"0", "10", "0"}) + std::string(20, ' ') + right("1", 10) + "\n" + along + "/END\n");
  ASSERT_OPENED(opened);
  // From node 1, by then at (0 10 0), to node 12: 5 along x and back by 10 along y.
  EXPECT_EQ(position_of(opened->model, 1), Vec3(5, 0, 0));
  EXPECT_EQ(position_of(opened->model, 3), Vec3(6, 1, 0));
}

TEST_F(Radioss, scales_about_one_node_whatever_else_the_card_has) {
  const auto opened = open(std::string(kHead) + "//SUBMODEL/1\ns\n\n" + kSquare + "//ENDSUB\n/NODE\n" + node(12, "1", "0", "0") +
                           "/TRANSFORM/SCA/1\nt\n" + kBlankId + reals({"2", "3", "4"}) + card({12, 77, 1}) + "/END\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(warning(*opened->deck, "unread-transform").count, 0u);
  EXPECT_EQ(position_of(opened->model, 1), Vec3(-1, 0, 0));
  EXPECT_EQ(position_of(opened->model, 3), Vec3(1, 3, 0));
}

TEST_F(Radioss, takes_the_points_of_a_position_in_its_unit_and_its_submodel_from_any_field) {
  const std::string points = " 0 0 0\n 0.001 0 0\n 0 0.001 0\n 0.007 0 0\n 0.007 0.001 0\n 0.006 0 0\n";
  for (const auto& ids : {card({0, 0, 0, 0, 0, 0, 0, 1}), card({0, 0, 0, 0, 0, 0, 0, 0, 1}), card({0, 0, 0, 0, 0, 0, 0, 0, 0, 1})}) {
    const auto opened = open(std::string(kHead) + "/UNIT/3\nSI\n" + reals({"kg", "m", "s"}) + "\n//SUBMODEL/1\ns\n\n" + kSquare +
                             "//ENDSUB\n/TRANSFORM/POSITION/1/3\np\n" + ids + points + "/END\n");
    ASSERT_OPENED(opened);
    EXPECT_EQ(warning(*opened->deck, "unread-transform").count, 0u);
    EXPECT_LT((position_of(opened->model, 2) - Vec3(7, 1, 0)).norm(), 1e-12) << ids;
    EXPECT_LT((position_of(opened->model, 4) - Vec3(6, 0, 0)).norm(), 1e-12) << ids;
  }
}

TEST_F(Radioss, a_group_that_was_moved_stays_in_its_submodel) {
  const auto opened =
      open(std::string(kHead) + "//SUBMODEL/1\ns\n" + card({0, 100}) + kSquare + "/GRNOD/GEN_INCR/5\ng\n" + card({1, 4, 2}) +
           "/TRANSFORM/TRA/1\nt\n" + right("5", 10) + reals({"0", "10", "0"}) + "\n//ENDSUB\n/TRANSFORM/TRA/2\nt\n" + kBlankId +
           reals({"100", "0", "0"}) + std::string(20, ' ') + right("1", 10) + "\n/END\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(position_of(opened->model, 101), Vec3(100, 10, 0));
  EXPECT_EQ(position_of(opened->model, 102), Vec3(101, 0, 0));
  EXPECT_EQ(position_of(opened->model, 103), Vec3(101, 11, 0));
  EXPECT_EQ(opened->deck->offsets_of(opened->deck->run_of(opened->model.find_node(103))).node, 100);
}

TEST_F(Radioss, holds_no_more_than_what_a_card_would_move) {
  const std::string lost = "/TRANSFORM/TRA/1\nt\n", shift = reals({"x", "0", "0"});
  const std::string model = std::string(kHead) + kSquare + "//SUBMODEL/1\ns\n" + card({0, 100}) + kSquare + "//ENDSUB\n";
  const auto held = [](const OpenedDeck& opened) {
    std::vector<std::int64_t> ids;
    for (std::size_t n = 0; n < opened.model.node_count(); ++n)
      if (opened.model.node_holds[n] == kHeldByFrame) ids.push_back(opened.model.node_ids[n]);
    return ids;
  };
  const auto of_submodel = open(model + lost + kBlankId + shift + std::string(20, ' ') + right("1", 10) + "\n/END\n");
  ASSERT_OPENED(of_submodel);
  EXPECT_EQ(held(*of_submodel), (std::vector<std::int64_t>{101, 102, 103, 104}));
  const auto of_group = open(model + "/GRNOD/NODE/5\ng\n" + card({2, 103}) + lost + right("5", 10) + shift + "\n/END\n");
  ASSERT_OPENED(of_group);
  EXPECT_EQ(held(*of_group), (std::vector<std::int64_t>{2, 103}));
}

TEST_F(Radioss, of_parts_defined_twice_the_first_counts) {
  const auto opened = open(std::string(kHead) + kPart + "/PART/1\nagain\n" + card({9, 9, 0}) + "/END\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ((*opened->model.parts)[0].name, "plate");
  EXPECT_EQ((*opened->model.parts)[0].section, 7);
}

TEST_F(Radioss, knows_the_unit_that_the_deck_is_in) {
  for (const auto& [unit, wanted] : {std::pair("m", std::optional(LengthUnit::m)), std::pair("mm", std::optional(LengthUnit::mm)),
                                     std::pair("cm", std::optional<LengthUnit>())}) {
    const std::string units = reals({"kg", unit, "s"}) + "\n";
    const auto opened = open("#RADIOSS STARTER\n/BEGIN\ndeck\n      2022         0\n" + units + units + kSquare + "/END\n");
    ASSERT_OPENED(opened);
    EXPECT_EQ(opened->deck->length_unit, wanted) << unit;
  }
}

TEST_F(Radioss, takes_the_first_begin_of_the_main_file) {
  const std::string centimetres = "/BEGIN\nother\n        44         0\n" + reals({"kg", "cm", "s"}, 16) + "\n";
  folder_.write("begins.inc", centimetres);
  const auto opened = open("#RADIOSS STARTER\n#include begins.inc\n" + std::string(kHead) + centimetres + "/UNIT/3\nSI\n" +
                           reals({"kg", "m", "s"}) + "\n/NODE/3\n" + node(1, "1.234567890123", "0.5", "0") + "/END\n");
  ASSERT_OPENED(opened);
  EXPECT_NEAR(position_of(opened->model, 1).x(), 1234.567890123, 1e-9);
  EXPECT_EQ(position_of(opened->model, 1).y(), 500);
  EXPECT_EQ(opened->deck->length_unit, LengthUnit::mm);
}

TEST_F(Radioss, looks_for_units_and_parameters_in_the_submodels_around) {
  const auto unit = [](const char* length) { return "/UNIT/3\nunit\n" + reals({"kg", length, "s"}) + "\n"; };
  const auto local = [](const char* value) { return "/PARAMETER/LOCAL/REAL/1\nparameter\nv         " + right(value, 20) + "\n"; };
  const auto opened =
      open(std::string(kHead) + unit("m") + "//SUBMODEL/1\nouter\n" + card({0, 100}) + unit("cm") + local("2") + "//SUBMODEL/2\ninner\n" +
           card({0, 200}) + "/NODE/3\n" + node(1, "&v", "0", "0") + "//ENDSUB\n//ENDSUB\n" + "//SUBMODEL/3\nother\n" + card({0, 1000}) +
           local("7") + "/NODE/3\n" + node(1, "&v", "0", "0") + "//ENDSUB\n/END\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(position_of(opened->model, 301), Vec3(20, 0, 0));
  EXPECT_EQ(position_of(opened->model, 1001), Vec3(7000, 0, 0));
}

TEST_F(Radioss, tells_submodels_that_dont_begin_or_end_and_uses_no_absurd_offsets) {
  const auto ended = open(std::string(kHead) + "//ENDSUB\n" + kSquare + "/END\n");
  ASSERT_OPENED(ended);
  EXPECT_EQ(warning(*ended->deck, "open-submodel").message, "//ENDSUB stands here without a //SUBMODEL");
  EXPECT_EQ(warning(*ended->deck, "open-submodel").line, 7);
  const auto begun =
      open(std::string(kHead) + "//SUBMODEL/1\ns\n" + right("0", 10) + right("1E15", 10) + "\n/NODE\n" + node(1, "1", "2", "3") + "/END\n");
  ASSERT_OPENED(begun);
  EXPECT_EQ(warning(*begun->deck, "open-submodel").message, "the submodel isn't closed by //ENDSUB");
  EXPECT_EQ(warning(*begun->deck, "open-submodel").line, 7);
  EXPECT_EQ(position_of(begun->model, 1), Vec3(1, 2, 3));
}

TEST_F(Radioss, reads_the_starters_part_of_a_deck_for_both_programs) {
  const auto opened = open("#RADIOSS STARTER\n/RUN/deck/1\n10.\n/PRINT/-1\n/WHATEVER/1\nw\n" + card({1}) + "/END/ENGINE\n" +
                           std::string(kHead) + kSquare + "$ a comment too\n" + node(5, "5", "0", "0") + "/END\n");
  ASSERT_OPENED(opened);
  EXPECT_TRUE(opened->deck->references->unread().empty());
  EXPECT_EQ(opened->model.node_count(), 5u);
}

TEST_F(Radioss, adds_offsets_to_elements_of_every_kind) {
  const auto opened =
      open(std::string(kHead) + "//SUBMODEL/1\ns\n" + card({1000, 100, 200, 300}) + kSquare + "/BEAM/4\n" + card({1, 1, 2, 3}) +
           "/SPHCEL/8\n" + card({4, 1}) + "/TH/SPHCEL/1\nhistory\nDEF\n" + card({4}) + "/ADMAS/5/10\nmass\n" + right("0.5", 20) +
           card({2}) + "/GRNOD/NODE/1/left\nset\n" + card({31, 32, 33, 34, 35, 36, 37, 38, 39, 40}) + card({-41}) + "//ENDSUB\n/END\n");
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  const ElementBlock& beams = *model.elements[static_cast<std::size_t>(ElementClass::beam)];
  EXPECT_EQ(beams.id[0], 201);
  EXPECT_EQ(beams.nodes[1], model.find_node(102));
  EXPECT_EQ(beams.part[0], model.find_part(304));
  const ElementBlock& particles = *model.elements[static_cast<std::size_t>(ElementClass::sph)];
  EXPECT_EQ(particles.id[0], 104);
  EXPECT_EQ(particles.nodes[0], model.find_node(104));
  const References& references = *opened->deck->references;
  const auto named_by = [&](Referred referred, std::int64_t id) {
    const auto naming = references.naming(referred, id);
    const Referrer* card = naming.size() == 1 ? &references.referrers()[naming[0].referrer] : nullptr;
    return card ? card->keyword + " " + std::to_string(card->id) + (naming[0].takes_away ? " without it" : "") : std::string("nobody");
  };
  EXPECT_EQ(named_by(Referred::sph, 104), "TH/SPHCEL 1001");
  EXPECT_EQ(named_by(Referred::node, 103), "BEAM 0");
  EXPECT_EQ(named_by(Referred::node, 102), "ADMAS 1010");
  EXPECT_EQ(named_by(Referred::node, 140), "GRNOD/NODE 1001");
  EXPECT_EQ(named_by(Referred::node, 141), "GRNOD/NODE 1001 without it");
}

TEST_F(Radioss, keeps_all_text_of_a_block_that_nobody_understands) {
  folder_.write("more.inc", card({77}));
  const auto opened = open(std::string(kHead) + kSquare + "/WHATEVER/1\nw\n" + card({1}) + "#include more.inc\n" + card({2}) + "/END\n");
  ASSERT_OPENED(opened);
  std::string kept;
  for (const UnreadText& unread : opened->deck->references->unread())
    kept += std::string(opened->deck->files[unread.file].bytes.text().substr(unread.begin, unread.end - unread.begin));
  EXPECT_EQ(kept, "/WHATEVER/1\nw\n" + card({1}) + card({77}) + card({2}));
}

}  // namespace
}  // namespace prismesh::mesh::deck
