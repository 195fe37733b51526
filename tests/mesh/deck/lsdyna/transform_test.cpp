// *INCLUDE_TRANSFORM: positions by hand, ids, units, and the way back into the file.
#include <cmath>
#include <tuple>

#include "mesh/deck/open.h"
#include "mesh/deck/save.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

/// The cards of an *INCLUDE_TRANSFORM: offsets of nodes, elements and parts, a factor of length, a transformation.
std::string include(const std::string& file, const std::string& transformation, const std::string& offsets = "0,0,0",
                    const std::string& factors = "") {
  return "*INCLUDE_TRANSFORM\n" + file + "\n" + offsets + "\n0\n" + (factors.empty() ? "1.,1.,1.,,1" : factors) + "\n" + transformation +
         "\n";
}

const char kThree[] = "*NODE\n1,1.,0.,0.\n2,0.,2.,0.\n3,0.,0.,3.\n";

/// Where the transformation's steps bring (1, 2, 3).
Vec3 moved(const std::string& steps, const std::string& more = "") {
  const DeckFolder folder;
  folder.write("a.k", "*NODE\n1,1.,2.,3.\n");
  const auto opened = folder.open("*KEYWORD\n*DEFINE_TRANSFORMATION\n7\n" + steps + include("a.k", "7") + more + "*END\n");
  EXPECT_TRUE(opened) << opened.error().text();
  if (!opened) return {};
  EXPECT_TRUE(opened->deck->warnings.empty()) << opened->deck->warnings[0].message;
  return position_of(opened->model, 1);
}

void expect_near(const Vec3& found, const Vec3& wanted) {
  EXPECT_LT((found - wanted).norm(), 1e-12) << found.transpose() << " is not " << wanted.transpose();
}

TEST(Transformation, each_step_does_what_the_manual_says) {
  expect_near(moved("TRANSL,10.,20.,30.\n"), {11, 22, 33});
  expect_near(moved("SCALE,2.,0.,-1.\n"), {2, 2, -3});
  expect_near(moved("ROTATE,0.,0.,5.,0.,0.,0.,90.\n"), {-2, 1, 3});
  expect_near(moved("ROTATE,0.,0.,1.,1.,1.,7.,90.\n"), {0, 1, 3});
  expect_near(moved("ROTATE,1.,1.,1.,0.,0.,0.,120.\n"), {3, 1, 2});
  expect_near(moved("ROTATE,0.,0.,1.,0.,0.,0.,60.\n"), {0.5 - std::sqrt(3.0), 1 + std::sqrt(3.0) / 2, 3});
  expect_near(moved("ROTATE,1.,0.,0.,0.,1.,7.,90.\n"), {1, 5, 8});
  expect_near(moved("ROTATE,0.,2.,0.,3.,0.,1.,90.\n"), {5, 2, 3});
  expect_near(moved("MIRROR,0.,5.,0.,0.,9.,0.\n"), {1, 8, 3});
  expect_near(moved("MIRROR,0.,0.,0.,1.,1.,0.,1\n"), {-2, -1, 3});
  expect_near(moved("TRANSL2ND,8,9,10.\n", "*NODE\n8,0.,0.,5.\n9,0.,0.,1.\n"), {1, 2, -7});
  expect_near(moved("TRANSL2ND,8,9\n", "*NODE\n8,0.,0.,5.\n9,0.,0.,1.\n"), {1, 2, -1});
  expect_near(moved("ROTATE3NA,8,9,10,90.\n", "*NODE\n8,5.,5.,5.\n9,5.,5.,6.\n10,1.,1.,0.\n"), {0, 1, 3});
  expect_near(moved("MATRIX\n0.,1.,0.,0.,-1.,0.,0.,0.\n0.,0.,1.,0.,10.,20.,30.,1.\n"), {8, 21, 33});
}

TEST(Transformation, of_steps_that_lead_nowhere_holds_the_nodes_and_is_said) {
  for (const char* steps : {"ROTATE,0.,0.,0.,1.,1.,1.,90.\n", "ROTATE,8,8,90.\n", "ROTATE3NA,8,8,9,90.\n", "TRANSL2ND,8,8,10.\n",
                            "MIRROR,1.,1.,1.,1.,1.,1.\n", "TRANSL,1e61,0.,0.\n"}) {
    const DeckFolder folder;
    folder.write("a.k", "*NODE\n1,1.,2.,3.\n");
    const auto opened = folder.open("*KEYWORD\n*DEFINE_TRANSFORMATION\n7\n" + std::string(steps) + include("a.k", "7") +
                                    "*NODE\n8,0.,0.,5.\n9,0.,0.,1.\n*END\n");
    ASSERT_OPENED(opened);
    EXPECT_FALSE(opened->deck->warnings.empty()) << steps;
    EXPECT_NE(opened->model.node_holds[opened->model.find_node(1).value], 0) << steps;
    EXPECT_TRUE(position_of(opened->model, 1).allFinite()) << steps;
  }
}

