// Parts, sections, materials, the time step and the guess at the unit.
#include "mesh/deck/lsdyna/definitions.h"

#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

const Part& part(const OpenedDeck& opened, std::int64_t id) {
  static const Part none;
  const PartIndex index = opened.model.find_part(id);
  EXPECT_TRUE(index.valid()) << "part " << id;
  return index.valid() ? (*opened.model.parts)[index.value] : none;
}

TEST(Parts, take_what_their_section_and_material_say) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "*KEYWORD\n"
      "*PART\n"
      "$# title\n"
      "  Roof, outer  \n"
      "         3        20        30\n"
      "*SECTION_SHELL_TITLE\nsheet\n"
      "        20         2     0.833         5\n"
      "       1.0       2.0       3.0       4.0\n"
      "*MAT_PIECEWISE_LINEAR_PLASTICITY_TITLE\nsteel\n"
      "        30   7.85E-9  210000.0       0.3      0.25\n"
      "*END\n");
  ASSERT_OPENED(opened);
  const Part& roof = part(*opened, 3);
  EXPECT_EQ(roof.name, "Roof, outer");
  EXPECT_TRUE(roof.defined);
  EXPECT_EQ(roof.section, 20);
  EXPECT_EQ(roof.material, 30);
  EXPECT_EQ(roof.thickness, 2.5);
  EXPECT_EQ(roof.density, 7.85e-9);
  EXPECT_EQ(roof.youngs_modulus, 210000.0);
  EXPECT_EQ(roof.poissons_ratio, 0.3);
  EXPECT_TRUE(roof.limits_time_step);
}

TEST(Parts, several_in_one_block_with_blank_titles) {
  const DeckFolder folder;
  const auto opened = folder.open("*PART\n\n         3         1         1\n\n         4         2         2\n*PART\n \n         5\n");
  ASSERT_OPENED(opened);
  ASSERT_EQ(opened->model.parts->size(), 3u);
  EXPECT_EQ(part(*opened, 4).section, 2);
  EXPECT_FALSE(part(*opened, 5).section.has_value());
}

TEST(Parts, cards_of_their_options_are_skipped) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "*PART_INERTIA\n"
      "first\n         1         1         1\n"
      " 1.590E-02 0.000E+00 1.424E-04 2.400E-02\n"
      "       1.0       0.0       0.0       1.0       0.0       1.0\n"
      "      14.8       0.0       0.0       0.0       0.0       0.0\n"
      "local axes\n         2         1         1\n"
      " 1.590E-02 0.000E+00 1.424E-04 2.400E-02         1\n"
      "       1.0       0.0       0.0       1.0       0.0       1.0\n"
      "      14.8       0.0       0.0       0.0       0.0       0.0\n"
      "       1.0       0.0       0.0       0.0       1.0       0.0\n"
      "third\n         3         1         1\n"
      " 1.590E-02 0.000E+00 1.424E-04 2.400E-02\n"
      "       1.0       0.0       0.0       1.0       0.0       1.0\n"
      "      14.8       0.0       0.0       0.0       0.0       0.0\n"
      "*PART_CONTACT\n"
      "fourth\n         4         1         1\n"
      "       0.0       0.0       0.0       0.0       1.0       0.0       0.0\n"
      "fifth\n         5         1         1\n"
      "       0.0       0.0       0.0       0.0       1.0       0.0       0.0\n");
  ASSERT_OPENED(opened);
  ASSERT_EQ(opened->model.parts->size(), 5u);
  EXPECT_EQ(part(*opened, 2).name, "local axes");
  EXPECT_EQ(part(*opened, 3).name, "third");
  EXPECT_EQ(part(*opened, 5).name, "fifth");
}

TEST(Parts, composite_layers_add_up_to_the_thickness) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "*MAT_ELASTIC\n         7    1.5e-9   70000.0      0.33\n"
      "*PART_COMPOSITE\nlaminate\n        11         2\n"
      "         7      0.25      45.0                   8      0.25     -45.0\n"
      "         7      0.50\n"
      "*PART_COMPOSITE_CONTACT_LONG\nlong\n        12         2\n"
      "       0.0       0.0       0.0       0.0       1.0       0.0       0.0\n"
      "         7      0.25      45.0         1         8      0.25\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(part(*opened, 11).thickness, 1.0);
  EXPECT_EQ(part(*opened, 11).density, 1.5e-9);
  EXPECT_EQ(part(*opened, 12).thickness, 0.25);
}

TEST(Parts, used_but_not_defined_ones_are_there_without_a_name) {
  const DeckFolder folder;
  const auto opened = folder.open("*NODE\n1,0.,0.,0.\n2,1.,0.,0.\n3,1.,1.,0.\n*ELEMENT_SHELL\n1,42,1,2,3,3\n*PART\nunused\n         7\n");
  ASSERT_OPENED(opened);
  ASSERT_EQ(opened->model.parts->size(), 2u);
  EXPECT_TRUE(part(*opened, 7).defined);
  EXPECT_FALSE(part(*opened, 42).defined);
  EXPECT_EQ(opened->model.shell_parts[0], opened->model.find_part(42));
}

