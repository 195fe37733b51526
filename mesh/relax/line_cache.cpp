#include "mesh/relax/line_cache.h"

#include <algorithm>

namespace prismesh::mesh::relax {

namespace {

bool has_end(const LineEnds& ends, NodeIndex other) {
  const auto last = ends.other.begin() + static_cast<std::ptrdiff_t>(ends.count);
  return std::find(ends.other.begin(), last, other) != last;
}

}  // namespace

LineCache::LineCache(const Model& model, double cos_limit)
    : model_(model), cos_limit_(cos_limit), known_(zeroed<std::atomic<const NodeLines*>>(model.node_count())) {}

const NodeLines& LineCache::at(NodeIndex node) const {
  const NodeLines* known = known_[node.value].load(std::memory_order_acquire);
  return known != nullptr ? *known : make(node);
}

const NodeLines& LineCache::make(NodeIndex node) const {
  NodeLines made{line_ends(model_, node, cos_limit_, true), false};
  made.pass_through = passes_through(model_, node, made.ends, cos_limit_);
  const std::lock_guard lock(mutex_);
  std::atomic<const NodeLines*>& known = known_[node.value];
  if (const NodeLines* other = known.load(std::memory_order_relaxed)) return *other;
  const NodeLines* kept = &made_.emplace_back(made);
  known.store(kept, std::memory_order_release);
  return *kept;
}

bool LineCache::is_feature(ShellIndex shell, NodeIndex a, NodeIndex b) const {
  // Of a node with many feature edges only the first are known.
  if (const LineEnds& ends = at(a).ends; ends.count < LineEnds::kMax) return has_end(ends, b);
  if (const LineEnds& ends = at(b).ends; ends.count < LineEnds::kMax) return has_end(ends, a);
  const ShellIndex beyond = smooth_neighbour(model_, shell, a, b, cos_limit_);
  return !beyond.valid() || model_.shell_parts[beyond.value] != model_.shell_parts[shell.value];
}

}  // namespace prismesh::mesh::relax
