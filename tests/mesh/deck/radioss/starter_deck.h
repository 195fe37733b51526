// Starter decks in block format as text, for the tests of this format.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>

#include "mesh/deck/open.h"
#include "mesh/deck/save.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {

inline constexpr std::string_view kHead =
    "#RADIOSS STARTER\n/BEGIN\ndeck\n      2022         0\n                  kg                  mm                  ms\n"
    "                  kg                  mm                  ms\n";

inline std::string right(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

/// A card of whole numbers.
inline std::string card(std::initializer_list<std::int64_t> ids, std::size_t width = 10) {
  std::string out;
  for (const std::int64_t id : ids) out += right(std::to_string(id), width);
  return out + "\n";
}
inline std::string reals(std::initializer_list<const char*> numbers, std::size_t width = 20) {
  std::string out;
  for (const char* number : numbers) out += right(number, width);
  return out;
}
inline std::string node(std::int64_t id, const char* x, const char* y, const char* z, std::size_t width = 10) {
  return right(std::to_string(id), width) + reals({x, y, z}, 2 * width) + "\n";
}
inline const std::string kSquare =
    "/NODE\n" + node(1, "0", "0", "0") + node(2, "1", "0", "0") + node(3, "1", "1", "0") + node(4, "0", "1", "0");
inline const std::string kPart = "/PART/1\nplate\n" + card({7, 8, 0});

class Radioss : public ::testing::Test {
 protected:
  Result<OpenedDeck> open(const std::string& text) const { return deck::open(folder_.write("deck_0000.rad", text)); }
  /// The main file saved with some node elsewhere.
  std::string saved(const OpenedDeck& opened, std::int64_t id, const Vec3& to) const {
    const auto report = save(*opened.deck, opened.model, with_node_at(opened.model, id, to), folder_ / "out/main.rad");
    EXPECT_TRUE(report) << report.error().text();
    return content(folder_ / "out/main.rad");
  }
  void SetUp() override { std::filesystem::create_directories(folder_ / "out"); }

  DeckFolder folder_;
};

}  // namespace prismesh::mesh::deck
