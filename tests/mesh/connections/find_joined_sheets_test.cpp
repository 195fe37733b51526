#include "mesh/connections/find_joined_sheets.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/make_model.h"

namespace prismesh::mesh::connections {
namespace {

/// Two parallel sheets of 4 x 4 shells, 1.5 apart; their nodes are 1 + i + 10 j and 1001 + i + 10 j, the shells 0-15 and 16-31.
struct TwoSheets {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  std::vector<NodeSet> cards;
  double thickness = 0;
  TwoSheets() {
    for (int sheet = 0; sheet < 2; ++sheet)
      for (int j = 0; j <= 4; ++j)
        for (int i = 0; i <= 4; ++i) nodes.push_back({1 + 1000 * sheet + i + 10 * j, Vec3(5.0 * i + sheet, 5.0 * j + sheet, 1.5 * sheet)});
    for (int sheet = 0; sheet < 2; ++sheet)
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
          const std::int64_t corner = 1 + 1000 * sheet + i + 10 * j;
          shells.push_back({1 + 100 * sheet + i + 4 * j, 1 + sheet, {corner, corner + 1, corner + 11, corner + 10}});
        }
  }
  Model model(const std::vector<test::ElementSpec>& elements) const {
    const Model made = test::make_model(nodes, shells, elements);
    return thickness > 0 ? test::with_thickness(made, thickness) : made;
  }
  /// Whether the elements join the sheets; they join no shell to one of the same sheet.
  bool joined_by(const std::vector<test::ElementSpec>& elements, OutOfSight hidden = {}) const {
    const JoinedSheets joined = find_joined_sheets(model(elements), cards, hidden);
    for (const auto& [a, b] : joined.all()) EXPECT_NE(a.value < 16, b.value < 16);
    return !joined.all().empty();
  }
};

TEST(JoinedSheets, hold_each_pair_in_both_orders_once) {
  const ShellIndex a(std::size_t{3}), b(std::size_t{7}), c(std::size_t{5});
  const JoinedSheets joined({{b, a}, {a, b}, {a, c}}, {10, 10, 10, 10, 20, 20, 20, 30, 40});
  EXPECT_EQ(std::vector(joined.all().begin(), joined.all().end()), (std::vector<JoinedSheets::Pair>{{a, c}, {a, b}, {c, a}, {b, a}}));
  EXPECT_EQ(joined.of(a).size(), 2u);
  EXPECT_EQ(joined.of(b).front().second, a);
  EXPECT_TRUE(joined.of(ShellIndex(std::size_t{4})).empty());
  EXPECT_TRUE(joined.joined(10, 20) && joined.joined(20, 10) && joined.joined(30, 10)) << "sheets, by any of their shells";
  EXPECT_TRUE(joined.joined(40, 40)) << "a sheet is joined to itself";
  EXPECT_FALSE(joined.joined(20, 30)) << "each is joined to the first, not to each other";
}

TEST(FindJoinedSheets, by_elements_of_every_kind) {
  using enum ElementClass;
  TwoSheets sheets;
  EXPECT_FALSE(sheets.joined_by({}));
  EXPECT_TRUE(sheets.joined_by({{beam, 1, 9, {23, 1023}}})) << "with the sheets' own nodes";
  EXPECT_TRUE(sheets.joined_by({{discrete, 1, 9, {23, 1023}}}));
  EXPECT_FALSE(sheets.joined_by({{beam, 1, 9, {22, 24}}})) << "a stiffener";
  EXPECT_FALSE(sheets.joined_by({{beam, 1, 9, {1, 1045}}})) << "too long for a weld";
  EXPECT_FALSE(sheets.joined_by({{mass, 1, 9, {23, 1023}}}));
  EXPECT_FALSE(sheets.joined_by({{beam, 1, 9, {22, 23, 1023}}})) << "a stiffener, turned towards the other sheet";
  EXPECT_TRUE(sheets.joined_by({{beam, 1, 9, {23, 1023, 1045}}})) << "a weld, turned towards a node far away";
  // nodes of their own, as welds in a file of their own have
  sheets.nodes.push_back({5001, Vec3(11.2, 12.1, 0.2)});
  sheets.nodes.push_back({5002, Vec3(11.2, 12.1, 1.4)});
  sheets.nodes.push_back({5003, Vec3(11.2, 12.1, 9.0)});
  EXPECT_TRUE(sheets.joined_by({{beam, 1, 9, {5001, 5002}}}));
  EXPECT_FALSE(sheets.joined_by({{beam, 1, 9, {5001, 5003}}})) << "one end is nowhere near a sheet";
  for (int k = 0; k < 8; ++k) {
    const int round = k % 4;
    sheets.nodes.push_back({6001 + k, Vec3(8.0 + 4 * (round == 1 || round == 2), 8.0 + 4 * (round > 1), k < 4 ? 0.1 : 1.45)});
  }
  EXPECT_TRUE(sheets.joined_by({{solid, 1, 9, {6001, 6002, 6003, 6004, 6005, 6006, 6007, 6008}}}));
}

TEST(FindJoinedSheets, by_nodes_that_a_card_holds_together) {
  TwoSheets sheets;
  const Model model = sheets.model({});
  sheets.cards = {{model.find_node(23), model.find_node(1023)}};
  EXPECT_TRUE(sheets.joined_by({}));
  sheets.cards = {{model.find_node(23), model.find_node(24)}, {model.find_node(1023)}};
  EXPECT_FALSE(sheets.joined_by({})) << "two cards, each on one sheet";
}

TEST(FindJoinedSheets, not_with_a_hidden_sheet) {
  TwoSheets sheets;
  const std::vector<std::uint8_t> second_hidden{0, 1, 0};
  EXPECT_FALSE(sheets.joined_by({{ElementClass::beam, 1, 9, {23, 1023}}}, second_hidden));
  sheets.nodes.push_back({5001, Vec3(11.2, 12.1, 0.2)});
  sheets.nodes.push_back({5002, Vec3(11.2, 12.1, 1.4)});
  EXPECT_FALSE(sheets.joined_by({{ElementClass::beam, 1, 9, {5001, 5002}}}, second_hidden));
}

TEST(FindJoinedSheets, up_to_the_reach_at_which_a_placed_node_lies_on_a_sheet) {
  // the end above the second sheet is 0.25 sides or a thickness away, less or more
  for (const double thickness : {0.0, 0.8, 1.245}) {
    const double reach = std::max(0.25 * 5, thickness);
    for (const double share : {0.99, 1.01}) {
      TwoSheets sheets;
      sheets.thickness = thickness;
      sheets.nodes.push_back({5002, Vec3(11.2, 12.1, 1.5 + share * reach)});
      EXPECT_EQ(sheets.joined_by({{ElementClass::beam, 1, 9, {23, 5002}}}), share < 1) << thickness;
    }
  }
}

TEST(FindJoinedSheets, not_by_a_stiffener_over_a_crease) {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (int j = 0; j <= 2; ++j)
    for (int i = 0; i <= 4; ++i) nodes.push_back({1 + i + 10 * j, Vec3(i, j, -std::abs(i - 2))});
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 4; ++i) shells.push_back({1 + i + 4 * j, 1, {1 + i + 10 * j, 2 + i + 10 * j, 12 + i + 10 * j, 11 + i + 10 * j}});
  const Model model = test::make_model(nodes, shells, {{ElementClass::beam, 1, 9, {12, 14}}});
  EXPECT_TRUE(find_joined_sheets(model, {}, {}).all().empty());
}

}  // namespace
}  // namespace prismesh::mesh::connections
