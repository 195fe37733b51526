#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>

#include "base/parallel_for.h"
#include "mesh/lod/levels.h"
#include "mesh/lod/simplify.h"
#include "mesh/lod/sphere_maker.h"
#include "mesh/spatial/curve_order.h"

namespace prismesh::mesh::lod {

namespace {

constexpr std::size_t kShellsOfCluster = 64;
constexpr std::size_t kShellsSplitAtOnce = 64 * kShellsOfCluster;
constexpr std::size_t kTrianglesOfCluster = 128;
constexpr std::size_t kClustersOfGroup = 8;
/// Below this share of its triangles a group is worth to be shown instead of its clusters.
constexpr double kWorthwhile = 0.8;
constexpr std::size_t kFewest = 4;  ///< clusters that are left as they are
constexpr int kMostRounds = 40;
/// How much more than others a common node of two clusters counts that were made by different groups: it was locked in the last round.
constexpr std::uint32_t kWeightOfLocked = 3;
constexpr std::size_t kGroupsAtOnce = 16;
constexpr std::uint32_t kNobody = 0xffffffffu;

Vec3 mean_of(const Model& model, std::span<const NodeIndex> nodes) {
  Vec3 sum = Vec3::Zero();
  for (const NodeIndex node : nodes) sum += model.position(node);
  return sum / static_cast<double>(nodes.size());
}

/// Orders the points so that each run of `run` of them is compact: halves along the longest side of their box, again and again.
void order_by_halves(std::span<const Vec3> points, std::span<std::uint32_t> order, std::size_t run) {
  if (order.size() <= run) return;
  Vec3 low = points[order[0]], high = low;
  for (const std::uint32_t i : order) {
    low = low.cwiseMin(points[i]);
    high = high.cwiseMax(points[i]);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const std::size_t half = (order.size() / run + 1) / 2 * run;
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(half), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return points[a][axis] != points[b][axis] ? points[a][axis] < points[b][axis] : a < b;
  });
  order_by_halves(points, order.first(half), run);
  order_by_halves(points, order.subspan(half), run);
}

bool can_be_drawn(const Model& model, ShellIndex shell) {
  if (model.is_removed(shell)) return false;
  const ShellNodes& nodes = model.shell(shell);
  return std::all_of(nodes.node.begin(), nodes.node.end(), [&](NodeIndex node) { return model.position(node).allFinite(); });
}

/// What one group was simplified to; nothing: not worth it.
struct Made {
  std::vector<CoarseTriangle> triangles;  ///< cluster by cluster
  std::vector<Cluster> clusters;          ///< `first` counts from the group's first triangle
  double error = 0;
};

class Builder {
 public:
  Builder(const Model& model, const Progress& progress) : model_(model), progress_(progress) {}

  Result<Levels> build() {
    make_shell_clusters();
    std::vector<std::uint32_t> shown(levels_.clusters.size());  // together they stand for each shell once
    for (std::size_t c = 0; c < shown.size(); ++c) shown[c] = static_cast<std::uint32_t>(c);
    const double all = static_cast<double>(std::max<std::size_t>(shown.size(), 1));
    for (int round = 0; round < kMostRounds && shown.size() > kFewest; ++round) {
      if (progress_ && !progress_(1 - static_cast<double>(shown.size()) / all)) return fail(cancelled());
      if (!coarsen(shown)) break;
    }
    if (progress_ && !progress_(1)) return fail(cancelled());
    return std::move(levels_);
  }

