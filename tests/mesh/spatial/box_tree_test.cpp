#include "mesh/spatial/box_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "mesh/spatial/closest_point.h"
#include "tests/mesh/spatial/tree_trials.h"
#include "tests/support/real_deck.h"
#include "tests/support/whole_model.h"

namespace prismesh::mesh::spatial {
namespace {

using test::edited_at_random;

Vec3 point_near(const Model& model, std::mt19937& random, double away) {
  std::uniform_real_distribution<double> off(-away, away);
  for (;;) {
    const Vec3 node = model.positions[std::uniform_int_distribution<std::size_t>(0, model.node_count() - 1)(random)];
    if (node.allFinite() && node.norm() < 1e6) return node + Vec3(off(random), off(random), off(random));
  }
}

/// Points near and far have the nearest shell that the model has without a tree, or one as near.
void expect_answers_of(const Model& model, const BoxTree& tree, int points, unsigned seed) {
  std::mt19937 random(seed);
  for (int i = 0; i < points; ++i) {
    const Vec3 point = point_near(model, random, i % 5 == 0 ? 40 : 2);
    const auto plain = test::plain_nearest(model, point);
    const auto found = tree.closest(point);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->shell, plain.shell) << i;
    EXPECT_EQ(found->distance, plain.distance) << i;
    EXPECT_NEAR((found->point - point).norm(), found->distance, 1e-12 * (1 + found->distance));
    const auto hinted = tree.closest(point, plain.distance, ShellIndex(static_cast<std::size_t>(i) % model.shell_count()));
    ASSERT_TRUE(hinted) << "a distance is within itself";
    EXPECT_EQ(hinted->shell, plain.shell);
    EXPECT_FALSE(tree.closest(point, plain.distance * (1 - 1e-9) - 1e-300));
  }
}

std::set<std::uint32_t> found_near(const BoxTree& tree, const Vec3& low, const Vec3& high, double distance) {
  std::set<std::uint32_t> found;
  tree.near_box(low, high, distance, [&](ShellIndex shell, const FloatBox& box) {
    EXPECT_TRUE(found.insert(shell.value).second) << "visited twice";
    EXPECT_EQ(box, tree.box_of(shell));
    return true;
  });
  return found;
}

double gap2(const FloatBox& a, const FloatBox& b) {
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double gap = std::max({0.0, double{a.low[axis]} - b.high[axis], double{b.low[axis]} - a.high[axis]});
    sum += gap * gap;
  }
  return sum;
}

/// Each shell and pair that is near by its box is visited; none that is clearly farther.
void expect_neighbours_of(const Model& model, const BoxTree& tree, double distance, unsigned seed) {
  std::mt19937 random(seed);
  const std::size_t count = model.shell_count();
  std::vector<FloatBox> boxes;
  for (std::size_t s = 0; s < count; ++s) boxes.push_back(tree.box_of(ShellIndex(s)));
  for (int i = 0; i < 20; ++i) {
    const Vec3 low = point_near(model, random, 2), high = low + Vec3(1, 0.5, i);
    FloatBox from;
    from.add(low);
    from.add(high);
    const auto found = found_near(tree, low, high, distance);
    for (std::size_t s = 0; s < count; ++s) {
      if (boxes[s].empty()) {
        EXPECT_FALSE(found.contains(static_cast<std::uint32_t>(s)));
        continue;
      }
      const double away = std::sqrt(gap2(boxes[s], from));
      if (away <= distance) {
        EXPECT_TRUE(found.contains(static_cast<std::uint32_t>(s))) << s;
      }
      if (away > distance * 1.00001 + 1e-5) {
        EXPECT_FALSE(found.contains(static_cast<std::uint32_t>(s))) << s;
      }
    }
  }
  std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
  tree.near_pairs(distance, [&](ShellIndex a, ShellIndex b) {
    EXPECT_LT(a, b);
    EXPECT_TRUE(pairs.insert({a.value, b.value}).second) << "visited twice";
  });
  for (std::uint32_t a = 0; a < count; ++a)
    for (std::uint32_t b = a + 1; b < count; ++b) {
      if (boxes[a].empty() || boxes[b].empty()) continue;
      const double away = std::sqrt(gap2(boxes[a], boxes[b]));
      if (away <= distance) {
        ASSERT_TRUE(pairs.contains({a, b})) << a << ' ' << b;
      }
      if (away > distance * 1.00001 + 1e-5) {
        ASSERT_FALSE(pairs.contains({a, b})) << a << ' ' << b;
      }
    }
}

