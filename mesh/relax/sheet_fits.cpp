#include "mesh/relax/sheet_fits.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "mesh/relax/feature_lines.h"

namespace prismesh::mesh::relax {

namespace {

constexpr std::size_t kEnoughNodes = 8;  ///< about a node for a fit; at ends of sheets more rings are needed for them
constexpr int kMaxRings = 4;
constexpr std::size_t kUsualNodes = 32;  ///< about a node of an ordinary mesh: memory reserved
constexpr std::size_t kUsualShells = 24;
constexpr std::uint8_t kSmooth = 1;
constexpr std::uint8_t kKinked = 2;

int corner_of(const ShellNodes& shell, NodeIndex node) {
  for (int i = 0; i < shell.corners(); ++i)
    if (shell.node[i] == node) return i;
  return -1;
}

bool contains(const std::vector<ShellIndex>& shells, ShellIndex shell) {
  return std::find(shells.begin(), shells.end(), shell) != shells.end();
}

/// The shells at a node that are connected with `shell` over smooth edges at the node, ascending.
std::vector<ShellIndex> shells_about(const Model& model, const SheetFits& sheets, ShellIndex shell, NodeIndex node) {
  std::vector<ShellIndex> found;
  if (sheets.is_smooth(node)) {
    const auto all = model.adjacency->shells_of(node);
    found.assign(all.begin(), all.end());
    return found;
  }
  found.push_back(shell);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const ShellNodes& nodes = model.shell(found[i]);
    const int corners = nodes.corners(), at = corner_of(nodes, node);
    for (const int side : {at, previous_corner(at, corners)}) {
      const ShellIndex next = sheets.smooth_neighbour(found[i], nodes.node[side], nodes.node[next_corner(side, corners)]);
      if (next.valid() && !contains(found, next)) found.push_back(next);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// Adds the shells that share a smooth edge with one of the shells from `begin` on.
void add_ring(const Model& model, const SheetFits& sheets, std::size_t begin, std::vector<ShellIndex>& shells) {
  const std::size_t end = shells.size();
  for (std::size_t s = begin; s < end; ++s) {
    const ShellNodes& nodes = model.shell(shells[s]);
    const int corners = nodes.corners();
    for (int i = 0; i < corners; ++i) {
      const ShellIndex next = sheets.smooth_neighbour(shells[s], nodes.node[i], nodes.node[next_corner(i, corners)]);
      if (next.valid() && !contains(shells, next)) shells.push_back(next);
    }
  }
}

void add_nodes(const Model& model, const std::vector<ShellIndex>& shells, std::size_t begin, NodeIndex centre,
               std::vector<NodeIndex>& nodes) {
  for (std::size_t s = begin; s < shells.size(); ++s)
    for (const NodeIndex node : model.shell(shells[s]).node)
      if (node != centre && model.position(node).allFinite() && std::find(nodes.begin(), nodes.end(), node) == nodes.end())
        nodes.push_back(node);
}

Vec3 normal_about(const Model& model, const std::vector<ShellIndex>& shells) {
  Vec3 sum = Vec3::Zero();
  for (const ShellIndex shell : shells) {
    const Vec3 normal = shell_normal(model, model.shell(shell));
    sum += normal.dot(sum) < 0 ? Vec3(-normal) : normal;
  }
  return sum.squaredNorm() > 0 ? sum.normalized() : Vec3::UnitZ();
}

LocalFit fit_sheet(const Model& model, const SheetFits& sheets, NodeIndex node, std::vector<ShellIndex> shells) {
  const Vec3 normal = normal_about(model, shells);
  std::vector<NodeIndex> nodes;
  nodes.reserve(kUsualNodes);
  shells.reserve(kUsualShells);
  add_nodes(model, shells, 0, node, nodes);
  const std::size_t ring = nodes.size();
  std::size_t begin = 0;
  for (int i = 0; i < kMaxRings && (i == 0 || nodes.size() < kEnoughNodes); ++i) {
    const std::size_t end = shells.size();
    add_ring(model, sheets, begin, shells);
    add_nodes(model, shells, end, node, nodes);
    begin = end;
    if (shells.size() == end) break;
  }
  std::vector<Vec3> around(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) around[i] = model.position(nodes[i]);
  LocalFit fit = fit_about(model.position(node), normal, around, ring);
  fit.edge = mean_edge(model, node);
  return fit;
}

}  // namespace

SheetFits::SheetFits(const Model& model, double cos_limit)
    : model_(model),
      cos_limit_(cos_limit),
      slots_(zeroed<Slot>(4 * model.shell_count())),
      node_states_(zeroed<std::atomic<std::uint8_t>>(model.node_count())) {}

bool SheetFits::is_smooth(NodeIndex node) const {
  std::atomic<std::uint8_t>& state = node_states_[node.value];
  std::uint8_t known = state.load(std::memory_order_relaxed);
  if (known == 0) {
    known = line_ends(model_, node, cos_limit_, false).count == 0 ? kSmooth : kKinked;
    state.store(known, std::memory_order_relaxed);
  }
  return known == kSmooth;
}

ShellIndex SheetFits::smooth_neighbour(ShellIndex shell, NodeIndex a, NodeIndex b) const {
  if (a == b) return {};
  if (!is_smooth(a) && !is_smooth(b)) return relax::smooth_neighbour(model_, shell, a, b, cos_limit_);
  for (const ShellIndex other : model_.adjacency->shells_of(a))
    if (other != shell && has_edge(model_.shell(other), a, b)) return other;
  return {};
}

const LocalFit& SheetFits::at(ShellIndex shell, int corner) const {
  const LocalFit* fit =
      slots_[4 * static_cast<std::size_t>(shell.value) + static_cast<std::size_t>(corner)].load(std::memory_order_acquire);
  return fit != nullptr ? *fit : make(shell, corner);
}

const LocalFit& SheetFits::make(ShellIndex shell, int corner) const {
  const NodeIndex node = model_.shell(shell).node[corner];
  const std::vector<ShellIndex> shells = shells_about(model_, *this, shell, node);
  const LocalFit made = fit_sheet(model_, *this, node, shells);
  const auto slot_of = [&](ShellIndex of, int at) -> Slot& {
    return slots_[4 * static_cast<std::size_t>(of.value) + static_cast<std::size_t>(at)];
  };
  const std::lock_guard lock(mutex_);
  Slot& own = slot_of(shell, corner);
  if (const LocalFit* other = own.load(std::memory_order_relaxed)) return *other;
  const LocalFit* kept = &fits_.emplace_back(made);
  own.store(kept, std::memory_order_release);
  for (const ShellIndex of : shells)
    if (const int at = corner_of(model_.shell(of), node); at >= 0) slot_of(of, at).store(kept, std::memory_order_release);
  return *kept;
}

double mean_edge(const Model& model, NodeIndex node) {
  double sum = 0;
  int count = 0;
  for (const ShellIndex shell : model.adjacency->shells_of(node)) {
    const ShellNodes& nodes = model.shell(shell);
    const int corners = nodes.corners();
    for (int i = 0; i < corners; ++i) {
      const double length = (model.position(nodes.node[next_corner(i, corners)]) - model.position(nodes.node[i])).norm();
      if (!(length > 0 && std::isfinite(length))) continue;
      sum += length;
      ++count;
    }
  }
  return count > 0 ? sum / count : 0;
}

Vec3 shell_normal(const Model& model, const ShellNodes& shell) {
  const auto at = [&](int i) -> const Vec3& { return model.position(shell.node[i]); };
  const Vec3 normal = shell.is_triangle() ? Vec3((at(1) - at(0)).cross(at(2) - at(0))) : Vec3((at(2) - at(0)).cross(at(3) - at(1)));
  const double length = normal.norm();
  return length > 0 ? Vec3(normal / length) : Vec3::Zero();
}

}  // namespace prismesh::mesh::relax
