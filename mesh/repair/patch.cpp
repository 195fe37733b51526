#include "mesh/repair/patch.h"

#include <algorithm>
#include <utility>

#include "mesh/model/adjacency.h"
#include "mesh/model/features.h"

namespace prismesh::mesh::repair {

namespace {

constexpr std::uint8_t kUntouchable = kKeepsNodes | kIndivisible | kLasting | kNoTriangle;

/// Whether the shell has a node at two corners.
bool repeats_node(const ShellNodes& nodes) {
  for (int i = 0; i < nodes.corners(); ++i)
    for (int j = 0; j < i; ++j)
      if (nodes.node[static_cast<std::size_t>(i)] == nodes.node[static_cast<std::size_t>(j)]) return true;
  return false;
}

template <class T>
void insert_sorted(std::vector<T>& list, T value) {
  const auto place = std::lower_bound(list.begin(), list.end(), value);
  if (place == list.end() || *place != value) list.insert(place, value);
}

std::vector<LineEnd>::const_iterator place_of(const std::vector<LineEnd>& lines, LocalNode node) {
  return std::lower_bound(lines.begin(), lines.end(), node, [](const LineEnd& end, LocalNode n) { return end.node < n; });
}

void add_line(std::vector<LineEnd>& lines, const LineEnd& end) {
  const auto place = place_of(lines, end.node);
  if (place == lines.end() || place->node != end.node) lines.insert(place, end);
}

void remove_line(std::vector<LineEnd>& lines, LocalNode node) {
  const auto place = place_of(lines, node);
  if (place != lines.end() && place->node == node) lines.erase(place);
}

}  // namespace

Patch::Patch(const Model& model, const ShellSet& scope, int rings, const Rules& rules, double feature_angle)
    : model_(&model), rules_(&rules) {
  ShellSet shells = scope;
  std::erase_if(shells, [&](ShellIndex s) { return model.is_removed(s); });
  for (int ring = 0; ring < rings; ++ring) {
    NodeSet corners;
    for (const ShellIndex shell : shells)
      for (const NodeIndex node : model.shell(shell).node) corners.push_back(node);
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    shells.clear();
    for (const NodeIndex node : corners)
      for (const ShellIndex shell : model.adjacency->shells_of(node)) shells.push_back(shell);
    std::sort(shells.begin(), shells.end());
    shells.erase(std::unique(shells.begin(), shells.end()), shells.end());
  }
  NodeSet nodes;
  for (const ShellIndex shell : shells)
    for (const NodeIndex node : model.shell(shell).node) nodes.push_back(node);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  load_nodes(nodes, rules, feature_angle);
  load_shells(shells, rules);
  load_lines(feature_angle);
  node_saved_.assign(nodes_.size(), 0);
  node_place_.assign(nodes_.size(), 0);
  shell_saved_.assign(shells_.size(), 0);
}

void Patch::load_nodes(const NodeSet& nodes, const Rules& rules, double feature_angle) {
  model_nodes_ = nodes;
  nodes_.resize(nodes.size());
  const std::vector<relax::Freedom> freedoms = relax::node_freedoms(*model_, nodes, feature_angle);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    PatchNode& node = nodes_[i];
    node.position = model_->position(nodes[i]);
    node.model = nodes[i];
    node.freedom = freedoms[i];
    node.rules = rules.node ? rules.node(nodes[i]) : std::uint8_t{0};
    if (model_->node_holds[nodes[i].value] != 0) node.rules |= kStays | kNeeded;
    if (!node.position.allFinite()) node.is_whole = false;
  }
}

void Patch::load_shells(const ShellSet& shells, const Rules& rules) {
  model_shells_ = shells;
  shells_.resize(shells.size());
  for (std::size_t i = 0; i < shells.size(); ++i) {
    PatchShell& shell = shells_[i];
    const ShellNodes& nodes = model_->shell(shells[i]);
    for (std::size_t c = 0; c < 4; ++c) shell.corners[c] = find(nodes.node[c]);
    shell.model = shell.parent = shells[i];
    shell.part = model_->shell_parts[shells[i].value];
    if (shell.part.valid() && model_->parts) shell.properties = quality::properties_of(*model_, shells[i]);
    shell.rules = rules.shell ? rules.shell(shells[i]) : std::uint8_t{0};
    link(LocalShell(i));
    if (!repeats_node(nodes)) continue;
    shell.rules = kUntouchable;
    for (const LocalNode corner : shell.corners) nodes_[corner.value].is_whole = false;
  }
  for (PatchNode& node : nodes_)
    if (node.shells.size() != model_->adjacency->shells_of(node.model).size()) node.is_whole = false;
}

