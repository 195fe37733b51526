#include "mesh/deck/lsdyna/generated_ids.h"

#include <algorithm>
#include <optional>

#include "mesh/deck/lsdyna/card.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

constexpr std::int64_t kNoEnd = std::int64_t{1} << 60;
constexpr std::int64_t kMaxPoints = 100'000;  ///< along a direction of a structured mesh

/// Keywords with the first ids of what they generate: the data line (from 1) and the fields, of ten columns, of the first node's and the
/// first element's id; 0 fields: none.
struct FirstIds {
  std::string_view keyword;
  std::uint8_t card, node, element;
};
constexpr FirstIds kFirstIds[] = {
    {"CONTROL_FORMING_BLANKMESH", 2, 2, 3},
    {"DEFINE_FORMING_BLANKMESH", 2, 2, 3},
    {"INCLUDE_AUTO_OFFSET_USER", 2, 1, 2},
    {"IGA_SHELL", 1, 0, 7},
    {"IGA_SOLID", 1, 0, 7},
    {"ELEMENT_SHELL_NURBS_PATCH", 2, 0, 8},
};

class CardsOfBlock {
 public:
  CardsOfBlock(std::string_view text, const Block& block, const Parameters& parameters)
      : lines_(text, block.begin, block.end), columns_(block.columns), parameters_(parameters) {}
  bool next() {
    Line line;
    if (!lines_.next(line)) return false;
    static constexpr std::array kTens{10, 10, 10, 10, 10, 10, 10, 10};
    card_.cut(line.text, kTens, columns_);
    return true;
  }
  /// `field`: from 1. Blank and what is no number: 0.
  std::int64_t number(std::size_t field) const {
    return std::clamp(card_.integer(field - 1, parameters_).value_or(0), std::int64_t{0}, kNoEnd / 2);
  }

 private:
  Lines lines_;
  Columns columns_;
  const Parameters& parameters_;
  Card card_;
};

}  // namespace

void GeneratedIds::read(std::string_view text, const Block& block, const Parameters& parameters) {
  const std::string_view name = block.name;
  CardsOfBlock cards(text, block, parameters);
  if (name == "ALE_STRUCTURED_MESH_CONTROL_POINTS") {
    if (!cards.next()) return;
    std::int64_t& count = point_counts_[cards.number(1)];
    // Each line has the number of a point of the mesh; the last one's is the largest.
    while (cards.next()) count = std::max(count, cards.number(1));
  } else if (name == "ALE_STRUCTURED_MESH") {
    if (!cards.next()) return;
    StructuredMesh mesh{cards.number(3), cards.number(4), {}};
    if (cards.next()) mesh.points = {cards.number(1), cards.number(2), cards.number(3)};
    if (mesh.node > 0 || mesh.element > 0) meshes_.push_back(std::move(mesh));
  } else if (name.starts_with("PART_DUPLICATE")) {
    while (cards.next())
      if (cards.number(5) > 0 || cards.number(4) > 0) copies_.push_back({cards.number(5), cards.number(4)});
  } else {
    for (const FirstIds& first : kFirstIds) {
      if (!name.starts_with(first.keyword)) continue;
      bool there = true;
      for (int card = 0; card < first.card && there; ++card) there = cards.next();
      if (!there) return;
      if (first.node > 0 && cards.number(first.node) > 0) open_.nodes.push_back({cards.number(first.node), kNoEnd});
      if (first.element > 0 && cards.number(first.element) > 0) open_.elements.push_back({cards.number(first.element), kNoEnd});
      return;
    }
  }
}

TakenIds GeneratedIds::finish(const LargestIds& largest) const {
  TakenIds taken = open_;
  for (const StructuredMesh& mesh : meshes_) {
    std::int64_t count = 1;
    for (const std::int64_t id : mesh.points) {
      const auto points = point_counts_.find(id);
      count = points == point_counts_.end() || points->second <= 0 ? 0 : count * std::min(points->second, kMaxPoints);
    }
    const auto last = [&](std::int64_t first) { return count == 0 || mesh.points.empty() ? kNoEnd : first + count - 1; };
    if (mesh.node > 0) taken.nodes.push_back({mesh.node, last(mesh.node)});
    if (mesh.element > 0) taken.elements.push_back({mesh.element, last(mesh.element)});
  }
  // A copy of a part has ids larger by an offset.
  for (const Offsets& copy : copies_) {
    if (copy.node > 0) taken.nodes.push_back({1 + copy.node, largest.node + copy.node});
    if (copy.element > 0) taken.elements.push_back({1 + copy.element, largest.element + copy.element});
  }
  return taken;
}

}  // namespace prismesh::mesh::deck::lsdyna
