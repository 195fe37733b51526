// Contacts kept from state to state: the search of each whole state from nothing is the oracle, bit for bit.
#include "mesh/contact/kept_contacts.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "tests/mesh/contact/sheets_that_meet.h"

namespace prismesh::mesh::contact {
namespace {

/// All that was found, every bit of every number.
std::vector<std::uint64_t> all_bits(const KeptContacts& kept) {
  std::vector<std::uint64_t> bits;
  const auto number = [&](double value) { bits.push_back(std::bit_cast<std::uint64_t>(value)); };
  const auto point = [&](const Vec3& at) { number(at.x()), number(at.y()), number(at.z()); };
  const auto indices = [&](const auto& of) {
    bits.push_back(of.size());
    for (const auto index : of) bits.push_back(index.value);
  };
  bits.push_back(kept.perforations().size());
  for (const Perforation& region : kept.perforations()) {
    bits.insert(bits.end(), {region.part_a.value, region.part_b.value});
    indices(region.shells_a), indices(region.shells_b);
    for (const auto& [a, b] : region.crossings) bits.insert(bits.end(), {a.value, b.value});
    for (const CurveSegment& segment : region.curve) point(segment.from), point(segment.to);
    number(region.length);
  }
  for (const PerforationDepth& depth : kept.depths()) {
    bits.push_back(depth.a_enters);
    indices(depth.entering), indices(depth.other_cut_off);
    number(depth.max.value_or(-1)), number(depth.mean);
    for (const Vec3& at : depth.nearest) point(at);
    bits.push_back(depth.deepest.value);
  }
  const auto pair = [&](const CloseShells& close) {
    bits.insert(bits.end(), {close.a.value, close.b.value, close.stand, close.touch_at_edge});
    number(close.distance), number(close.depth), point(close.on_a), point(close.on_b);
  };
  for (const Penetration& region : kept.penetrations()) {
    bits.insert(bits.end(), {region.part_a.value, region.part_b.value, region.is_clearance});
    indices(region.shells_a), indices(region.shells_b);
    for (const CloseShells& close : region.pairs) pair(close);
    pair(region.worst);
    number(region.max_depth), number(region.mean_depth), number(region.area);
    for (const auto* nodes : {&region.nodes_a, &region.nodes_b})
      for (const WayOut& way : *nodes) bits.push_back(way.node.value), point(way.direction), number(way.depth);
  }
  return bits;
}

/// A state, as a document has it.
struct Version {
  Model model;
  std::shared_ptr<const ContactThickness> thickness;
  double gap = 0;
};

void search(KeptContacts& kept, spatial::BoxTree& tree, const Version& version) {
  if (tree.empty())
    tree = spatial::BoxTree(version.model);
  else
    tree.follow(version.model);
  ASSERT_TRUE(kept.search({version.model, tree, version.thickness, version.gap}));
}

std::vector<std::uint64_t> from_nothing(const Version& version) {
  KeptContacts kept;
  spatial::BoxTree tree;
  search(kept, tree, version);
  return all_bits(kept);
}

class Edits {
 public:
  explicit Edits(std::uint32_t seed) : random_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * (static_cast<double>(random_()) / 4294967296.0); }
  std::size_t below(std::size_t count) { return random_() % count; }

  /// Three sheets that wave close to each other and through each other, and one that stands on the lowest.
  Model sheets() {
    test::SheetsThatMeet all;
    for (const int part : {1, 2, 3}) {
      const double phase = uniform(0, 6), off = uniform(0, 1), steep = uniform(0.1, 0.7);
      all.add(part, 30, 24, [=](int i, int j) {
        return Vec3(i + off, j + off, 0.9 * part + steep * std::sin(0.5 * i + phase) * std::cos(0.6 * j - phase));
      });
    }
    const double x = 4 + uniform(0, 8);
    all.add(4, 8, 3, [=](int i, int j) { return Vec3(x, 2 + 0.9 * i, -2 + 0.95 * j); });
    return all.model();
  }
  void move(Model& model) {
    const Vec3 centre = model.positions[below(model.node_count())];
    const double x = uniform(-0.3, 0.3), y = uniform(-0.3, 0.3), z = uniform(-0.6, 0.6);  // in this order with any compiler
    const Vec3 by(x, y, z);
    const double radius = uniform(0.3, 2.5);
    for (std::size_t n = 0; n < model.node_count(); ++n)
      if ((model.positions[n] - centre).norm() < radius) model.positions.set(n, model.positions[n] + by);
  }
  /// Removes some shells about a place, and puts one of their size in the hole, at the end.
  void restructure(Model& model) {
    const ShellIndex shell(below(model.shell_count()));
    if (model.is_removed(shell)) return;
    const ShellNodes nodes = model.shell(shell);
    model.shell_nodes.set(shell.value, ShellNodes{});
    for (const auto& corners : {std::array{nodes.node[0], nodes.node[1], nodes.node[2]}, {nodes.node[0], nodes.node[2], nodes.node[3]}}) {
      const std::size_t added = model.shell_count();
      if (below(4) == 0) break;  // some get one triangle, or none
      model.shell_nodes.resize(added + 1, ShellNodes{{corners[0], corners[1], corners[2], corners[2]}});
      model.shell_parts.resize(added + 1, model.shell_parts[shell.value]);
      model.shell_ids.resize(added + 1, static_cast<std::int64_t>(added) + 1);
    }
    model.adjacency = std::make_shared<const Adjacency>(build_adjacency(model));
  }

