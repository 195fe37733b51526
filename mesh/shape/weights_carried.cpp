#include "mesh/shape/weights_carried.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>

#include "base/parallel_for.h"
#include "mesh/model/adjacency.h"
#include "mesh/spatial/closest_point.h"

namespace prismesh::mesh::shape {

namespace {

constexpr std::size_t kCarryGrain = 256;

class Carrying {
 public:
  Carrying(const Model& model, const spatial::Patch& patch, std::vector<std::uint8_t>& reached, std::vector<double>& weight)
      : model_(model), patch_(patch), reached_(reached), weight_(weight) {
    find_pieces();
  }

  void run() {
    std::vector<std::uint32_t> source;
    for (std::uint32_t i = 0; i < reached_.size(); ++i)
      if (reached_[i] != 0) source.push_back(i);
    while (!source.empty() && !waiting_.empty()) {
      const ShellSet shells = shells_at(source);
      trees_.emplace_back(model_, shells);
      mark_near(max_reach(shells));
      source = carry_near_pieces();
    }
  }

 private:
  /// Numbers the connected pieces among the nodes without a weight; a node without a shell is a piece by itself.
  void find_pieces() {
    piece_.assign(reached_.size(), 0);
    for (std::uint32_t first = 0; first < reached_.size(); ++first) {
      if (reached_[first] != 0 || piece_[first] != 0) continue;
      ++pieces_;
      std::vector<std::uint32_t> open{first};
      piece_[first] = pieces_;
      while (!open.empty()) {
        const std::uint32_t node = open.back();
        open.pop_back();
        waiting_.push_back(node);
        for (std::uint32_t k = patch_.node_first[node]; k < patch_.node_first[node + 1]; ++k)
          for (const std::uint32_t next : patch_.shells[patch_.node_shells[k]])
            if (piece_[next] == 0 && reached_[next] == 0) {
              piece_[next] = pieces_;
              open.push_back(next);
            }
      }
    }
    std::sort(waiting_.begin(), waiting_.end());
    near_.assign(reached_.size(), 0);
    last_.resize(reached_.size());
  }

  ShellSet shells_at(const std::vector<std::uint32_t>& nodes) const {
    ShellSet shells;
    for (const std::uint32_t node : nodes)
      for (const ShellIndex shell : model_.adjacency->shells_of(patch_.nodes[node]))
        if (!model_.is_removed(shell)) shells.push_back(shell);
    std::sort(shells.begin(), shells.end());
    shells.erase(std::unique(shells.begin(), shells.end()), shells.end());
    return shells;
  }

  double max_reach(const ShellSet& shells) const {
    double reach = 0;
    for (const ShellIndex shell : shells) reach = std::max(reach, reach_of(shell));
    return reach;
  }

  /// Marks the waiting nodes that are near the surface of the last round.
  void mark_near(double radius) {
    parallel_for(waiting_.size(), kCarryGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        auto& found = last_[waiting_[i]];
        found = trees_.back().closest(patch_.positions[waiting_[i]], radius);
        near_[waiting_[i]] = found && found->distance <= reach_of(found->shell) ? 1 : 0;
      }
    });
  }

  double reach_of(ShellIndex index) const {
    const ShellNodes& shell = model_.shell(index);
    const int corners = shell.corners();
    double around = 0;
    for (int i = 0; i < corners; ++i) around += (model_.position(shell.node[(i + 1) % corners]) - model_.position(shell.node[i])).norm();
    return kWeldReach * around / corners;
  }

  double weight_at(const spatial::SurfacePoint& at) const {
    const ShellNodes& shell = model_.shell(at.shell);
    double weight = 0;
    for (int i = 0; i < shell.corners(); ++i) {
      const auto node = std::lower_bound(patch_.nodes.begin(), patch_.nodes.end(), shell.node[i]);
      if (node != patch_.nodes.end() && *node == shell.node[i])
        weight += at.share[i] * weight_[static_cast<std::size_t>(node - patch_.nodes.begin())];
    }
    return std::clamp(weight, 0.0, 1.0);
  }

  /// The weight at the closest point of the surfaces of all rounds so far.
  double carried_weight(std::uint32_t node) const {
    std::optional<spatial::SurfacePoint> closest = last_[node];
    const std::size_t unasked = closest ? trees_.size() - 1 : trees_.size();
    for (const spatial::ShellTree& tree : std::span(trees_).first(unasked)) {
      const auto found = tree.closest(patch_.positions[node], closest ? closest->distance : std::numeric_limits<double>::infinity());
      if (found && (!closest || found->distance < closest->distance)) closest = found;
    }
    return closest ? weight_at(*closest) : 0.0;
  }

  /// Gives the pieces that are near their weights, and returns their nodes.
  std::vector<std::uint32_t> carry_near_pieces() {
    std::vector<std::uint8_t> near(pieces_ + std::size_t{1}, 0);
    for (const std::uint32_t node : waiting_)
      if (near_[node] != 0) near[piece_[node]] = 1;
    std::vector<std::uint32_t> carried;
    for (const std::uint32_t node : waiting_)
      if (near[piece_[node]] != 0 && patch_.positions[node].allFinite()) carried.push_back(node);
    std::erase_if(waiting_, [&](std::uint32_t node) { return near[piece_[node]] != 0; });
    std::vector<double> weights(carried.size());
    parallel_for(carried.size(), kCarryGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) weights[i] = carried_weight(carried[i]);
    });
    for (std::size_t i = 0; i < carried.size(); ++i) {
      reached_[carried[i]] = 1;
      weight_[carried[i]] = weights[i];
    }
    return carried;
  }

  const Model& model_;
  const spatial::Patch& patch_;
  std::vector<std::uint8_t>& reached_;
  std::vector<double>& weight_;
  std::uint32_t pieces_ = 0;
  std::vector<std::uint32_t> piece_;                        ///< of each node, from 1; 0: connected to the grab
  std::vector<std::uint32_t> waiting_;                      ///< nodes without a weight yet, ascending
  std::vector<std::uint8_t> near_;                          ///< of each node
  std::vector<std::optional<spatial::SurfacePoint>> last_;  ///< of each node: the closest point in the last tree, if near enough
  std::vector<spatial::ShellTree> trees_;                   ///< one for each round: the shells whose nodes got weights
};

}  // namespace

void carry_across_welds(const Model& model, const spatial::Patch& patch, std::vector<std::uint8_t>& reached, std::vector<double>& weight) {
  Carrying(model, patch, reached, weight).run();
}

}  // namespace prismesh::mesh::shape
