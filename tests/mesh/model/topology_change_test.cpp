// Adding and removing nodes and shells: indices stay, ids are found, copies aren't touched, and what differs is told.
#include "mesh/model/topology_change.h"

#include <functional>
#include <map>
#include <random>
#include <set>
#include <string>

#include <array>

#include <gtest/gtest.h>

#include "mesh/model/adjacency.h"

namespace prismesh::mesh {
namespace {

/// `columns` x `rows` quads; node ids count from 1, shell ids from 101.
Model sheet(std::size_t columns, std::size_t rows) {
  Model model;
  std::vector<std::int64_t> nodes, shells;
  for (std::size_t y = 0; y <= rows; ++y)
    for (std::size_t x = 0; x <= columns; ++x) {
      nodes.push_back(static_cast<std::int64_t>(nodes.size()) + 1);
      model.positions.resize(nodes.size(), Vec3(static_cast<double>(x), static_cast<double>(y), 0));
      model.node_ids.resize(nodes.size(), nodes.back());
    }
  model.node_holds.resize(nodes.size());
  for (std::size_t y = 0; y < rows; ++y)
    for (std::size_t x = 0; x < columns; ++x) {
      const std::size_t a = y * (columns + 1) + x;
      shells.push_back(static_cast<std::int64_t>(shells.size()) + 101);
      model.shell_ids.resize(shells.size(), shells.back());
      model.shell_nodes.resize(shells.size(), {{NodeIndex(a), NodeIndex(a + 1), NodeIndex(a + columns + 2), NodeIndex(a + columns + 1)}});
    }
  model.shell_parts.resize(shells.size(), PartIndex(std::size_t{3}));
  model.shell_thickness.resize(shells.size(), 1.5f);
  model.midside = std::make_shared<const std::vector<MidsideNodes>>();
  model.node_index = std::make_shared<const IdIndex>(nodes);
  model.shell_index = std::make_shared<const IdIndex>(shells);
  model.adjacency = std::make_shared<const Adjacency>(build_adjacency(model));
  return model;
}

TEST(TopologyChange, adds_at_the_end_and_finds_by_id) {
  const Model before = sheet(2, 1);
  Model model = before;
  const NodeIndex middle = add_node(model, 77, {0.5, 0, 0}, edge_origin(NodeIndex(std::size_t{0}), NodeIndex(std::size_t{1})));
  const ShellIndex child = add_shell(model, 5, {{middle, NodeIndex(std::size_t{1}), NodeIndex(std::size_t{4}), NodeIndex(std::size_t{4})}},
                                     ShellIndex(std::size_t{0}));
  EXPECT_EQ(middle.value, 6u);
  EXPECT_EQ(child.value, 2u);
  EXPECT_EQ(model.find_node(77), middle);
  EXPECT_EQ(model.find_shell(5), child);
  EXPECT_EQ(model.find_node(3).value, 2u);
  EXPECT_FALSE(before.find_node(77).valid());
  EXPECT_EQ(before.node_count(), 6u);
  EXPECT_EQ(model.shell_parts[2].value, 3u);
  EXPECT_EQ(model.shell_thickness[2], 1.5f);
  EXPECT_TRUE(is_added(model, middle));
  EXPECT_FALSE(is_added(model, NodeIndex(std::size_t{5})));
  EXPECT_EQ(origin_of(model, middle).count(), 2);
  EXPECT_EQ(deck_ancestor(model, child).value, 0u);
  const ShellIndex grandchild = add_shell(model, 6, model.shell(child), child);
  EXPECT_EQ(deck_ancestor(model, grandchild).value, 0u);
  EXPECT_EQ(model.adjacency, nullptr);
}

TEST(TopologyChange, keeps_the_entries_of_what_is_removed) {
  const Model before = sheet(2, 1);
  Model model = before;
  remove_shell(model, ShellIndex(std::size_t{0}));
  remove_node(model, NodeIndex(std::size_t{0}));
  EXPECT_TRUE(model.is_removed(ShellIndex(std::size_t{0})));
  EXPECT_TRUE(model.is_removed(NodeIndex(std::size_t{0})));
  EXPECT_FALSE(model.find_node(1).valid());
  EXPECT_FALSE(model.find_shell(101).valid());
  EXPECT_EQ(model.find_node(2).value, 1u);
  EXPECT_EQ(model.find_shell(102).value, 1u);
  EXPECT_EQ(model.node_ids[0], 1);
  EXPECT_EQ(live_nodes(model), 5u);
  EXPECT_EQ(live_shells(model), 1u);
  EXPECT_TRUE(before.find_node(1).valid());
  const Adjacency adjacency = build_adjacency(model);
  EXPECT_EQ(adjacency.edge_count(), 4u);
  EXPECT_TRUE(adjacency.shells_of(NodeIndex(std::size_t{0})).empty());
}

TEST(TopologyChange, tells_what_differs) {
  const Model opened = sheet(3, 1);
  Model model = opened;
  EXPECT_TRUE(changes_between(opened, model).empty());
  const NodeIndex added = add_node(model, 50, {0, 0, 1}, edge_origin(NodeIndex(std::size_t{0}), NodeIndex(std::size_t{4})));
  ShellNodes corners = model.shell(ShellIndex(std::size_t{1}));
  corners.node[0] = added;
  set_shell_nodes(model, ShellIndex(std::size_t{1}), corners);
  const ShellIndex child = add_shell(model, 9, corners, ShellIndex(std::size_t{1}));
  const Model half = model;
  remove_shell(model, ShellIndex(std::size_t{0}));
  remove_shell(model, child);
  set_shell_nodes(model, ShellIndex(std::size_t{2}), corners);
  set_shell_nodes(model, ShellIndex(std::size_t{1}), opened.shell(ShellIndex(std::size_t{1})));
  model.positions.set(2, {9, 9, 9});

  const Changes all = changes_between(opened, model);
  EXPECT_EQ(all.added_nodes, std::vector{added});
  EXPECT_TRUE(all.added_shells.empty()) << "it was removed again";
  EXPECT_EQ(all.removed_shells, std::vector{ShellIndex(std::size_t{0})});
  EXPECT_EQ(all.reshaped_shells, std::vector{ShellIndex(std::size_t{2})}) << "the other one has its nodes back";
  const Changes second = changes_between(half, model);
  EXPECT_TRUE(second.added_nodes.empty());
  EXPECT_EQ(second.removed_shells, (std::vector{ShellIndex(std::size_t{0}), child}));
  EXPECT_EQ(second.reshaped_shells, (std::vector{ShellIndex(std::size_t{1}), ShellIndex(std::size_t{2})}));
  EXPECT_EQ(moved_nodes(opened, model), std::vector{NodeIndex(std::size_t{2})});
  remove_node(model, NodeIndex(std::size_t{2}));
  EXPECT_TRUE(moved_nodes(opened, model).empty()) << "what is gone hasn't moved";
}

TEST(TopologyChange, tells_each_kind_of_difference_by_itself) {
  const Model opened = sheet(2, 1);
  const std::map<std::string, std::function<void(Model&)>> edits{
      {"a node added",
       [](Model& m) {
         add_node(m, 77, {0, 0, 1}, edge_origin(NodeIndex(std::size_t{0}), NodeIndex(std::size_t{1})));
       }},
      {"a node removed", [](Model& m) { remove_node(m, NodeIndex(std::size_t{0})); }},
      {"a shell added", [](Model& m) { add_shell(m, 5, m.shell(ShellIndex(std::size_t{0})), ShellIndex(std::size_t{0})); }},
      {"a shell removed", [](Model& m) { remove_shell(m, ShellIndex(std::size_t{1})); }},
      {"a shell reshaped", [](Model& m) { set_shell_nodes(m, ShellIndex(std::size_t{0}), m.shell(ShellIndex(std::size_t{1}))); }}};
  for (const auto& [name, edit] : edits) {
    Model model = opened;
    edit(model);
    EXPECT_FALSE(changes_between(opened, model).empty()) << name;
  }
}

TEST(TopologyChange, lists_only_shells_of_the_deck_as_reshaped) {
  Model model = sheet(2, 1);
  const ShellIndex added = add_shell(model, 5, model.shell(ShellIndex(std::size_t{0})), ShellIndex(std::size_t{0}));
  set_shell_nodes(model, added, model.shell(ShellIndex(std::size_t{1})));
  EXPECT_TRUE(model.topology_change->reshaped_shells.empty());
  set_shell_nodes(model, ShellIndex(std::size_t{1}), model.shell(ShellIndex(std::size_t{0})));
  EXPECT_EQ(model.topology_change->reshaped_shells, std::vector{ShellIndex(std::size_t{1})});
}

TEST(TopologyChange, shares_what_it_does_not_change) {
  const Model before = sheet(300, 60);
  Model model = before;
  add_node(model, 1'000'000, {0, 0, 1}, edge_origin(NodeIndex(std::size_t{0}), NodeIndex(std::size_t{1})));
  remove_node(model, NodeIndex(std::size_t{9000}));
  std::size_t own = 0;
  for (std::size_t c = 0; c < before.node_holds.chunk_count(); ++c)
    own += before.node_holds.chunk_owner(c) != model.node_holds.chunk_owner(c);
  EXPECT_EQ(own, 2u);
}

/// Ranks and lookups of a changed index are those of one built afresh.
TEST(IdIndex, changed_is_as_one_built_afresh) {
  std::mt19937 random(7);
  for (int round = 0; round < 30; ++round) {
    std::vector<std::int64_t> ids;
    for (std::int64_t id = 10; id < 60; ++id)
      if (round % 3 == 0 || random() % 3 != 0) ids.push_back(id * (round % 2 == 0 ? 1 : 7));
    if (round % 5 == 0) std::shuffle(ids.begin(), ids.end(), random);
    std::shared_ptr<const IdIndex> index = std::make_shared<const IdIndex>(ids);
    const auto original = index;
    std::map<std::int64_t, std::uint32_t> wanted;
    for (std::size_t i = 0; i < ids.size(); ++i) wanted[ids[i]] = static_cast<std::uint32_t>(i);
    auto next = static_cast<std::uint32_t>(ids.size());
    std::set<std::int64_t> ever(ids.begin(), ids.end());
    for (int step = 0; step < 60; ++step) {
      const auto held = step % 4 == 0 ? index : nullptr;  // someone else looks at it too
      const auto id = static_cast<std::int64_t>(random() % 460);
      if (random() % 2 == 0 && ever.insert(id).second) {
        IdIndex::add(index, id, next);
        wanted[id] = next++;
      } else if (!wanted.empty()) {
        const auto gone = std::next(wanted.begin(), static_cast<std::ptrdiff_t>(random() % wanted.size()));
        IdIndex::remove(index, gone->first);
        wanted.erase(gone);
      }
      ASSERT_EQ(index->size(), wanted.size());
      std::size_t rank = 0;
      for (const auto& [want, at] : wanted) {
        ASSERT_EQ(index->at(rank), std::pair(want, at)) << "rank " << rank << " step " << step;
        ASSERT_EQ(index->lower_bound(want), rank);
        ASSERT_EQ(index->find(want), at);
        ++rank;
      }
      ASSERT_EQ(index->lower_bound(100'000), wanted.size());
      for (std::int64_t missing = 0; missing < 470; missing += 3) {
        if (wanted.contains(missing)) continue;
        ASSERT_EQ(index->find(missing), IdIndex::kNotFound) << missing;
      }
    }
    EXPECT_EQ(original->size(), ids.size());
  }
}

void expect_same_adjacency(const Adjacency& updated, const Adjacency& built) {
  EXPECT_EQ(updated.node_first, built.node_first);
  EXPECT_EQ(updated.node_shells, built.node_shells);
  EXPECT_EQ(updated.edge_first, built.edge_first);
  EXPECT_EQ(updated.edge_high, built.edge_high);
  EXPECT_EQ(updated.edge_shell_first, built.edge_shell_first);
  EXPECT_EQ(updated.edge_shells, built.edge_shells);
}

/// Splits, collapses, cuts and removes at random, a few at a time.
void change_at_random(std::mt19937& random, Model& model) {
  const auto any_shell = [&] {
    for (;;)
      if (const ShellIndex s(random() % model.shell_count()); !model.is_removed(s)) return s;
  };
  std::int64_t next_id = 1'000'000 + static_cast<std::int64_t>(model.node_count() + model.shell_count());
  for (std::size_t change = 0; change < 1 + random() % 6; ++change) {
    const ShellIndex shell = any_shell();
    const ShellNodes n = model.shell(shell);
    switch (random() % 4) {
      case 0: {
        const NodeIndex middle = add_node(model, next_id++, Vec3(0.5, 0.5, 0), centre_origin(n));
        for (std::size_t i = 1; i < static_cast<std::size_t>(n.corners()); ++i)
          add_shell(model, next_id++, {{n.node[i], n.node[(i + 1) % static_cast<std::size_t>(n.corners())], middle, middle}}, shell);
        set_shell_nodes(model, shell, {{n.node[0], n.node[1], middle, middle}});
        break;
      }
      case 1: set_shell_nodes(model, shell, {{n.node[0], n.node[1], n.node[2], n.node[2]}}); break;
      case 2:
        if (live_shells(model) > 40) remove_shell(model, shell);
        break;
      default: {  // one corner becomes another shell's, which may make it degenerate
        ShellNodes other = n;
        other.node[1] = model.shell(any_shell()).node[0];
        set_shell_nodes(model, shell, other);
      }
    }
  }
}

TEST(TopologyChange, adjacency_brought_up_to_date_is_that_built_anew) {
  std::mt19937 random(20);
  for (int round = 0; round < 20; ++round) {
    Model before = sheet(20 + random() % 20, 15);
    for (int step = 0; step < 10; ++step) {
      Model after = before;
      change_at_random(random, after);
      if (round % 2 == 0) change_at_random(random, after);
      auto updated = std::make_shared<const Adjacency>(update_adjacency(before, after));
      expect_same_adjacency(*updated, build_adjacency(after));
      ASSERT_FALSE(HasFailure()) << "round " << round << ", step " << step;
      after.adjacency = std::move(updated);
      before = std::move(after);
    }
  }
}

TEST(TopologyChange, adjacency_of_what_is_only_taken_away_or_only_put_there) {
  const Model before = sheet(12, 12);
  Model less = before;
  for (std::size_t s = 0; s < 6; ++s) remove_shell(less, ShellIndex(s * 24));
  expect_same_adjacency(update_adjacency(before, less), build_adjacency(less));
  Model more = before;
  for (int i = 0; i < 5; ++i) add_node(more, 9000 + i, Vec3(i, -1, 0), edge_origin(NodeIndex(std::size_t{0}), NodeIndex(std::size_t{1})));
  expect_same_adjacency(update_adjacency(before, more), build_adjacency(more));
  expect_same_adjacency(update_adjacency(before, before), *before.adjacency);
}

TEST(TopologyChange, elements_and_parts_are_added_behind_those_of_the_deck) {
  const Model before = test::make_model({{1, Vec3(0, 0, 0)}, {2, Vec3(1, 0, 0)}, {3, Vec3(1, 1, 0)}}, {{1, 7, {1, 2, 3, 3}}},
                                        {{ElementClass::beam, 5, 8, {1, 2}}});
  Model model = before;
  const NodeIndex end = add_placed_node(model, 9, Vec3(0.5, 0.5, 0), edge_origin(NodeIndex(0), NodeIndex(1)), kJoinsCommon);
  Part part;
  part.id = 20;
  const PartIndex added_part = add_part(model, part, {"*PART\n"});
  EXPECT_EQ(add_element(model, ElementClass::beam, 6, added_part, std::array{NodeIndex(2), end}, 0), 1u);
  EXPECT_EQ(add_element(model, ElementClass::beam, 7, added_part, std::array{NodeIndex(0), end}, kNoExample), 2u);

  const auto beam = static_cast<std::size_t>(ElementClass::beam);
  EXPECT_EQ(before.elements[beam]->size(), 1u);
  EXPECT_EQ(model.elements[beam]->id, (std::vector<std::int64_t>{5, 6, 7}));
  EXPECT_EQ(model.elements[beam]->nodes.back(), end);
  EXPECT_EQ(model.topology_change->deck_elements[beam], 1u);
  EXPECT_EQ(model.topology_change->element_examples[beam], (std::vector<std::uint32_t>{0, kNoExample}));
  ASSERT_NE(placed_node(model, end), nullptr);
  EXPECT_EQ(placed_node(model, NodeIndex(0)), nullptr);
  EXPECT_EQ(model.parts->back().id, 20);
  EXPECT_EQ(before.parts->back().id, 8);

  const Changes changes = changes_between(before, model);
  EXPECT_EQ(changes.other_elements(), 2u);
  EXPECT_EQ(changes.added_elements[beam], (std::vector<std::uint32_t>{1, 2}));
  EXPECT_EQ(changes.added_parts, std::vector<PartIndex>{added_part});
  EXPECT_FALSE(changes.empty());
  EXPECT_TRUE(changes_between(model, model).empty());

  Model next = model;
  add_element(next, ElementClass::beam, 8, added_part, std::array{NodeIndex(1), end}, 0);
  EXPECT_EQ(model.elements[beam]->size(), 3u);
  EXPECT_EQ(changes_between(model, next).added_elements[beam], std::vector<std::uint32_t>{3});
}

}  // namespace
}  // namespace prismesh::mesh
