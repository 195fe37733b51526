// An edited model comes back from its change as it was; a change that doesn't fit is a sentence.
#include "ipc/import/model_change.h"

#include <cstring>
#include <functional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/deck/open.h"
#include "mesh/model/topology_change.h"
#include "tests/ipc/import/small_deck.h"

namespace prismesh::ipc {
namespace {

using mesh::Model;
using mesh::NodeIndex;
using mesh::ShellIndex;
using ::testing::HasSubstr;

class ModelChange : public ::testing::Test {
 protected:
  ModelChange() : original(open_small_deck().model), model(original) {}

  NodeIndex middle(std::int64_t id, std::int64_t a, std::int64_t b) {
    const NodeIndex from = model.find_node(a), to = model.find_node(b);
    return mesh::add_node(model, id, (model.position(from) + model.position(to)) / 2, mesh::edge_origin(from, to));
  }
  Model read() const {
    auto there = read_model_change(write_model_change(original, model), original);
    EXPECT_TRUE(there) << there.error().text();
    return there.value_or(original);
  }
  std::string refusal(const std::function<void(std::vector<std::byte>&)>& damage) const {
    std::vector<std::byte> bytes = write_model_change(original, model);
    damage(bytes);
    const auto there = read_model_change(bytes, original);
    return there ? "it was read" : there.error().text();
  }