 private:
  void make_shell_clusters() {
    std::vector<Vec3> middles(model_.shell_count());
    parallel_for(middles.size(), 16384, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s)
        middles[s] = can_be_drawn(model_, ShellIndex(s)) ? mean_of(model_, model_.shell(ShellIndex(s)).node)
                                                         : Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    });
    std::vector<std::uint32_t> order = spatial::along_curve(middles);
    parallel_for(order.size(), kShellsSplitAtOnce, [&](std::size_t begin, std::size_t end) {
      for (std::size_t at = begin; at < end; at += kShellsSplitAtOnce)
        order_by_halves(middles, std::span(order).subspan(at, std::min(kShellsSplitAtOnce, end - at)), kShellsOfCluster);
    });
    for (const std::uint32_t s : order) levels_.shells.emplace_back(s);
    for (std::size_t first = 0; first < levels_.shells.size(); first += kShellsOfCluster) {
      Cluster cluster;
      cluster.first = static_cast<std::uint32_t>(first);
      cluster.count = static_cast<std::uint32_t>(std::min(kShellsOfCluster, levels_.shells.size() - first));
      levels_.clusters.push_back(cluster);
    }
    levels_.shell_clusters = levels_.clusters.size();
    parallel_for(levels_.clusters.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c) levels_.clusters[c].bounds = bounds_of_shells(model_, levels_, levels_.clusters[c]);
    });
    owner_.resize(model_.node_count());
    locked_.resize(model_.node_count());
  }

  void append_triangles(std::uint32_t index, std::vector<CoarseTriangle>& triangles) const {
    const Cluster& cluster = levels_.clusters[index];
    if (index >= levels_.shell_clusters) {
      const auto first = levels_.triangles.begin() + cluster.first;
      triangles.insert(triangles.end(), first, first + cluster.count);
      return;
    }
    for (std::uint32_t i = 0; i < cluster.count; ++i) {
      const ShellIndex shell = levels_.shells[cluster.first + i];
      const ShellNodes& nodes = model_.shell(shell);
      triangles.push_back({{nodes.node[0], nodes.node[1], nodes.node[2]}, shell});
      if (!nodes.is_triangle()) triangles.push_back({{nodes.node[2], nodes.node[3], nodes.node[0]}, shell});
    }
  }

  /// Which of the shown clusters have a node in common, and how many.
  void find_neighbours(const std::vector<std::uint32_t>& shown) {
    std::fill(owner_.begin(), owner_.end(), kNobody);
    common_.clear();
    std::vector<CoarseTriangle> triangles;
    for (const std::uint32_t c : shown) {
      triangles.clear();
      append_triangles(c, triangles);
      for (const CoarseTriangle& triangle : triangles)
        for (const NodeIndex node : triangle.node) {
          std::uint32_t& owner = owner_[node.value];
          if (owner == kNobody) owner = c;
          if (owner != c && (common_.empty() || common_.back().node != node || common_.back().cluster != c)) common_.push_back({node, c});
        }
    }
  }

  /// Puts neighbours together that have much in common, so that few nodes are shared between groups.
  std::vector<std::vector<std::uint32_t>> group(const std::vector<std::uint32_t>& shown) {
    std::vector<std::unordered_map<std::uint32_t, std::uint32_t>> weights(levels_.clusters.size());
    for (const Common& each : common_) {
      const std::uint32_t a = owner_[each.node.value], b = each.cluster;
      const std::uint32_t weight = levels_.clusters[a].made_by == levels_.clusters[b].made_by ? 1 : kWeightOfLocked;
      weights[a][b] += weight;
      weights[b][a] += weight;
    }
    group_of_.assign(levels_.clusters.size(), kNobody);
    std::vector<std::vector<std::uint32_t>> groups;
    for (const std::uint32_t seed : shown) {
      if (group_of_[seed] != kNobody) continue;
      const auto number = static_cast<std::uint32_t>(groups.size());
      groups.emplace_back();
      std::map<std::uint32_t, std::uint32_t> near;  // ordered: equals are decided by the number
      std::uint32_t next = seed;
      while (next != kNobody) {
        groups.back().push_back(next);
        group_of_[next] = number;
        near.erase(next);
        for (const auto& [other, weight] : weights[next])
          if (group_of_[other] == kNobody) near[other] += weight;
        next = kNobody;
        if (groups.back().size() == kClustersOfGroup || near.empty()) break;
        next = std::max_element(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.second < b.second; })->first;
      }
    }
    return groups;
  }

  void find_locked() {
    std::fill(locked_.begin(), locked_.end(), std::uint8_t{0});
    for (const Common& each : common_)
      if (group_of_[owner_[each.node.value]] != group_of_[each.cluster]) locked_[each.node.value] = 1;
  }

  std::optional<Made> make(const std::vector<std::uint32_t>& clusters) const {
    std::vector<CoarseTriangle> triangles;
    for (const std::uint32_t c : clusters) append_triangles(c, triangles);
    const auto is_locked = [&](NodeIndex node) { return locked_[node.value] != 0; };
    Simplified simplified = simplify(model_, triangles, is_locked, triangles.size() / 2);
    if (static_cast<double>(simplified.triangles.size()) > kWorthwhile * static_cast<double>(triangles.size())) return std::nullopt;
    Made made;
    made.error = simplified.error;
    std::vector<Vec3> middles;
    for (const CoarseTriangle& triangle : simplified.triangles) middles.push_back(mean_of(model_, triangle.node));
    std::vector<std::uint32_t> order(middles.size());
    std::iota(order.begin(), order.end(), 0U);
    order_by_halves(middles, order, kTrianglesOfCluster);
    for (const std::uint32_t t : order) made.triangles.push_back(simplified.triangles[t]);
    for (std::size_t first = 0; first < made.triangles.size(); first += kTrianglesOfCluster) {
      Cluster cluster;
      cluster.first = static_cast<std::uint32_t>(first);
      cluster.count = static_cast<std::uint32_t>(std::min(kTrianglesOfCluster, made.triangles.size() - first));
      SphereMaker maker;
      for (std::uint32_t i = 0; i < cluster.count; ++i)
        for (const NodeIndex node : made.triangles[first + i].node) maker.add(model_.position(node));
      cluster.bounds = maker.sphere();
      made.clusters.push_back(cluster);
    }
    return made;
  }

  double mean_side(const Cluster& cluster) const {
    double sum = 0;
    std::size_t sides = 0;
    for (std::uint32_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
      const ShellNodes& nodes = model_.shell(levels_.shells[i]);
      for (std::size_t k = 0; k < 4; ++k)
        if (nodes.node[k] != nodes.node[(k + 1) % 4]) {
          sum += (model_.position(nodes.node[k]) - model_.position(nodes.node[(k + 1) % 4])).norm();
          ++sides;
        }
    }
    return sides > 0 ? sum / static_cast<double>(sides) : 0;
  }

  /// Takes over what a group was simplified to. Its sphere and error hold those of the groups inside it.
  void take(const std::vector<std::uint32_t>& inside, const Made& made, std::vector<std::uint32_t>& next) {
    Group group;
    std::vector<Sphere> spheres;
    double before = 0;
    for (const std::uint32_t c : inside) {
      Cluster& cluster = levels_.clusters[c];
      cluster.replaced_by = static_cast<std::uint32_t>(levels_.groups.size());
      spheres.push_back(cluster.bounds);
      if (cluster.made_by == kNoGroup) {
        group.side = std::max(group.side, mean_side(cluster));
        continue;
      }
      group.side = std::max(group.side, levels_.groups[cluster.made_by].side);
      spheres.push_back(levels_.groups[cluster.made_by].sphere);
      before = std::max(before, levels_.groups[cluster.made_by].error);
    }
    group.error = std::hypot(before, made.error);
    group.sphere = around(spheres);
    group.first_cluster = static_cast<std::uint32_t>(levels_.clusters.size());
    group.clusters = static_cast<std::uint32_t>(made.clusters.size());
    for (Cluster cluster : made.clusters) {
      cluster.first += static_cast<std::uint32_t>(levels_.triangles.size());
      cluster.made_by = static_cast<std::uint32_t>(levels_.groups.size());
      next.push_back(static_cast<std::uint32_t>(levels_.clusters.size()));
      levels_.clusters.push_back(cluster);
    }
    levels_.triangles.insert(levels_.triangles.end(), made.triangles.begin(), made.triangles.end());
    levels_.groups.push_back(group);
  }

  /// Replaces what is shown by about half as many clusters. Returns false if nothing could be replaced.
  bool coarsen(std::vector<std::uint32_t>& shown) {
    find_neighbours(shown);
    const std::vector<std::vector<std::uint32_t>> groups = group(shown);
    find_locked();
    std::vector<std::optional<Made>> made(groups.size());
    parallel_for(groups.size(), kGroupsAtOnce, [&](std::size_t begin, std::size_t end) {
      for (std::size_t g = begin; g < end; ++g) made[g] = make(groups[g]);
    });
    std::vector<std::uint32_t> next;
    bool any = false;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      any = any || made[g].has_value();
      if (made[g])
        take(groups[g], *made[g], next);
      else
        next.insert(next.end(), groups[g].begin(), groups[g].end());
    }
    shown = std::move(next);
    return any;
  }

  const Model& model_;
  const Progress& progress_;
  Levels levels_;
  /// A node that a cluster has in common with the node's owner.
  struct Common {
    NodeIndex node;
    std::uint32_t cluster = 0;
  };
  std::vector<std::uint32_t> owner_;  ///< by node: the first of the shown clusters that has it
  std::vector<Common> common_;
  std::vector<std::uint32_t> group_of_;  ///< by cluster, in this round
  std::vector<std::uint8_t> locked_;     ///< by node: groups share it
};

}  // namespace

Result<Levels> build_levels(const Model& model, const Progress& progress) { return Builder(model, progress).build(); }

}  // namespace prismesh::mesh::lod
