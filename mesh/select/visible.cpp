// Method: first an item buffer, a coarse picture with the number of the front shell in each square. Nearly every hidden node is hidden by
// the shell at its square, which an exact test of this one shell proves. The other nodes are tested against every shell whose box covers
// them. The item buffer only chooses the first test: its errors cost time, not correctness.
#include "mesh/select/visible.h"

#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include "base/parallel_for.h"
#include "mesh/model/adjacency.h"
#include "mesh/select/visible_scene.h"

namespace prismesh::mesh::select {

namespace {

constexpr std::size_t kShellGrain = 8192;
constexpr std::size_t kNodeGrain = 8192;

/// Squares over the box of the nodes in the picture.
class Squares {
 public:
  Squares(const Scene& scene, std::size_t side) : side_(side), low_(scene.low()) {
    for (int axis = 0; axis < 2; ++axis) {
      const double extent = scene.high()[axis] - scene.low()[axis];
      scale_[axis] = extent > 0 ? static_cast<double>(side) / extent : 0;
    }
  }
  std::size_t side() const { return side_; }
  std::size_t count() const { return side_ * side_; }
  /// The coordinate in squares, not rounded.
  double place(const Seen& at, int axis) const { return (at[axis] - low_[axis]) * scale_[axis]; }
  std::size_t along(const Seen& at, int axis) const { return within(place(at, axis)); }
  std::size_t within(double place) const {
    return place > 0 ? static_cast<std::size_t>(std::min(place, static_cast<double>(side_ - 1))) : 0;
  }
  std::size_t of(const Seen& at) const { return along(at, 1) * side_ + along(at, 0); }

 private:
  std::size_t side_;
  Seen low_;
  std::array<double, 2> scale_{};
};

/// For each square the shell that is nearest at its centre, if there is one.
class ItemBuffer {
 public:
  ItemBuffer(const Scene& scene, std::size_t side) : squares_(scene, side), items_(new std::atomic<std::uint64_t>[squares_.count()]) {
    parallel_for(squares_.count(), std::size_t{1} << 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) items_[i].store(kEmpty, std::memory_order_relaxed);
    });
  }
  /// A shell of a few squares is drawn as its box; an exact test follows where it matters.
  void draw(const SeenShell& shell) {
    const Area area = area_of(shell.low, shell.high);
    if (area.squares() == 0) return;
    if (area.squares() <= 4) {
      const double z = 0.5 * (shell.low.z() + shell.high.z());
      each_square(area, [&](std::size_t square, std::size_t, std::size_t) { put(square, z, shell.shell); });
    } else {
      for (std::size_t t = 0; t < shell.triangles; ++t)
        draw(shell.shell, shell.point[shell.triangle[t][0]], shell.point[shell.triangle[t][1]], shell.point[shell.triangle[t][2]]);
    }
  }
  /// Invalid: none.
  ShellIndex at(const Seen& place) const {
    const std::uint64_t item = items_[squares_.of(place)].load(std::memory_order_relaxed);
    return item == kEmpty ? ShellIndex() : ShellIndex(static_cast<std::size_t>(item & 0xffffffffu));
  }

 private:
  static constexpr std::uint64_t kEmpty = std::numeric_limits<std::uint64_t>::max();

  /// Squares whose centres lie in a box: columns x_from to before x_end.
  struct Area {
    std::size_t x_from, x_end, y_from, y_end;
    std::size_t squares() const { return x_from < x_end && y_from < y_end ? (x_end - x_from) * (y_end - y_from) : 0; }
  };
  Area area_of(const Seen& low, const Seen& high) const {
    return {first_middle(low, 0), first_middle(high, 0), first_middle(low, 1), first_middle(high, 1)};
  }
  /// The first square whose centre lies beyond.
  std::size_t first_middle(const Seen& at, int axis) const {
    const double place = squares_.place(at, axis) + 0.5;
    return place > 0 ? static_cast<std::size_t>(std::min(place, static_cast<double>(squares_.side()))) : 0;
  }
  template <class Body>
  void each_square(const Area& area, Body&& body) const {
    for (std::size_t y = area.y_from; y < area.y_end; ++y)
      for (std::size_t x = area.x_from; x < area.x_end; ++x) body(y * squares_.side() + x, x, y);
  }

