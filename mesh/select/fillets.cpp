#include "mesh/select/fillets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "base/deterministic_math.h"
#include "mesh/select/cells.h"

namespace prismesh::mesh::select {

namespace {

constexpr double kMinOfPeak = 0.3;     ///< a fillet's edge has at least this share of its greatest curvature
constexpr double kFlatOfPeak = 0.15;   ///< beside a fillet the curvature is at most this share
constexpr int kMaxColumns = 64;        ///< over which a fillet goes on beside something that isn't flat
constexpr int kMaxCrooked = 3;         ///< of these, columns whose own rows don't bend like a fillet: a bead ends in it
constexpr double kCrooked = 1.0 / 15;  ///< of the angle
constexpr double kMaxWidths = 10;      ///< rows of a fillet whose widths differ by a greater factor aren't looked for

/// What the rows around a cell are. Crooked: one of the cell's edges bends. Bent: they bend like a fillet, but beside them nothing is flat.
enum class Rows : std::uint8_t { nothing, crooked, bent, fillet };

/// The two walks from a cell over opposite edges, and the run of edges around it that bend alike.
class Run {
 public:
  Run(const Walk& one, const Walk& other) : walks_{one, other} {}

  Rows judge(double angle_degrees) {
    if (walks_[0].count == 0 || walks_[1].count == 0) return Rows::nothing;
    side_ = walks_[0].edges[0].degrees < 0 ? -1 : 1;
    if (!(curvature(0, 0) > 0 && curvature(1, 0) > 0)) return Rows::nothing;
    if (!find_ends()) return Rows::nothing;
    if (length_[0] + length_[1] - 1 > kMaxRows || total_degrees() <= angle_degrees) return Rows::nothing;
    const Beside beside[] = {beyond(0), beyond(1)};
    const auto is = [&](Beside what) { return beside[0] == what || beside[1] == what; };
    return !is(Beside::bent) && is(Beside::flat) ? Rows::fillet : Rows::bent;
  }

 private:
  enum class Beside : std::uint8_t { flat, ends_or_bends_back, bent };

  double curvature(std::size_t walk, std::size_t edge) const { return side_ * walks_[walk].edges[edge].curvature; }

  /// Sets length_ and peak_; false if the quad itself isn't between two edges of the run.
  bool find_ends() {
    peak_ = std::max(curvature(0, 0), curvature(1, 0));
    length_ = {1, 1};
    for (bool more = true; more;) {
      more = false;
      for (const std::size_t walk : {0, 1})
        while (length_[walk] < walks_[walk].count && curvature(walk, length_[walk]) >= kMinOfPeak * peak_) {
          peak_ = std::max(peak_, curvature(walk, length_[walk]++));
          more = true;
        }
    }
    // the peak may have grown beyond what the edges before it allow
    for (const std::size_t walk : {0, 1})
      for (std::size_t i = 0; i < length_[walk]; ++i)
        if (curvature(walk, i) < kMinOfPeak * peak_) length_[walk] = i;
    return length_[0] > 0 && length_[1] > 0;
  }

  Beside beyond(std::size_t walk) const {
    const std::size_t next = length_[walk];
    if (next == walks_[walk].count) return walks_[walk].at_end ? Beside::ends_or_bends_back : Beside::bent;
    if (curvature(walk, next) < -kMinOfPeak * peak_) return Beside::ends_or_bends_back;
    const bool is_last = next + 1 == walks_[walk].count;
    if (std::abs(curvature(walk, is_last ? next : next + 1)) <= kFlatOfPeak * peak_) return Beside::flat;
    return is_last && walks_[walk].at_end ? Beside::ends_or_bends_back : Beside::bent;
  }

  double total_degrees() const {
    double total = 0;
    for (const std::size_t walk : {0, 1})
      for (std::size_t i = 0; i < length_[walk]; ++i) total += side_ * walks_[walk].edges[i].degrees;
    return total;
  }

