#include "tests/station/sheet_deck.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace prismesh::test {
namespace {

constexpr double kRadius = 90;
constexpr double kStep = 5;

/// True inside *NODE blocks; follows the keywords line by line.
class NodeBlocks {
 public:
  bool is_card(const std::string& line) {
    if (!line.empty() && line[0] == '*') {
      inside_ = line.rfind("*NODE", 0) == 0 && line.find('_') == std::string::npos;
      return false;
    }
    return inside_ && !line.empty() && line[0] != '$';
  }

 private:
  bool inside_ = false;
};

std::int64_t id_of(const std::string& card) { return std::stoll(card.substr(0, 8)); }

}  // namespace

namespace {

/// A number from -1 to 1 that looks random, the same everywhere.
double scatter(int row, int column, std::uint32_t which) {
  std::uint32_t x = static_cast<std::uint32_t>(row) * 2654435761u + static_cast<std::uint32_t>(column) * 40503u + which * 97u;
  x = (x ^ (x >> 15)) * 2246822519u;
  x = (x ^ (x >> 13)) * 3266489917u;
  return static_cast<double>(x >> 8) / (1 << 23) - 1;
}

/// `jitter`: how far nodes inside lie beside their place on the cylinder, as a share of a step.
void write_sheet_of(const std::filesystem::path& path, int side, double jitter) {
  const double radius = kRadius * side / kSheetSide;
  std::FILE* file = std::fopen(path.c_str(), "w");
  std::fprintf(file,
               "$ a curved sheet for the station test\n*KEYWORD\n*TITLE\nCurved sheet   with   odd spacing\n*NODE\n$#   nid               "
               "x               y               z\n");
  std::int64_t id = kFirstNode;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const bool inside = row > 0 && column > 0 && row + 1 < side && column + 1 < side;
      const double along = inside ? jitter * scatter(row, column, 1) : 0, across = inside ? jitter * scatter(row, column, 2) : 0;
      const double angle = (column + across - (side - 1) / 2) * kStep / radius;
      std::fprintf(file, "%8lld%16.6f%16.6f%16.6f%8d%8d\n", static_cast<long long>(id++), radius * std::sin(angle), (row + along) * kStep,
                   radius * std::cos(angle), 0, 0);
    }
  std::fprintf(file, "*ELEMENT_SHELL\n$#   eid     pid      n1      n2      n3      n4\n");
  std::int64_t element = 1;
  for (int row = 0; row + 1 < side; ++row)
    for (int column = 0; column + 1 < side; ++column) {
      const long long n = kFirstNode + row * side + column;
      std::fprintf(file, "%8lld%8d%8lld%8lld%8lld%8lld\n", static_cast<long long>(element++), 7, n, n + 1, n + side + 1, n + side);
    }
  std::fprintf(file,
               "*PART\nRoof panel, drawn\n%10d%10d%10d\n*SECTION_SHELL\n%10d%10d\n%10.2f%10.2f%10.2f%10.2f\n"
               "*MAT_ELASTIC\n%10d%10.2e%10.1f%10.2f\n*SOME_CARD_NOBODY_KNOWS\n word for word,  1.0E0\n*END\n",
               7, 1, 1, 1, 2, 0.8, 0.8, 0.8, 0.8, 1, 7.85e-9, 210000.0, 0.3);
  std::fclose(file);
}

}  // namespace

void write_sheet(const std::filesystem::path& path) { write_sheet_of(path, kSheetSide, 0); }

void write_uneven_sheet(const std::filesystem::path& path, int side) { write_sheet_of(path, side, 0.3); }