TEST(Sections, corners_that_are_blank_take_the_first_thickness) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "*SECTION_SHELL\n"
      "        20        16       1.0         9       3.0                   1\n       1.5\n"
      "      10.0      20.0      30.0      40.0      50.0      60.0      70.0      80.0\n      90.0\n"
      "        21         2\n       2.5       2.5       2.5       2.5\n"
      "*PART\na\n         1        20\n*PART\nb\n         2        21\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(part(*opened, 1).thickness, 1.5);
  EXPECT_EQ(part(*opened, 2).thickness, 2.5);
}

TEST(Materials, keep_their_constants_where_the_manual_says) {
  struct Case {
    const char* keyword;
    std::optional<double> density, modulus, poisson;
    bool limits;
  };
  // Every field holds its own number, from 2 on.
  const Case cases[] = {{"MAT_ELASTIC", 2, 3, 4, true},
                        {"MAT_001", 2, 3, 4, true},
                        {"MAT_24_TITLE", 2, 3, 4, true},
                        {"MAT_RIGID", 2, 3, 4, false},
                        {"MAT_020", 2, 3, 4, false},
                        {"MAT_NULL", 2, 7, 8, false},
                        {"MAT_JOHNSON_COOK", 2, 4, 5, true},
                        {"MAT_SIMPLIFIED_JOHNSON_COOK", 2, 3, 4, true},
                        {"MAT_FABRIC_TITLE", 2, 3, 6, true},
                        {"MAT_ENHANCED_COMPOSITE_DAMAGE", 2, 3, 6, true},
                        {"MAT_PIECEWISE_LINEAR_PLASTICITY_LOG_INTERPOLATION", 2, 3, 4, true},
                        {"MAT_PLASTICITY_WITH_DAMAGE_ORTHO", 2, 3, 4, true},
                        {"MAT_SAMP-1", 2, 5, 6, true},
                        {"MAT_SPRING_ELASTIC", std::nullopt, std::nullopt, std::nullopt, true},
                        {"MAT_SEATBELT", std::nullopt, std::nullopt, std::nullopt, true},
                        {"MAT_OF_THE_FUTURE", 2, std::nullopt, std::nullopt, true}};
  for (const Case& c : cases) {
    const DeckFolder folder;
    const std::string title = std::string_view(c.keyword).find("_TITLE") != std::string_view::npos ? "title\n" : "";
    const auto opened = folder.open(
        std::string("*") + c.keyword + "\n" + title +
        "         9       2.0       3.0       4.0       5.0       6.0       7.0       8.0\n*PART\np\n         1         0         9\n");
    ASSERT_OPENED(opened);
    const Part& p = part(*opened, 1);
    EXPECT_EQ(p.density, c.density) << c.keyword;
    EXPECT_EQ(p.youngs_modulus, c.modulus) << c.keyword;
    EXPECT_EQ(p.poissons_ratio, c.poisson) << c.keyword;
    EXPECT_EQ(p.limits_time_step, c.limits) << c.keyword;
  }
}

TEST(Materials, additions_to_a_material_are_none) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "*mat_add_erosion\n         9       888\n*MAT_ELASTIC\n         9   7.85E-9  210000.0       0.3\n*PART\np\n         1         0      "
      "   9\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(part(*opened, 1).density, 7.85e-9);
}

TEST(TimeStep, is_what_the_deck_says_and_else_the_solvers_default) {
  const DeckFolder folder;
  const auto said = folder.open("*CONTROL_TIMESTEP\n       0.0      0.67         1       0.0   -3.5E-4\n");
  ASSERT_OPENED(said);
  EXPECT_EQ(said->deck->time_step.scale, 0.67);
  EXPECT_EQ(said->deck->time_step.shell_option, 1);
  EXPECT_EQ(said->deck->time_step.mass_scaled, -3.5e-4);
  const auto silent = folder.open("*CONTROL_TIMESTEP\n1.00000E-8       0.0\n");
  ASSERT_OPENED(silent);
  EXPECT_EQ(silent->deck->time_step.scale, 0.9);
}

TEST(LengthUnit, follows_the_density_and_else_the_edges) {
  const DeckFolder folder;
  const auto guess = [&](const std::string& density, const std::string& size) {
    const auto opened = folder.open("*NODE\n1,0.,0.,0.\n2," + size + ",0.,0.\n3," + size + "," + size + ",0.\n4,0.," + size +
                                    ",0.\n*ELEMENT_SHELL\n1,1,1,2,3,4\n" +
                                    (density.empty() ? "" : "*MAT_ELASTIC\n1," + density + ",1.,0.3\n*PART\np\n1,1,1\n"));
    EXPECT_TRUE(opened);
    return opened ? guess_length_unit(opened->model) : LengthUnit::mm;
  };
  EXPECT_EQ(guess("7.8e-9", "0.005"), LengthUnit::mm);
  EXPECT_EQ(guess("2.7e-6", "5."), LengthUnit::mm);
  EXPECT_EQ(guess("7800.", "5."), LengthUnit::m);
  EXPECT_EQ(guess("7.34e-4", "5."), LengthUnit::in);
  EXPECT_EQ(guess("", "5."), LengthUnit::mm);
  EXPECT_EQ(guess("", "0.005"), LengthUnit::m);
  EXPECT_EQ(guess("1.e-30", "0.005"), LengthUnit::m);
}

}  // namespace
}  // namespace prismesh::mesh::deck
