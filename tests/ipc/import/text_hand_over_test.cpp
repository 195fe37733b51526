// New text that was handed over is what was made; text that doesn't fit its files is a sentence.
#include "ipc/import/text_hand_over.h"

#include <functional>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/ipc/import/small_deck.h"

namespace prismesh::ipc {
namespace {

using mesh::NodeIndex;
using mesh::deck::TextChanges;
using ::testing::HasSubstr;

class TextHandOver : public ::testing::Test {
 protected:
  TextHandOver() : opened(open_small_deck()) {
    text.by_file = {{{10, 4, "new"}, {14, 0, std::string("with\0zero", 9)}, {20, 2, ""}}};
    text.rounding = {3, 0.125, "main.k:3 (node 1)", {{NodeIndex(1), {1, 2, 3}}}};
    text.counts.nodes_moved = 5;
    text.set_cards = 2;
    text.lines = 7;
  }
  std::string refusal(const std::function<void(TextChanges&)>& change) const {
    TextChanges changed = text;
    change(changed);
    const auto there = read_text_hand_over(write_text_hand_over(changed), *opened.deck, opened.model.node_count());
    return there ? "it was read" : there.error().text();
  }

  mesh::deck::OpenedDeck opened;
  TextChanges text;
};

TEST_F(TextHandOver, keeps_everything) {
  const auto there = read_text_hand_over(write_text_hand_over(text), *opened.deck, opened.model.node_count());
  ASSERT_TRUE(there) << there.error().text();
  EXPECT_EQ(there->by_file[0][1].text, text.by_file[0][1].text);
  EXPECT_EQ(there->by_file[0][2].offset, 20u);
  EXPECT_EQ(there->rounding.first, text.rounding.first);
  EXPECT_EQ(there->rounding.nodes, text.rounding.nodes);
  EXPECT_EQ(there->counts.nodes_moved, 5u);
  EXPECT_EQ(there->lines, 7u);
  EXPECT_EQ(write_text_hand_over(*there), write_text_hand_over(text));
}

TEST_F(TextHandOver, that_does_not_fit_is_told) {
  const std::size_t size = opened.deck->files[0].bytes.text().size();
  EXPECT_THAT(refusal([](TextChanges& t) { t.by_file.clear(); }), HasSubstr("other files"));
  EXPECT_THAT(refusal([&](TextChanges& t) { t.by_file[0].push_back({size + 1, 0, ""}); }), HasSubstr("isn't in its file"));
  EXPECT_THAT(refusal([&](TextChanges& t) { t.by_file[0].push_back({size, 1, ""}); }), HasSubstr("isn't in its file"));
  EXPECT_THAT(refusal([](TextChanges& t) { t.by_file[0][1].offset = 12; }), HasSubstr("overlaps"));
  EXPECT_THAT(refusal([](TextChanges& t) { t.by_file[0][0].length = std::numeric_limits<std::size_t>::max(); }),
              HasSubstr("isn't in its file"));
  EXPECT_THAT(refusal([](TextChanges& t) { t.rounding.nodes[0].first = NodeIndex(4); }), HasSubstr("rounded node doesn't exist"));
  EXPECT_THAT(refusal([](TextChanges& t) { t.rounding.largest_error = std::numeric_limits<double>::infinity(); }), HasSubstr("finite"));
  std::vector<std::byte> bytes = write_text_hand_over(text);
  for (std::size_t size_now = bytes.size(); size_now-- > 0;) {
    bytes.resize(size_now);
    EXPECT_FALSE(read_text_hand_over(bytes, *opened.deck, opened.model.node_count())) << size_now;
  }
}

}  // namespace
}  // namespace prismesh::ipc