void expect_tree_of(const Model& model, const BoxTree& tree, unsigned seed) {
  expect_answers_of(model, tree, 60, seed);
  expect_neighbours_of(model, tree, 0.6, seed);
  std::size_t finite = 0;
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    EXPECT_EQ(tree.contains(ShellIndex(s)), !tree.box_of(ShellIndex(s)).empty());
    finite += tree.contains(ShellIndex(s)) ? 1 : 0;
  }
  EXPECT_EQ(tree.shell_count(), finite);
}

TEST(FloatBoxTest, contains_what_it_is_made_of) {
  for (const double value : {0.1, -0.1, 1e-50, -1e-50, 3.4028236e38, 1e300, -1e300, 16777217.0, -16777217.0, 0.0}) {
    EXPECT_LE(double{rounded_down(value)}, value);
    EXPECT_GE(double{rounded_up(value)}, value);
    FloatBox box;
    EXPECT_TRUE(box.empty());
    box.add(Vec3::Constant(value));
    EXPECT_FALSE(box.empty());
  }
  EXPECT_EQ(rounded_down(0.5), 0.5F);
  EXPECT_EQ(rounded_up(0.5), 0.5F);
}

TEST(BoxTreeTest, gives_the_answers_of_all_shells) {
  unsigned seed = 1;
  for (const Model& model : {test::folded_sheet(), test::junction(), test::spoiled_sheet(),
                             test::make_grid(9, 9, [](int i, int j) { return Vec3(i, j, 0.1 * i * j); })})
    expect_tree_of(model, BoxTree(model), seed++);
}

TEST(BoxTreeTest, works_with_few_shells_and_none) {
  for (int n = 0; n < 12; ++n) {
    const Model model = test::make_grid(n, n == 0 ? 0 : 1, [](int i, int j) { return Vec3(i, j, 0); });
    BoxTree tree(model);
    EXPECT_EQ(tree.shell_count(), static_cast<std::size_t>(n));
    EXPECT_EQ(tree.empty(), n == 0);
    if (n > 0) expect_tree_of(model, tree, 3);
    if (n == 0) {
      EXPECT_FALSE(tree.closest(Vec3::Zero()));
    }
  }
  BoxTree never;
  EXPECT_FALSE(never.closest(Vec3::Zero()));
  never.near_pairs(1, [](ShellIndex, ShellIndex) { ADD_FAILURE(); });
  const Model sheet = test::make_grid(5, 5, [](int i, int j) { return Vec3(i, j, 0); });
  EXPECT_TRUE(never.follow(sheet).rebuilt);
  expect_tree_of(sheet, never, 4);
}

TEST(BoxTreeTest, refuses_odd_questions) {
  const BoxTree tree(test::junction());
  const double inf = std::numeric_limits<double>::infinity();
  for (const double odd : {std::nan(""), inf, -inf}) EXPECT_FALSE(tree.closest(Vec3(0, odd, 0)));
  EXPECT_FALSE(tree.closest(Vec3(0, 0, 0), -1));
  EXPECT_FALSE(tree.closest(Vec3(0, 0, 0), std::nan("")));
  EXPECT_TRUE(tree.closest(Vec3(1e30, 0, 0)));
  EXPECT_TRUE(tree.closest(Vec3(1, 0, 3), 0.5, ShellIndex(std::size_t{1'000'000}))) << "a hint that isn't a shell";
  EXPECT_TRUE(tree.closest(Vec3(1, 0, 3), 0.5, ShellIndex()));
}

TEST(BoxTreeTest, of_equally_close_shells_takes_the_first) {
  const Model model = test::make_grid(8, 8, [](int i, int j) { return Vec3(i, j, 0); });
  const BoxTree tree(model);
  for (std::size_t n = 0; n < model.node_count(); ++n) {
    const auto shells = model.adjacency->shells_of(NodeIndex(n));
    for (const ShellIndex hint : {ShellIndex(), shells.back()}) {
      const auto found = tree.closest(model.position(NodeIndex(n)) + Vec3(0, 0, 2), 5, hint);
      ASSERT_TRUE(found);
      EXPECT_EQ(found->shell, shells.front()) << n;
    }
  }
}