  void draw(ShellIndex shell, const Seen& a, const Seen& b, const Seen& c) {
    const auto place = [&](const Seen& at, int axis) { return squares_.place(at, axis) - 0.5; };  // whole numbers are centres
    const std::array<double, 3> x{place(a, 0), place(b, 0), place(c, 0)};
    const std::array<double, 3> y{place(a, 1), place(b, 1), place(c, 1)};
    const double twice_area = (x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]);
    if (twice_area == 0) return;
    each_square(area_of(a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)),
                [&](std::size_t square, std::size_t column, std::size_t row) {
                  const auto px = static_cast<double>(column), py = static_cast<double>(row);
                  const double of_b = ((x[2] - px) * (y[0] - py) - (y[2] - py) * (x[0] - px)) / twice_area;
                  const double of_c = ((x[0] - px) * (y[1] - py) - (y[0] - py) * (x[1] - px)) / twice_area;
                  if (of_b < 0 || of_c < 0 || of_b + of_c > 1) return;
                  put(square, a.z() + of_b * (b.z() - a.z()) + of_c * (c.z() - a.z()), shell);
                });
  }
  void put(std::size_t square, double z, ShellIndex shell) {
    constexpr double kSteps = 4294967295.0;
    const auto depth = static_cast<std::uint64_t>(std::clamp(0.5 * (z + 1), 0.0, 1.0) * kSteps);
    const std::uint64_t item = depth << 32 | shell.value;
    std::uint64_t old = items_[square].load(std::memory_order_relaxed);
    while (item < old && !items_[square].compare_exchange_weak(old, item, std::memory_order_relaxed)) {
    }
  }

  Squares squares_;
  std::unique_ptr<std::atomic<std::uint64_t>[]> items_;
};

/// The neighbour of `shell` over the side that the place is farthest beyond; invalid if there is none.
ShellIndex next_towards(const Scene& scene, const SeenShell& shell, const Seen& place) {
  const std::size_t corners = shell.triangles == 2 ? 4 : 3;
  const auto cross = [](const Seen& a, const Seen& b, const Seen& p) {
    return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
  };
  const double turn = cross(shell.point[0], shell.point[1], shell.point[2]) + cross(shell.point[0], shell.point[2], shell.point[3]);
  std::size_t side = corners;
  double max_beyond = 0;
  for (std::size_t i = 0; i < corners; ++i) {
    const double beyond = cross(shell.point[i], shell.point[(i + 1) % corners], place) * (turn > 0 ? -1 : 1);
    if (beyond > max_beyond) max_beyond = beyond, side = i;
  }
  if (side == corners) return {};
  const Adjacency& adjacency = *scene.model().adjacency;
  const EdgeIndex edge = adjacency.find_edge(shell.corner[side], shell.corner[(side + 1) % corners]);
  if (!edge.valid()) return {};
  for (const ShellIndex other : adjacency.shells_of(edge))
    if (other != shell.shell) return scene.may_hide(other.value) ? other : ShellIndex();
  return {};
}

/// Whether the sheet in front at the node's square hides the node: tests the shell found there and a few neighbours towards the node.
bool hidden_by_item(const Scene& scene, const ItemBuffer& items, const SeenNode& node) {
  ShellIndex item = items.at(node.at);
  for (int step = 0; step < 4 && item.valid(); ++step) {
    const SeenShell shell = scene.seen(item);
    if (shell.is_own(node.node) || !(shell.low.z() < node.at.z())) return false;
    if (scene.hides(shell, node)) return true;
    if (shell.is_cut) return false;
    item = next_towards(scene, shell, node.at);
  }
  return false;
}

/// Estimates how many shells lie behind each other: the area of a sample of them, divided by the picture's.
double layers(const Scene& scene) {
  constexpr std::size_t kEvery = 16;
  const Squares unit(scene, 1);
  double area = 0;
  for (std::size_t shell = 0; shell < scene.model().shell_count(); shell += kEvery) {
    if (!scene.may_hide(shell)) continue;
    const SeenShell seen = scene.seen(ShellIndex(shell));
    const auto extent = [&](int axis) {
      return std::clamp(unit.place(seen.high, axis), 0.0, 1.0) - std::clamp(unit.place(seen.low, axis), 0.0, 1.0);
    };
    area += extent(0) * extent(1);
  }
  return kEvery * area;
}

/// The nodes that the sheet in front at their square doesn't hide, in order.
std::vector<SeenNode> doubtful_nodes(const Scene& scene) {
  const std::vector<SeenNode>& nodes = scene.nodes();
  if (layers(scene) < 2) return nodes;  // a single sheet: the item buffer would save nothing
  const std::size_t side = std::clamp<std::size_t>(static_cast<std::size_t>(0.25 * std::sqrt(static_cast<double>(nodes.size()))), 16, 512);
  ItemBuffer items(scene, side);
  parallel_for(scene.model().shell_count(), kShellGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t shell = begin; shell < end; ++shell)
      if (scene.may_hide(shell)) items.draw(scene.seen(ShellIndex(shell)));
  });
  std::vector<std::vector<SeenNode>> pieces((nodes.size() + kNodeGrain - 1) / kNodeGrain);
  parallel_for(nodes.size(), kNodeGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<SeenNode>& piece = pieces[begin / kNodeGrain];
    for (std::size_t i = begin; i < end; ++i)
      if (!hidden_by_item(scene, items, nodes[i])) piece.push_back(nodes[i]);
  });
  std::vector<SeenNode> doubtful;
  for (const auto& piece : pieces) doubtful.insert(doubtful.end(), piece.begin(), piece.end());
  return doubtful;
}