TEST(Transformation, turns_by_quarters_to_the_last_digit) {
  EXPECT_EQ(moved("ROTATE,0.,0.,1.,0.,0.,0.,90.\n"), Vec3(-2, 1, 3));
  EXPECT_EQ(moved("ROTATE,0.,0.,1.,0.,0.,0.,-270.\n"), Vec3(-2, 1, 3));
  EXPECT_EQ(moved("ROTATE,0.,0.,1.,0.,0.,0.,180.\n"), Vec3(-1, -2, 3));
}

TEST(Transformation, steps_follow_each_other) {
  expect_near(moved("SCALE,2.,2.,2.\nROTATE,0.,0.,1.,0.,0.,0.,90.\nTRANSL,100.,0.,0.\n"), {96, 2, 6});
  expect_near(moved("TRANSL,100.,0.,0.\nROTATE,0.,0.,1.,0.,0.,0.,90.\nSCALE,2.,2.,2.\n"), {-4, 202, 6});
  expect_near(moved("    TRANSL      10.0      20.0\n    SCALE        2.0       1.0       1.0\n"), {22, 22, 3});
}

TEST(Transformation, points_are_moved_by_the_steps_before_their_use) {
  // The axis from (10 0 0) along z: defined before or after the shift, it is used after it.
  for (const char* order : {"POINT,1,10.,0.,0.\nPOINT,2,10.,0.,1.\nTRANSL,1.,0.,0.\nROTATE,1,2,180.\n",
                            "TRANSL,1.,0.,0.\nROTATE,1,2,180.\nPOINT,1,10.,0.,0.\nPOINT,2,10.,0.,1.\n"})
    expect_near(moved(order), {20, -2, 3});
}

TEST(Transformation, six_points_or_nodes_position) {
  // The first axes are turned so that x becomes y and y becomes z, at (100 0 0).
  const std::string points =
      "POINT,1,0.,0.,0.\nPOINT,2,2.,0.,0.\nPOINT,3,1.,4.,0.\nPOINT,4,100.,0.,0.\nPOINT,5,100.,3.,0.\nPOINT,6,100.,1.,1.\n";
  expect_near(moved(points + "POS6P,1,2,3,4,5,6\n"), {103, 1, 2});
  expect_near(
      moved("POS6N,11,12,13,14,15,16\n", "*NODE\n11,0.,0.,0.\n12,2.,0.,0.\n13,1.,4.,0.\n14,100.,0.,0.\n15,100.,3.,0.\n16,100.,1.,1.\n"),
      {103, 1, 2});
}

TEST(Transformation, by_nodes_of_the_include_itself_goes_by_where_they_are_by_then) {
  const DeckFolder folder;
  folder.write("a.k", kThree);
  // After the scaling node 1 is at (2 0 0) and node 2 at (0 4 0).
  const auto opened =
      folder.open(include("a.k", "5", "100,0,0") + "*DEFINE_TRANSFORMATION_TITLE\nlater\n5\nSCALE,2.,2.,2.\nTRANSL2ND,101,102\n");
  ASSERT_OPENED(opened);
  expect_near(position_of(opened->model, 101), {0, 4, 0});
  expect_near(position_of(opened->model, 103), {-2, 4, 6});
}

