// Pieces of a repair that don't touch are repaired alone, on several threads, with the same result for any number of them.
#include "mesh/repair/pieces.h"

#include <numeric>
#include <thread>

#include <gtest/gtest.h>

#include "mesh/quality/report.h"
#include "mesh/quality/target_size.h"
#include "tests/mesh/repair/patch_fixture.h"
#include "tests/mesh/repair/validator.h"
#include "tests/support/real_deck.h"

namespace prismesh::mesh::repair {
namespace {

/// A flat sheet with bumps of radius 4 around some places.
Grid with_bumps(std::size_t columns, std::size_t rows, std::vector<std::array<double, 2>> places) {
  return {columns,
          rows,
          [places = std::move(places)](double x, double y) {
            double z = 0;
            for (const auto& [at_x, at_y] : places) {
              const double d = 1 - std::hypot(x - at_x, y - at_y) / 4;
              if (d > 0) z += 3 * d * d * (3 - 2 * d);
            }
            return Vec3(x, y, z);
          },
          {}};
}

Model model_on(const Grid& grid) { return model_of(grid.positions(), grid.shells()); }

struct Job {
  Job(Model of, ShellSet to_repair, double size = 1)
      : model(std::move(of)),
        scope(std::move(to_repair)),
        surface(model, all_shells(model), 30),
        criteria{quality::default_criteria(), size} {}

  Result<Repaired> run(std::size_t threads, const Progress& progress = {}, std::vector<std::uint64_t> stop_at = {}) const {
    Options options;
    options.stop_at = std::move(stop_at);
    options.max_threads = threads;
    return repair({model, surface, {}, criteria, options, clusters}, scope, progress);
  }

