// Small decks, written and read back by the test itself: an independent check of what was saved.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace prismesh::test {

using Point = std::array<double, 3>;

/// A cylinder's segment, axis along y, its ridge upward: 25 x 25 nodes, 24 x 24 shells, one part.
void write_sheet(const std::filesystem::path& path);
inline constexpr std::int64_t kFirstNode = 1001;
inline constexpr int kSheetSide = 25;
/// The same with `side` x `side` nodes and as much curved, its nodes unevenly apart: relaxing has something to do everywhere.
void write_uneven_sheet(const std::filesystem::path& path, int side);
/// The outward normal of the sheet at a point of it.
Point sheet_normal(const Point& point);

/// A hat section with sloping walls, axis along y, 100 wide between its flanges' ends (part 1), and under it the plate that closes it,
/// 80 wide (part 2): seen from above, the hat hides the plate.
struct HatDeck {
  std::map<std::int64_t, Point> hat, plate;  ///< their nodes
};
HatDeck write_closed_hat(const std::filesystem::path& path);

/// Two sheets of 1.5 on each other, 120 x 20, the lower one at z = 0 (nodes 1001 and on), the upper one at 1.5 (2001 and on), 25 nodes in a
/// row 5 apart. A beam welds them at (5, 10); a second one at (100, 10) hangs 8 above the upper one.
void write_flange(const std::filesystem::path& path);

std::string whole_file(const std::filesystem::path& path);
std::vector<std::string> lines_of(const std::string& text);
/// Node cards in fixed columns of 8 and 16 characters.
std::map<std::int64_t, Point> nodes_of_deck(const std::string& text);

/// What two decks differ in, line by line.
struct DeckDifference {
  bool same_line_count = false;
  std::vector<std::int64_t> nodes;         ///< ids of node cards that differ
  std::vector<std::string> other_changes;  ///< lines that differ and are no node cards of the same id
};
DeckDifference compare_decks(const std::string& before, const std::string& after);

}  // namespace prismesh::test