TEST(Transformation, that_is_not_there_or_not_understood_is_said_and_holds_the_nodes) {
  const DeckFolder folder;
  folder.write("a.k", kThree);
  const auto held = [&](const std::string& rest) {
    const auto opened = folder.open(include("a.k", "7") + rest);
    EXPECT_TRUE(opened) << opened.error().text();
    EXPECT_EQ(opened->model.node_count(), 3u);
    const Model& model = opened->model;
    const Warning said = warning(*opened->deck, "unresolved-transformation");
    EXPECT_EQ(said.count, 1u);
    EXPECT_EQ(model.node_holds[0] & ~kHeldByFrame, kHeldByInclude);  // the other bit: it gives the transformation as well
    Model other = with_node_at(model, 1, Vec3(5, 5, 5));
    EXPECT_FALSE(save(*opened->deck, model, other, folder / "out.k"));
    return said.message;
  };
  const std::string ending = "; the include is shown without that, and its nodes can't be moved";
  EXPECT_EQ(held(""), "transformation 7 of this include isn't defined" + ending);
  const std::string define = "*DEFINE_TRANSFORMATION\n7\n";
  EXPECT_EQ(held(define + "WARP,1.\n"), "transformation 7 of this include has the option WARP, which this version doesn't know" + ending);
  EXPECT_EQ(held(define + "TRANSL2ND,1,99\n"),
            "transformation 7 of this include needs node 99 for its TRANSL2ND, whose place can't be told" + ending);
  EXPECT_EQ(held(define + "ROTATE,1,2,90.\n"),
            "transformation 7 of this include needs POINT 1 for its ROTATE, which it doesn't have" + ending);
  EXPECT_EQ(held(define + "MIRROR,1.,1.,1.,1.,1.,1.\n"),
            "transformation 7 of this include has a MIRROR whose points leave no direction" + ending);
  std::string steps;
  for (int i = 0; i < 1001; ++i) steps += "TRANSL,0.,0.,0.\n";
  EXPECT_EQ(held(define + steps),
            "transformation 7 of this include has the option thousand and first card, which this version doesn't know" + ending);
  EXPECT_EQ(held(define + "TRANSL,&lost\n"), "transformation 7 of this include has a TRANSL whose numbers can't be read" + ending);
  EXPECT_EQ(held(define + "SCALE,1.e50\nSCALE,1.e50\n"),
            "transformation 7 of this include moves things out of the range of numbers" + ending);
}

/// Each transformation by itself is one that numbers can hold.
TEST(Transformation, of_includes_in_each_other_that_lead_too_far_is_said_and_holds_the_inner_ones) {
  const DeckFolder folder;
  folder.write("inner.k", "*NODE\n1,1.,0.,0.\n");
  folder.write("outer.k", "*NODE\n2,2.,0.,0.\n*DEFINE_TRANSFORMATION\n8\nSCALE,1.e40,1.e40,1.e40\n" + include("inner.k", "8"));
  const auto opened = folder.open("*KEYWORD\n*DEFINE_TRANSFORMATION\n7\nSCALE,1.e40,1.e40,1.e40\n" + include("outer.k", "7") + "*END\n");
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  const Warning said = warning(*opened->deck, "unresolved-transformation");
  EXPECT_EQ(said.count, 1u);
  EXPECT_EQ(said.message,
            "transformation 8 of this include moves things out of the range of numbers; the include is shown without that, and its nodes "
            "can't be moved");
  EXPECT_EQ(std::filesystem::path(said.file).filename(), "outer.k");
  EXPECT_EQ(said.line, 6);
  EXPECT_EQ(position_of(model, 1), Vec3(1, 0, 0));
  EXPECT_EQ(position_of(model, 2), Vec3(2e40, 0, 0));
  EXPECT_EQ(model.node_holds[model.find_node(1).value], kHeldByInclude);
  EXPECT_EQ(model.node_holds[model.find_node(2).value], 0);
}

TEST(Transformation, includes_placed_by_each_others_nodes_end_with_a_warning) {
  const DeckFolder folder;
  folder.write("a.k", "*NODE\n1,1.,0.,0.\n2,2.,0.,0.\n");
  folder.write("b.k", "*NODE\n3,1.,0.,0.\n4,2.,0.,0.\n");
  const auto opened = folder.open("*DEFINE_TRANSFORMATION\n1\nTRANSL2ND,3,4\n*DEFINE_TRANSFORMATION\n2\nTRANSL2ND,1,2\n" +
                                  include("a.k", "1") + include("b.k", "2"));
  ASSERT_OPENED(opened);
  EXPECT_GE(warning(*opened->deck, "unresolved-transformation").count, 1u);
}