/// Nodes sorted by squares, with a mark at those that are hidden.
class Sorted {
 public:
  Sorted(const Scene& scene, const std::vector<SeenNode>& nodes)
      : squares_(scene, std::clamp<std::size_t>(static_cast<std::size_t>(std::sqrt(0.5 * static_cast<double>(nodes.size()))), 1, 1024)),
        first_(squares_.count() + 1, 0),
        max_depth_(squares_.count(), -std::numeric_limits<double>::infinity()),
        nodes_(nodes.size()),
        place_(nodes.size()),
        hidden_(nodes.size(), 0) {
    std::vector<std::uint32_t> square(nodes.size());
    parallel_for(nodes.size(), kNodeGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) square[i] = static_cast<std::uint32_t>(squares_.of(nodes[i].at));
    });
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      ++first_[square[i] + 1];
      max_depth_[square[i]] = std::max(max_depth_[square[i]], nodes[i].at.z());
    }
    for (std::size_t s = 0; s < squares_.count(); ++s) first_[s + 1] += first_[s];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      place_[i] = next[square[i]]++;
      nodes_[place_[i]] = nodes[i];
    }
  }

  /// Marks the nodes that the shell hides. May be called from any thread.
  void pass(const Scene& scene, const SeenShell& shell) {
    const std::size_t x_from = squares_.along(shell.low, 0), x_to = squares_.along(shell.high, 0);
    const std::size_t y_from = squares_.along(shell.low, 1), y_to = squares_.along(shell.high, 1);
    for (std::size_t y = y_from; y <= y_to; ++y)
      for (std::size_t x = x_from; x <= x_to; ++x) {
        const std::size_t square = y * squares_.side() + x;
        if (!(shell.low.z() < max_depth_[square])) continue;
        for (std::uint32_t i = first_[square]; i < first_[square + 1]; ++i) pass(scene, shell, i);
      }
  }

  NodeSet left() const {
    NodeSet nodes;
    nodes.reserve(nodes_.size());
    for (const std::uint32_t i : place_)
      if (hidden_[i] == 0) nodes.push_back(nodes_[i].node);
    return nodes;
  }

 private:
  void pass(const Scene& scene, const SeenShell& shell, std::uint32_t i) {
    const Seen& at = nodes_[i].at;
    if (!(shell.low.z() < at.z()) || at.x() < shell.low.x() || at.x() > shell.high.x() || at.y() < shell.low.y() || at.y() > shell.high.y())
      return;
    std::atomic_ref<std::uint8_t> hidden(hidden_[i]);
    if (hidden.load(std::memory_order_relaxed) == 0 && scene.hides(shell, nodes_[i])) hidden.store(1, std::memory_order_relaxed);
  }

  Squares squares_;
  std::vector<std::uint32_t> first_;
  std::vector<double> max_depth_;     ///< of a square's nodes
  std::vector<SeenNode> nodes_;       ///< by square
  std::vector<std::uint32_t> place_;  ///< position in nodes_, by the order of the input
  std::vector<std::uint8_t> hidden_;
};

/// Whether the view keeps depth where the candidates are: its matrix can be inverted in coordinates relative to their centre and size.
bool keeps_depth(const Model& model, const ViewMatrix& view, const NodeSet& nodes) {
  Vec3 low = model.position(nodes.front());
  Vec3 high = low;
  for (const NodeIndex node : nodes) {
    low = low.cwiseMin(model.position(node));
    high = high.cwiseMax(model.position(node));
  }
  const double size = std::max((high - low).norm(), 1e-6 * high.cwiseAbs().cwiseMax(low.cwiseAbs()).maxCoeff());
  Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix4d>(view.data());
  matrix.col(3) += matrix.leftCols<3>() * (0.5 * (low + high));
  if (size > 0) matrix.leftCols<3>() *= size;
  for (int row = 0; row < 4; ++row) {
    const double length = matrix.row(row).norm();
    if (!(length > 0) || !std::isfinite(length)) return false;
    matrix.row(row) /= length;
  }
  return std::abs(matrix.determinant()) > 1e-13;
}

}  // namespace

Result<NodeSet> visible_nodes(const Model& model, const ViewMatrix& view, const NodeSet& candidates,
                              std::span<const std::uint8_t> out_of_sight) {
  if (candidates.empty()) return NodeSet();
  if (!keeps_depth(model, view, candidates))
    return fail(
        "",
        "the view keeps no depth, so it can't be decided which shells hide which nodes: give the matrix that the picture is drawn with");
  const Scene scene(model, view, candidates, out_of_sight);
  if (scene.nodes().empty()) return NodeSet();
  Sorted doubtful(scene, doubtful_nodes(scene));
  parallel_for(model.shell_count(), kShellGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t shell = begin; shell < end; ++shell)
      if (scene.may_hide(shell)) doubtful.pass(scene, scene.seen(ShellIndex(shell)));
  });
  return doubtful.left();
}

}  // namespace prismesh::mesh::select
