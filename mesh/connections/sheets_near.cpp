#include "mesh/connections/sheets_near.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/parallel_for.h"
#include "mesh/connections/sheet_reach.h"

namespace prismesh::mesh::connections {

namespace {

constexpr std::size_t kSearchGrain = 16384;
constexpr double kMaxCells = 64;  ///< a shell over more cells than this is checked exactly at once

using Cell = std::array<std::int64_t, 3>;

/// A table of bits for the cells of a grid that hold a point; it may have false positives. It grows with the points, so that their share
/// stays small: a shell asks for some eight cells.
class CellTable {
 public:
  CellTable(const Model& model, const NodeSet& points, double width) : width_(width) {
    while (std::size_t{1} << log2_bits_ < kBitsForAPoint * points.size()) ++log2_bits_;
    words_.assign((std::size_t{1} << log2_bits_) / 64, 0);
    for (const NodeIndex point : points) {
      const std::size_t bit = slot(cell_of(model.position(point)));
      words_[bit / 64] |= std::uint64_t{1} << bit % 64;
    }
  }
  Cell cell_of(const Vec3& point) const {
    Cell cell;
    for (int i = 0; i < 3; ++i) {
      const double along = point[i] / width_;
      cell[static_cast<std::size_t>(i)] = std::isnan(along) ? 0 : static_cast<std::int64_t>(std::floor(std::clamp(along, -1e15, 1e15)));
    }
    return cell;
  }
  bool may_hold_any(const Vec3& low, const Vec3& high) const {
    const Cell a = cell_of(low), b = cell_of(high);
    double cells = 1;
    for (std::size_t i = 0; i < 3; ++i) cells *= static_cast<double>(b[i] - a[i] + 1);
    if (cells > kMaxCells) return true;
    for (std::int64_t x = a[0]; x <= b[0]; ++x)
      for (std::int64_t y = a[1]; y <= b[1]; ++y)
        for (std::int64_t z = a[2]; z <= b[2]; ++z)
          if (const std::size_t bit = slot({x, y, z}); (words_[bit / 64] >> bit % 64 & 1) != 0) return true;
    return false;
  }

 private:
  static constexpr std::size_t kBitsForAPoint = 64;
  std::size_t slot(const Cell& cell) const {
    const auto mixed = static_cast<std::uint64_t>(cell[0]) * 0x9e3779b97f4a7c15u ^
                       static_cast<std::uint64_t>(cell[1]) * 0xc2b2ae3d27d4eb4fu ^
                       static_cast<std::uint64_t>(cell[2]) * 0x165667b19e3779f9u;
    return static_cast<std::size_t>(mixed >> (64 - log2_bits_));
  }
  double width_;
  int log2_bits_ = 20;
  std::vector<std::uint64_t> words_;
};

/// Shells that may have a point within their reach.
ShellSet shells_near(const Model& model, const NodeSet& points, OutOfSight out_of_sight) {
  if (points.empty()) return {};
  double sum = 0;
  std::size_t asked = 0;
  for (std::size_t s = 0; s < model.shell_count(); s += 64)
    if (!model.is_removed(ShellIndex(s)))
      sum += mean_side(model, ShellIndex(s)) + 2 * sheet_reach(model, ShellIndex(s), Attachment::tied), ++asked;
  // As wide as a shell with its reach, which is the thickness where shells are smaller than that: then it lies in eight cells or so.
  const double width = asked > 0 && sum > 0 && std::isfinite(sum) ? sum / static_cast<double>(asked) : 1.0;
  const CellTable table(model, points, width);
  std::vector<ShellSet> found((model.shell_count() + kSearchGrain - 1) / kSearchGrain);
  parallel_for(model.shell_count(), kSearchGrain, [&](std::size_t begin, std::size_t end) {
    ShellSet& near = found[begin / kSearchGrain];
    for (std::size_t s = begin; s < end; ++s) {
      const ShellIndex shell(s);
      if (!in_sight(model, shell, out_of_sight)) continue;
      Vec3 low = model.position(model.shell(shell).node[0]), high = low;
      for (const NodeIndex node : model.shell(shell).node) {
        low = low.cwiseMin(model.position(node));
        high = high.cwiseMax(model.position(node));
      }
      const Vec3 reach = Vec3::Constant(sheet_reach(model, shell, Attachment::tied));
      if (table.may_hold_any(low - reach, high + reach)) near.push_back(shell);
    }
  });
  ShellSet all;
  for (const ShellSet& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace

SheetsNear::SheetsNear(const Model& model, const NodeSet& nodes, OutOfSight out_of_sight)
    : SheetsNear(model, shells_near(model, nodes, out_of_sight)) {}

SheetsNear::SheetsNear(const Model& model, const ShellSet& shells) : tree_(model, shells) {
  double sum = 0;
  for (const ShellIndex shell : shells) sum += sheet_reach(model, shell, Attachment::tied);
  search_radius_ = shells.empty() ? 0 : 2 * sum / static_cast<double>(shells.size());
}

}  // namespace prismesh::mesh::connections