void Patch::load_lines(double feature_angle) {
  for (const PatchShell& shell : shells_) {
    const int corners = corner_count(shell.corners);
    for (int i = 0; i < corners; ++i) {
      const LocalNode a = shell.corners[static_cast<std::size_t>(i)];
      const LocalNode b = shell.corners[static_cast<std::size_t>((i + 1) % corners)];
      if (a == b || line(a, b) != nullptr) continue;
      const std::vector<LocalShell> here = shells_at(a, b);
      const EdgeIndex edge = model_->adjacency->find_edge(node(a).model, node(b).model);
      const std::size_t in_model = model_->adjacency->shells_of(edge).size();
      const auto [low, high] = std::minmax(node(a).model, node(b).model);
      const bool is_rim = in_model != here.size() || (!node(a).is_whole && !node(b).is_whole);
      const bool is_line = is_rim || in_model != 2 || this->shell(here[0]).part != this->shell(here[1]).part ||
                           classify_edge(*model_, edge, {low, high}, feature_angle) != EdgeKind::smooth;
      if (!is_line) continue;
      const auto shells = static_cast<std::uint8_t>(std::min<std::size_t>(here.size(), 255));
      add_line(nodes_[a.value].lines, {b, shells, is_rim});
      add_line(nodes_[b.value].lines, {a, shells, is_rim});
    }
  }
}

LocalNode Patch::find(NodeIndex node) const {
  const auto place = std::lower_bound(model_nodes_.begin(), model_nodes_.end(), node);
  if (place == model_nodes_.end() || *place != node) return {};
  return LocalNode(static_cast<std::size_t>(place - model_nodes_.begin()));
}

LocalShell Patch::find(ShellIndex shell) const {
  const auto place = std::lower_bound(model_shells_.begin(), model_shells_.end(), shell);
  if (place == model_shells_.end() || *place != shell) return {};
  return LocalShell(static_cast<std::size_t>(place - model_shells_.begin()));
}

const LineEnd* Patch::line(LocalNode a, LocalNode b) const {
  const std::vector<LineEnd>& lines = node(a).lines;
  const auto place = place_of(lines, b);
  return place == lines.end() || place->node != b ? nullptr : &*place;
}

std::vector<LocalShell> Patch::shells_at(LocalNode a, LocalNode b) const {
  std::vector<LocalShell> found;
  for (const LocalShell s : node(a).shells) {
    const Corners& corners = shell(s).corners;
    const int count = corner_count(corners);
    for (int i = 0; i < count; ++i) {
      const LocalNode c = corners[static_cast<std::size_t>(i)], d = corners[static_cast<std::size_t>((i + 1) % count)];
      if ((c != a || d != b) && (c != b || d != a)) continue;
      found.push_back(s);
      break;
    }
  }
  return found;
}

bool Patch::may_divide(LocalNode a, LocalNode b) const {
  const LineEnd* end = line(a, b);
  if (end != nullptr && end->is_rim) return false;
  if (!rules_->may_divide || !node(a).model.valid() || !node(b).model.valid()) return true;
  return rules_->may_divide(node(a).model, node(b).model);
}

bool Patch::may_exchange(LocalShell a, LocalShell b) const {
  const ShellIndex of_a = shell(a).parent, of_b = shell(b).parent;
  return of_a == of_b || !rules_->may_exchange || rules_->may_exchange(of_a, of_b);
}

PatchNode& Patch::own(LocalNode node) {
  if (node.value < nodes_at_begin_ && node_saved_[node.value] != change_) {
    node_saved_[node.value] = change_;
    node_place_[node.value] = static_cast<std::uint32_t>(old_nodes_.size());
    old_nodes_.emplace_back(node, nodes_[node.value]);
  }
  return nodes_[node.value];
}

PatchShell& Patch::own(LocalShell shell) {
  if (shell.value < shells_at_begin_ && shell_saved_[shell.value] != change_) {
    shell_saved_[shell.value] = change_;
    old_shells_.emplace_back(shell, shells_[shell.value]);
  }
  return shells_[shell.value];
}

void Patch::begin() {
  ++change_;
  old_nodes_.clear();
  old_shells_.clear();
  nodes_at_begin_ = nodes_.size();
  shells_at_begin_ = shells_.size();
  node_saved_.resize(nodes_.size(), 0);
  node_place_.resize(nodes_.size(), 0);
  shell_saved_.resize(shells_.size(), 0);
}

