#include "mesh/deck/abaqus/generated_ids.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include "mesh/deck/abaqus/instance_shifts.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::abaqus {
namespace {

/// Abaqus takes no larger numbers. What would exceed it is cut off, so that sums can't overflow.
constexpr std::int64_t kLargest = 999'999'999'999;

using Numbers = std::array<std::int64_t, 10>;

/// The whole numbers of a data line; blank: 0. nullopt: a parameter gives one of them.
std::optional<Numbers> numbers_of(const DataLine& line) {
  Numbers numbers{};
  const auto fields = first_fields<10>(line.text);
  for (std::size_t f = 0; f < fields.size(); ++f) {
    if (fields[f].find('<') != std::string_view::npos) return std::nullopt;
    if (parse_integer(fields[f], numbers[f])) numbers[f] = std::clamp(numbers[f], -kLargest, kLargest);
  }
  return numbers;
}

std::int64_t or_one(std::int64_t number) { return number == 0 ? 1 : number; }

/// a * b, cut off at kLargest.
std::int64_t times(std::int64_t a, std::int64_t b) {
  if (a == 0 || b == 0) return 0;
  return std::abs(a) > kLargest / std::abs(b) ? ((a < 0) == (b < 0) ? kLargest : -kLargest) : a * b;
}

class Generation {
 public:
  Generation(const DeckOutline& outline, LargestIds largest) : outline_(outline), largest_(largest) {}

  TakenIds run() {
    for (const KeptBlock& kept : outline_.kept) read(outline_.words[kept.word], kept.block);
    for (const OffsetElements& offset : outline_.offset_elements) take_offset(offset);
    return std::move(taken_);
  }

 private:
  void read(std::string_view word, const Block& block) {
    const bool is_line = word == "NGEN" || word == "NFILL" || word == "ELGEN";
    if (!is_line && word != "NCOPY" && word != "ELCOPY" && word != "SYMMETRIC MODEL GENERATION") return;
    const Parameters given = outline_.parameters(block);
    shifts_ = shifts_of(outline_, block, given);
    if (word == "NCOPY") return copy_nodes(number(given, "CHANGENUMBER"));
    if (word == "ELCOPY") return copy_elements(number(given, "ELEMENTSHIFT"));
    if (!is_line) return revolve(given);
    for (std::uint32_t s = 0; s < block.segments; ++s) {
      const Segment& where = outline_.segments[block.first_segment + s];
      DataLines lines(outline_.text(where.file), where.begin, where.end);
      for (DataLine line; lines.next(line);) read_line(word, line);
    }
  }

  static std::int64_t number(const Parameters& given, std::string_view name) {
    std::int64_t value = 0;
    const auto text = given.value(name);
    return text && parse_integer(*text, value) ? std::clamp(value, -kLargest, kLargest) : 0;
  }

  void read_line(std::string_view word, const DataLine& line) {
    const std::optional<Numbers> numbers = numbers_of(line);
    if (word == "NGEN")
      numbers ? take_nodes({std::min((*numbers)[0], (*numbers)[1]), std::max((*numbers)[0], (*numbers)[1])}) : take_nodes({1, kLargest});
    else if (word == "NFILL")
      // From each node of the first set L - 1 more, an increment apart.
      numbers ? fill(times((*numbers)[2], or_one((*numbers)[3]))) : take_nodes({1, kLargest});
    else
      numbers ? generate_elements(*numbers) : take_elements({1, kLargest});
  }

  void fill(std::int64_t reach) {
    take_nodes({1 + std::min<std::int64_t>(reach, 0), std::min(kLargest, largest_.node + std::max<std::int64_t>(reach, 0))});
  }

  /// From the master element on, in a row, in rows, and in layers: of each the number, and the increments of nodes and elements.
  void generate_elements(const Numbers& n) {
    IdRange range{n[0], n[0]};
    for (const std::size_t f : {std::size_t{1}, std::size_t{4}, std::size_t{7}}) {
      const std::int64_t reach = times(std::max<std::int64_t>(n[f] - 1, 0), or_one(n[f + 2]));
      (reach < 0 ? range.first : range.last) += reach;
    }
    take_elements(range);
  }

  void copy_nodes(std::int64_t change) { take_nodes({std::max<std::int64_t>(1, 1 + change), std::min(kLargest, largest_.node + change)}); }
  void copy_elements(std::int64_t change) {
    take_elements({std::max<std::int64_t>(1, 1 + change), std::min(kLargest, largest_.element + change)});
  }

  /// Every copy adds the offset again; how many there are, a line of the original's geometry decides. Without offsets the solver begins
  /// behind the largest ids that there are.
  void revolve(const Parameters& given) {
    if (const std::int64_t by = number(given, "NODEOFFSET"); by > 0) take_nodes({1 + by, kLargest});
    if (const std::int64_t by = number(given, "ELEMENTOFFSET"); by > 0) take_elements({1 + by, kLargest});
  }

  /// Cohesive elements that give their first face only: the other faces' nodes have the offset added once and twice.
  void take_offset(const OffsetElements& offset) {
    shifts_ = shifts_of(outline_, offset.block, outline_.parameters(offset.block));
    const std::int64_t by = std::clamp<std::int64_t>(offset.by, 0, kLargest / 4);
    if (by > 0) take_nodes({1 + by, std::min(kLargest, largest_.node + 2 * by)});
  }

  /// What is generated may be what a later keyword generates from.
  void take_nodes(const IdRange& range) {
    take(range, taken_.nodes);
    largest_.node = std::max(largest_.node, std::min(range.last, kLargest));
  }
  void take_elements(const IdRange& range) {
    take(range, taken_.elements);
    largest_.element = std::max(largest_.element, std::min(range.last, kLargest));
  }
  void take(const IdRange& range, std::vector<IdRange>& ranges) const {
    for (const std::int64_t shift : shifts_) ranges.push_back({range.first + shift, range.last + shift});
  }

  const DeckOutline& outline_;
  LargestIds largest_;
  TakenIds taken_;
  std::vector<std::int64_t> shifts_;
};

}  // namespace

TakenIds find_generated_ids(const DeckOutline& outline, LargestIds largest) { return Generation(outline, largest).run(); }

}  // namespace prismesh::mesh::deck::abaqus
