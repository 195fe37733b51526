// Parts, sections, materials, the time step and the guess at the unit.
#include "mesh/deck/lsdyna/definitions.h"
#include "mesh/deck/data/length_unit.h"
#include "mesh/deck/open.h"

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

TEST(Parts, have_their_options_in_any_combination) {
  struct Case {
    const char* keyword;
    int cards;  ///< behind the ids
  };
  // Each card would be taken for a title or for ids if it weren't skipped.
  const Case cases[] = {{"PART", 0},
                        {"PART_REPOSITION", 1},
                        {"PART_CONTACT", 1},
                        {"PART_PRINT", 1},
                        {"PART_ATTACHMENT_NODES", 1},
                        {"PART_AVERAGED", 0},
                        {"PART_FIELD", 1},
                        {"PART_INERTIA", 3},
                        {"PART_REPOSITION_CONTACT", 2},
                        {"PART_CONTACT_PRINT_ATTACHMENT_NODES", 3},
                        {"PART_INERTIA_CONTACT_AVERAGED", 4},
                        {"PART_INERTIA_CONTACT_PRINT_ATTACHMENT_NODES_FIELD", 7}};
  for (const Case& c : cases) {
    const DeckFolder folder;
    std::string text = std::string("*") + c.keyword + "\n";
    for (const char* id : {"1", "2"}) {
      text += std::string("title ") + id + "\n         " + id + "        20        30\n$ what the options want\n";
      for (int card = 0; card < c.cards; ++card) text += "        77        78        79        80\n";
    }
    const auto opened = folder.open(text +
                                    "*SECTION_SHELL\n        20         2\n       1.5\n"
                                    "*MAT_ELASTIC\n        30   7.85E-9  210000.0       0.3\n");
    ASSERT_OPENED(opened);
    ASSERT_EQ(opened->model.parts->size(), 2u) << c.keyword;
    EXPECT_EQ(part(*opened, 2).name, "title 2") << c.keyword;
    EXPECT_EQ(part(*opened, 2).thickness, 1.5) << c.keyword;
    EXPECT_EQ(part(*opened, 2).density, 7.85e-9) << c.keyword;
  }
}

