// Regions of real decks, whose normals disagree and whose sheets branch.
#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/connections/find_joined_sheets.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/open.h"
#include "mesh/model/adjacency.h"
#include "mesh/select/loops.h"
#include "mesh/select/region.h"

namespace prismesh::mesh::select {
namespace {

struct Trial {
  const char* file;
  std::size_t disagreeing;  ///< at least so many pairs of neighbours whose normals disagree
};

class RealRegions : public testing::TestWithParam<Trial> {
 protected:
  void SetUp() override {
    const char* models = std::getenv("PRISMESH_MODELS");
    if (models == nullptr) GTEST_SKIP() << "PRISMESH_MODELS isn't set";
    auto opened = deck::open(std::string(models) + "/" + GetParam().file);
    ASSERT_TRUE(opened) << opened.error().text();
    model = std::move(opened->model);
  }
  Model model;
};

/// Every third shell with its nodes the other way round.
Model turned_over(const Model& model) {
  Model other = model;
  for (std::size_t s = 0; s < model.shell_count(); s += 3) {
    ShellNodes nodes = model.shell_nodes[s];
    const bool triangle = nodes.is_triangle();
    std::swap(nodes.node[1], nodes.node[triangle ? 2 : 3]);
    if (triangle) nodes.node[3] = nodes.node[2];
    other.shell_nodes.set(s, nodes);
  }
  other.adjacency = std::make_shared<Adjacency>(build_adjacency(other));
  return other;
}

std::size_t disagreeing_pairs(const Model& model) {
  const Adjacency& adjacency = *model.adjacency;
  const auto runs = [&](ShellIndex shell, NodeIndex from, NodeIndex to) {
    const ShellNodes& nodes = model.shell(shell);
    const auto corners = static_cast<std::size_t>(nodes.corners());
    for (std::size_t i = 0; i < corners; ++i)
      if (nodes.node[i] == from && nodes.node[(i + 1) % corners] == to) return true;
    return false;
  };
  std::size_t count = 0;
  for (std::size_t e = 0; e < adjacency.edge_count(); ++e) {
    const auto shells = adjacency.shells_of(EdgeIndex(e));
    const Edge ends = adjacency.edge(EdgeIndex(e));
    if (shells.size() == 2 && runs(shells[0], ends.low, ends.high) == runs(shells[1], ends.low, ends.high)) ++count;
  }
  return count;
}

TEST_P(RealRegions, are_the_same_whatever_the_normals_and_from_wherever_they_begin) {
  if (model.shell_count() == 0) return;
  EXPECT_GE(disagreeing_pairs(model), GetParam().disagreeing);
  const Model other = turned_over(model);
  for (const RegionBound bound : {RegionBound::features, RegionBound::piece})
    for (std::size_t trial = 0; trial < 4; ++trial) {
      const ShellIndex start(trial * 7919 % model.shell_count());
      const RegionOptions options{bound, 25, {}, nullptr};
      const ShellSet shells = region(model, {start}, options);
      EXPECT_TRUE(std::binary_search(shells.begin(), shells.end(), start));
      EXPECT_EQ(region(other, {start}, options), shells) << "shell " << model.shell_ids[start.value];
      if (bound == RegionBound::piece) {
        EXPECT_EQ(region(model, {shells[shells.size() / 2]}, options), shells);
      }
    }
}

TEST_P(RealRegions, cover_the_sheets_once_and_widen_with_the_angle) {
  std::vector<int> owner(model.shell_count(), -1);
  int pieces = 0;
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    if (owner[s] >= 0) continue;
    for (const ShellIndex shell : region(model, {ShellIndex(s)}, {RegionBound::piece, 30, {}, nullptr})) {
      EXPECT_EQ(owner[shell.value], -1);
      owner[shell.value] = pieces;
    }
    ++pieces;
  }
  EXPECT_LT(pieces, static_cast<int>(model.shell_count()) / 4);
  const connections::JoinedSheets welds = connections::find_joined_sheets(model, {}, {});
  for (std::size_t trial = 0; trial < 3; ++trial) {
    const ShellIndex start(trial * 7919 % model.shell_count());
    std::size_t before = 0;
    for (const double angle : {5.0, 20.0, 60.0, 180.0}) {
      const std::size_t size = region(model, {start}, {RegionBound::features, angle, {}, nullptr}).size();
      EXPECT_GE(size, before);
      EXPECT_GE(region(model, {start}, {RegionBound::features, angle, {}, &welds}).size(), size);
      before = size;
    }
  }
}

TEST_P(RealRegions, have_loops_that_any_of_their_nodes_leads_to) {
  // a loop's node has a free edge; going there and asking again gives a loop through that node
  for (std::size_t trial = 0; trial < 8; ++trial) {
    const ShellIndex start(trial * 104729 % model.shell_count());
    const Vec3& place = model.position(model.shell(start).node[0]);
    const NodeSet loop = free_edge_loop(model, {start}, place, {});
    if (loop.empty()) continue;
    const NodeIndex some = loop[loop.size() / 2];
    const NodeSet again = free_edge_loop(model, shells_at(model, some, {}), model.position(some), {});
    EXPECT_TRUE(std::binary_search(again.begin(), again.end(), some));
  }
}

INSTANTIATE_TEST_SUITE_P(Decks, RealRegions,
                         testing::Values(Trial{"wing_ferig/main.k", 2000}, Trial{"wheel_k/wheel.k", 500},
                                         Trial{"gsa_car6_comma/car6_crash.k", 50},
                                         Trial{"bumper_beam_rad/Bumper_Beam_AP_meshed_0000.rad", 0}),
                         [](const auto& trial) {
                           const std::string file = trial.param.file;
                           return file.substr(0, file.find('/'));
                         });

}  // namespace
}  // namespace prismesh::mesh::select
