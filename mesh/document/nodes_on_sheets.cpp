#include "mesh/document/nodes_on_sheets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>

#include "base/parallel_for.h"
#include "mesh/model/adjacency.h"
#include "mesh/quality/shell_properties.h"
#include "mesh/spatial/closest_point.h"

namespace prismesh::mesh::document {

namespace {

/// Connected beams, springs and solids count as one weld up to this many: sixteen solids make the largest nuggets.
constexpr std::size_t kMaxOfAWeld = 16;
constexpr double kReachOfSize = 0.25;  ///< max distance at which a node lies on a shell, as a share of the shell's size
constexpr double kReachOfTied = 0.5;   ///< the same for tied nodes, which are offset by half of both thicknesses
constexpr std::size_t kSearchGrain = 16384;
constexpr double kMaxCells = 64;  ///< a shell over more cells than this is checked exactly at once

bool may_be_weld(ElementClass element_class) {
  return element_class == ElementClass::beam || element_class == ElementClass::solid || element_class == ElementClass::discrete ||
         element_class == ElementClass::tshell;
}

std::vector<std::uint8_t> flag_middles(const Model& model) {
  std::vector<std::uint8_t> is_middle(model.node_count(), 0);
  if (model.midside)
    for (const MidsideNodes& midside : *model.midside)
      for (const NodeIndex node : midside.node)
        if (node.valid()) is_middle[node.value] = 1;
  return is_middle;
}

}  // namespace

std::vector<NodeOnSheet> find_weld_nodes(const Model& model, std::span<const ElementUse> uses) {
  const std::vector<std::uint8_t> is_middle = flag_middles(model);
  std::array<std::vector<std::uint32_t>, kElementClassCount> number;  // of each element, from 0 over all classes
  std::uint32_t count = 0;
  for (std::size_t c = 0; c < model.elements.size(); ++c)
    if (model.elements[c]) {
      number[c].resize(model.elements[c]->size());
      std::iota(number[c].begin(), number[c].end(), count);
      count += static_cast<std::uint32_t>(number[c].size());
    }
  std::vector<std::uint32_t> parent(count), size(count, 1);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t e) {
    while (parent[e] != e) e = parent[e] = parent[parent[e]];
    return e;
  };
  const auto number_of = [&](const ElementUse& use) { return number[static_cast<std::size_t>(use.element_class)][use.element]; };
  const auto lone = [&](NodeIndex node) { return model.adjacency->shells_of(node).empty() && is_middle[node.value] == 0; };
  for (std::size_t u = 1; u < uses.size(); ++u) {
    const auto &a = uses[u - 1], &b = uses[u];
    if (a.node != b.node || !lone(a.node)) continue;
    const std::uint32_t x = root(number_of(a)), y = root(number_of(b));
    if (x == y) continue;
    parent[y] = x;
    size[x] += size[y];
  }
  std::vector<NodeOnSheet> nodes;
  for (const ElementUse& use : uses) {
    if (!may_be_weld(use.element_class) || !lone(use.node) || size[root(number_of(use))] > kMaxOfAWeld) continue;
    if (!nodes.empty() && nodes.back().node == use.node) continue;
    NodeOnSheet found;
    found.node = use.node;
    found.element_class = use.element_class;
    found.of = use.element;
    nodes.push_back(found);
  }
  return nodes;
}

