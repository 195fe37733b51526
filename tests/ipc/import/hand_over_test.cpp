// A deck that was handed over is the deck that was read; damage of any kind is a sentence.
#include "ipc/import/hand_over.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ipc/import/check_hand_over.h"
#include "mesh/deck/open.h"
#include "tests/ipc/import/small_deck.h"

namespace prismesh::ipc {
namespace {

namespace fs = std::filesystem;
using mesh::NodeIndex;
using mesh::deck::OpenedDeck;
using ::testing::HasSubstr;

std::vector<std::byte> handed_over(const OpenedDeck& opened) {
  std::vector<std::byte> bytes(hand_over_size(opened));
  write_hand_over(opened, bytes);
  return bytes;
}

TEST(HandOver, keeps_deck_and_model) {
  const OpenedDeck opened = open_small_deck();
  const auto taken = read_hand_over(handed_over(opened), "/somewhere");
  ASSERT_TRUE(taken) << taken.error().text();
  EXPECT_EQ(taken->deck->files.at(0).path, "/somewhere/main.k");
  EXPECT_EQ(taken->deck->files[0].bytes.text(), kSmallDeck);
  EXPECT_EQ(taken->deck->content, opened.deck->content);
  EXPECT_EQ(taken->model.find_node(3), opened.model.find_node(3));
  EXPECT_EQ(taken->model.position(NodeIndex(2)), opened.model.position(NodeIndex(2)));
  EXPECT_EQ(taken->model.shell(mesh::ShellIndex(0)), opened.model.shell(mesh::ShellIndex(0)));
  EXPECT_EQ(taken->model.parts->at(0).thickness, 1.2);
  EXPECT_EQ(taken->model.elements[1]->nodes, opened.model.elements[1]->nodes);
  EXPECT_EQ(taken->deck->last_ids.at(0).node, 4);
  EXPECT_EQ(taken->deck->hidden.size(), opened.deck->hidden.size());
  EXPECT_EQ(taken->deck->hidden.size(), 1u);
  EXPECT_EQ(taken->deck->contacts.cards.size(), opened.deck->contacts.cards.size());
  EXPECT_EQ(taken->deck->warnings.size(), opened.deck->warnings.size());
  EXPECT_EQ(taken->deck->element_kinds, opened.deck->element_kinds);
  EXPECT_EQ(taken->deck->references->all().size(), opened.deck->references->all().size());
  // The same once more: nothing is lost on the way.
  EXPECT_EQ(hand_over_size(*taken), hand_over_size(opened));
}

TEST(HandOver, that_ends_early_or_late_is_refused) {
  const std::vector<std::byte> bytes = handed_over(open_small_deck());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(read_hand_over({bytes.data(), size}, "/somewhere")) << size << " of " << bytes.size();
  std::vector<std::byte> longer = bytes;
  longer.push_back(std::byte{0});
  EXPECT_THAT(read_hand_over(longer, "/somewhere").error().text(), HasSubstr("something follows"));
}

/// Every byte, changed to what hurts most: the deck is refused or sound.
TEST(HandOver, with_any_byte_changed_is_refused_or_sound) {
  const std::vector<std::byte> bytes = handed_over(open_small_deck());
  std::size_t refused = 0;
  for (std::size_t at = 0; at < bytes.size(); ++at)
    for (const unsigned flip : {0x01u, 0x80u, 0xffu}) {
      std::vector<std::byte> changed = bytes;
      changed[at] ^= std::byte(flip);
      const auto taken = read_hand_over(changed, "/somewhere");
      refused += taken ? 0 : 1;
      if (taken) {
        EXPECT_EQ(fault_of(*taken->deck, {}, taken->model), "");
      }
    }
  EXPECT_GT(refused, bytes.size() / 2);
}

mesh::deck::SourceFile file_named(const char* name) { return {name, name, FileBytes::copy_of("*END\n", {})}; }

/// The fault that is found once `spoil` has changed the deck.
std::string fault_after(const std::function<void(mesh::deck::Deck&, mesh::Model&)>& spoil) {
  OpenedDeck opened = open_small_deck();
  spoil(const_cast<mesh::deck::Deck&>(*opened.deck), opened.model);
  const auto taken = read_hand_over(handed_over(opened), "/somewhere");
  return taken ? "none" : taken.error().text();
}

TEST(HandOver, names_what_is_wrong) {
  using mesh::Model;
  using mesh::deck::Deck;
  EXPECT_EQ(fault_after([](Deck&, Model&) {}), "none");
  EXPECT_THAT(fault_after([](Deck&, Model& m) {
                m.shell_nodes.set(0, {{NodeIndex(0), NodeIndex(1), NodeIndex(2), NodeIndex(4)}});
              }),
              HasSubstr("a shell has a node that isn't there"));
  EXPECT_THAT(fault_after([](Deck&, Model& m) { m.shell_parts.set(0, mesh::PartIndex(2)); }),
              HasSubstr("a shell has a part that isn't there"));
  EXPECT_THAT(fault_after([](Deck&, Model& m) {
                m.positions.set(1, {0, std::numeric_limits<double>::quiet_NaN(), 0});
              }),
              HasSubstr("isn't finite"));
  EXPECT_THAT(fault_after([](Deck&, Model& m) { m.node_ids.set(1, 1); }), HasSubstr("two nodes have one id"));
  EXPECT_THAT(fault_after([](Deck&, Model& m) { m.node_ids.resize(5); }), HasSubstr("differ in length"));
  EXPECT_THAT(fault_after([](Deck&, Model& m) { m.node_holds.set(0, mesh::kRemoved); }), HasSubstr("held"));
  EXPECT_THAT(fault_after([](Deck& d, Model&) { d.node_line[0] = 1u << 20; }), HasSubstr("beyond the end of its file"));
  EXPECT_THAT(fault_after([](Deck& d, Model&) { d.node_runs[0].file = 1; }), HasSubstr("no such file"));
  EXPECT_THAT(fault_after([](Deck& d, Model&) { d.node_runs.push_back(d.node_runs[0]); }), HasSubstr("aren't in order"));
  EXPECT_THAT(fault_after([](Deck& d, Model&) { d.node_runs.clear(); }), HasSubstr("belongs to no file"));
  EXPECT_THAT(fault_after([](Deck& d, Model&) { d.hidden.first_node.back() = 77; }), HasSubstr("leaves out"));
  EXPECT_THAT(fault_after([](Deck& d, Model&) { d.held_files = {3}; }), HasSubstr("must not change"));
  for (const char* name : {"../main.k", "/etc/passwd", "a/../../b", "a/..", "", "./main.k", "a//b"})
    EXPECT_THAT(fault_after([&](Deck& d, Model&) { d.files.push_back(file_named(name)); }), HasSubstr("leads elsewhere")) << name;
  EXPECT_THAT(fault_after([](Deck& d, Model&) { d.files.push_back(file_named("main.k")); }), HasSubstr("another file has"));
  EXPECT_THAT(fault_after([](Deck& d, Model&) { d.companions.push_back({"x", "../x"}); }), HasSubstr("leads elsewhere"));
  EXPECT_THAT(fault_after([](Deck&, Model& m) {
                auto parts = std::make_shared<std::vector<mesh::Part>>(*m.parts);
                std::swap(parts->front(), parts->back());
                m.parts = parts;
              }),
              HasSubstr("order of their ids"));
  EXPECT_THAT(fault_after([](Deck&, Model& m) {
                auto beams = std::make_shared<mesh::ElementBlock>(*m.elements[1]);
                beams->nodes[0] = NodeIndex(4);
                m.elements[1] = beams;
              }),
              HasSubstr("class beam has a node"));
  EXPECT_THAT(fault_after([](Deck&, Model& m) {
                auto midside = std::make_shared<std::vector<mesh::MidsideNodes>>();
                midside->push_back({mesh::ShellIndex(1), {}});
                m.midside = midside;
              }),
              HasSubstr("mid-side"));
}

}  // namespace
}  // namespace prismesh::ipc