TEST(BoxTreeTest, agrees_with_the_tree_of_chosen_shells) {
  const Model model = test::mixed_panel(0.3, 0.3);
  const BoxTree tree(model);
  const ShellTree other(model, test::all_shells(model));
  std::mt19937 random(7);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 point = point_near(model, random, 8);
    const auto a = tree.closest(point, 6), b = other.closest(point, 6);
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) continue;
    EXPECT_EQ(a->shell, b->shell);
    EXPECT_EQ(a->distance, b->distance);
    EXPECT_LT((a->point - b->point).norm(), 1e-12);  // on a quad's diagonal, of either triangle
    for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(a->share[c], b->share[c], 1e-12);
  }
}

TEST(BoxTreeTest, followed_edits_give_the_answers_of_a_new_tree) {
  std::mt19937 random(5);
  for (const Model& start : {test::with_adjacency(test::folded_sheet()), test::with_adjacency(test::spoiled_sheet())}) {
    std::vector<Model> history{start};
    BoxTree tree(start);
    for (int edit = 0; edit < 14; ++edit) {
      Model next;
      if (edit % 4 == 3)
        next = history[std::uniform_int_distribution<std::size_t>(0, history.size() - 1)(random)];  // undo or redo
      else
        next = edited_at_random(tree.shell_count() > 0 ? history.back() : start, random);
      tree.follow(next);
      history.push_back(next);
      expect_tree_of(next, tree, static_cast<unsigned>(edit));
    }
  }
}

TEST(BoxTreeTest, follows_shells_that_cease_to_be_finite_and_come_back) {
  const Model start = test::with_adjacency(test::junction());
  BoxTree tree(start);
  Model spoiled = start;
  for (std::size_t n = 0; n < 60; ++n) spoiled.positions.set(n, Vec3(0, std::nan(""), 0));
  const auto lost = tree.follow(spoiled);
  EXPECT_GT(lost.removed, 0u);
  expect_tree_of(spoiled, tree, 1);
  EXPECT_EQ(tree.follow(spoiled).removed, 0u) << "NaN differs from itself, but nothing has changed";
  const auto back = tree.follow(start);
  EXPECT_EQ(back.added, lost.removed);
  expect_tree_of(start, tree, 2);
  for (std::size_t n = 0; n < spoiled.node_count(); ++n) spoiled.positions.set(n, Vec3(0, std::nan(""), 0));
  tree.follow(spoiled);
  EXPECT_TRUE(tree.empty());
  tree.follow(start);
  expect_tree_of(start, tree, 3);
}

TEST(BoxTreeTest, a_copy_keeps_its_answers_while_the_other_follows) {
  std::mt19937 random(9);
  const Model start = test::with_adjacency(test::folded_sheet());
  const BoxTree tree(start);
  BoxTree copy = tree;
  Model next = start;
  for (int i = 0; i < 3; ++i) {
    next = edited_at_random(next, random);
    copy.follow(next);
  }
  expect_tree_of(start, tree, 1);
  expect_tree_of(next, copy, 1);
}

TEST(BoxTreeTest, says_what_changed) {
  const Model start = test::make_grid(30, 30, [](int i, int j) { return Vec3(i, j, 0); });
  BoxTree tree(start);
  Model next = start;
  const NodeIndex node = test::grid_node(30, 10, 10);
  next.positions.set(node.value, Vec3(10, 10, 2));
  const auto update = tree.follow(next);
  EXPECT_EQ(update.moved, 4u);
  EXPECT_EQ(update.added + update.removed, 0u);
  FloatBox expected;
  expected.add(Vec3(9, 9, 0));
  expected.add(Vec3(11, 11, 2));
  EXPECT_EQ(update.changed, expected);
  EXPECT_TRUE(tree.follow(next).changed.empty());
  remove_shell(next, ShellIndex(std::size_t{0}));
  next = test::with_adjacency(next);
  const auto removed = tree.follow(next);
  EXPECT_EQ(removed.removed, 1u);
  EXPECT_EQ(removed.changed.high[0], 1.0F);
}

