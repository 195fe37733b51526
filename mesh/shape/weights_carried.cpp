#include "mesh/shape/weights_carried.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "base/parallel_for.h"
#include "mesh/connections/sheet_reach.h"
#include "mesh/model/adjacency.h"
#include "mesh/spatial/closest_point.h"

namespace prismesh::mesh::shape {

namespace {

constexpr std::size_t kCarryGrain = 256;

constexpr std::uint32_t kNoSheet = std::numeric_limits<std::uint32_t>::max();

/// A part of one sheet whose nodes have weights.
struct Surface {
  std::uint32_t sheet = kNoSheet;
  double reach = 0;  ///< the max of those of its shells
  spatial::ShellTree tree;
};

class Carrying {
 public:
  Carrying(const Model& model, const spatial::Patch& patch, const connections::JoinedSheets& joined, std::vector<std::uint8_t>& reached,
           std::vector<double>& weight)
      : model_(model), patch_(patch), joined_(joined), reached_(reached), weight_(weight) {
    find_pieces();
  }

  void run() {
    std::vector<std::uint32_t> source;
    for (std::uint32_t i = 0; i < reached_.size(); ++i)
      if (reached_[i] != 0) source.push_back(i);
    while (!source.empty() && !waiting_.empty()) {
      first_of_round_ = surfaces_.size();
      add_surfaces(source);
      mark_near();
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

  /// Adds the surfaces at these nodes, one for each sheet.
  void add_surfaces(const std::vector<std::uint32_t>& nodes) {
    std::vector<std::pair<std::uint32_t, ShellIndex>> shells;
    for (const std::uint32_t node : nodes)
      for (const ShellIndex shell : model_.adjacency->shells_of(patch_.nodes[node]))
        if (!model_.is_removed(shell)) shells.emplace_back(joined_.sheet_of(shell), shell);
    std::sort(shells.begin(), shells.end());
    shells.erase(std::unique(shells.begin(), shells.end()), shells.end());
    for (std::size_t at = 0; at < shells.size();) {
      const std::uint32_t sheet = shells[at].first;
      ShellSet of_sheet;
      double reach = 0;
      for (; at < shells.size() && shells[at].first == sheet; ++at) {
        of_sheet.push_back(shells[at].second);
        reach = std::max(reach, connections::max_joint_length(model_, shells[at].second));
      }
      surfaces_.push_back({sheet, reach, spatial::ShellTree(model_, of_sheet)});
    }
  }

  std::uint32_t sheet_of(std::uint32_t node) const {
    for (const ShellIndex shell : model_.adjacency->shells_of(patch_.nodes[node]))
      if (!model_.is_removed(shell)) return joined_.sheet_of(shell);
    return kNoSheet;
  }

  /// The closest point of those of the surfaces from which weights may be carried to the node, unless `closest` is closer. Within reach: no
  /// farther than the surface's reach.
  std::optional<spatial::SurfacePoint> closest_on(std::span<const Surface> surfaces, std::uint32_t node, bool within_reach,
                                                  std::optional<spatial::SurfacePoint> closest) const {
    const std::uint32_t sheet = sheet_of(node);
    for (const Surface& surface : surfaces) {
      if (sheet != kNoSheet && !joined_.joined(sheet, surface.sheet)) continue;
      double radius = closest ? closest->distance : std::numeric_limits<double>::infinity();
      if (within_reach) radius = std::min(radius, surface.reach);
      const auto found = surface.tree.closest(patch_.positions[node], radius);
      if (found && (!closest || found->distance < closest->distance)) closest = found;
    }
    return closest;
  }

  /// Marks the waiting nodes that are near the surfaces of the last round.
  void mark_near() {
    const std::span<const Surface> of_round = std::span(surfaces_).subspan(first_of_round_);
    parallel_for(waiting_.size(), kCarryGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        auto& found = last_[waiting_[i]];
        found = closest_on(of_round, waiting_[i], true, std::nullopt);
        near_[waiting_[i]] = found && found->distance <= connections::max_joint_length(model_, found->shell) ? 1 : 0;
      }
    });
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
    const std::size_t unasked = last_[node] ? first_of_round_ : surfaces_.size();
    const auto closest = closest_on(std::span(surfaces_).first(unasked), node, false, last_[node]);
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
  const connections::JoinedSheets& joined_;
  std::vector<std::uint8_t>& reached_;
  std::vector<double>& weight_;
  std::uint32_t pieces_ = 0;
  std::vector<std::uint32_t> piece_;    ///< of each node, from 1; 0: connected to the grab
  std::vector<std::uint32_t> waiting_;  ///< nodes without a weight yet, ascending
  std::vector<std::uint8_t> near_;      ///< of each node
  std::vector<std::optional<spatial::SurfacePoint>>
      last_;                        ///< of each node: the closest point on surfaces of the last round, if near enough
  std::vector<Surface> surfaces_;   ///< round by round: the shells whose nodes got weights
  std::size_t first_of_round_ = 0;  ///< in surfaces_, of the last round
};

}  // namespace

void carry_across_welds(const Model& model, const spatial::Patch& patch, const connections::JoinedSheets& joined,
                        std::vector<std::uint8_t>& reached, std::vector<double>& weight) {
  Carrying(model, patch, joined, reached, weight).run();
}

}  // namespace prismesh::mesh::shape
