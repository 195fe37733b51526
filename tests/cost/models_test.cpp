// The counted models: that every format holds the same rails, and that they have what the operations look for.
#include "tests/cost/models.h"

#include <gtest/gtest.h>

#include "mesh/deck/open.h"
#include "mesh/quality/report.h"
#include "mesh/select/expression.h"
#include "mesh/select/region.h"
#include "tests/bench/deck_twins.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::cost {
namespace {

using namespace mesh;

constexpr std::size_t kShells = 2'000;
constexpr std::size_t kColumnsOfTop = 40, kRows = kShells / 2 / 100;

TEST(CostModels, are_the_same_in_every_format) {
  const Model model = rails(kShells);
  ASSERT_EQ(model.shell_count(), kShells);
  const deck::DeckFolder folder;
  for (const auto& [name, text] :
       {std::pair("rails.bdf", bench::nastran_twin_text(model)), std::pair("rails_0000.rad", bench::radioss_twin_text(model)),
        std::pair("rails.inp", bench::abaqus_twin_text(model))}) {
    const auto opened = deck::open(folder.write(name, text));
    ASSERT_TRUE(opened) << name << ": " << opened.error().text();
    ASSERT_EQ(opened->model.node_count(), model.node_count()) << name;
    ASSERT_EQ(opened->model.shell_count(), model.shell_count()) << name;
    EXPECT_EQ(opened->model.parts->size(), 2u) << name;
    for (std::size_t i = 0; i < model.node_count(); ++i)
      ASSERT_LT((opened->model.positions[i] - model.positions[i]).norm(), 1e-3) << name << " node " << i;
    for (std::size_t i = 0; i < model.shell_count(); ++i) ASSERT_EQ(opened->model.shell_nodes[i], model.shell_nodes[i]) << name;
  }
}

TEST(CostModels, have_a_top_between_fillets_and_a_flat_sheet) {
  const Model model = rails(kShells);
  const auto region_at = [](const Model& of, NodeIndex node) {
    return select::region(of, select::shells_at(of, node, {}), {select::RegionBound::features, 60, {}, nullptr}).size();
  };
  EXPECT_EQ(region_at(model, middle_of_top(model)), kColumnsOfTop * kRows);
  const Model sheet = flat_sheet(kShells);
  EXPECT_EQ(sheet.shell_count(), 44u * 44u);
  EXPECT_EQ(region_at(sheet, NodeIndex(sheet.node_count() / 2)), sheet.shell_count());

  const auto top = select::evaluate(model, top_of_first_rail(model), select::EntityKind::node);
  ASSERT_TRUE(top) << top.error().text();
  EXPECT_EQ(top->nodes.size(), (kColumnsOfTop + 1) * (kRows - 2 * (kRows / 4) + 1));
}

TEST(CostModels, fail_around_each_defect) {
  const Model model = rails(2 * kShellsOfDefect);
  const auto judged = quality::judge_model(model, {quality::default_criteria(), 5.0});
  const quality::Counts counts = quality::count(judged);
  EXPECT_GE(counts.fail, 2u);
  EXPECT_LE(counts.fail, 8u) << "a corner out of place spoils the shells at it at most";
}

}  // namespace
}  // namespace prismesh::cost