namespace {

double size_of(const Model& model, ShellIndex shell) {
  const ShellNodes& nodes = model.shell(shell);
  double around = 0;
  const int corners = nodes.corners();
  for (int i = 0; i < corners; ++i) around += (model.position(nodes.node[(i + 1) % corners]) - model.position(nodes.node[i])).norm();
  return around / corners;
}

double reach_of(const Model& model, ShellIndex shell, bool tied) {
  const double thickness = quality::thickness_of(model, shell.value);
  return std::max((tied ? kReachOfTied : kReachOfSize) * size_of(model, shell), thickness > 0 ? (tied ? 1.2 : 1.0) * thickness : 0.0);
}

using Cell = std::array<std::int64_t, 3>;

/// A table of bits for the cells of a grid that hold a point; it may have false positives. It grows with the points, so that their share
/// stays small: a shell asks for some eight cells.
class CellTable {
 public:
  CellTable(const Model& model, const std::vector<NodeOnSheet>& points, double width) : width_(width) {
    while (std::size_t{1} << log2_bits_ < kBitsForAPoint * points.size()) ++log2_bits_;
    words_.assign((std::size_t{1} << log2_bits_) / 64, 0);
    for (const NodeOnSheet& point : points) {
      const std::size_t bit = slot(cell_of(model.position(point.node)));
      words_[bit / 64] |= std::uint64_t{1} << bit % 64;
    }
  }
  Cell cell_of(const Vec3& point) const {
    Cell cell;
    for (int i = 0; i < 3; ++i)
      cell[static_cast<std::size_t>(i)] = static_cast<std::int64_t>(std::floor(std::clamp(point[i] / width_, -1e15, 1e15)));
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
ShellSet shells_near(const Model& model, const std::vector<NodeOnSheet>& points) {
  double sum = 0;
  std::size_t asked = 0;
  for (std::size_t s = 0; s < model.shell_count(); s += 64)
    if (!model.is_removed(ShellIndex(s))) sum += size_of(model, ShellIndex(s)) + 2 * reach_of(model, ShellIndex(s), true), ++asked;
  // As wide as a shell with its reach, which is the thickness where shells are smaller than that: then it lies in eight cells or so.
  const double width = asked > 0 && sum > 0 && std::isfinite(sum) ? sum / static_cast<double>(asked) : 1.0;
  const CellTable table(model, points, width);
  std::vector<ShellSet> found((model.shell_count() + kSearchGrain - 1) / kSearchGrain);
  parallel_for(model.shell_count(), kSearchGrain, [&](std::size_t begin, std::size_t end) {
    ShellSet& near = found[begin / kSearchGrain];
    for (std::size_t s = begin; s < end; ++s) {
      const ShellIndex shell(s);
      if (model.is_removed(shell)) continue;
      Vec3 low = model.position(model.shell(shell).node[0]), high = low;
      for (const NodeIndex node : model.shell(shell).node) {
        low = low.cwiseMin(model.position(node));
        high = high.cwiseMax(model.position(node));
      }
      const Vec3 reach = Vec3::Constant(reach_of(model, shell, true));
      if (table.may_hold_any(low - reach, high + reach)) near.push_back(shell);
    }
  });
  ShellSet all;
  for (const ShellSet& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// The nearest shell that the node isn't a corner of, and for a tied node isn't of its own parts.
std::optional<spatial::SurfacePoint> sheet_under(const Model& model, const spatial::ShellTree& tree, const NodeOnSheet& candidate,
                                                 double far) {
  const Vec3& point = model.position(candidate.node);
  if (!candidate.tied) return tree.closest(point);
  std::optional<spatial::SurfacePoint> best;
  const auto own = model.adjacency->shells_of(candidate.node);
  for (const spatial::SurfacePoint& on : tree.within(point, far)) {
    const PartIndex part = model.shell_parts[on.shell.value];
    const bool is_own = std::any_of(own.begin(), own.end(), [&](ShellIndex shell) { return model.shell_parts[shell.value] == part; });
    if (!is_own && (!best || on.distance < best->distance)) best = on;
  }
  return best;
}

}  // namespace

std::vector<NodeOnSheet> find_sheets(const Model& model, std::vector<NodeOnSheet> candidates) {
  if (candidates.empty() || model.shell_count() == 0) return {};
  const ShellSet near = shells_near(model, candidates);
  const spatial::ShellTree tree(model, near);
  if (tree.empty()) return {};
  double far = 0;
  for (const ShellIndex shell : near) far += reach_of(model, shell, true);
  far = near.empty() ? 0 : 2 * far / static_cast<double>(near.size());
  std::vector<std::uint8_t> lies(candidates.size(), 0);
  parallel_for(candidates.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto on = sheet_under(model, tree, candidates[i], far);
      if (!on) continue;
      candidates[i].shell = on->shell;
      candidates[i].reach = reach_of(model, on->shell, candidates[i].tied);
      lies[i] = on->distance <= candidates[i].reach ? 1 : 0;
    }
  });
  std::vector<NodeOnSheet> found;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (lies[i] != 0) found.push_back(candidates[i]);
  return found;
}

}  // namespace prismesh::mesh::document