TEST(IncludeTransform, moved_nodes_are_saved_in_their_own_system) {
  const DeckFolder folder;
  folder.write("sub.k",
               "*NODE\n"
               "       1             1.0             2.0             3.0\n"
               "       2             4.0             5.0             6.0\n");
  const auto opened = folder.open(
      "*KEYWORD\n*NODE\n50,0.,0.,0.\n*DEFINE_TRANSFORMATION\n7\nSCALE,2.,1.,1.\nROTATE,0.,0.,1.,0.,0.,0.,90.\nMIRROR,0.,0.,0.,0.,0.,1."
      "\nTRANSL,0.,0.,100.\n" +
      include("sub.k", "7", "1000,0,0", "1.,1.,10.") + "*END\n");
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  expect_near(position_of(model, 1001), {-20, 20, 70});
  const Deck& deck = *opened->deck;
  EXPECT_EQ(deck.offsets_of(deck.run_of(model.find_node(1001))).node, 1000);
  EXPECT_EQ(deck.offsets_of(deck.run_of(model.find_node(50))).node, 0);
  // 10 to the left and 5 down: the card's own y (10 times) and z (mirrored).
  const auto saved = save(deck, model, with_node_at(model, 1002, position_of(model, 1002) + Vec3(-10, 0, -5)), folder / "out/deck.k");
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(saved->lines_changed, 1u);
  EXPECT_EQ(content(folder / "out/sub.k"),
            "*NODE\n"
            "       1             1.0             2.0             3.0\n"
            "       2             4.0             6.0             6.5\n");
  const auto again = deck::open(folder / "out/deck.k");
  ASSERT_OPENED(again);
  expect_near(position_of(again->model, 1002), position_of(model, 1002) + Vec3(-10, 0, -5));
}

TEST(IncludeTransform, coordinates_that_a_move_leaves_alone_keep_their_digits) {
  const DeckFolder folder;
  // twenty columns hold every digit that turning there and back costs
  const auto text = [](const char* z) {
    std::string all = "*NODE+\n";
    for (const auto& [id, x, y] : {std::tuple("1", "10.1", "33.3"), std::tuple("2", "0.377", "-1234.567"), std::tuple("3", "7.1", "0.1")})
      for (const std::string field : {id, x, y, z}) all += std::string(20 - field.size(), ' ') + field + (field == z ? "\n" : "");
    return all;
  };
  folder.write("sub.k", text("5.0"));
  const auto opened = folder.open("*KEYWORD\n*DEFINE_TRANSFORMATION\n7\nROTATE,0.,0.,1.,0.,0.,0.,37.\nTRANSL,0.3,0.7,0.\n" +
                                  include("sub.k", "7") + "*END\n");
  ASSERT_OPENED(opened);
  Model model = opened->model;
  for (std::size_t n = 0; n < 3; ++n) model.positions.set(n, Vec3(model.positions[n] + Vec3(0, 0, 0.5)));
  const auto saved = save(*opened->deck, opened->model, model, folder / "out/deck.k");
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(content(folder / "out/sub.k"), text("5.5"));
}

TEST(IncludeTransform, ids_get_their_offsets_and_elements_find_their_nodes) {
  const DeckFolder folder;
  folder.write("sub.k",
               "*NODE\n1,1.,2.,3.\n2,4.,5.,6.\n3,7.,8.,9.\n4,1.,1.,1.\n5,1.,1.,2.\n"
               "*ELEMENT_SHELL_THICKNESS\n1,9,1,2,3,0,4,5\n2.,2.,2.,2.\n0.\n*ELEMENT_BEAM\n1,8,1,2,3\n*ELEMENT_MASS\n1,2,5.,9\n*ELEMENT_"
               "SPH\n3,9,1.\n"
               "*ELEMENT_DISCRETE\n1,7,1,0\n");
  const auto opened = folder.open(include("sub.k", "0", "100,2000,30") + kThree);
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  EXPECT_EQ(warning(*opened->deck, "undefined-node").count, 0u);
  EXPECT_EQ(model.node_count(), 8u);
  EXPECT_EQ(corners_of(model, 2001), (std::array<std::int64_t, 4>{101, 102, 103, 103}));
  ASSERT_EQ(model.midside->size(), 1u);
  EXPECT_EQ(model.midside->at(0).node[0], model.find_node(104));
  EXPECT_TRUE(model.find_part(39).valid());
  EXPECT_TRUE(model.find_part(38).valid());
  const auto block = [&](ElementClass c) -> const ElementBlock& { return *model.elements[static_cast<std::size_t>(c)]; };
  EXPECT_EQ(block(ElementClass::beam).id[0], 2001);
  EXPECT_EQ(block(ElementClass::mass).nodes[0], model.find_node(102));
  EXPECT_EQ(block(ElementClass::sph).id[0], 103);
  EXPECT_EQ(block(ElementClass::sph).nodes[0], model.find_node(103));
  EXPECT_EQ(block(ElementClass::discrete).nodes.size(), 1u);
  EXPECT_EQ(opened->deck->offsets_of(opened->deck->run_of(model.find_shell(2001))), (IdOffsets{.node = 100, .element = 2000, .part = 30}));
  EXPECT_EQ(position_of(model, 1), Vec3(1, 0, 0));
  EXPECT_EQ(position_of(model, 101), Vec3(1, 2, 3));
}

