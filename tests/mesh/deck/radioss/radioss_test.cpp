// Radioss starter decks of our own: what is read, where it is shown, what is written back.
#include "mesh/deck/formats/formats.h"
#include "mesh/deck/open.h"
#include "mesh/deck/save.h"
#include "tests/mesh/deck/radioss/starter_deck.h"

namespace prismesh::mesh::deck {
namespace {

bool all_is_understood(const Deck& deck) {
  std::size_t odd = 0;
  for (const char* kind : {"unread-card", "unread-transform", "empty-transform", "undefined-unit"}) odd += warning(deck, kind).count;
  return odd == 0;
}

TEST_F(Radioss, reads_every_kind_of_element) {
  std::string text(kHead);
  text += "/NODE\n";
  for (int i = 1; i <= 20; ++i) text += node(i, std::to_string(i).c_str(), "0", "0");
  text += "/SHELL/1\n" + card({1, 1, 2, 3, 4}) + card({2, 1, 2, 3, 3}) + "/SH3N/1\n" + card({3, 1, 2, 3});
  text += "/BRICK/2\n" + card({1, 1, 2, 3, 4, 5, 6, 7, 8}) + "/TETRA4/2\n" + card({2, 1, 2, 3, 4}) + "/TETRA10/2\n" + card({3}) +
          card({1, 2, 3, 4, 5, 6, 7, 8, 9, 10}) + "/BRIC20/2\n" + card({4, 1, 2, 3, 4, 5, 6, 7, 8}) +
          card({9, 10, 11, 12, 13, 14, 15, 16}) + card({17, 18, 19, 20}) + "/PENTA6/2\n" + card({5, 1, 2, 3, 4, 5, 6}) + "/SHEL16/3\n" +
          card({6, 1, 2, 3, 4, 5, 6, 7, 8}) + card({9, 10, 11, 12}) + card({13, 14, 15, 16});
  text += "/BEAM/4\n" + card({1, 1, 2, 9}) + "/TRUSS/5\n" + card({2, 1, 2}) + "/SPRING/6\n" + card({3, 1, 2, 10}) + "/QUAD/7\n" +
          card({1, 1, 2, 3, 4}) + "/SPHCEL/8\n" + card({20, 1}) + "/XELEM/9\n" + card({5, 77}) + "/END\n/SHELL/1\n" +
          card({99, 1, 2, 3, 4});
  const auto opened = open(text);
  ASSERT_OPENED(opened);
  const ElementCounts& counts = opened->deck->element_cards;
  EXPECT_EQ(counts.quad, 1u);
  EXPECT_EQ(counts.tri, 2u);
  EXPECT_EQ(counts.solid, 5u);
  EXPECT_EQ(counts.tshell, 1u);
  EXPECT_EQ(counts.beam, 2u);
  EXPECT_EQ(counts.other, 4u);
  EXPECT_EQ(opened->deck->element_kinds.at("BRIC20"), 1u);
  EXPECT_EQ(opened->deck->element_kinds.at("SHELL"), 2u) << "what follows /END doesn't count";
  const auto& solids = *opened->model.elements[static_cast<std::size_t>(ElementClass::solid)];
  EXPECT_EQ(solids.first_node, (std::vector<std::uint32_t>{0, 8, 12, 22, 42, 48}));
  EXPECT_EQ(opened->model.elements[static_cast<std::size_t>(ElementClass::sph)]->nodes[0], opened->model.find_node(20));
  // A beam's third node only gives a direction, and so does a spring's.
  EXPECT_EQ(opened->model.elements[static_cast<std::size_t>(ElementClass::beam)]->nodes.size(), 4u);
  const auto naming = opened->deck->references->naming(Referred::node, 9);
  ASSERT_EQ(naming.size(), 1u);
  EXPECT_EQ(opened->deck->references->referrers()[naming[0].referrer].keyword, "BEAM");
  EXPECT_TRUE(opened->deck->references->named(Referred::node, 10));
}

TEST_F(Radioss, reads_and_writes_the_eight_columns_of_old_versions) {
  const std::string text = "#RADIOSS STARTER\n/BEGIN\nold\n      44       0\n/NODE\n" + node(1, "0.", "0.", "0.", 8) +
                           node(2, "1.5", "0.", "0.", 8) + node(3, "1.", "1.", "0.", 8) + node(4, "0.", "1.", "0.", 8) + "/SHELL/1\n" +
                           card({1, 1, 2, 3, 4}, 8) + "/END\n";
  const auto opened = open(text);
  ASSERT_OPENED(opened);
  EXPECT_EQ(position_of(opened->model, 2), Vec3(1.5, 0, 0));
  EXPECT_EQ(corners_of(opened->model, 1), (std::array<std::int64_t, 4>{1, 2, 3, 4}));
  std::string wanted = text;
  const std::string before = node(2, "1.5", "0.", "0.", 8);
  wanted.replace(wanted.find(before), before.size(), node(2, "1.25", "0.", "-3.0", 8));
  EXPECT_EQ(saved(*opened, 2, Vec3(1.25, 0, -3)), wanted);
}

TEST_F(Radioss, rewrites_only_the_moved_coordinates) {
  std::string text = std::string(kHead) + kSquare + "/SHELL/1\n" + card({1, 1, 2, 3, 4}) + kPart + "/END\n";
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.replace(at, 1, "\r\n");
  const auto opened = open(text);
  ASSERT_OPENED(opened);
  EXPECT_EQ(saved(*opened, 1, Vec3(0, 0, 0)), text);
  std::string wanted = text;
  const std::string before = "         3                   1                   1                   0\r\n";
  ASSERT_NE(wanted.find(before), std::string::npos);
  wanted.replace(wanted.find(before), before.size(), "         3                   1  0.3333333333333333                   0\r\n");
  EXPECT_EQ(saved(*opened, 3, Vec3(1, 0.3333333333333333, 0)), wanted);
  EXPECT_EQ(opened->deck->length_unit, LengthUnit::mm);
}

TEST_F(Radioss, takes_includes_as_text_wherever_they_stand) {
  folder_.write("more.inc", node(2, "1", "0", "0") + node(3, "1", "1", "0") + "#enddata\nnonsense\n");
  folder_.write("sub/set.inc", card({3, 4}) + "#include deeper.inc\n");
  folder_.write("sub/deeper.inc", card({5}) + "/END\n/SHELL/1\n" + card({9, 1, 2, 3, 4}));
  const auto opened = open(std::string(kHead) + "/NODE\n" + node(1, "0", "0", "0") + "#include more.inc\n" + node(4, "0", "1", "0") +
                           "/GRNOD/NODE/6\nset\n" + card({1, 2}) + "#INCLUDE sub/set.inc\n/SHELL/1\n" + card({1, 1, 2, 3, 4}) +
                           "#include gone.inc\n#include deck_0000.rad\n/END\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.node_count(), 4u);
  EXPECT_EQ(opened->model.shell_count(), 1u) << "an include's /END ends the include only";
  for (const std::int64_t id : {1, 2, 3, 4, 5}) EXPECT_TRUE(opened->deck->references->named(Referred::node, id)) << id;
  EXPECT_EQ(opened->deck->missing_files, std::vector<std::string>{"gone.inc"});
  EXPECT_EQ(warning(*opened->deck, "missing-include").line, 17);
  EXPECT_EQ(warning(*opened->deck, "circular-include").count, 1u);
  EXPECT_EQ(opened->deck->files.size(), 4u);
}

TEST_F(Radioss, adds_a_submodels_offsets_and_shows_it_in_place) {
  // The submodel is in metres, and moved by 10, 20, 30 mm after a quarter turn about z.
  const std::string text = std::string(kHead) + "/UNIT/3\nmetres\n" + reals({"kg", "m", "s"}) + "\n" + kSquare + "/SHELL/1\n" +
                           card({1, 1, 2, 3, 4}) + "//SUBMODEL/5/3\nsub\n" + card({1000, 100, 200, 300, 400, 500}) + kSquare +
                           "/SHELL/1\n" + "         1         1         2         3         4" + std::string(30, ' ') + right("0.002", 20) +
                           "\n" + kPart + "/PROP/SHELL/7\np\n\n\n" + card({5, 0}).substr(0, 20) + right("0.003", 20) +
                           "\n/MAT/ELAST/8\nm\n" + right("7800", 20) + "\n" + right("210e9", 20) + right("0.3", 20) +
                           "\n/GRNOD/NODE/1\nset\n" + card({1, 2}) + "//ENDSUB\n/TRANSFORM/ROT/1\nturn\n" + std::string(10, ' ') +
                           reals({"0", "0", "0"}) + std::string(20, ' ') + "         5\n" + std::string(10, ' ') +
                           reals({"0", "0", "1", "90"}) + "\n/TRANSFORM/TRA/2\nmove\n" + std::string(10, ' ') + reals({"10", "20", "30"}) +
                           std::string(20, ' ') + "         5\n/END\n";
  const auto opened = open(text);
  ASSERT_OPENED(opened);
  EXPECT_TRUE(all_is_understood(*opened->deck));
  EXPECT_EQ(position_of(opened->model, 2), Vec3(1, 0, 0));
  EXPECT_LT((position_of(opened->model, 102) - Vec3(10, 1020, 30)).norm(), 1e-9);
  EXPECT_EQ(corners_of(opened->model, 201), (std::array<std::int64_t, 4>{101, 102, 103, 104}));
  const ShellIndex shell = opened->model.find_shell(201);
  EXPECT_FLOAT_EQ(opened->model.shell_thickness[shell.value], 2.0f);
  const Part& part = (*opened->model.parts)[opened->model.find_part(301).value];
  EXPECT_TRUE(part.defined);
  EXPECT_EQ(part.material, 408);
  EXPECT_DOUBLE_EQ(part.thickness.value(), 3);
  EXPECT_DOUBLE_EQ(part.density.value(), 7800e-9);
  EXPECT_DOUBLE_EQ(part.youngs_modulus.value(), 210);
  EXPECT_TRUE(opened->deck->references->named(Referred::node, 102));
  EXPECT_FALSE(opened->deck->references->named(Referred::node, 2));
  EXPECT_EQ(opened->deck->offsets_of(opened->deck->run_of(shell)).node, 100);
  // Node 102 stands at x = 1 m in its own text; 500 mm in y of the model are half a metre in x there.
  std::string wanted = text;
  const std::string before = node(2, "1", "0", "0");
  wanted.replace(wanted.rfind(before), before.size(), node(2, "0.5", "0", "0"));
  EXPECT_EQ(saved(*opened, 102, Vec3(10, 520, 30)), wanted);
}

TEST_F(Radioss, moves_the_submodel_that_is_named_with_those_inside_it_and_no_other) {
  const std::string blank(10, ' ');
  const auto inside = [](int number, const std::string& what) {
    return "//SUBMODEL/" + std::to_string(number) + "\ns\n" + card({0, 100 * number}) + what + "//ENDSUB\n";
  };
  const std::string text = std::string(kHead) + kSquare + inside(1, kSquare) + inside(2, kSquare + inside(3, kSquare)) +
                           "/TRANSFORM/TRA/1\nt\n" + blank + reals({"10", "20", "30"}) + std::string(20, ' ') + right("2", 10) + "\n/END\n";
  const auto opened = open(text);
  ASSERT_OPENED(opened);
  EXPECT_TRUE(all_is_understood(*opened->deck));
  EXPECT_EQ(position_of(opened->model, 2), Vec3(1, 0, 0));
  EXPECT_EQ(position_of(opened->model, 102), Vec3(1, 0, 0));
  EXPECT_EQ(position_of(opened->model, 202), Vec3(11, 20, 30));
  EXPECT_EQ(position_of(opened->model, 502), Vec3(11, 20, 30)) << "its offset comes on top of that of the one around it";
}

TEST_F(Radioss, takes_a_shell_without_a_fourth_node_for_a_triangle) {
  const auto opened =
      open(std::string(kHead) + kSquare + "/SHELL/1\n" + card({1, 1, 2, 3, 0}) + card({2, 1, 3, 4}) + card({3, 1, 2, 0, 4}) + "/END\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(corners_of(opened->model, 1), (std::array<std::int64_t, 4>{1, 2, 3, 3}));
  EXPECT_EQ(corners_of(opened->model, 2), (std::array<std::int64_t, 4>{1, 3, 4, 4}));
  EXPECT_EQ(opened->model.shell_count(), 2u);
  EXPECT_EQ(warning(*opened->deck, "incomplete-element").count, 1u);
}

TEST_F(Radioss, takes_a_transformations_lengths_in_its_own_unit) {
  const std::string blank(10, ' ');
  const std::string model =
      std::string(kHead) + "/UNIT/3\nmetres\n" + reals({"kg", "m", "s"}) + "\n//SUBMODEL/1\ns\n\n" + kSquare + "//ENDSUB\n";
  const auto place_after = [&](const std::string& transform) {
    const auto opened = open(model + transform + "/END\n");
    EXPECT_TRUE(opened) << opened.error().text();
    EXPECT_TRUE(!opened || all_is_understood(*opened->deck)) << transform;
    return opened ? position_of(opened->model, 2) : Vec3(0, 0, 0);
  };
  const std::string of_submodel = std::string(20, ' ') + "         1\n";
  const auto expect_at = [](const Vec3& at, const Vec3& wanted) { EXPECT_LT((at - wanted).norm(), 1e-9) << at.transpose(); };
  expect_at(place_after("/TRANSFORM/TRA/1/3\nt\n" + blank + reals({"0.01", "0.02", "0.03"}) + of_submodel), Vec3(11, 20, 30));
  expect_at(place_after("/TRANSFORM/TRA/1\nt\n" + blank + reals({"0.01", "0.02", "0.03"}) + of_submodel), Vec3(1.01, 0.02, 0.03));
  // half a turn about the line through x = 2 mm, along z
  expect_at(place_after("/TRANSFORM/ROT/1/3\nt\n" + blank + reals({"0.002", "0", "0"}) + of_submodel + blank +
                        reals({"0.002", "0", "1", "180"}) + "\n"),
            Vec3(3, 0, 0));
  // factors have no unit
  expect_at(place_after("/TRANSFORM/SCA/1/3\nt\n" + blank + reals({"2", "2", "2"}) + of_submodel), Vec3(2, 0, 0));
  // a matrix has none but in its last column
  expect_at(place_after("/TRANSFORM/MATRIX/1/3\nt\n" + blank + reals({"1", "0", "0", "0.005"}) + "         1\n" + blank +
                        reals({"0", "1", "0", "0"}) + "\n" + blank + reals({"0", "0", "1", "0"}) + "\n"),
            Vec3(6, 0, 0));
}

TEST_F(Radioss, holds_what_is_included_into_two_submodels) {
  folder_.write("square.inc", kSquare + "/SHELL/1\n" + card({1, 1, 2, 3, 4}));
  const auto opened = open(std::string(kHead) + "//SUBMODEL/1\na\n" + card({100}) + "#include square.inc\n//ENDSUB\n//SUBMODEL/2\nb\n" +
                           card({200}) + "#include square.inc\n//ENDSUB\n/END\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.node_count(), 8u);
  EXPECT_EQ(corners_of(opened->model, 201), (std::array<std::int64_t, 4>{201, 202, 203, 204}));
  EXPECT_EQ(opened->model.node_holds[opened->model.find_node(102).value], kHeldByInclude);
  EXPECT_FALSE(save(*opened->deck, opened->model, with_node_at(opened->model, 102, Vec3(5, 5, 5)), folder_ / "out/main.rad"));
}

TEST_F(Radioss, moves_the_nodes_of_groups) {
  const std::string blank(10, ' ');
  const std::string text = std::string(kHead) + kSquare + node(10, "0", "0", "0") + node(11, "0", "0", "2") + "/SHELL/1\n" +
                           card({1, 1, 2, 3, 4}) + "/GRNOD/NODE/1\na\n" + card({2, 3}) + "/GRNOD/GENE/2\nb\n" + card({3, 4}) +
                           "/GRNOD/PART/3\nc\n" + card({1}) + "/GRNOD/GRNOD/4\nd\n" + card({1, 2}) +
                           // along 10 -> 11, by nodes; then mirrored at x = 0; then the part doubled about node 10
                           "/TRANSFORM/TRA/1\nt\n" + right("1", 10) + reals({"9", "9", "9"}) + card({10, 11}) + "/TRANSFORM/SYM/2\nt\n" +
                           right("4", 10) + reals({"0", "0", "0"}) + "\n" + blank + reals({"1", "0", "0"}) + "\n/TRANSFORM/SCA/3\nt\n" +
                           right("3", 10) + reals({"2", "2", "2"}) + card({10}) + "/END\n";
  const auto opened = open(text);
  ASSERT_OPENED(opened);
  EXPECT_TRUE(all_is_understood(*opened->deck));
  EXPECT_EQ(position_of(opened->model, 1), Vec3(0, 0, 0));
  EXPECT_EQ(position_of(opened->model, 2), Vec3(-2, 0, 4));
  EXPECT_EQ(position_of(opened->model, 3), Vec3(-2, 2, 4));
  EXPECT_EQ(position_of(opened->model, 4), Vec3(0, 2, 0));
  EXPECT_EQ(opened->model.node_holds[opened->model.find_node(11).value], kHeldByFrame);
  EXPECT_EQ(opened->model.node_holds[opened->model.find_node(2).value], 0);
  std::string wanted = text;
  wanted.replace(wanted.find(node(2, "1", "0", "0")), node(2, "1", "0", "0").size(), node(2, "1.5", "0", "0"));
  EXPECT_EQ(saved(*opened, 2, Vec3(-3, 0, 4)), wanted);
}

TEST_F(Radioss, holds_what_a_transformation_moves_that_cant_be_worked_out) {
  const auto opened = open(std::string(kHead) + kSquare + "/BOX/RECTA/1\nb\n/GRNOD/BOX/1\na\n" + card({1}) + "/TRANSFORM/TRA/1\nt\n" +
                           right("1", 10) + reals({"9", "9", "9"}) + "\n/END\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(warning(*opened->deck, "unread-transform").line, 17);
  EXPECT_EQ(position_of(opened->model, 2), Vec3(1, 0, 0));
  for (std::size_t n = 0; n < 4; ++n) EXPECT_EQ(opened->model.node_holds[n], kHeldByFrame);
}

TEST_F(Radioss, knows_rotations_matrices_and_positions) {
  const std::string blank(10, ' ');
  const std::string sub = std::string(kHead) + "//SUBMODEL/1\ns\n\n" + kSquare + "//ENDSUB\n";
  const auto matrix = open(sub + "/TRANSFORM/MATRIX/1\nm\n" + blank + reals({"0", "-1", "0", "5"}) + right("1", 10) + "\n" + blank +
                           reals({"1", "0", "0", "6"}) + "\n" + blank + reals({"0", "0", "1", "7"}) + "\n/END\n");
  ASSERT_OPENED(matrix);
  EXPECT_EQ(position_of(matrix->model, 2), Vec3(5, 7, 7));
  std::string points;
  for (const char* point : {" 0 0 0", " 1 0 0", " 0 1 0", " 1 1 1", " 1 2 1", " 1 1 2"}) points += std::string(point) + "\n";
  const auto position = open(sub + "/TRANSFORM/POSITION/1\np\n" + card({0, 0, 0, 0, 0, 0, 0, 1}) + points + "/END\n");
  ASSERT_OPENED(position);
  EXPECT_TRUE(all_is_understood(*position->deck));
  EXPECT_LT((position_of(position->model, 2) - Vec3(1, 2, 1)).norm(), 1e-12);
  EXPECT_LT((position_of(position->model, 4) - Vec3(1, 1, 2)).norm(), 1e-12);
}

TEST_F(Radioss, fills_in_the_corners_that_bricks_leave_out_and_takes_springs_to_the_ground) {
  std::string text(kHead);
  text += "/NODE\n";
  for (int i = 1; i <= 10; ++i) text += node(i, std::to_string(i).c_str(), "0", "0");
  text += "/BRICK/2\n" + card({1, 1, 2, 3, 4, 5, 0, 0, 0}) + "/TETRA10/2\n" + card({2}) + card({1, 2, 3, 4, 5, 0, 7, 0, 9, 10}) +
          "/SPRING/6\n" + card({3, 1, 0}) + card({4, 0, 1}) + "/SHELL/1\n" + card({5, 1, 0, 3, 4}) + card({6, 1, 2, 3, 4}) + "/END\n";
  const auto opened = open(text);
  ASSERT_OPENED(opened);
  const auto nodes_of = [&](ElementClass of, std::size_t element) {
    const ElementBlock& block = *opened->model.elements[static_cast<std::size_t>(of)];
    std::vector<std::int64_t> ids;
    for (std::uint32_t n = block.first_node[element]; n < block.first_node[element + 1]; ++n)
      ids.push_back(opened->model.node_ids[block.nodes[n].value]);
    return ids;
  };
  EXPECT_EQ(nodes_of(ElementClass::solid, 0), (std::vector<std::int64_t>{1, 2, 3, 4, 5, 5, 5, 5}));
  EXPECT_EQ(nodes_of(ElementClass::solid, 1), (std::vector<std::int64_t>{1, 2, 3, 4, 5, 7, 9, 10}));
  EXPECT_EQ(opened->model.elements[static_cast<std::size_t>(ElementClass::discrete)]->id, std::vector<std::int64_t>{3});
  EXPECT_EQ(nodes_of(ElementClass::discrete, 0), std::vector<std::int64_t>{1});
  EXPECT_EQ(opened->model.shell_count(), 1u);
  EXPECT_EQ(warning(*opened->deck, "incomplete-element").count, 2u);
}

TEST_F(Radioss, says_which_units_are_not_defined) {
  const auto lonely = [&](const std::string& cards) {
    const auto opened = open(std::string(kHead) + cards + "/END\n");
    EXPECT_TRUE(opened) << opened.error().text();
    return opened ? warning(*opened->deck, "undefined-unit").count : 0u;
  };
  EXPECT_EQ(lonely(kSquare), 0u);
  EXPECT_EQ(lonely("/NODE/4\n" + node(1, "0", "0", "0")), 1u);
  EXPECT_EQ(lonely("//SUBMODEL/1/4\ns\n\n" + kSquare + "//ENDSUB\n"), 1u);
}

TEST_F(Radioss, holds_what_transformations_without_sense_move) {
  const std::string blank(10, ' '), of_submodel = std::string(20, ' ') + "         1\n";
  const auto held_by = [&](const std::string& transform) {
    const auto opened = open(std::string(kHead) + "//SUBMODEL/1\ns\n\n" + kSquare + "//ENDSUB\n/NODE\n" + node(11, "0", "0", "0") +
                             node(12, "0", "0", "2") + transform + "/END\n");
    EXPECT_TRUE(opened) << opened.error().text();
    return opened && opened->model.node_holds[opened->model.find_node(2).value] == kHeldByFrame &&
           position_of(opened->model, 2) == Vec3(1, 0, 0) && warning(*opened->deck, "unread-transform").count == 1;
  };
  EXPECT_TRUE(held_by("/TRANSFORM/ROT/1\nt\n" + blank + reals({"1", "1", "1"}) + of_submodel + blank + reals({"1", "1", "1", "90"}) + "\n"))
      << "an axis without a direction";
  EXPECT_TRUE(held_by("/TRANSFORM/TRA/1\nt\n" + blank + reals({"1", "1", "1"}) + right("11", 10) + right("0", 10) + right("1", 10) + "\n"))
      << "one of two nodes";
  EXPECT_TRUE(held_by("/TRANSFORM/TRA/1\nt\n" + blank + reals({"x", "1", "1"}) + of_submodel)) << "no number";
  std::string points;
  for (const char* point : {" 0 0 0", " 1 0 0", " 2 0 0", " 1 1 1", " 1 2 1", " 1 1 2"}) points += std::string(point) + "\n";
  EXPECT_TRUE(held_by("/TRANSFORM/POSITION/1\np\n" + card({0, 0, 0, 0, 0, 0, 0, 1}) + points)) << "three points on a line";
}

TEST_F(Radioss, turns_about_an_axis_through_two_nodes) {
  const std::string blank(10, ' ');
  const auto opened = open(std::string(kHead) + "//SUBMODEL/1\ns\n\n" + kSquare + "//ENDSUB\n/NODE\n" + node(11, "0", "0", "0") +
                           node(12, "0", "0", "2") + "/TRANSFORM/ROT/1\nt\n" + blank + reals({"9", "9", "9"}) + right("11", 10) +
                           right("12", 10) + right("1", 10) + "\n" + blank + reals({"8", "9", "9", "90"}) + "\n/END\n");
  ASSERT_OPENED(opened);
  EXPECT_LT((position_of(opened->model, 2) - Vec3(0, 1, 0)).norm(), 1e-12);
}

TEST_F(Radioss, puts_parameters_in) {
  const auto opened = open(std::string(kHead) + "/PARAMETER/GLOBAL/REAL/1\nlength\nlen                        2.5\n" +
                           "/PARAMETER/GLOBAL/REAL_EXPR/2\nwidth\nwid            &len*2\n/NODE\n" + node(1, "&len", "-&len", "0") +
                           node(2, "1", "0", "0") + node(3, "&wid", "0", "0") + "/END\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(position_of(opened->model, 1), Vec3(2.5, -2.5, 0));
  EXPECT_EQ(opened->model.node_holds[0], kHeldByParameter);
  EXPECT_EQ(opened->model.node_count(), 2u);
  EXPECT_EQ(warning(*opened->deck, "unread-parameter").count, 1u);
  EXPECT_EQ(warning(*opened->deck, "undefined-parameter").count, 1u);
}

TEST_F(Radioss, finds_who_names_what) {
  const auto opened =
      open(std::string(kHead) + kSquare + "/GRNOD/GENE/1\nrange\n" + card({100, 200, 300, 400}) + "/GRNOD/GEN_INCR/2\nsteps\n" +
           card({500, 600, 50}) + "/GRNOD/NODE/3\nbut\n" + card({21, -22}) + "/GRSHEL/SHEL/4\ns\n" + card({31}) + "/GRSH3N/SH3N/5\ns\n" +
           card({32}) + "/SURF/SEG/6\nsegments\n" + card({1, 41, 42, 43, 44}) + "/SURF/PART/EXT/7\np\n" + card({51}) + "/RBODY/8\nr\n" +
           card({61, 62, 63}) + "/TH/NODE/9\nhistory\nDEF\n" + card({71, 72}) + "/TH/RBODY/9\nhistory\nDEF\n" + card({73}) +
           "/ADMAS/5/10\nmass\n" + right("0.5", 20) + card({81}) + "/ADMAS/1/11\nmass\n" + right("0.5", 20) + card({82}) +
           "/SKEW/MOV/12\nskew\n  91  92  93X\n" + "/SECT/13\ns\n" + card({95, 96, 97, 98}) + "/INTER/TYPE7/14\ni\n" + card({99}) +
           "/WHATEVER/15\nw\n" + card({111}) + "/END\n");
  ASSERT_OPENED(opened);
  const References& references = *opened->deck->references;
  const auto role = [&](Referred referred, std::int64_t id) {
    const auto naming = references.naming(referred, id);
    return naming.size() == 1 ? std::optional(naming[0].role) : std::nullopt;
  };
  EXPECT_EQ(role(Referred::node, 150), ReferenceRole::range);
  EXPECT_EQ(role(Referred::node, 250), std::nullopt);
  EXPECT_EQ(role(Referred::node, 350), ReferenceRole::range);
  EXPECT_EQ(role(Referred::node, 550), ReferenceRole::range);
  EXPECT_EQ(role(Referred::node, 551), std::nullopt);
  EXPECT_EQ(role(Referred::node, 21), ReferenceRole::list);
  EXPECT_EQ(role(Referred::node, 22), ReferenceRole::single);
  EXPECT_EQ(role(Referred::shell, 31), ReferenceRole::list);
  EXPECT_EQ(role(Referred::shell, 32), ReferenceRole::list);
  EXPECT_EQ(role(Referred::node, 44), ReferenceRole::segment);
  EXPECT_EQ(role(Referred::part, 51), ReferenceRole::list);
  for (const std::int64_t id : {61, 71, 81, 95, 96, 97}) EXPECT_EQ(role(Referred::node, id), ReferenceRole::single) << id;
  for (const std::int64_t id : {62, 72, 73, 82, 98, 99}) EXPECT_EQ(role(Referred::node, id), std::nullopt) << id;
  ASSERT_EQ(references.unread().size(), 1u);
  EXPECT_EQ(references.unread()[0].keyword, "WHATEVER");
}

TEST_F(Radioss, changes_lists_and_segments) {
  const std::string text = std::string(kHead) + kSquare + "/GRNOD/NODE/1\nset\n" + card({1, 2, 3, 4, 5, 6, 7, 8, 9}) +
                           "/SURF/SEG/2\nsurface\n" + card({7, 1, 2, 3, 4}) + "/END\n";
  const auto opened = open(text);
  ASSERT_OPENED(opened);
  const auto writer = card_writer(Format::radioss);
  const auto referrers = opened->deck->references->referrers();
  const auto changed = [&](const Result<std::vector<Replacement>>& replacements) {
    std::string out = text;
    EXPECT_TRUE(replacements) << replacements.error().text();
    if (replacements)
      for (auto r = replacements->rbegin(); r != replacements->rend(); ++r) out.replace(r->offset, r->length, r->text);
    return out.substr(out.find("/GRNOD"));
  };
  const std::string surface = "/SURF/SEG/2\nsurface\n";
  EXPECT_EQ(changed(writer->join(text, referrers[0], std::array<std::int64_t, 3>{90, 91, 92})),
            "/GRNOD/NODE/1\nset\n" + card({1, 2, 3, 4, 5, 6, 7, 8, 9, 90}) + card({91, 92}) + surface + card({7, 1, 2, 3, 4}) + "/END\n");
  EXPECT_EQ(changed(writer->change_list(text, referrers[0], std::array<std::int64_t, 1>{90}, std::array<std::int64_t, 2>{2, 9})),
            "/GRNOD/NODE/1\nset\n" + card({1, 3, 4, 5, 6, 7, 8, 90}) + surface + card({7, 1, 2, 3, 4}) + "/END\n");
  EXPECT_FALSE(writer->change_list(text, referrers[0], {}, std::array<std::int64_t, 9>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_FALSE(writer->change_list(text, referrers[0], {}, std::array<std::int64_t, 1>{77}));
  const std::size_t segment = text.find(card({7, 1, 2, 3, 4}));
  EXPECT_EQ(writer->segment(text, referrers[1], segment), (std::array<std::int64_t, 4>{1, 2, 3, 4}));
  const std::array<std::array<std::int64_t, 4>, 2> with = {{{1, 2, 9, 9}, {2, 3, 4, 9}}};
  EXPECT_EQ(
      changed(writer->replace_segment(text, referrers[1], segment, with)),
      "/GRNOD/NODE/1\nset\n" + card({1, 2, 3, 4, 5, 6, 7, 8, 9}) + surface + card({7, 1, 2, 9, 9}) + card({8, 2, 3, 4, 9}) + "/END\n");
}

TEST_F(Radioss, writes_shells_into_the_block_of_their_kind) {
  const auto writer = card_writer(Format::radioss);
  const std::string quad = "         1         1         2         3         4          " + right("30", 20) + right("1.5", 20);
  ShellCard shell{12, {1, 2, 9, 4}, {}, 0};
  const auto changed = writer->shell({quad, 0, 0}, shell);
  ASSERT_TRUE(changed);
  EXPECT_EQ(changed->text, "        12         1         2         9         4          " + right("30", 20) + right("1.5", 20));
  shell.nodes = {1, 2, 9, 9};
  EXPECT_FALSE(writer->holds_triangles_and_quads({quad, 0, 0}));
  EXPECT_FALSE(writer->shell({quad, 0, 0}, shell));
  const auto triangle = writer->shell_in_manner({quad, 0, 0}, {quad, 0, 2}, shell);
  ASSERT_TRUE(triangle);
  EXPECT_EQ(triangle->text, "        12         1         2         9                    " + right("30", 20) + right("1.5", 20));
  EXPECT_EQ(writer->new_node({"", 0, 0}, 77, Vec3(0.5, -1, 0)).text, node(77, "0.5", "-1.0", "0.0").substr(0, 70));
  EXPECT_EQ(writer->largest_node_id(1), 99999999);
}

TEST_F(Radioss, refuses_what_it_cant_read_with_the_place) {
  const auto bad = open(std::string(kHead) + "/NODE\n" + node(1, "0", "zero", "0"));
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().line, 8);
  EXPECT_EQ(bad.error().message, "expected the y coordinate of node 1 but found \"                zero\"");
  const auto no_id = open(std::string(kHead) + "/SHELL/1\n" + card({0, 1, 2, 3, 4}));
  ASSERT_FALSE(no_id);
  EXPECT_EQ(no_id.error().message, "an element needs an id above 0");
  const auto engine = open("#RADIOSS ENGINE\n/RUN/deck/1\n10.\n/TFILE\n0.1\n");
  ASSERT_FALSE(engine);
  EXPECT_NE(engine.error().message.find("engine"), std::string::npos);
  const auto fixed = open("#RADIOSS STARTER\ntitle\n    1    2    3\n");
  ASSERT_FALSE(fixed);
  EXPECT_NE(fixed.error().message.find("D00"), std::string::npos);
}

TEST_F(Radioss, bears_hostile_text) {
  const std::string head(kHead);
  for (const std::string& text :
       {head + "/NODE", head + "/NODE\n1", head + "/SHELL/999999999999999999\n" + card({1}), head + "//ENDSUB\n//ENDSUB\n//SUBMODEL/1\n",
        head + "/GRNOD/GENE/1\nt\n" + card({1, 9999999999, 9999999999, 1}), head + "/TETRA10/1\n" + card({1}),
        head + "/GRNOD/GRNOD/1\nt\n" + card({1, 1, 1}) + "/TRANSFORM/TRA/1\nt\n" + card({1}), head + "#include \n#include",
        head + std::string(1 << 20, '/') + "\n", head + std::string("/NO\0DE\n\0\n", 9), head + "/PART/1",
        head + "/PARAMETER/GLOBAL/REAL/1\n\n\n",
        head + "/UNIT/1\nu\n" + reals({"0", "-1", "nan"}) + "\n/NODE/1\n" + node(1, "1", "2", "3")}) {
    const auto opened = open(text);
    EXPECT_TRUE(opened || !opened.error().message.empty());
  }
}

}  // namespace
}  // namespace prismesh::mesh::deck