 private:
  std::mt19937 random_;
};

TEST(KeptContacts, are_those_of_a_search_from_nothing_after_any_edit) {
  std::size_t perforations = 0, penetrations = 0;
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    Edits edits(seed);
    std::vector<Version> versions(1);
    versions[0].model = edits.sheets();
    const double thickness = edits.uniform(0.2, 0.5);
    versions[0].gap = seed % 3 == 0 ? 0.1 : 0;
    versions[0].thickness = std::make_shared<const ContactThickness>(given_thickness(versions[0].model, thickness));
    KeptContacts kept;
    spatial::BoxTree tree;
    for (int step = 0; step < 14; ++step) {
      Version version = versions.back();
      if (step % 5 == 4) {
        version = versions[edits.below(versions.size())];  // undo, or redo
      } else if (step % 5 == 3) {
        edits.restructure(version.model);
        version.thickness = std::make_shared<const ContactThickness>(given_thickness(version.model, thickness));
      } else if (step > 0) {
        edits.move(version.model);
      }
      search(kept, tree, version);
      ASSERT_EQ(all_bits(kept), from_nothing(version)) << "seed " << seed << ", step " << step;
      perforations += kept.perforations().size(), penetrations += kept.penetrations().size();
      versions.push_back(std::move(version));
    }
  }
  EXPECT_GT(perforations, 150u);
  EXPECT_GT(penetrations, 300u);
}

TEST(KeptContacts, follow_thicknesses_gaps_and_parts) {
  Edits edits(7);
  Version version;
  version.model = edits.sheets();
  KeptContacts kept;
  spatial::BoxTree tree;
  auto thickness = std::make_shared<ContactThickness>(given_thickness(version.model, 0.3));
  for (const int step : {0, 1, 2, 3}) {
    for (std::size_t s = 40; s < 60; ++s) thickness->of_shell[s] = 0.3 + 0.3 * step;  // of a few shells
    if (step == 2) version.gap = 0.2;
    if (step == 3)
      for (std::size_t s = 10; s < 14; ++s) version.model.shell_parts.set(s, PartIndex(1u));
    version.thickness = std::make_shared<const ContactThickness>(*thickness);
    search(kept, tree, version);
    EXPECT_EQ(all_bits(kept), from_nothing(version)) << "step " << step;
  }
}

TEST(KeptContacts, stay_when_a_search_is_stopped) {
  Edits edits(3);
  Version version;
  version.model = edits.sheets();
  version.thickness = std::make_shared<const ContactThickness>(given_thickness(version.model, 0.3));
  KeptContacts kept;
  spatial::BoxTree tree;
  search(kept, tree, version);
  const auto before = all_bits(kept);
  Version moved = version;
  edits.move(moved.model);
  tree.follow(moved.model);
  EXPECT_FALSE(kept.search({moved.model, tree, moved.thickness, 0}, [](double) { return false; }));
  EXPECT_EQ(all_bits(kept), before);
  search(kept, tree, moved);
  EXPECT_EQ(all_bits(kept), from_nothing(moved));
}

TEST(KeptContacts, are_the_same_on_any_number_of_threads) {
  const auto numbers = [](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    Edits edits(5);
    Version version;
    version.model = edits.sheets();
    version.thickness = std::make_shared<const ContactThickness>(given_thickness(version.model, 0.4));
    KeptContacts kept;
    spatial::BoxTree tree;
    for (int step = 0; step < 4; ++step) {
      search(kept, tree, version);
      edits.move(version.model);
    }
    return all_bits(kept);
  };
  const auto one = numbers(1);
  EXPECT_EQ(numbers(2), one);
  EXPECT_EQ(numbers(7), one);
}

}  // namespace
}  // namespace prismesh::mesh::contact