void Patch::keep() {
  old_nodes_.clear();
  old_shells_.clear();
  nodes_at_begin_ = nodes_.size();
  shells_at_begin_ = shells_.size();
}

void Patch::take_back() {
  for (auto& [node, was] : old_nodes_) nodes_[node.value] = std::move(was);
  for (const auto& [shell, was] : old_shells_) shells_[shell.value] = was;
  nodes_.resize(nodes_at_begin_);
  shells_.resize(shells_at_begin_);
  old_nodes_.clear();
  old_shells_.clear();
}

void Patch::link(LocalShell shell) {
  for (const LocalNode corner : shells_[shell.value].corners) insert_sorted(own(corner).shells, shell);
}

void Patch::unlink(LocalShell shell) {
  for (const LocalNode corner : shells_[shell.value].corners) std::erase(own(corner).shells, shell);
}

LocalNode Patch::add_node(const Vec3& position, std::span<const LocalNode> parents, std::span<const double> weights,
                          relax::Freedom freedom) {
  PatchNode node;
  node.position = position;
  node.freedom = freedom;
  for (std::size_t i = 0; i < parents.size() && i < 4; ++i) {
    node.parent[i] = parents[i];
    node.weight[i] = weights[i];
  }
  nodes_.push_back(std::move(node));
  return LocalNode(nodes_.size() - 1);
}

LocalShell Patch::add_shell(const Corners& corners, LocalShell like) {
  PatchShell shell = shells_[like.value];
  shell.model = ShellIndex();
  shell.corners = corners;
  shell.is_alive = true;
  shells_.push_back(shell);
  const LocalShell added(shells_.size() - 1);
  link(added);
  return added;
}

void Patch::set_corners(LocalShell shell, const Corners& corners) {
  own(shell);
  unlink(shell);
  shells_[shell.value].corners = corners;
  link(shell);
}

void Patch::remove_shell(LocalShell shell) {
  own(shell);
  unlink(shell);
  shells_[shell.value].is_alive = false;
}

void Patch::remove_node(LocalNode node) { own(node).is_alive = false; }

void Patch::move(LocalNode node, const Vec3& position, bool off_surface) {
  PatchNode& own_node = own(node);
  own_node.position = position;
  own_node.is_off_surface = off_surface;
  for (const LocalShell shell : own_node.shells) own(shell);
}

void Patch::set_judged(LocalShell shell, float composite, quality::ShellState state) {
  PatchShell& own_shell = own(shell);
  own_shell.composite = composite;
  own_shell.state = state;
}

void Patch::divide_line(LocalNode a, LocalNode b, LocalNode middle) {
  const LineEnd end = *line(a, b);
  remove_line(own(a).lines, b);
  remove_line(own(b).lines, a);
  add_line(own(a).lines, {middle, end.shells, end.is_rim});
  add_line(own(b).lines, {middle, end.shells, end.is_rim});
  add_line(own(middle).lines, {a, end.shells, end.is_rim});
  add_line(own(middle).lines, {b, end.shells, end.is_rim});
}

void Patch::join_lines(LocalNode a, LocalNode middle, LocalNode b) {
  const LineEnd end = *line(a, middle);
  remove_line(own(a).lines, middle);
  remove_line(own(b).lines, middle);
  remove_line(own(middle).lines, a);
  remove_line(own(middle).lines, b);
  add_line(own(a).lines, {b, end.shells, end.is_rim});
  add_line(own(b).lines, {a, end.shells, end.is_rim});
}

std::vector<LocalShell> Patch::changed_shells() const {
  std::vector<LocalShell> changed;
  for (const auto& [shell, was] : old_shells_)
    if (shells_[shell.value].is_alive) changed.push_back(shell);
  for (std::size_t s = shells_at_begin_; s < shells_.size(); ++s)
    if (shells_[s].is_alive) changed.push_back(LocalShell(s));
  return changed;
}

std::vector<LocalNode> Patch::changed_nodes() const {
  std::vector<LocalNode> changed;
  for (const auto& [node, was] : old_nodes_)
    if (nodes_[node.value].is_alive) changed.push_back(node);
  for (std::size_t n = nodes_at_begin_; n < nodes_.size(); ++n)
    if (nodes_[n].is_alive) changed.push_back(LocalNode(n));
  return changed;
}

const Vec3& Patch::old_position(LocalNode node) const {
  if (node.value < nodes_at_begin_ && node_saved_[node.value] == change_ && !old_nodes_.empty())
    return old_nodes_[node_place_[node.value]].second.position;
  return nodes_[node.value].position;
}

}  // namespace prismesh::mesh::repair
