#include "mesh/connections/nodes_on_sheets.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <optional>

#include "base/parallel_for.h"
#include "mesh/connections/sheet_reach.h"
#include "mesh/connections/sheets_near.h"
#include "mesh/model/adjacency.h"
#include "mesh/spatial/closest_point.h"

namespace prismesh::mesh::connections {

namespace {

/// Connected beams, springs and solids count as one weld up to this many: sixteen solids make the largest nuggets.
constexpr std::size_t kMaxOfAWeld = 16;

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

/// The nearest shell that the node isn't a corner of, and for a tied node isn't of its own parts.
std::optional<spatial::SurfacePoint> sheet_under(const Model& model, const SheetsNear& sheets, const NodeOnSheet& candidate) {
  const Vec3& point = model.position(candidate.node);
  if (!candidate.tied) return sheets.tree().closest(point);
  std::optional<spatial::SurfacePoint> best;
  const auto own = model.adjacency->shells_of(candidate.node);
  for (const spatial::SurfacePoint& on : sheets.tree().within(point, sheets.search_radius())) {
    const PartIndex part = model.shell_parts[on.shell.value];
    const bool is_own = std::any_of(own.begin(), own.end(), [&](ShellIndex shell) { return model.shell_parts[shell.value] == part; });
    if (!is_own && (!best || on.distance < best->distance)) best = on;
  }
  return best;
}

}  // namespace

std::vector<NodeOnSheet> find_sheets(const Model& model, std::vector<NodeOnSheet> candidates) {
  NodeSet nodes;
  nodes.reserve(candidates.size());
  for (const NodeOnSheet& candidate : candidates) nodes.push_back(candidate.node);
  const SheetsNear sheets(model, nodes, {});
  if (sheets.empty()) return {};
  std::vector<std::uint8_t> lies(candidates.size(), 0);
  parallel_for(candidates.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto on = sheet_under(model, sheets, candidates[i]);
      if (!on) continue;
      candidates[i].shell = on->shell;
      candidates[i].reach = sheet_reach(model, on->shell, candidates[i].tied ? Attachment::tied : Attachment::placed);
      lies[i] = on->distance <= candidates[i].reach ? 1 : 0;
    }
  });
  std::vector<NodeOnSheet> found;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (lies[i] != 0) found.push_back(candidates[i]);
  return found;
}

}  // namespace prismesh::mesh::connections