HatDeck write_closed_hat(const std::filesystem::path& path) {
  constexpr int kRows = 13;
  const std::vector<Point> hat{{-50, 0, 0}, {-40, 0, 0}, {-30, 0, 0}, {-24, 0, 15}, {-18, 0, 30}, {-9, 0, 30}, {0, 0, 30},
                               {9, 0, 30},  {18, 0, 30}, {24, 0, 15}, {30, 0, 0},   {40, 0, 0},   {50, 0, 0}};
  std::vector<Point> plate;
  for (int x = -40; x <= 40; x += 8) plate.push_back({static_cast<double>(x), 0, -3});
  HatDeck deck;
  std::FILE* file = std::fopen(path.c_str(), "w");
  std::fprintf(file, "*KEYWORD\n*NODE\n");
  const auto write_nodes = [&](const std::vector<Point>& section, std::int64_t first, std::map<std::int64_t, Point>& nodes) {
    for (int row = 0; row < kRows; ++row)
      for (const Point& point : section) {
        const auto id = first++;
        nodes[id] = {point[0], row * 10.0, point[2]};
        std::fprintf(file, "%8lld%16.6f%16.6f%16.6f\n", static_cast<long long>(id), point[0], row * 10.0, point[2]);
      }
  };
  write_nodes(hat, 1, deck.hat);
  write_nodes(plate, 1001, deck.plate);
  std::fprintf(file, "*ELEMENT_SHELL\n");
  long long element = 1;
  const auto write_shells = [&](std::size_t across, long long first, int part) {
    for (int row = 0; row + 1 < kRows; ++row)
      for (std::size_t i = 0; i + 1 < across; ++i) {
        const long long n = first + row * static_cast<long long>(across) + static_cast<long long>(i);
        const long long up = n + static_cast<long long>(across);
        std::fprintf(file, "%8lld%8d%8lld%8lld%8lld%8lld\n", element++, part, n, n + 1, up + 1, up);
      }
  };
  write_shells(hat.size(), 1, 1);
  write_shells(plate.size(), 1001, 2);
  std::fprintf(file,
               "*PART\nHat\n%10d%10d%10d\n*PART\nClosing plate\n%10d%10d%10d\n*SECTION_SHELL\n%10d%10d\n%10.2f%10.2f%10.2f%10.2f\n"
               "*MAT_ELASTIC\n%10d%10.2e%10.1f%10.2f\n*END\n",
               1, 1, 1, 2, 1, 1, 1, 2, 0.8, 0.8, 0.8, 0.8, 1, 7.85e-9, 210000.0, 0.3);
  std::fclose(file);
  return deck;
}

void write_flange(const std::filesystem::path& path) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  std::fprintf(file, "*KEYWORD\n*NODE\n");
  for (int part = 1; part <= 2; ++part)
    for (int row = 0; row < 5; ++row)
      for (int i = 0; i < 25; ++i)
        std::fprintf(file, "%8d%16.6f%16.6f%16.6f\n", 1000 * part + 1 + i + 25 * row, 5.0 * i, 5.0 * row, 1.5 * (part - 1));
  const std::array<Point, 4> ends{Point{5, 10, 0}, Point{5, 10, 1.5}, Point{100, 10, 0}, Point{100, 10, 9.5}};
  for (std::size_t e = 0; e < ends.size(); ++e)
    std::fprintf(file, "%8d%16.6f%16.6f%16.6f\n", 80001 + static_cast<int>(e), ends[e][0], ends[e][1], ends[e][2]);
  std::fprintf(file, "*ELEMENT_SHELL\n");
  for (int part = 1; part <= 2; ++part)
    for (int row = 0; row < 4; ++row)
      for (int i = 0; i < 24; ++i) {
        const int corner = 1000 * part + 1 + i + 25 * row;
        std::fprintf(file, "%8d%8d%8d%8d%8d%8d\n", 1000 * part + 1 + i + 24 * row, part, corner, corner + 1, corner + 26, corner + 25);
      }
  std::fprintf(
      file,
      "*ELEMENT_BEAM\n   90001      90   80001   80002       0       0       0       0       0       2\n"
      "   90002      90   80003   80004       0       0       0       0       0       2\n"
      "*PART\nlower\n         1         1         1\n*PART\nupper\n         2         1         1\n*PART\nspot welds\n        90"
      "        90        90\n*SECTION_SHELL\n         1         2\n       1.5       1.5       1.5       1.5\n*MAT_ELASTIC\n         "
      "1  7.85E-09    210000       0.3\n*SECTION_BEAM\n        90         9       1.0         2\n       6.0       6.0\n*MAT_SPOTWELD\n"
      "        90  7.85E-09  210000.0       0.3     300.0    2100.0\n*END\n");
  std::fclose(file);
}

Point sheet_normal(const Point& point) { return {point[0] / kRadius, 0, point[2] / kRadius}; }

std::string whole_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::stringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::map<std::int64_t, Point> nodes_of_deck(const std::string& text) {
  std::map<std::int64_t, Point> nodes;
  NodeBlocks blocks;
  for (const std::string& line : lines_of(text))
    if (blocks.is_card(line))
      nodes[id_of(line)] = {std::stod(line.substr(8, 16)), std::stod(line.substr(24, 16)), std::stod(line.substr(40, 16))};
  return nodes;
}

DeckDifference compare_decks(const std::string& before, const std::string& after) {
  const std::vector<std::string> a = lines_of(before), b = lines_of(after);
  DeckDifference difference;
  difference.same_line_count = a.size() == b.size();
  NodeBlocks blocks;
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
    const bool card = blocks.is_card(a[i]);
    if (a[i] == b[i]) continue;
    if (card && b[i].size() > 56 && id_of(a[i]) == id_of(b[i]))
      difference.nodes.push_back(id_of(a[i]));
    else
      difference.other_changes.push_back(b[i]);
  }
  return difference;
}

}  // namespace prismesh::test