TEST(IncludeTransform, an_offset_that_leaves_no_id_is_an_error) {
  const DeckFolder folder;
  folder.write("sub.k", "*NODE\n7,1.,2.,3.\n5,4.,5.,6.\n");
  const auto opened = folder.open(include("sub.k", "0", "-6,0,0"));
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().message, "the include's offset makes the id of this node -1");
  EXPECT_EQ(opened.error().line, 3);
  for (const char* const elements : {"*ELEMENT_SHELL\n7,1,1,2,3,3\n5,1,1,2,3,3\n", "*ELEMENT_BEAM\n7,1,1,2\n5,1,1,2\n"}) {
    folder.write("sub.k", std::string("*NODE\n1,1.,2.,3.\n2,4.,5.,6.\n3,7.,8.,8.\n") + elements);
    const auto of_elements = folder.open(include("sub.k", "0", "0,-6,0"));
    ASSERT_FALSE(of_elements) << elements;
    EXPECT_EQ(of_elements.error().message, "the include's offset makes the id of this element -1");
    EXPECT_EQ(of_elements.error().line, 7);
  }
}

TEST(IncludeTransform, of_a_node_that_stands_too_far_away_is_an_error) {
  const DeckFolder folder;
  folder.write("sub.k", "*NODE\n7,1.,2.,3.\n5,4.,5.,-2.e200\n");
  const auto opened = folder.open(include("sub.k", "0", "6,0,0"));
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().message, "a node of a transformed include stands too far away");
  EXPECT_EQ(std::filesystem::path(opened.error().file).filename(), "sub.k");
  EXPECT_EQ(opened.error().line, 3);
}

TEST(IncludeTransform, factors_that_multiply_up_beyond_all_units_are_told) {
  for (const char* factors : {"1.,1.,1.e20", "1.,1.,1.e-20", "1.e20,1.,1.", "1.,1.e-20,1."}) {
    const DeckFolder folder;
    folder.write("inner.k", "*NODE\n1,1.,0.,0.\n");
    folder.write("outer.k", "*NODE\n2,1.,0.,0.\n" + include("inner.k", "0", "0,0,0", factors));
    const auto opened = folder.open("*KEYWORD\n" + include("outer.k", "0", "0,0,0", factors) + "*END\n");
    ASSERT_OPENED(opened);
    const Warning said = warning(*opened->deck, "bad-include-transform");
    EXPECT_EQ(said.message, "*INCLUDE_TRANSFORM has a factor of units that can't be used; that is left out") << factors;
    EXPECT_EQ(said.count, 1u);
    EXPECT_EQ(std::filesystem::path(said.file).filename(), "outer.k");
    EXPECT_EQ(said.line, 3);
    EXPECT_TRUE(position_of(opened->model, 1).allFinite());
  }
}

TEST(IncludeTransform, factors_change_lengths_densities_and_moduli) {
  const DeckFolder folder;
  // Metres, kilograms and seconds into millimetres, tonnes and seconds; an inner include in 0.1 m.
  folder.write("m.k",
               "*NODE\n1,1.,2.,3.\n2,2.,2.,3.\n3,2.,3.,3.\n*ELEMENT_SHELL_THICKNESS\n1,9,1,2,3\n0.002,0.002,0.002\n*PART\nsheet\n9,4,5\n*"
               "SECTION_SHELL\n4,2\n0.0015\n"
               "*MAT_ELASTIC\n5,7850.,2.1e11,0.3\n" +
                   include("dm.k", "0", "10,0,0", "1.,1.,0.1"));
  folder.write("dm.k", "*NODE\n1,10.,20.,30.\n");
  const auto opened = folder.open("*INCLUDE_TRANSFORM\nm.k\n0,0,0,1,0,0,0\n1000,car,2\n0.001,1.,1000.\n0\n");
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  expect_near(position_of(model, 1), {1000, 2000, 3000});
  expect_near(position_of(model, 11), {1000, 2000, 3000});
  EXPECT_FLOAT_EQ(model.shell_thickness[0], 2.0f);
  const Part& part = (*model.parts)[model.find_part(9).value];
  EXPECT_EQ(part.name, "car.sheet.2");
  EXPECT_EQ(part.section, 1004);
  EXPECT_EQ(part.material, 6);
  EXPECT_DOUBLE_EQ(part.thickness.value_or(0), 1.5);
  EXPECT_DOUBLE_EQ(part.density.value_or(0), 7.85e-9);
  EXPECT_DOUBLE_EQ(part.youngs_modulus.value_or(0), 2.1e5);
}

