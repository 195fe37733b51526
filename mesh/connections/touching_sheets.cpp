#include "mesh/connections/touching_sheets.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>

#include <Eigen/Geometry>

#include "base/parallel_for.h"
#include "mesh/connections/sheet_reach.h"
#include "mesh/connections/sheets_near.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::connections {

namespace {

using SheetNumbers = std::span<const std::uint32_t>;

constexpr std::size_t kTouchingGrain = 1024;

Vec3 normal_of(const Model& model, ShellIndex shell) {
  const ShellNodes& nodes = model.shell(shell);
  const auto at = [&](std::size_t i) -> const Vec3& { return model.position(nodes.node[i]); };
  if (nodes.is_triangle()) return (at(1) - at(0)).cross(at(2) - at(0));
  return (at(2) - at(0)).cross(at(3) - at(1));
}

bool lie_flat(const Model& model, ShellIndex a, ShellIndex b) {
  const Vec3 of_a = normal_of(model, a), of_b = normal_of(model, b);
  return std::abs(of_a.dot(of_b)) >= kMinCosOfTouching * std::sqrt(of_a.squaredNorm() * of_b.squaredNorm());
}

/// A shell at a node without a joint, with the node.
struct Unjoined {
  NodeIndex node;
  ShellIndex shell;
};

/// The nodes of the sheets that no joint joins to another sheet, each with its first visible shell, if there are several sheets.
std::vector<Unjoined> find_unjoined(const Model& model, SheetNumbers sheet_numbers, std::span<const JoinedSheets::Pair> joints,
                                    OutOfSight out_of_sight) {
  std::vector<std::uint8_t> joined(model.node_count(), 0);  // by sheet number
  for (const auto& [a, b] : joints) {
    const std::uint32_t of_a = sheet_numbers[a.value], of_b = sheet_numbers[b.value];
    if (of_a != of_b) joined[of_a] = joined[of_b] = 1;
  }
  std::optional<std::uint32_t> first;
  bool several = false;
  std::vector<Unjoined> found;
  std::vector<std::uint8_t> seen;
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    const ShellIndex shell(s);
    if (!in_sight(model, shell, out_of_sight)) continue;
    if (!first) first = sheet_numbers[s];
    several |= *first != sheet_numbers[s];
    if (joined[sheet_numbers[s]] != 0) continue;
    if (seen.empty()) seen.assign(model.node_count(), 0);
    for (const NodeIndex node : model.shell(shell).node)
      if (seen[node.value] == 0) seen[node.value] = 1, found.push_back({node, shell});
  }
  if (!several) found.clear();
  return found;
}

}  // namespace

std::vector<std::uint32_t> number_sheets(const Model& model, OutOfSight out_of_sight) {
  std::vector<std::uint32_t> parent(model.node_count());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t node) {
    while (parent[node] != node) node = parent[node] = parent[parent[node]];
    return node;
  };
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    if (!in_sight(model, ShellIndex(s), out_of_sight)) continue;
    const ShellNodes& nodes = model.shell(ShellIndex(s));
    const std::uint32_t first = root(nodes.node[0].value);
    for (std::size_t i = 1; i < 4; ++i) parent[root(nodes.node[i].value)] = first;
  }
  std::vector<std::uint32_t> numbers(model.shell_count(), 0);
  for (std::size_t s = 0; s < model.shell_count(); ++s)
    if (!model.is_removed(ShellIndex(s))) numbers[s] = root(model.shell(ShellIndex(s)).node[0].value);
  return numbers;
}

std::vector<JoinedSheets::Pair> find_touching(const Model& model, SheetNumbers sheet_numbers, std::span<const JoinedSheets::Pair> joints,
                                              OutOfSight out_of_sight) {
  const std::vector<Unjoined> unjoined = find_unjoined(model, sheet_numbers, joints, out_of_sight);
  NodeSet nodes;
  nodes.reserve(unjoined.size());
  for (const Unjoined& each : unjoined) nodes.push_back(each.node);
  const SheetsNear sheets(model, nodes, out_of_sight);
  double max_reach = 0;
  for (const Part& part : *model.parts) max_reach = std::max(max_reach, kTiedReachInThicknesses * part.thickness.value_or(0.0));
  for (std::size_t s = 0; s < model.shell_count(); ++s)
    max_reach = std::max(max_reach, kTiedReachInThicknesses * double{model.shell_thickness[s]});
  if (sheets.empty() || !(max_reach > 0)) return {};
  std::vector<std::vector<JoinedSheets::Pair>> of_range((unjoined.size() + kTouchingGrain - 1) / kTouchingGrain);
  parallel_for(unjoined.size(), kTouchingGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [node, shell] = unjoined[i];
      for (const spatial::SurfacePoint& on : sheets.tree().within(model.position(node), max_reach))
        if (sheet_numbers[on.shell.value] != sheet_numbers[shell.value] &&
            on.distance <= sheet_reach(model, on.shell, Attachment::touching) && lie_flat(model, shell, on.shell))
          of_range[begin / kTouchingGrain].emplace_back(shell, on.shell);
    }
  });
  std::vector<JoinedSheets::Pair> pairs;
  for (const auto& some : of_range) pairs.insert(pairs.end(), some.begin(), some.end());
  return pairs;
}

}  // namespace prismesh::mesh::connections