TEST(Parts, are_not_defined_by_keywords_about_them) {
  for (const char* keyword : {"PART_ANNEAL", "PART_ANNEAL_SET", "PART_SENSOR", "PART_MODES", "PART_ADAPTIVE_FAILURE", "PART_MOVE"}) {
    const DeckFolder folder;
    const auto opened = folder.open(std::string("*PART\na\n         1\n*") + keyword + "\n         1       0.5\n         2       0.5\n");
    ASSERT_OPENED(opened);
    EXPECT_EQ(opened->model.parts->size(), 1u) << keyword;
  }
  const DeckFolder folder;
  const auto opened = folder.open("*PART\na\n         1\n*PART_DUPLICATE\n      PART         1       100      1000      1000\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(warning(*opened->deck, "made-at-start").line, 4);
}

TEST(Parts, of_layers_have_the_mean_density_and_thick_ones_no_thickness) {
  const DeckFolder folder;
  const std::string layers =
      "         7       1.5      45.0                   8       0.5     -45.0\n"
      "         7       0.5      45.0                   8       1.5     -45.0\n";
  const auto opened = folder.open(
      "*MAT_ELASTIC\n         7       2.0   70000.0      0.33\n*MAT_ELASTIC\n         8       4.0   10000.0      0.33\n"
      "*PART_COMPOSITE\nsheet\n        11         2\n" +
      layers + "*PART_COMPOSITE_CONTACT\ncontact\n        12         2\n       0.1       0.1       0.0       0.0       1.0       9.0\n" +
      layers + "*PART_COMPOSITE_TSHELL\nthick\n        13         1\n" + layers +
      "*PART_COMPOSITE_IGA_SHELL\nsmooth\n        14         0\n" + layers +
      "*PART_COMPOSITE_LONG\nlong\n        15         2\n"
      "         7       1.0      45.0         0         5       9.0\n         8       3.0      45.0         0         6       9.0\n"
      "*PART_COMPOSITE\nhalf known\n        16         2\n         7       1.0                           9       1.0\n");
  ASSERT_OPENED(opened);
  for (const std::int64_t id : {11, 12, 14}) {
    EXPECT_EQ(part(*opened, id).thickness, 4.0) << id;
    EXPECT_EQ(part(*opened, id).density, 3.0) << id;
  }
  EXPECT_EQ(part(*opened, 12).name, "contact");
  EXPECT_FALSE(part(*opened, 13).thickness.has_value());
  EXPECT_EQ(part(*opened, 13).density, 3.0);
  EXPECT_EQ(part(*opened, 15).thickness, 4.0);
  EXPECT_EQ(part(*opened, 15).density, 3.5);
  EXPECT_EQ(part(*opened, 16).thickness, 2.0);
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

TEST(Parts, and_what_they_are_made_of_count_as_defined_first) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "*PART\nfirst\n         3        20        30\n*PART\nagain\n         3        21        31\n"
      "*SECTION_SHELL\n        20         2\n       1.5\n*SECTION_SHELL\n        20         2\n       9.5\n"
      "*MAT_ELASTIC\n        30       2.0      10.0       0.3\n*MAT_ELASTIC\n        30       4.0      20.0       0.3\n"
      "*MAT_ELASTIC\n        31       8.0      20.0       0.3\n"
      "*PART_COMPOSITE\nlayers\n         4         2\n        30       0.5       0.0\n"
      "*PART_COMPOSITE\nagain\n         4         2\n        31       9.5       0.0\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(part(*opened, 3).name, "first");
  EXPECT_EQ(part(*opened, 3).thickness, 1.5);
  EXPECT_EQ(part(*opened, 3).density, 2.0);
  EXPECT_EQ(part(*opened, 3).youngs_modulus, 10.0);
  EXPECT_EQ(part(*opened, 4).name, "layers");
  EXPECT_EQ(part(*opened, 4).thickness, 0.5);
  EXPECT_EQ(part(*opened, 4).density, 2.0);
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

TEST(Sections, several_in_one_block_with_cards_of_their_options) {
  for (const char* option : {"", "_EFG", "_THERMAL", "_XFEM", "_MISC"})
    for (const bool titled : {false, true}) {
      const DeckFolder folder;
      std::string text = std::string("*SECTION_SHELL") + option + (titled ? "_TITLE\n" : "\n");
      for (int section = 1; section <= 3; ++section) {
        text += titled ? "a title\n" : "";
        // The second has an angle for each of its nine points.
        text += "         " + std::to_string(section) + "        16       1.0         9       0.0       0.0" +
                (section == 2 ? "         1\n" : "         0\n") + "       " + std::to_string(section) + ".5\n";
        if (section == 2) text += "      91.0      92.0      93.0\n$ between\n      99.0\n";
        text += *option ? "        88        89        90\n" : "";
      }
      const auto opened = folder.open(text + "*PART\na\n         1         1\nb\n         2         2\nc\n         3         3\n");
      ASSERT_OPENED(opened);
      for (const std::int64_t id : {1, 2, 3}) EXPECT_EQ(part(*opened, id).thickness, static_cast<double>(id) + 0.5) << option << titled;
    }
}

TEST(Sections, of_user_defined_formulations_have_cards_of_their_own) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "*SECTION_SHELL\n"
      "         1       101       1.0         2\n       1.5       1.5       1.5       1.5\n"
      "$ two points and ten constants\n"
      "         2         0         0         0         0        10\n"
      "    0.5774    0.5774       1.0\n   -0.5774    0.5774       1.0\n"
      "      11.0      12.0      13.0      14.0      15.0      16.0      17.0      18.0\n      19.0      20.0\n"
      "         2       105       1.0         2\n       2.5\n         0         0         0         0         0         0\n"
      "         3         2\n       3.5\n"
      "*PART\na\n         1         1\nb\n         2         2\nc\n         3         3\nd\n         4        11\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(part(*opened, 1).thickness, 1.5);
  EXPECT_EQ(part(*opened, 2).thickness, 2.5);
  EXPECT_EQ(part(*opened, 3).thickness, 3.5);
  EXPECT_FALSE(part(*opened, 4).thickness.has_value());
}

TEST(Sections, hold_absurd_counts_out) {
  const DeckFolder folder;
  for (const char* counts : {"         1        16       1.0     1e300       0.0       0.0         1\n       1.5\n",
                             "         1       101\n       1.5\n 999999999 999999999         0         0         0     1e300\n",
                             "         1       101\n       1.5\n-999999999         0         0         0         0    -1e300\n"}) {
    const auto opened = folder.open(std::string("*SECTION_SHELL\n") + counts + "*PART\na\n         1         1\n");
    ASSERT_OPENED(opened);
    EXPECT_EQ(part(*opened, 1).thickness, 1.5);
  }
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
                        {"MAT_057", 2, 3, std::nullopt, true},
                        {"MAT_073", 2, 3, std::nullopt, true},
                        {"MAT_VISCOUS_FOAM", 2, 3, 8, true},
                        {"MAT_142", 2, std::nullopt, std::nullopt, true},
                        {"MAT_ARUP_ADHESIVE", 2, 3, 4, true},
                        {"MAT_169_TITLE", 2, 3, 4, true},
                        {"MAT_SIMPLIFIED_RUBBER/FOAM", 2, std::nullopt, std::nullopt, true},
                        {"MAT_225", 2, 3, 4, true},
                        {"MAT_251", 2, 3, 4, true},
                        {"MAT_LAMINATED_FRACTURE_DAIMLER_PINHO", 2, 3, 6, true},
                        // Their names or numbers begin as others do, but their constants are different ones.
                        {"MAT_ELASTIC_SPRING_DISCRETE_BEAM", 2, std::nullopt, std::nullopt, true},
                        {"MAT_ELASTIC_PLASTIC_THERMAL", 2, std::nullopt, std::nullopt, true},
                        {"MAT_ELASTIC_WITH_VISCOSITY", 2, std::nullopt, std::nullopt, true},
                        {"MAT_ELASTIC_VISCOPLASTIC_THERMAL", 2, 3, 4, true},
                        {"MAT_002_ANIS", 2, std::nullopt, std::nullopt, true},
                        {"MAT_122_3D_TITLE", 2, 3, 6, true},
                        {"MAT_122", 2, 3, 4, true},
                        {"MAT_B01", std::nullopt, std::nullopt, std::nullopt, true},
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
      "*mat_add_erosion\n         9       888\n*MAT_NONLOCAL\n         9       777\n*MAT_ELASTIC\n         9   7.85E-9  210000.0       "
      "0.3\n*PART\np\n         1         0      "
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
  EXPECT_EQ(guess("", "0.09"), LengthUnit::m) << "coarse shells of a body in metres";
  EXPECT_EQ(guess("", "0.11"), LengthUnit::mm) << "fine ones in millimetres";
  const auto without_shells = folder.open("*NODE\n1,0.,0.,0.\n2,0.001,0.,0.\n");
  ASSERT_OPENED(without_shells);
  EXPECT_EQ(guess_length_unit(without_shells->model), LengthUnit::mm);
}

}  // namespace
}  // namespace prismesh::mesh::deck
