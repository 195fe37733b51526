// The contacts that a change makes: the search of both whole models, and the least distances of all triangles, are the oracles.
#include "mesh/contact/new_contacts.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <random>
#include <utility>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "mesh/contact/find_penetrations.h"
#include "tests/mesh/contact/plain_clearance.h"
#include "tests/mesh/contact/sheets_that_meet.h"

namespace prismesh::mesh::contact {
namespace {

ContactsBefore before_of(const Model& model, double thickness) {
  return {model, spatial::BoxTree(model), std::make_shared<const ContactThickness>(given_thickness(model, thickness))};
}

/// The greatest depth between two parts by the search of the whole model; where they cross a number above every depth.
using DepthOfParts = std::map<std::pair<PartIndex, PartIndex>, double>;
DepthOfParts depths_by_parts(const Model& model, double thickness) {
  constexpr double kCrosses = 1e9;
  const spatial::BoxTree tree(model);
  const auto crossings = find_shell_crossings(model, tree);
  DepthOfParts depths;
  for (const Penetration& region : find_penetrations(model, tree, given_thickness(model, thickness), crossings)) {
    double& depth = depths[{region.part_a, region.part_b}];
    depth = std::max(depth, region.max_depth);
  }
  for (const ShellCrossing& crossing : crossings) {
    const auto parts = std::minmax(model.shell_parts[crossing.a.value], model.shell_parts[crossing.b.value]);
    depths[{parts.first, parts.second}] = kCrosses;
  }
  return depths;
}

/// Moves the nodes within a radius about a node.
Model moved_about(const Model& model, NodeIndex node, double radius, const Vec3& by) {
  Model moved = model;
  const Vec3 centre = model.position(node);
  for (std::size_t n = 0; n < model.node_count(); ++n)
    if ((model.positions[n] - centre).norm() < radius) moved.positions.set(n, model.positions[n] + by);
  return moved;
}

TEST(NewContacts, are_found_wherever_two_parts_come_closer_than_they_were) {
  std::size_t found_any = 0, deeper = 0;
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    std::mt19937 random(seed);
    const auto uniform = [&](double low, double high) { return low + (high - low) * (static_cast<double>(random()) / 4294967296.0); };
    test::SheetsThatMeet sheets;
    for (const int part : {1, 2, 3}) {
      const double phase = uniform(0, 6), off = uniform(0, 1), steep = uniform(0, 0.3);
      sheets.add(part, 12, 9, [=](int i, int j) {
        return Vec3(i + off, j + off, 0.9 * part + steep * std::sin(0.5 * i + phase) * std::cos(0.6 * j - phase));
      });
    }
    const Model model = sheets.model();
    const NodeIndex about(random() % model.node_count());
    const double x = uniform(-0.2, 0.2), y = uniform(-0.2, 0.2), z = uniform(-0.7, 0.7);  // in this order with any compiler
    const Model after = moved_about(model, about, 2.2, Vec3(x, y, z));
    const auto found = before_of(model, 0.35).new_in(after);
    DepthOfParts was = depths_by_parts(model, 0.35);
    for (const auto& [parts, depth] : depths_by_parts(after, 0.35)) {
      if (depth <= was[parts] + 1e-3 * 0.35) continue;
      ++deeper;
      EXPECT_TRUE(std::any_of(found.begin(), found.end(),
                              [&, both = parts](const NewContact& contact) {
                                const auto its = std::minmax(after.shell_parts[contact.a.value], after.shell_parts[contact.b.value]);
                                return its.first == both.first && its.second == both.second;
                              }))
          << "seed " << seed;
    }
    for (const NewContact& contact : found) {
      ++found_any;
      EXPECT_LT(contact.a, contact.b);
      EXPECT_FALSE(contact.by.empty());
      const ShellSet touched = shells_touching(after, moved_nodes(model, after));
      for (const ShellIndex shell : contact.by) EXPECT_TRUE(std::binary_search(touched.begin(), touched.end(), shell));
      EXPECT_LT(test::PlainClearance::between(after, after.shell_parts[contact.a.value], after.shell_parts[contact.b.value]), 0.35);
    }
    EXPECT_TRUE(before_of(after, 0.35).new_in(after).empty()) << "nothing changed";
  }
  EXPECT_GT(deeper, 8u);
  EXPECT_GT(found_any, 100u);
}

TEST(NewContacts, are_none_where_a_sheet_slides_on_another_and_all_where_it_sinks) {
  test::SheetsThatMeet sheets;
  sheets.add_plate(1).add(2, 10, 10, [](int i, int j) { return Vec3(i - 5, j - 5, 0.6); });
  const Model model = sheets.model();
  const ContactsBefore before = before_of(model, 1);
  const auto upper = [&](const Vec3& by) {
    Model moved = model;
    for (std::size_t n = 0; n < model.node_count(); ++n)
      if (model.positions[n].z() > 0.3) moved.positions.set(n, model.positions[n] + by);
    return moved;
  };
  EXPECT_TRUE(before.new_in(upper({0.4, 0.7, 0})).empty());
  EXPECT_TRUE(before.new_in(upper({0, 0, 0.1})).empty());
  const auto sunk = before.new_in(upper({0, 0, -0.01}));
  ASSERT_FALSE(sunk.empty());
  EXPECT_NEAR(sunk.front().depth, 0.41, 1e-9);
  EXPECT_EQ(in_words(model, sunk), "part 1 and part 2 would be too close, 0.41 deep");
  EXPECT_TRUE(before.new_in(upper({0, 0, -0.0005})).empty()) << "rounding of what is closer by less than a thousandth";
  EXPECT_EQ(in_words(model, before.new_in(upper({0.3, 0.3, -0.9}))).substr(0, 17), "part 1 and part 2");
}

TEST(NewContacts, are_the_same_on_any_number_of_threads) {
  test::SheetsThatMeet sheets;
  sheets.add_plate(1).add(2, 30, 30, [](int i, int j) { return Vec3(0.3 * i - 4.5, 0.3 * j - 4.5, 1.2 + 0.02 * (i % 3)); });
  const Model model = sheets.model();
  const Model after = moved_about(model, NodeIndex(500u), 3, Vec3(0.1, 0, -0.9));
  const auto numbers = [&](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    std::vector<std::tuple<std::uint32_t, std::uint32_t, bool, double>> all;
    for (const NewContact& c : before_of(model, 1).new_in(after)) all.emplace_back(c.a.value, c.b.value, c.crosses, c.depth);
    return all;
  };
  const auto one = numbers(1);
  EXPECT_GT(one.size(), 20u);
  EXPECT_EQ(numbers(2), one);
  EXPECT_EQ(numbers(7), one);
}

}  // namespace
}  // namespace prismesh::mesh::contact
