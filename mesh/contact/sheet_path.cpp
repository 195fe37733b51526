#include "mesh/contact/sheet_path.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <queue>
#include <unordered_map>
#include <utility>

#include "mesh/model/adjacency.h"

namespace prismesh::mesh::contact {

namespace {

/// Shortest paths by Dijkstra's method.
class SheetPaths {
 public:
  SheetPaths(const Model& model, std::span<const PathWish> wishes) : model_(model), wishes_(wishes), reached_(wishes.size(), 0) {
    for (const PathWish& wish : wishes) max_length_ = std::max(max_length_, wish.max_length);
  }

  std::vector<std::uint8_t> from(ShellIndex shell) {
    for (const NodeIndex node : model_.shell(shell).node) reach(node, 0);
    std::size_t left = wishes_.size();
    while (!waiting_.empty() && left > 0) {
      const auto [length, node] = waiting_.top();
      waiting_.pop();
      if (length == length_.at(node.value)) left -= visit(node, length);
    }
    return std::move(reached_);
  }

 private:
  /// Returns how many wishes it fulfils. A corner of a shell is linked to all its other corners.
  std::size_t visit(NodeIndex node, double length) {
    const Vec3& at = model_.position(node);
    std::size_t fulfilled = 0;
    for (const ShellIndex shell : model_.adjacency->shells_of(node)) {
      const auto wish =
          std::lower_bound(wishes_.begin(), wishes_.end(), shell, [](const PathWish& x, ShellIndex wanted) { return x.shell < wanted; });
      if (wish != wishes_.end() && wish->shell == shell && length <= wish->max_length) {
        std::uint8_t& reached = reached_[static_cast<std::size_t>(wish - wishes_.begin())];
        if (reached == 0) reached = 1, ++fulfilled;
      }
      for (const NodeIndex to : model_.shell(shell).node)
        if (to != node) reach(to, length + (model_.position(to) - at).norm());
    }
    return fulfilled;
  }

  void reach(NodeIndex node, double length) {
    if (!(length <= max_length_)) return;
    const auto [at, is_new] = length_.try_emplace(node.value, length);
    if (!is_new && !(length < at->second)) return;
    at->second = length;
    waiting_.emplace(length, node);
  }

  using Waiting = std::pair<double, NodeIndex>;  ///< with its length

  const Model& model_;
  std::span<const PathWish> wishes_;
  std::vector<std::uint8_t> reached_;
  double max_length_ = 0;
  std::unordered_map<std::uint32_t, double> length_;
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> waiting_;
};

}  // namespace

std::vector<std::uint8_t> reached_over_sheet(const Model& model, ShellIndex from, std::span<const PathWish> wishes) {
  return SheetPaths(model, wishes).from(from);
}

}  // namespace prismesh::mesh::contact