  std::array<Walk, 2> walks_;
  double side_ = 1;
  std::array<std::size_t, 2> length_{};  ///< edges of the run on each side
  double peak_ = 0;
};

}  // namespace

Fillets::Fillets(const Model& model, double angle_degrees, OutOfSight out_of_sight)
    : model_(model),
      angle_degrees_(angle_degrees),
      cells_(std::make_unique<Cells>(model, out_of_sight)),
      known_(model.shell_count(), 0),
      rows_(model.shell_count(), 0) {}
Fillets::~Fillets() = default;

/// How the rows across a cell's edges `first` and `first + 2` bend; remembered.
int Fillets::rows_across(const Cell& cell, std::size_t first) {
  // Of two triangles, the one with the lower index keeps the answer for the cell's first edge and the one after.
  const bool is_first = cell.one <= cell.other;
  const ShellIndex keeper = is_first ? cell.one : cell.other;
  const Cell kept = is_first ? cell : *cells_->of(keeper);
  const std::size_t position = kept.position_of(cell.edge(first)) % 2;
  std::uint8_t& known = rows_[keeper.value];
  const int shift = position == 0 ? 0 : 4;
  if ((known >> shift & 8) == 0) {
    // Most of a sheet is flat: its nearest edges tell.
    const double least = angle_degrees_ / static_cast<double>(kMaxRows + 1) * kMinOfPeak / kMaxWidths;
    const double radians = least / kDegreesPerRadian;
    if (cells_->is_flat_at(kept, position, radians) && cells_->is_flat_at(kept, position + 2, radians)) {
      known = static_cast<std::uint8_t>(known | 8 << shift);
      return 0;
    }
    const Walk one = cells_->walk(kept, position, 1), other = cells_->walk(kept, position + 2, 1);
    const auto bend = [](const Walk& walk) { return walk.count > 0 ? walk.edges[0].degrees : 0.0; };
    const bool is_crooked = std::max(std::abs(bend(one)), std::abs(bend(other))) > kCrooked * angle_degrees_;
    Rows rows = is_crooked ? Rows::crooked : Rows::nothing;
    if (std::abs(bend(one)) > least && std::abs(bend(other)) > least && (bend(one) > 0) == (bend(other) > 0))
      rows = std::max(
          rows, Run(cells_->walk(kept, position, kMaxRows + 3), cells_->walk(kept, position + 2, kMaxRows + 3)).judge(angle_degrees_));
    known = static_cast<std::uint8_t>(known | (8 + static_cast<int>(rows)) << shift);
  }
  return known >> shift & 7;
}

/// Whether a fillet goes on along its axis, from the cell over its edge `position`: to rows beside which the sheet is flat, or to its end.
/// nullopt: something else comes first.
std::optional<bool> Fillets::goes_on(Cell cell, std::size_t position, int crooked) {
  for (int column = 0; column < kMaxColumns; ++column) {
    const ShellIndex next = cells_->beyond(cell, position);
    if (!next.valid()) return false;
    const std::optional<Cell> other = cells_->of(next);
    if (!other) return std::nullopt;
    const std::size_t there = other->position_of(cell.edge(position));
    if (there == 4) return std::nullopt;
    const auto rows = static_cast<Rows>(rows_across(*other, (there + 1) % 4));
    if (rows == Rows::fillet) return true;
    if (rows == Rows::nothing || (rows == Rows::crooked && ++crooked > kMaxCrooked)) return std::nullopt;
    cell = *other;
    position = (there + 2) % 4;
  }
  return std::nullopt;
}

bool Fillets::is_fillet_across(const Cell& cell, std::size_t first) {
  const auto rows = static_cast<Rows>(rows_across(cell, first));
  if (rows == Rows::fillet || rows == Rows::nothing) return rows == Rows::fillet;
  // A bead or a hole beside a fillet doesn't end it.
  const int crooked = rows == Rows::crooked ? 1 : 0;
  const std::optional<bool> one = goes_on(cell, first + 1, crooked);
  if (!one) return false;
  const std::optional<bool> other = goes_on(cell, (first + 3) % 4, crooked);
  // A crooked column needs the fillet on both sides.
  return other && (crooked > 0 ? *one && *other : *one || *other);
}

/// A triangle that is no half of a quad lies in a fillet if two of its neighbours do.
int Fillets::directions_of_triangle(ShellIndex shell) {
  const ShellNodes& nodes = model_.shell(shell);
  int in_fillet = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const NodeIndex a = nodes.node[i], b = nodes.node[(i + 1) % 3];
    const ShellIndex other = cells_->only_neighbour(shell, a < b ? Edge{a, b} : Edge{b, a});
    if (other.valid() && cells_->of(other) && directions(other) != 0) ++in_fillet;
  }
  return in_fillet >= 2 ? kLoneTriangle : 0;
}

int Fillets::directions(ShellIndex shell) {
  std::uint8_t& known = known_[shell.value];
  if (known == 0) {
    int found = 0;
    if (const std::optional<Cell> cell = cells_->of(shell)) {
      for (const std::size_t first : {0, 1})
        if (is_fillet_across(*cell, first)) found |= 1 << first;
    } else {
      found = directions_of_triangle(shell);
    }
    known = static_cast<std::uint8_t>(kAsked + found);
  }
  return known - kAsked;
}

bool Fillets::bends_across(ShellIndex shell, Edge edge) {
  const int found = directions(shell);
  if (found == 0 || found == kLoneTriangle) return found != 0;
  const std::size_t position = cells_->of(shell)->position_of(edge);
  // The edge between two triangles of a cell lies within the fillet.
  return position == 4 || (found >> (position % 2) & 1) != 0;
}

}  // namespace prismesh::mesh::select