TEST(IncludeTransform, factors_of_time_and_offsets_of_layers_count) {
  const DeckFolder folder;
  // Milliseconds, kilograms and metres into seconds, tonnes and millimetres.
  folder.write("ms.k",
               "*MAT_ELASTIC\n5,7850.,2.1e5,0.3\n*PART_COMPOSITE\nlayers\n9,2\n5,0.002,0.0\n*PART\nsheet\n8,0,5\n"
               "*CONTROL_TIMESTEP\n0.,0.8,0,0.,-2.\n");
  const auto opened = folder.open("*INCLUDE_TRANSFORM\nms.k\n0,0,0,100\n0\n0.001,0.001,1000.\n0\n*MAT_ELASTIC\n5,1.,1.,0.1\n");
  ASSERT_OPENED(opened);
  const Part& sheet = (*opened->model.parts)[opened->model.find_part(8).value];
  EXPECT_EQ(sheet.material, 105);
  EXPECT_DOUBLE_EQ(sheet.density.value_or(0), 7.85e-9);
  EXPECT_DOUBLE_EQ(sheet.youngs_modulus.value_or(0), 2.1e5);
  const Part& layers = (*opened->model.parts)[opened->model.find_part(9).value];
  EXPECT_DOUBLE_EQ(layers.thickness.value_or(0), 2);
  EXPECT_DOUBLE_EQ(layers.density.value_or(0), 7.85e-9);
  EXPECT_DOUBLE_EQ(opened->deck->time_step.mass_scaled, -2e-3);
}

