#include "mesh/select/expression.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/model/topology_change.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::select {
namespace {

using Ids = std::vector<std::int64_t>;

/// Two parts of two shells each, a beam and a solid. Node ids 10, 20, .. 90 in a 3x3 grid, then 1000..1007 and two far ones.
Model two_part_model() {
  std::vector<test::NodeSpec> nodes;
  for (int i = 0; i < 9; ++i) nodes.push_back({10 * (i + 1), Vec3(i % 3, i / 3, 0)});
  for (int i = 0; i < 8; ++i) nodes.push_back({1000 + i, Vec3(5 + i % 2, i / 2 % 2, i / 4)});
  nodes.push_back({5000000000, Vec3(9, 9, 9)});
  nodes.push_back({9223372036854775807, Vec3(9, 9, 8)});
  return test::make_model(
      nodes, {{100, 3, {10, 20, 50, 40}}, {101, 3, {20, 30, 60, 50}}, {205, 7, {40, 50, 80, 70}}, {206, 7, {50, 60, 90}}},
      {{ElementClass::beam, 9, 7, {90, 1000}}, {ElementClass::solid, 100, 8, {1000, 1001, 1003, 1002, 1004, 1005, 1007, 1006}}}, {55});
}

Ids node_ids(const Model& model, const Chosen& chosen) {
  Ids ids;
  for (const NodeIndex node : chosen.nodes) ids.push_back(model.node_ids[node.value]);
  return ids;
}
Ids shell_ids(const Model& model, const Chosen& chosen) {
  Ids ids;
  for (const ShellIndex shell : chosen.shells) ids.push_back(model.shell_ids[shell.value]);
  return ids;
}

Ids nodes_named(const Model& model, std::string_view expression) {
  const auto chosen = evaluate(model, expression, EntityKind::node);
  EXPECT_TRUE(chosen.has_value()) << expression << ": " << chosen.error().text();
  if (!chosen) return {};
  EXPECT_TRUE(chosen->shells.empty());
  return node_ids(model, *chosen);
}
Ids shells_named(const Model& model, std::string_view expression, EntityKind kind = EntityKind::element) {
  const auto chosen = evaluate(model, expression, kind);
  EXPECT_TRUE(chosen.has_value()) << expression << ": " << chosen.error().text();
  return chosen ? shell_ids(model, *chosen) : Ids();
}
std::string error_of(const Model& model, std::string_view expression, EntityKind kind = EntityKind::node) {
  const auto chosen = evaluate(model, expression, kind);
  return chosen ? "no error" : chosen.error().text();
}

TEST(Expression, names_single_ids_ranges_and_steps) {
  const Model model = two_part_model();
  EXPECT_EQ(nodes_named(model, "20"), (Ids{20}));
  EXPECT_EQ(nodes_named(model, "20,10"), (Ids{10, 20}));
  EXPECT_EQ(nodes_named(model, "20-50"), (Ids{20, 30, 40, 50}));
  EXPECT_EQ(nodes_named(model, "15-55"), (Ids{20, 30, 40, 50}));
  EXPECT_EQ(nodes_named(model, "10-90:20"), (Ids{10, 30, 50, 70, 90}));
  EXPECT_EQ(nodes_named(model, "5-90:15"), (Ids{20, 50, 80}));
  EXPECT_EQ(nodes_named(model, "1000-1003:2"), (Ids{1000, 1002}));
  EXPECT_EQ(nodes_named(model, "007-0000010"), (Ids{10}));
}

TEST(Expression, works_from_left_to_right) {
  const Model model = two_part_model();
  EXPECT_EQ(nodes_named(model, "10-50,!30"), (Ids{10, 20, 40, 50}));
  EXPECT_EQ(nodes_named(model, "!30,10-50"), (Ids{10, 20, 30, 40, 50}));
  EXPECT_EQ(nodes_named(model, "10-90,!20-80,50"), (Ids{10, 50, 90}));
  EXPECT_EQ(nodes_named(model, "10,!10"), Ids());
  EXPECT_EQ(nodes_named(model, "10-30,part:7,!part:3,1000-1003:3"), (Ids{70, 80, 90, 1000, 1003}));
}

TEST(Expression, ignores_spaces_and_case) {
  const Model model = two_part_model();
  EXPECT_EQ(nodes_named(model, "  10 - 30 ,\t! 20 "), (Ids{10, 30}));
  EXPECT_EQ(nodes_named(model, "10 - 90 : 40"), (Ids{10, 50, 90}));
  EXPECT_EQ(nodes_named(model, "Shell : 100 ,! NODE:10"), (Ids{20, 40, 50}));
}

TEST(Expression, names_all) {
  const Model model = two_part_model();
  EXPECT_EQ(nodes_named(model, "all").size(), 19u);
  EXPECT_EQ(nodes_named(model, "all,!1-8000000000").size(), 1u);
  EXPECT_EQ(nodes_named(model, "shell:all").size(), 9u);
  EXPECT_EQ(nodes_named(model, "all,!all"), Ids());
  EXPECT_EQ(shells_named(model, "all"), (Ids{100, 101, 205, 206}));
  EXPECT_EQ(shells_named(model, "all", EntityKind::part), (Ids{100, 101, 205, 206}));
}

TEST(Expression, names_nothing_that_was_removed) {
  Model model = two_part_model();
  remove_shell(model, model.find_shell(206));
  remove_node(model, model.find_node(90));
  const auto count = [&](std::string_view expression, EntityKind kind) {
    const auto chosen = evaluate(model, expression, kind);
    EXPECT_TRUE(chosen.has_value()) << chosen.error().text();
    return chosen ? std::pair(chosen->nodes.size(), chosen->shells.size()) : std::pair<std::size_t, std::size_t>();
  };
  const Ids shells{100, 101, 205};
  EXPECT_EQ(shells_named(model, "all"), shells);
  EXPECT_EQ(shells_named(model, "~shell:100"), (Ids{101, 205}));
  EXPECT_EQ(shells_named(model, "part:7"), Ids{205});
  EXPECT_EQ(shells_named(model, "part:7", EntityKind::part), Ids{205});
  EXPECT_EQ(count("~node:10", EntityKind::node).first, model.node_count() - 2);
}

TEST(Expression, takes_the_mid_side_nodes_of_shells) {
  Model model = two_part_model();
  auto midside = std::make_shared<std::vector<MidsideNodes>>();
  midside->push_back({model.find_shell(101), {model.find_node(1000), NodeIndex(), model.find_node(1001), NodeIndex()}});
  model.midside = midside;
  EXPECT_EQ(nodes_named(model, "shell:101"), (Ids{20, 30, 50, 60, 1000, 1001}));
  EXPECT_EQ(nodes_named(model, "shell:100"), (Ids{10, 20, 40, 50}));
}

TEST(Expression, takes_the_class_of_each_item) {
  const Model model = two_part_model();
  EXPECT_EQ(nodes_named(model, "shell:100"), (Ids{10, 20, 40, 50}));
  EXPECT_EQ(nodes_named(model, "element:206"), (Ids{50, 60, 90}));
  EXPECT_EQ(nodes_named(model, "beam:9"), (Ids{90, 1000}));
  EXPECT_EQ(nodes_named(model, "solid:100,!node:1004-1007"), (Ids{1000, 1001, 1002, 1003}));
  // all elements of the part: its shells and its beam
  EXPECT_EQ(nodes_named(model, "part:7"), (Ids{40, 50, 60, 70, 80, 90, 1000}));
  EXPECT_EQ(nodes_named(model, "part:8").size(), 8u);
  EXPECT_EQ(nodes_named(model, "part:55"), Ids());
  EXPECT_EQ(shells_named(model, "205"), (Ids{205}));
  EXPECT_EQ(shells_named(model, "part:3,!100"), (Ids{101}));
  EXPECT_EQ(shells_named(model, "node:60"), (Ids{101, 206}));
  EXPECT_EQ(shells_named(model, "3", EntityKind::part), (Ids{100, 101}));
  EXPECT_EQ(shells_named(model, "shell:101,node:70", EntityKind::part), (Ids{100, 101, 205, 206}));
}

TEST(Expression, gives_the_nodes_of_elements_and_the_parts) {
  const Model model = two_part_model();
  const auto shells = evaluate(model, "100,206", EntityKind::element);
  ASSERT_TRUE(shells);
  EXPECT_EQ(node_ids(model, *shells), (Ids{10, 20, 40, 50, 60, 90}));
  EXPECT_TRUE(shells->parts.empty());
  const auto parts = evaluate(model, "3,8,55", EntityKind::part);
  ASSERT_TRUE(parts);
  EXPECT_EQ(parts->parts, (std::vector{PartIndex(std::size_t{0}), PartIndex(std::size_t{2}), PartIndex(std::size_t{3})}));
  EXPECT_EQ(shell_ids(model, *parts), (Ids{100, 101}));
  EXPECT_EQ(node_ids(model, *parts).size(), 6u + 8u);
}

TEST(Expression, reaches_the_largest_ids_at_no_cost) {
  const Model model = two_part_model();
  EXPECT_EQ(nodes_named(model, "5000000000"), (Ids{5000000000}));
  EXPECT_EQ(nodes_named(model, "9223372036854775807"), (Ids{9223372036854775807}));
  EXPECT_EQ(nodes_named(model, "0-9223372036854775807").size(), 19u);
  EXPECT_EQ(nodes_named(model, "0-9223372036854775807:9223372036854775807"), (Ids{9223372036854775807}));
  EXPECT_EQ(nodes_named(model, "2000-9223372036854775806"), (Ids{5000000000}));
}

TEST(Expression, says_what_names_nothing_and_what_is_near) {
  const Model model = two_part_model();
  EXPECT_EQ(error_of(model, "10,24"), "expression:4: there is no node 24; the nearest is node:20");
  EXPECT_EQ(error_of(model, "10,25"), "expression:4: there is no node 25; the nearest is node:20");
  EXPECT_EQ(error_of(model, "10,26"), "expression:4: there is no node 26; the nearest is node:30");
  EXPECT_EQ(error_of(model, "10, !1"), "expression:6: there is no node 1; the nearest is node:10");
  EXPECT_EQ(error_of(model, "31-39"), "expression:1: no node lies in 31-39; the nearest is node:30");
  EXPECT_EQ(error_of(model, "33-39"), "expression:1: no node lies in 33-39; the nearest is node:40");
  EXPECT_EQ(error_of(model, "11-59:10"), "expression:1: no node lies in 11-59:10; the nearest is node:20");
  EXPECT_EQ(error_of(model, "part:4"), "expression:1: there is no part 4; the nearest is part:3");
  EXPECT_EQ(error_of(model, "99", EntityKind::element), "expression:1: there is no shell 99; the nearest is shell:100");
  EXPECT_EQ(error_of(model, "1", EntityKind::part), "expression:1: there is no part 1; the nearest is part:3");
  EXPECT_EQ(error_of(model, "sph:1"), "expression:1: there is no sph in the model");
  EXPECT_EQ(error_of(model, "100,beam:9", EntityKind::element),
            "expression:5: only shells can be selected as elements; select beam nodes with kind node");
}

TEST(Expression, points_at_what_it_cannot_read) {
  const Model model = two_part_model();
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "expression:1: the expression is empty: write ids such as 1-100,205 or all"},
      {"   ", "expression:1: the expression is empty: write ids such as 1-100,205 or all"},
      {"10,", "expression:4: the expression ends where an id is expected"},
      {"10,,20", "expression:4: unexpected ',' where an id is expected"},
      {"10 20", "expression:4: unexpected '2': items are separated by commas"},
      {"10-", "expression:4: the expression ends where the range's last id is expected"},
      {"10-x", "expression:4: unexpected 'x' where the range's last id is expected"},
      {"-5", "expression:1: unexpected '-' where an id is expected"},
      {"50-10", "expression:1: the range runs backwards: write 10-50"},
      {"10-50:0", "expression:7: a range's step must be at least 1"},
      {"10-50:", "expression:7: the expression ends where the range's step is expected"},
      {"10:5", "expression:3: a step needs a range, as in 1-1000:10"},
      {"prt:3", "expression:1: unknown word \"prt\"; did you mean \"part\"?"},
      {"10,al", "expression:4: unknown word \"al\"; did you mean \"all\"?"},
      {"part", "expression:5: a colon and an id must follow \"part\", as in part:3"},
      {"part:", "expression:6: the expression ends where an id is expected"},
      {"part:node:3", "expression:6: an id or all must follow \"part:\", not \"node\""},
      {"10;20", "expression:3: unexpected ';': items are separated by commas"},
      {"10,!!20", "expression:5: unexpected '!' where an id is expected"},
      {"99999999999999999999", "expression:1: the number is too large: ids end at 9223372036854775807"},
      {"10-9223372036854775808", "expression:4: the number is too large: ids end at 9223372036854775807"},
      {"10,\xc3\xa9", "expression:4: unexpected the byte \\xc3 where an id is expected"},
      {std::string("10\0", 3), "expression:3: unexpected the byte \\x00: items are separated by commas"},
  };
  for (const auto& [expression, message] : cases) EXPECT_EQ(error_of(model, expression), message) << expression;
}

TEST(Expression, is_written_in_ascending_ranges) {
  EXPECT_EQ(to_expression({}), "");
  EXPECT_EQ(to_expression({7}), "7");
  EXPECT_EQ(to_expression({205, 3, 2, 1, 3, 4}), "1-4,205");
  EXPECT_EQ(to_expression({9223372036854775807, 9223372036854775806, 1}), "1,9223372036854775806-9223372036854775807");
}

TEST(Expression, comes_back_from_what_it_writes) {
  const Model model = two_part_model();
  for (const char* expression : {"10-50,!30", "all", "part:7", "1000-1007:3,90"}) {
    const Ids ids = nodes_named(model, expression);
    EXPECT_EQ(nodes_named(model, to_expression(ids)), ids) << expression;
  }
}

}  // namespace
}  // namespace prismesh::mesh::select
