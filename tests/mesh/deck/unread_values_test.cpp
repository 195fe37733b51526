// Values of sections, properties and materials that can't be read: the deck opens, the value is unknown, and a warning names the line.
#include "mesh/deck/open.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

const std::string kNodes =
    "*KEYWORD\n*NODE\n       1             0.0             0.0             0.0\n       2             1.0             0.0             0.0\n"
    "       3             1.0             1.0             0.0\n*ELEMENT_SHELL\n       1       1       1       2       3       3\n"
    "*PART\nplate\n         1         1         1\n";

struct UnreadValue {
  std::string cards, message;
  long line;
};

TEST(UnreadValues, of_lsdyna_sections_and_materials_are_unknown_and_said) {
  const DeckFolder folder;
  const std::string section = "*SECTION_SHELL\n         1         2\n       1.0       1.0       1.0       1.0\n";
  const UnreadValue cases[] = {
      {"*SECTION_SHELL\n         1         2\n      abc1       1.0       1.0       1.0\n",
       "expected the thickness of a *SECTION_SHELL but found \"abc1\"", 13},
      {section + "*MAT_ELASTIC\n         1     7.x-9   210000.       0.3\n", "expected the density of a material but found \"7.x-9\"", 15},
      {section + "*MAT_ELASTIC\n         1     7.8-9   2100x0.       0.3\n", "expected the modulus of a material but found \"2100x0.\"",
       15},
      {section + "*MAT_ELASTIC\n         1     7.8-9   210000.     steel\n",
       "expected the Poisson's ratio of a material but found \"steel\"", 15},
  };
  for (const UnreadValue& c : cases) {
    const auto opened = folder.open(kNodes + c.cards + "*END\n");
    ASSERT_OPENED(opened);
    const Warning said = warning(*opened->deck, "bad-card");
    EXPECT_EQ(said.message, c.message + "; the card is kept as it is, without that value");
    EXPECT_EQ(said.line, c.line) << c.cards;
    const Part& part = (*opened->model.parts)[0];
    EXPECT_EQ(part.thickness.has_value(), c.cards.find("abc1") == std::string::npos) << "a mean without a corner is no thickness";
    if (c.cards.find("7.x-9") != std::string::npos) {
      EXPECT_EQ(part.density, std::nullopt);
    }
  }
  const auto whole = folder.open(kNodes + section + "*MAT_ELASTIC\n         1     7.8-9   210000.       0.3\n*END\n");
  ASSERT_OPENED(whole);
  EXPECT_EQ(warning(*whole->deck, "bad-card").count, 0u);
}

TEST(UnreadValues, of_radioss_properties_and_materials_are_unknown_and_said) {
  const DeckFolder folder;
  const std::string head =
      "#RADIOSS STARTER\n/BEGIN\nx\n      2022         0\n                  kg                  mm                  ms\n"
      "                  kg                  mm                  ms\n/NODE\n         1                 0.0                 0.0             "
      "    0.0\n"
      "         2                 1.0                 0.0                 0.0\n         3                 1.0                 1.0          "
      "       0.0\n"
      "/SH3N/1\n         1         1         2         3\n/PART/1\nplate\n         1         1         0\n";
  const auto property = [](const std::string& thickness) {
    return "/PROP/SHELL/1\np\n         1         1         1         1\n                 0.0\n         5          " +
           std::string(20 - thickness.size(), ' ') + thickness + "\n";
  };
  const auto material = [](const std::string& density, const std::string& modulus) {
    return "/MAT/ELAST/1\nm\n" + std::string(20 - density.size(), ' ') + density + "\n" + std::string(20 - modulus.size(), ' ') + modulus +
           "                 0.3\n";
  };
  const UnreadValue cases[] = {
      {property("1.x") + material("7.8E-6", "210."), "expected the thickness of a /PROP but found \"1.x\"", 20},
      {property("1.5") + material("7.8Q-6x", "210."), "expected the density of a /MAT but found \"7.8Q-6x\"", 23},
      {property("1.5") + material("7.8E-6", "steel"), "expected the modulus of a /MAT but found \"steel\"", 24},
  };
  for (const UnreadValue& c : cases) {
    const auto opened = deck::open(folder.write("a_0000.rad", head + c.cards + "/END\n"));
    ASSERT_OPENED(opened);
    const Warning said = warning(*opened->deck, "bad-card");
    EXPECT_EQ(said.message, c.message + "; the card is kept as it is, without that value");
    EXPECT_EQ(said.line, c.line) << c.cards;
  }
  const auto whole = deck::open(folder.write("a_0000.rad", head + property("1.5") + material("7.8E-6", "210.") + "/END\n"));
  ASSERT_OPENED(whole);
  EXPECT_EQ(warning(*whole->deck, "bad-card").count, 0u);
  EXPECT_EQ((*whole->model.parts)[0].thickness, 1.5);
}

}  // namespace
}  // namespace prismesh::mesh::deck