  Model original;
  Model model;
};

void expect_same(const Model& a, const Model& b) {
  ASSERT_EQ(a.node_count(), b.node_count());
  ASSERT_EQ(a.shell_count(), b.shell_count());
  for (std::size_t n = 0; n < a.node_count(); ++n) {
    EXPECT_EQ(a.node_ids[n], b.node_ids[n]);
    EXPECT_EQ(a.positions[n], b.positions[n]);
    EXPECT_EQ(a.node_holds[n], b.node_holds[n]);
  }
  for (std::size_t s = 0; s < a.shell_count(); ++s) {
    EXPECT_EQ(a.shell_ids[s], b.shell_ids[s]);
    EXPECT_EQ(a.shell_nodes[s].node, b.shell_nodes[s].node);
    EXPECT_EQ(a.shell_parts[s], b.shell_parts[s]);
    EXPECT_EQ(a.shell_thickness[s], b.shell_thickness[s]);
  }
  EXPECT_EQ(mesh::live_nodes(a), mesh::live_nodes(b));
  EXPECT_EQ(mesh::live_shells(a), mesh::live_shells(b));
}

TEST_F(ModelChange, of_nothing_is_the_model) {
  const Model there = read();
  expect_same(there, model);
  EXPECT_EQ(there.topology_change, nullptr);
  EXPECT_NE(there.adjacency, nullptr);
}

TEST_F(ModelChange, holds_moves_and_growth_over_several_edits) {
  model.positions.set(1, {2, 0.5, 0.25});
  const NodeIndex between = middle(100, 1, 2);
  const ShellIndex first = model.find_shell(1);
  const mesh::ShellNodes whole = model.shell(first);
  const ShellIndex half = mesh::add_shell(model, 200, {{between, whole.node[1], whole.node[2], whole.node[2]}}, first);
  mesh::set_shell_nodes(model, first, {{whole.node[0], between, whole.node[2], whole.node[3]}});
  // What was added is divided, moved and removed again.
  const NodeIndex later = middle(101, 100, 2);
  mesh::add_shell(model, 201, {{later, whole.node[1], whole.node[2], whole.node[2]}}, half);
  mesh::remove_shell(model, half);
  model.positions.set(between.value, {0.4, 0, 0});
  const NodeIndex unused = middle(102, 3, 4);
  mesh::remove_node(model, unused);
  const Model there = read();
  expect_same(there, model);
  EXPECT_EQ(there.topology_change->removed_shells, model.topology_change->removed_shells);
  EXPECT_EQ(mesh::origin_of(there, later), mesh::origin_of(model, later));
  EXPECT_EQ(mesh::deck_ancestor(there, there.find_shell(201)), first);
  EXPECT_FALSE(there.find_shell(200).valid());
  EXPECT_EQ(write_model_change(original, there), write_model_change(original, model));
}

TEST_F(ModelChange, that_does_not_fit_is_told) {
  model.positions.set(1, {2, 0.5, 0.25});
  middle(100, 1, 2);
  constexpr std::size_t kFirstMoved = 16;  // behind magic and count
  EXPECT_THAT(refusal([](auto& bytes) { bytes[0] = std::byte{0}; }), HasSubstr("doesn't begin as one"));
  EXPECT_THAT(refusal([](auto& bytes) { bytes.pop_back(); }), HasSubstr("it ends early"));
  EXPECT_THAT(refusal([](auto& bytes) { bytes.push_back(std::byte{0}); }), HasSubstr("something follows its end"));
  EXPECT_THAT(refusal([](auto& bytes) { bytes[kFirstMoved] = std::byte{77}; }), HasSubstr("a moved node isn't in the deck"));
  EXPECT_THAT(refusal([](auto& bytes) { bytes[8] = std::byte{0xff}; }), HasSubstr("longer than what follows"));
  // Behind: the moved node, its place; ids, places and origins of the added node.
  constexpr std::size_t kId = kFirstMoved + 4 + 8 + 24 + 8, kPlace = kId + 8 + 8, kParents = kPlace + 24 + 8;
  EXPECT_THAT(refusal([](auto& bytes) { bytes[kId] = std::byte{1}; }), HasSubstr("id that isn't free"));
  EXPECT_THAT(refusal([](auto& bytes) { std::fill_n(bytes.begin() + kPlace, 8, std::byte{0xff}); }), HasSubstr("nowhere"));
  EXPECT_THAT(refusal([](auto& bytes) { bytes[kParents] = std::byte{77}; }), HasSubstr("comes from none before it"));
  EXPECT_THAT(refusal([](auto& bytes) {
                std::fill_n(bytes.begin() + kParents + 12, 4, std::byte{0});
                bytes[kParents + 12] = std::byte{77};
              }),
              HasSubstr("comes from none before it"))
      << "a parent behind those that count";
}

/// A weld with a part of its own, and one like the deck's beam.
void add_two_welds(Model& model) {
  std::vector<NodeIndex> ends;
  for (const std::int64_t id : {100, 101})
    ends.push_back(mesh::add_placed_node(model, id, {0.5, 0.5, static_cast<double>(id)}, mesh::edge_origin(NodeIndex(0), NodeIndex(1)),
                                         id == 101 ? mesh::kJoinsTies : mesh::kJoinsNone));
  mesh::Part part;
  part.id = 90;
  part.name = "spot welds";
  const mesh::PartIndex added = mesh::add_part(model, part, {"*PART\nspot welds\n"});
  mesh::add_element(model, mesh::ElementClass::beam, 6, added, ends, mesh::kNoExample);
  mesh::add_element(model, mesh::ElementClass::beam, 7, mesh::PartIndex(0), ends, 0);
}

TEST_F(ModelChange, holds_added_elements_and_parts) {
  add_two_welds(model);
  const Model there = read();
  expect_same(there, model);
  const auto beam = static_cast<std::size_t>(mesh::ElementClass::beam);
  EXPECT_EQ(there.elements[beam]->id, model.elements[beam]->id);
  EXPECT_EQ(there.elements[beam]->part, model.elements[beam]->part);
  EXPECT_EQ(there.elements[beam]->nodes, model.elements[beam]->nodes);
  EXPECT_EQ(there.topology_change->element_examples, model.topology_change->element_examples);
  EXPECT_EQ(there.topology_change->placed_nodes, model.topology_change->placed_nodes);
  EXPECT_EQ(there.topology_change->added_parts, model.topology_change->added_parts);
  EXPECT_EQ(there.parts->back().id, 90);
  EXPECT_EQ(write_model_change(original, there), write_model_change(original, model));
}

TEST_F(ModelChange, with_elements_that_do_not_fit_is_told) {
  const auto refusal_with = [&](const std::function<void(Model&)>& change) {
    model = original;
    change(model);
    return refusal([](auto&) {});
  };
  const auto add = [](Model& m, std::int64_t id, mesh::PartIndex part, NodeIndex node, std::uint32_t example) {
    mesh::add_element(m, mesh::ElementClass::beam, id, part, std::vector{node}, example);
  };
  EXPECT_THAT(refusal_with([&](Model& m) { add(m, 5, mesh::PartIndex(0), NodeIndex(0), 0); }), HasSubstr("id that isn't free"));
  EXPECT_THAT(refusal_with([&](Model& m) { add(m, 6, mesh::PartIndex(77), NodeIndex(0), 0); }), HasSubstr("a part that doesn't exist"));
  EXPECT_THAT(refusal_with([&](Model& m) { add(m, 6, mesh::PartIndex(0), NodeIndex(77), 0); }), HasSubstr("a node that doesn't exist"));
  EXPECT_THAT(refusal_with([&](Model& m) { add(m, 6, mesh::PartIndex(0), NodeIndex(0), 1); }), HasSubstr("like one that doesn't exist"));
  EXPECT_THAT(refusal_with([&](Model& m) { mesh::add_part(m, {}, {"*PART\n"}); }), HasSubstr("an added part has an id"));
}

}  // namespace
}  // namespace prismesh::ipc
