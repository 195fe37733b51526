#include "mesh/contact/contact_thickness.h"

#include <cmath>
#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "tests/support/make_model.h"

namespace prismesh::mesh::contact {
namespace {

/// A row of four quads in the parts 1, 1, 2, 3; part 1 is 2 thick, part 2 has no thickness, part 3 has `third`.
Model four_shells(double third) {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int i = 0; i <= 4; ++i) nodes.push_back({1 + i, Vec3(i, 0, 0)}), nodes.push_back({11 + i, Vec3(i, 1, 0)});
  for (const std::int64_t i : {0, 1, 2, 3}) shells.push_back({1 + i, i < 2 ? 1 : i, {1 + i, 2 + i, 12 + i, 11 + i}});
  Model model = test::make_model(nodes, shells);
  std::vector<Part> parts = *model.parts;
  parts[0].thickness = 2;
  parts[2].thickness = third;
  model.parts = std::make_shared<const std::vector<Part>>(parts);
  return model;
}

TEST(ContactThickness, is_the_elements_own_else_its_sections) {
  Model model = four_shells(0.7);
  model.shell_thickness.set(1, 1.5F);
  const ContactThickness thickness = section_thickness(model);
  EXPECT_EQ(thickness.of_shell, (std::vector<double>{2, 1.5, 0, 0.7}));
  EXPECT_EQ(thickness.of_part, (std::vector{ThicknessFrom::section, ThicknessFrom::none, ThicknessFrom::section}));
  EXPECT_EQ(thickness.without, std::vector{PartIndex(std::size_t{1})});
  EXPECT_EQ(name(thickness.from(PartIndex(std::size_t{0}))), "section");
  EXPECT_EQ(name(thickness.from(PartIndex{})), "none");
}

TEST(ContactThickness, is_none_where_the_deck_has_no_usable_number) {
  for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    const ContactThickness thickness = section_thickness(four_shells(bad));
    EXPECT_EQ(thickness.of_shell[3], 0) << bad;
    EXPECT_EQ(thickness.without.size(), 2u) << bad;
  }
}

TEST(ContactThickness, of_some_shells_of_a_part) {
  Model model = four_shells(1);
  model.shell_thickness.set(2, 3);
  EXPECT_TRUE(section_thickness(model).without.empty()) << "the part's only shell has its own";
  std::vector<Part> parts = *model.parts;
  parts[0].thickness.reset();
  model.parts = std::make_shared<const std::vector<Part>>(parts);
  model.shell_thickness.set(0, 1);
  EXPECT_EQ(section_thickness(model).without, std::vector{PartIndex(std::size_t{0})}) << "its second shell has none";
  EXPECT_EQ(section_thickness(model).of_part[0], ThicknessFrom::section);
}

TEST(ContactThickness, can_be_given_for_all) {
  const ContactThickness thickness = given_thickness(four_shells(0), 1.25);
  EXPECT_EQ(thickness.of_shell, std::vector<double>(4, 1.25));
  EXPECT_EQ(name(thickness.of_part[1]), "given");
  EXPECT_TRUE(thickness.without.empty());
}

}  // namespace
}  // namespace prismesh::mesh::contact