TEST(BoxTreeTest, leaves_out_shells) {
  const Model model = test::folded_sheet();
  BoxTree tree(model);
  ShellSet some;
  for (std::size_t s = 0; s < model.shell_count(); s += 3) some.emplace_back(s);
  tree.leave_out(some);
  tree.leave_out(some);
  Model without = model;
  for (const ShellIndex shell : some) remove_shell(without, shell);
  EXPECT_EQ(tree.shell_count(), live_shells(without));
  expect_answers_of(without, tree, 60, 2);
  ShellSet all = test::all_shells(model);
  tree.leave_out(all);
  EXPECT_TRUE(tree.empty());
  EXPECT_FALSE(tree.closest(Vec3(1, 1, 0)));
}

TEST(BoxTreeTest, is_built_anew_after_many_additions) {
  std::mt19937 random(3);
  Model model = test::with_adjacency(test::folded_sheet());
  BoxTree tree(model);
  bool rebuilt = false;
  for (int edit = 0; edit < 40 && !rebuilt; ++edit) {
    model = edited_at_random(std::move(model), random);
    rebuilt = tree.follow(model).rebuilt;
  }
  EXPECT_TRUE(rebuilt);
  expect_tree_of(model, tree, 1);
}

TEST(BoxTreeTest, stays_shallow_where_many_shells_lie_on_each_other) {
  Model model = test::make_grid(4, 4, [](int i, int j) { return Vec3(i, j, 0); });
  BoxTree tree(model);
  for (int i = 0; i < 1000; ++i) {
    add_shell(model, 5000 + i, ShellNodes(model.shell_nodes[5]), ShellIndex(std::size_t{5}));
    model = test::with_adjacency(std::move(model));
    tree.follow(model);
    ASSERT_LE(tree.depth(), 64u);
  }
  EXPECT_EQ(tree.shell_count(), 1016u);
  EXPECT_EQ(tree.closest(model.position(test::grid_node(4, 1, 1)) + Vec3(0.5, 0.5, 1))->shell, ShellIndex(std::size_t{5}));
}

TEST(BoxTreeTest, takes_at_most_100_bytes_a_shell) {
  const Model model = test::make_grid(400, 400, [](int i, int j) { return Vec3(i, j, 0.01 * i * j); });
  BoxTree tree(model);
  EXPECT_LT(static_cast<double>(tree.bytes()) / 160'000, 70);
  // a generation beside it costs the change: the chunks on the way to the root
  Model next = model;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) next.positions.set(test::grid_node(400, 100 + i, 100 + j).value, Vec3(100 + i, 100 + j, 3));
  BoxTree moved = tree;
  moved.follow(next);
  EXPECT_GT(moved.bytes_beside(tree), 0u);
  EXPECT_LT(moved.bytes_beside(tree), tree.bytes() / 8);
  EXPECT_EQ(BoxTree(tree).bytes_beside(tree), 0u);
}

TEST(BoxTreeTest, real_decks) {
  const auto decks = test::real_decks();
  if (!decks) GTEST_SKIP() << "PRISMESH_MODELS doesn't point to the real decks";
  for (const char* name : {"hatprofile", "wheel_k"}) {
    Model model = test::open_real(*decks, name);
    ASSERT_GT(model.shell_count(), 0u) << name;
    model = test::with_adjacency(std::move(model));
    BoxTree tree(model);
    expect_answers_of(model, tree, 40, 1);
    Model moved = model;
    std::mt19937 random(2);
    for (int i = 0; i < 300; ++i) {
      const std::size_t n = std::uniform_int_distribution<std::size_t>(0, model.node_count() - 1)(random);
      moved.positions.set(n, Vec3(moved.positions[n] + Vec3(1, 2, -1)));
    }
    tree.follow(moved);
    expect_answers_of(moved, tree, 40, 2);
    tree.follow(model);
    expect_answers_of(model, tree, 40, 3);
  }
}

}  // namespace
}  // namespace prismesh::mesh::spatial