TEST(IncludeTransform, titles_stand_between_the_prefixes_and_suffixes_of_all_includes) {
  const DeckFolder folder;
  folder.write("outer.k", "*INCLUDE_TRANSFORM\ninner.k\n0\n0,door,left\n1.\n0\n");
  folder.write("inner.k", "*PART\nsheet\n9\n");
  const auto opened = folder.open("*INCLUDE_TRANSFORM\nouter.k\n0\n0,car,red\n1.\n0\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ((*opened->model.parts)[0].name, "car.door.sheet.left.red");
}

TEST(IncludeTransform, of_transformed_ones_in_files_at_two_places_is_another_each_time) {
  const DeckFolder folder;
  folder.write("outer.k", "*NODE\n1,1.,0.,0.\n*ELEMENT_LANCING\n1\n2\n" + include("inner.k", "0", "50,0,0"));
  folder.write("inner.k", "*NODE\n2,2.,0.,0.\n");
  const auto opened = folder.open("*DEFINE_TRANSFORMATION\n1\nTRANSL,0.,10.,0.\n*DEFINE_TRANSFORMATION\n2\nTRANSL,0.,20.,0.\n" +
                                  include("outer.k", "1") + include("outer.k", "2"));
  ASSERT_OPENED(opened);
  EXPECT_EQ(warning(*opened->deck, "several-places").count, 2u);
  EXPECT_EQ(warning(*opened->deck, "repeated-include").count, 0u);
  EXPECT_NE(warning(*opened->deck, "unread-elements").message.find("(2 lines)"), std::string::npos);
  EXPECT_EQ(position_of(opened->model, 52), Vec3(2, 10, 0));
}

TEST(IncludeTransform, nodes_in_one_that_cant_be_placed_are_held_with_those_inside) {
  const DeckFolder folder;
  folder.write("outer.k", "*NODE\n1,1.,0.,0.\n" + include("inner.k", "5"));
  folder.write("inner.k", "*NODE\n2,2.,0.,0.\n");
  folder.write("flat.k", "*NODE\n3,3.,4.,5.\n");
  folder.write("other.k", "*NODE\n4,0.,0.,0.\n");
  const auto opened = folder.open(
      "*DEFINE_TRANSFORMATION\n5\nTRANSL,0.,10.,0.\n*DEFINE_TRANSFORMATION\n6\nMATRIX\n1.,0.,0.,0.,0.,1.,0.,0.\n0.,0.,0.,0.,0.,0.,0.,1.\n"
      "*DEFINE_TRANSFORMATION\n7\nTRANSL2ND,1,2\n" +
      include("outer.k", "99") + include("flat.k", "6") + include("other.k", "7"));
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  EXPECT_EQ(model.node_holds[model.find_node(1).value] & kHeldByInclude, kHeldByInclude);
  EXPECT_EQ(model.node_holds[model.find_node(2).value] & kHeldByInclude, kHeldByInclude);
  EXPECT_EQ(position_of(model, 3), Vec3(3, 4, 0));
  EXPECT_EQ(model.node_holds[model.find_node(3).value], kHeldByInclude) << "a flattened node has no way back";
  EXPECT_EQ(model.node_holds[model.find_node(4).value], kHeldByInclude) << "node 1 stands in an include that can't be placed";
  EXPECT_EQ(warning(*opened->deck, "unresolved-transformation").count, 1u);
  EXPECT_EQ(opened->deck->warnings.size(), 2u);
}

TEST(IncludeTransform, one_by_nodes_of_the_main_file_knows_them_in_its_own_system) {
  const DeckFolder folder;
  folder.write("outer.k", include("middle.k", "2"));
  folder.write("middle.k", include("inner.k", "3"));
  folder.write("inner.k", "*NODE\n5,0.,0.,0.\n");
  const auto opened = folder.open(
      "*NODE\n1,0.,0.,0.\n2,1.,0.,0.\n*DEFINE_TRANSFORMATION\n1\nROTATE,0.,0.,1.,0.,0.,0.,90.\n"
      "*DEFINE_TRANSFORMATION\n2\nROTATE,1.,0.,0.,0.,0.,0.,90.\nTRANSL,7.,0.,0.\n"
      "*DEFINE_TRANSFORMATION\n3\nTRANSL2ND,1,2\n" +
      include("outer.k", "1"));
  ASSERT_OPENED(opened);
  EXPECT_TRUE(opened->deck->warnings.empty());
  expect_near(position_of(opened->model, 5), {1, 7, 0});
}

TEST(IncludeTransform, nodes_and_transformations_of_an_include_have_its_offsets) {
  const DeckFolder folder;
  folder.write("outer.k", "*NODE\n1,0.,0.,0.\n2,0.,0.,4.\n*DEFINE_TRANSFORMATION\n3\nTRANSL2ND,1,2\n" + include("inner.k", "3"));
  folder.write("inner.k", "*NODE\n5,0.,0.,0.\n");
  const auto opened = folder.open(
      "*NODE\n1,0.,0.,0.\n2,1.,0.,0.\n*DEFINE_TRANSFORMATION\n3\nTRANSL,9.,9.,9.\n"
      "*INCLUDE_TRANSFORM\nouter.k\n100,0,0,0,0,0,50\n0\n1.\n0\n");
  ASSERT_OPENED(opened);
  EXPECT_TRUE(opened->deck->warnings.empty());
  expect_near(position_of(opened->model, 105), {0, 0, 4});
  EXPECT_EQ(opened->model.node_holds[opened->model.find_node(101).value], kHeldByFrame);
  EXPECT_EQ(opened->model.node_holds[opened->model.find_node(1).value], 0);
}

TEST(IncludeTransform, nested_ones_compose) {
  const DeckFolder folder;
  folder.write("outer.k", "*NODE\n1,1.,0.,0.\n*DEFINE_TRANSFORMATION\n3\nTRANSL,10.,0.,0.\n" + include("inner.k", "3", "1,0,0"));
  folder.write("inner.k", "*NODE\n1,1.,0.,0.\n*INCLUDE\nplain.k\n");
  folder.write("plain.k", "*NODE\n2,0.,1.,0.\n");
  // The definitions of an include have offsets of their own: 3 is another transformation here.
  const auto opened =
      folder.open("*DEFINE_TRANSFORMATION\n3\nROTATE,0.,0.,1.,0.,0.,0.,90.\n*INCLUDE_TRANSFORM\nouter.k\n100,0,0,0,0,0,50\n0\n,,2.\n3\n");
  ASSERT_OPENED(opened);
  EXPECT_TRUE(opened->deck->warnings.empty()) << opened->deck->warnings[0].message;
  expect_near(position_of(opened->model, 101), {0, 2, 0});
  expect_near(position_of(opened->model, 102), {0, 22, 0});
  expect_near(position_of(opened->model, 103), {-2, 20, 0});
}

TEST(IncludeTransform, a_file_at_two_places_is_shown_twice_and_held) {
  const DeckFolder folder;
  folder.write("dummy.k", "*NODE\n1,1.,0.,0.\n2,2.,0.,0.\n3,2.,1.,0.\n*ELEMENT_SHELL\n1,1,1,2,3\n*PART\np\n1\n*INCLUDE\nhand.k\n");
  folder.write("hand.k", "*NODE\n4,5.,0.,0.\n");
  const auto opened = folder.open("*DEFINE_TRANSFORMATION\n1\nTRANSL,0.,100.,0.\n" + include("dummy.k", "0", "100,100,100") +
                                  include("dummy.k", "1", "200,200,200") + include("dummy.k", "1", "200,200,200") + "*NODE\n9,9.,0.,0.\n");
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  EXPECT_EQ(model.node_count(), 9u);
  EXPECT_EQ(model.shell_count(), 2u);
  EXPECT_EQ(model.parts->size(), 2u);
  expect_near(position_of(model, 102), {2, 0, 0});
  expect_near(position_of(model, 202), {2, 100, 0});
  expect_near(position_of(model, 204), {5, 100, 0});
  for (const std::int64_t id : {101, 203, 104, 204}) EXPECT_EQ(model.node_holds[model.find_node(id).value], kHeldByInclude) << id;
  EXPECT_EQ(model.node_holds[model.find_node(9).value], 0);
  EXPECT_EQ(warning(*opened->deck, "several-places").count, 2u);
  EXPECT_EQ(warning(*opened->deck, "repeated-include").count, 1u);
  const auto saved = save(*opened->deck, model, with_node_at(model, 101, Vec3(0, 0, 7)), folder / "out/deck.k");
  ASSERT_FALSE(saved);
}

TEST(IncludeTransform, many_places_of_large_files_end_with_a_warning) {
  const DeckFolder folder;
  // Eight files that each include the next one nine times would be shown 40 million times.
  for (int i = 0; i < 8; ++i) {
    std::string text = "*NODE\n1,1.,0.,0.\n";
    for (int k = 0; k < 9; ++k)
      text += include("f" + std::to_string(i + 1) + ".k", "0", std::to_string((k + 1) * std::pow(10, i)) + ",0,0");
    folder.write("f" + std::to_string(i) + ".k", text);
  }
  folder.write("f8.k", "*NODE\n1,1.,0.,0.\n");
  const auto opened = folder.open("*INCLUDE\nf0.k\n");
  ASSERT_OPENED(opened);
  EXPECT_GE(warning(*opened->deck, "too-many-includes").count, 1u);
  EXPECT_LT(opened->model.node_count(), 30000u);
}

TEST(IncludeTransform, what_of_it_cannot_be_used_is_said) {
  const DeckFolder folder;
  folder.write("a.k", kThree);
  for (const char* cards :
       {"1x,0,0\n0\n1.,1.,1.\n0\n", "0,0,0\n0\n1.,1.,-2.\n0\n", "0,0,0\n0\n1.,1.,1.\n&lost\n", "123456789012345678,0\n"}) {
    const auto opened = folder.open(std::string("*INCLUDE_TRANSFORM\na.k\n") + cards);
    ASSERT_OPENED(opened);
    EXPECT_EQ(warning(*opened->deck, "bad-include-transform").count, 1u) << cards;
    EXPECT_EQ(opened->model.node_count(), 3u);
  }
}

TEST(Transform, nodes_that_give_a_transformation_are_held) {
  const DeckFolder folder;
  folder.write("part.k", "*NODE\n1,1.,0.,0.\n");
  const auto opened = folder.open(
      "*KEYWORD\n*NODE\n101,0.,0.,0.\n102,0.,0.,2.\n103,5.,5.,5.\n*DEFINE_TRANSFORMATION\n8\nTRANSL2ND,101,102,4.\n"
      "*INCLUDE_TRANSFORM\npart.k\n200\n0\n1.,1.,1.\n8\n*END\n");
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  EXPECT_EQ(model.node_holds[model.find_node(101).value] & kHeldByFrame, kHeldByFrame);
  EXPECT_EQ(model.node_holds[model.find_node(102).value] & kHeldByFrame, kHeldByFrame);
  EXPECT_EQ(model.node_holds[model.find_node(103).value], 0);
  EXPECT_EQ(model.node_holds[model.find_node(201).value], 0);
}

}  // namespace
}  // namespace prismesh::mesh::deck