  Model model;
  ShellSet scope;
  relax::ReferenceSurface surface;
  quality::SizedCriteria criteria;
  NodeSet clusters{};
};

ShellSet bad_in(const Model& model, const quality::SizedCriteria& criteria) {
  const auto states = quality::judge_model(model, criteria);
  ShellSet bad;
  for (const ShellIndex shell : all_shells(model))
    if (states[shell.value].warn != 0) bad.push_back(shell);
  return bad;
}

/// The repair of a sheet with bumps; its scope is what they damaged.
Job bumped_sheet(std::size_t columns, std::size_t rows, std::vector<std::array<double, 2>> places) {
  Model model = model_on(with_bumps(columns, rows, std::move(places)));
  ShellSet bad = bad_in(model, {quality::default_criteria(), 1});
  return {std::move(model), std::move(bad)};
}

std::vector<std::pair<ShellIndex, std::string>> left_of(const Repaired& repaired) {
  std::vector<std::pair<ShellIndex, std::string>> left;
  for (const Unrepaired& shell : repaired.unrepaired) left.emplace_back(shell.shell, shell.why);
  return left;
}

void expect_same(const Restructuring& a, const Restructuring& b) {
  EXPECT_EQ(a.moved, b.moved);
  EXPECT_EQ(a.reshaped, b.reshaped);
  EXPECT_EQ(a.removed_nodes, b.removed_nodes);
  EXPECT_EQ(a.removed_shells, b.removed_shells);
  ASSERT_EQ(a.new_nodes.size(), b.new_nodes.size());
  for (std::size_t i = 0; i < a.new_nodes.size(); ++i) {
    EXPECT_EQ(a.new_nodes[i].position, b.new_nodes[i].position) << i;
    EXPECT_EQ(a.new_nodes[i].origin.parent, b.new_nodes[i].origin.parent) << i;
    EXPECT_EQ(a.new_nodes[i].origin.weight, b.new_nodes[i].origin.weight) << i;
  }
  ASSERT_EQ(a.new_shells.size(), b.new_shells.size());
  for (std::size_t i = 0; i < a.new_shells.size(); ++i) {
    EXPECT_EQ(a.new_shells[i].nodes, b.new_shells[i].nodes) << i;
    EXPECT_EQ(a.new_shells[i].parent, b.new_shells[i].parent) << i;
  }
}

void expect_same_for_any_threads(const Job& job) {
  const Result<Repaired> one = job.run(1);
  ASSERT_TRUE(one.has_value());
  EXPECT_FALSE(one->change.empty());
  for (const std::size_t threads : {2, 4}) {
    SCOPED_TRACE(threads);
    const Result<Repaired> several = job.run(threads);
    ASSERT_TRUE(several.has_value());
    expect_same(one->change, several->change);
    EXPECT_EQ(one->done, several->done);
    EXPECT_EQ(left_of(*one), left_of(*several));
    EXPECT_EQ(one->triangle_pairs, several->triangle_pairs);
    EXPECT_EQ(one->rounds, several->rounds);
  }
}

std::vector<Piece> pieces_in(const Job& job) {
  const Options options;
  const Rules rules;
  Patch patch(job.model, job.scope, 4, rules, 30);
  const RepairContext context{patch, job.surface, job.criteria, options, quality::limits_for(job.criteria)};
  ChangeHistory history;
  history.in_scope.assign(patch.shell_count(), 0);
  for (const ShellIndex shell : job.scope) history.in_scope[patch.find(shell).value] = 1;
  std::vector<LocalShell> all;
  for (std::size_t s = 0; s < patch.shell_count(); ++s) all.push_back(LocalShell(s));
  patch.begin();
  judge_shells(context, all);
  patch.keep();
  return pieces_of(context, history, job.clusters);
}

TEST(Pieces, give_the_same_bytes_for_any_number_of_threads) {
  const Job job = bumped_sheet(40, 18, {{8, 9}, {31, 9}});
  EXPECT_EQ(pieces_in(job).size(), 2U);
  expect_same_for_any_threads(job);
}

TEST(PiecesOfRealDecks, give_the_same_bytes_for_any_number_of_threads) {
  const auto decks = test::real_decks();
  if (!decks) GTEST_SKIP() << "PRISMESH_MODELS doesn't point to the real decks";
  auto opened = deck::open(*decks / "seat_adyrel_rad/SEAT_ADYREL_0000.rad");
  ASSERT_TRUE(opened.has_value());
  Model model = std::move(opened->model);
  if (!model.adjacency) model.adjacency = std::make_shared<const Adjacency>(build_adjacency(model));
  const double size = quality::guess_target_size(model);
  const ShellSet bad = bad_in(model, {quality::default_criteria(), size});
  ShellSet some;  // far from each other
  for (std::size_t i = 0; i < bad.size(); i += std::max<std::size_t>(bad.size() / 12, 1)) some.push_back(bad[i]);
  const Job job(model, some, size);
  EXPECT_GE(pieces_in(job).size(), 3U);
  expect_same_for_any_threads(job);
}

TEST(Pieces, repaired_together_are_as_repaired_alone) {
  const Job both = bumped_sheet(48, 24, {{12, 12}, {36, 12}});
  ShellSet left, right;
  for (const ShellIndex shell : both.scope) (shell.value % 48 < 24 ? left : right).push_back(shell);
  const Job only_left(both.model, left), only_right(both.model, right);
  const auto together = both.run(2), first = only_left.run(2), second = only_right.run(2);
  ASSERT_TRUE(together && first && second);
  ASSERT_FALSE(first->change.new_shells.empty());
  const Model after = carried_out(both.model, together->change);
  EXPECT_EQ(together->change.moved.size(), first->change.moved.size() + second->change.moved.size());
  for (const auto& [node, position] : first->change.moved) EXPECT_EQ(after.position(node), position);
  for (const auto& [node, position] : second->change.moved) EXPECT_EQ(after.position(node), position);
  EXPECT_EQ(together->change.new_shells.size(), first->change.new_shells.size() + second->change.new_shells.size());
  EXPECT_EQ(together->bad_before, first->bad_before + second->bad_before);
  for (std::size_t i = 0; i < together->done.size(); ++i) EXPECT_EQ(together->done[i], first->done[i] + second->done[i]);
  EXPECT_EQ(what_is_wrong(after), "");
  EXPECT_EQ(shape_of(after).euler, shape_of(both.model).euler);
}

TEST(Pieces, have_no_node_in_common_and_hold_all_that_is_bad) {
  const Job job = bumped_sheet(80, 24, {{8, 12}, {30, 12}, {36, 12}, {66, 12}});
  const std::vector<Piece> pieces = pieces_in(job);
  ASSERT_EQ(pieces.size(), 3U);  // the two in the middle are near to each other
  const auto states = quality::judge_model(job.model, job.criteria);
  std::vector<int> node_piece(job.model.node_count(), -1);
  std::size_t work = 0, bad = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    EXPECT_TRUE(std::is_sorted(pieces[i].shells.begin(), pieces[i].shells.end()));
    for (const ShellIndex shell : pieces[i].shells) {
      bad += states[shell.value].warn != 0 ? 1 : 0;
      for (const NodeIndex node : job.model.shell(shell).node) {
        EXPECT_TRUE(node_piece[node.value] < 0 || node_piece[node.value] == static_cast<int>(i));
        node_piece[node.value] = static_cast<int>(i);
      }
    }
    work += pieces[i].work;
  }
  EXPECT_EQ(work, bad);
}

TEST(Pieces, hold_the_whole_strip_through_a_stretched_shell) {
  // Two columns are stretched threefold, far apart: each strip runs over all rows. A short sheet beyond would be cut off after eight rings.
  Grid grid = flat(40, 60);
  grid.place = [](double x, double y) { return Vec3(x + 2 * std::clamp(x - 8, 0.0, 1.0) + 2 * std::clamp(x - 31, 0.0, 1.0), y, 0); };
  std::vector<Vec3> positions = grid.positions();
  const Model model = model_of(positions, grid.shells());
  const Job job(model, {shell_at(grid.shell(8, 30)), shell_at(grid.shell(31, 30))});
  Options options;
  const Rules rules;
  Patch patch(job.model, all_shells(job.model), 0, rules, 30);
  const RepairContext context{patch, job.surface, job.criteria, options, quality::limits_for(job.criteria)};
  ChangeHistory history;
  history.in_scope.assign(patch.shell_count(), 0);
  for (const ShellIndex shell : job.scope) history.in_scope[shell.value] = 1;
  patch.begin();
  judge_shells(context, std::vector<LocalShell>{LocalShell(job.scope[0].value), LocalShell(job.scope[1].value)});
  patch.keep();
  const std::vector<Piece> pieces = pieces_of(context, history, {});
  ASSERT_EQ(pieces.size(), 2U);
  for (std::size_t row = 0; row < 60; ++row) {
    EXPECT_TRUE(std::binary_search(pieces[0].shells.begin(), pieces[0].shells.end(), shell_at(grid.shell(8, row)))) << row;
    EXPECT_TRUE(std::binary_search(pieces[1].shells.begin(), pieces[1].shells.end(), shell_at(grid.shell(31, row)))) << row;
  }
}

TEST(Pieces, are_none_where_all_is_well) {
  const Model sheet = model_on(flat());
  const Job job(sheet, all_shells(sheet));
  EXPECT_TRUE(pieces_in(job).empty());
  const auto repaired = job.run(2);
  ASSERT_TRUE(repaired.has_value());
  EXPECT_TRUE(repaired->change.empty());
  EXPECT_EQ(repaired->rounds, 0);
}

std::vector<long> shares(std::vector<std::size_t> work, long allowed) {
  std::vector<Piece> pieces;
  for (const std::size_t each : work) pieces.push_back({{}, each});
  return shares_of(pieces, allowed);
}

TEST(SharesOfTriangles, follow_the_work) {
  EXPECT_EQ(shares({100}, 50), (std::vector<long>{50}));
  EXPECT_EQ(shares({50, 50}, 50), (std::vector<long>{25, 25}));
  EXPECT_EQ(shares({300, 100}, 44), (std::vector<long>{32, 12}));
  EXPECT_EQ(shares({1, 999}, 104), (std::vector<long>{2, 102}));  // a small piece gets some too
  EXPECT_EQ(shares({5, 5, 5}, 4), (std::vector<long>{1, 1, 2}));
  EXPECT_EQ(shares({5, 5}, 0), (std::vector<long>{0, 0}));
  EXPECT_TRUE(shares({}, 10).empty());
}

TEST(SharesOfTriangles, add_up_to_what_is_allowed) {
  for (long allowed = 0; allowed < 60; ++allowed) {
    const std::vector<long> all = shares({1, 7, 3, 1, 30, 2, 11}, allowed);
    EXPECT_EQ(std::accumulate(all.begin(), all.end(), 0L), allowed);
    EXPECT_GE(*std::min_element(all.begin(), all.end()), allowed >= 14 ? 2 : 0);
  }
}

TEST(PiecesProgress, goes_forward_on_the_thread_that_started_the_repair) {
  const Job job = bumped_sheet(46, 24, {{10, 12}, {35, 12}});
  for (const std::size_t threads : {1, 3}) {
    const std::thread::id here = std::this_thread::get_id();
    std::vector<double> told;
    const auto repaired = job.run(threads, [&](double fraction) {
      EXPECT_EQ(std::this_thread::get_id(), here);
      told.push_back(fraction);
      return true;
    });
    ASSERT_TRUE(repaired.has_value());
    ASSERT_FALSE(told.empty());
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_NEAR(told.back(), 1, 1e-12);
  }
}

TEST(PiecesProgress, stops_all_pieces_at_steps_that_can_be_repeated) {
  const Job job = bumped_sheet(46, 24, {{10, 12}, {35, 12}});
  for (const std::size_t threads : {1, 3}) {
    int calls_after = 0;
    bool is_stopped = false;
    const auto stopped = job.run(threads, [&](double fraction) {
      calls_after += is_stopped ? 1 : 0;
      is_stopped = is_stopped || fraction > 0.02;
      return !is_stopped;
    });
    ASSERT_TRUE(stopped.has_value());
    ASSERT_TRUE(stopped->stopped.has_value());
    EXPECT_EQ(stopped->stopped->steps.size(), 2u);
    EXPECT_EQ(calls_after, 0);
    const auto again = job.run(4 - threads, {}, stopped->stopped->steps);
    ASSERT_TRUE(again.has_value());
    expect_same(again->change, stopped->change);
    EXPECT_EQ(again->stopped->steps, stopped->stopped->steps);
    EXPECT_EQ(again->bad_left, stopped->bad_left);
    EXPECT_EQ(what_is_wrong(carried_out(job.model, again->change)), "");
  }
}

TEST(PiecesProgress, stops_one_piece_and_finishes_the_others) {
  const Job job = bumped_sheet(46, 24, {{10, 12}, {35, 12}});
  const auto whole = job.run(1), second = job.run(1, {}, {1, 0});
  ASSERT_TRUE(whole && second);
  ASSERT_TRUE(second->stopped.has_value());
  EXPECT_EQ(second->stopped->steps, (std::vector<std::uint64_t>{1, 0}));
  EXPECT_FALSE(second->change.moved.empty());
  for (const auto& [node, position] : second->change.moved) EXPECT_GT(job.model.position(node).x(), 20) << "the first piece is as it was";
  EXPECT_GT(second->bad_left, whole->bad_left);
}

}  // namespace
}  // namespace prismesh::mesh::repair
