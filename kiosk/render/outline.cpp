#include "kiosk/render/outline.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel_for.h"

namespace prismesh::kiosk::render {

using mesh::kChunkSize;
using mesh::Vec3;

namespace {

/// Calls `visit(low, high, shell)` for every side of every shell whose nodes are in range.
template <class Visit>
void for_each_side(const ModelTable& table, const Visit& visit) {
  mesh::ShellNodes nodes;
  for (std::size_t s = 0; s < table.shell_count(); ++s) {
    if (!table.shell(s, nodes)) continue;
    const auto corners = static_cast<std::size_t>(nodes.corners());
    for (std::size_t corner = 0; corner < corners; ++corner) {
      const std::uint32_t a = nodes.node[corner].value, b = nodes.node[(corner + 1) % corners].value;
      if (a != b) visit(std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(s));
    }
  }
}

/// Unit direction from an edge to the shell's centre, perpendicular to the edge; zero if there is none.
Vec3 inward(const ModelTable& table, std::uint32_t shell, const Vec3& from, const Vec3& along) {
  Vec3 centre;
  if (!table.shell_centre(shell, centre)) return Vec3::Zero();
  const Vec3 into = centre - from;
  const Vec3 across = into - along * into.dot(along);
  const double length = across.norm();
  return length > 0 ? Vec3(across / length) : Vec3::Zero();
}

bool is_crease(const ModelTable& table, std::uint32_t low, std::uint32_t high, std::uint32_t shell_a, std::uint32_t shell_b) {
  static const double kFlat = -std::cos(Outline::kCreaseDegrees * std::numbers::pi / 180);
  const Vec3 from = table.position(low);
  const Vec3 edge = table.position(high) - from;
  const double length = edge.norm();
  if (!(length > 0)) return false;
  const Vec3 along = edge / length;
  return inward(table, shell_a, from, along).dot(inward(table, shell_b, from, along)) > kFlat;
}

}  // namespace

void Outline::update(const ModelTable& table, bool topology_changed, bool visibility_changed, std::span<const std::uint32_t> moved_chunks) {
  if (topology_changed) {
    build_half_edges(table);
    find_dependencies(table);
  }
  std::vector<std::uint32_t> stale;
  for (std::uint32_t c = 0; c < chunks_.size(); ++c) {
    const auto depends = [&](std::uint32_t moved) {
      return std::binary_search(chunks_[c].depends_on.begin(), chunks_[c].depends_on.end(), moved);
    };
    if (topology_changed || visibility_changed || std::any_of(moved_chunks.begin(), moved_chunks.end(), depends)) stale.push_back(c);
  }
  parallel_for(stale.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) classify(table, stale[i]);
  });
}

void Outline::build_half_edges(const ModelTable& table) {
  first_.assign(table.node_count() + 2, 0);
  for_each_side(table, [&](std::uint32_t low, std::uint32_t, std::uint32_t) { ++first_[low + 2]; });
  for (std::size_t n = 2; n < first_.size(); ++n) first_[n] += first_[n - 1];
  half_edges_.resize(first_.back());
  for_each_side(table, [&](std::uint32_t low, std::uint32_t high, std::uint32_t shell) { half_edges_[first_[low + 1]++] = {high, shell}; });
  first_.pop_back();
  const auto by_high = [](const HalfEdge& a, const HalfEdge& b) { return a.high != b.high ? a.high < b.high : a.shell < b.shell; };
  parallel_for(table.node_count(), kChunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) std::sort(half_edges_.begin() + first_[n], half_edges_.begin() + first_[n + 1], by_high);
  });
}

void Outline::find_dependencies(const ModelTable& table) {
  chunks_.assign((table.node_count() + kChunkSize - 1) / kChunkSize, {});
  parallel_for(chunks_.size(), 1, [&](std::size_t begin, std::size_t end) {
    mesh::ShellNodes nodes;
    for (std::size_t c = begin; c < end; ++c) {
      std::vector<std::uint32_t>& depends_on = chunks_[c].depends_on;
      const std::size_t last_node = std::min((c + 1) * kChunkSize, table.node_count());
      for (std::size_t e = first_[c * kChunkSize]; e < first_[last_node]; ++e) {
        if (!table.shell(half_edges_[e].shell, nodes)) continue;
        for (const mesh::NodeIndex node : nodes.node) {
          const auto used = static_cast<std::uint32_t>(node.value / kChunkSize);
          const auto place = std::lower_bound(depends_on.begin(), depends_on.end(), used);
          if (place == depends_on.end() || *place != used) depends_on.insert(place, used);
        }
      }
    }
  });
}

void Outline::classify(const ModelTable& table, std::size_t c) {
  Chunk& chunk = chunks_[c];
  chunk.borders.clear();
  chunk.creases.clear();
  const std::size_t last_node = std::min((c + 1) * kChunkSize, table.node_count());
  for (std::size_t n = c * kChunkSize; n < last_node; ++n) {
    const auto low = static_cast<std::uint32_t>(n);
    for (std::size_t e = first_[n]; e < first_[n + 1];) {
      const std::uint32_t high = half_edges_[e].high;
      std::array<std::uint32_t, 2> shells{};
      std::size_t visible = 0;
      for (; e < first_[n + 1] && half_edges_[e].high == high; ++e) {
        if (!table.shell_visible(half_edges_[e].shell)) continue;
        if (visible < 2) shells[visible] = half_edges_[e].shell;
        ++visible;
      }
      if (visible == 1 || visible > 2)
        chunk.borders.push_back({low, high});
      else if (visible == 2 && is_crease(table, low, high, shells[0], shells[1]))
        chunk.creases.push_back({low, high});
    }
  }
}

std::vector<NodePair> Outline::rim(std::span<const std::uint8_t> corners, const std::function<bool(std::uint32_t)>& is_in) const {
  std::vector<NodePair> edges;
  const std::size_t nodes = std::min(corners.size(), first_.empty() ? 0 : first_.size() - 1);
  for (std::size_t n = 0; n < nodes; ++n) {
    if (corners[n] == 0) continue;
    for (std::size_t e = first_[n]; e < first_[n + 1];) {
      const std::uint32_t high = half_edges_[e].high;
      std::size_t inside = 0;
      for (; e < first_[n + 1] && half_edges_[e].high == high; ++e) inside += is_in(half_edges_[e].shell) ? 1 : 0;
      if (inside % 2 == 1) edges.push_back({static_cast<std::uint32_t>(n), high});
    }
  }
  return edges;
}

std::vector<NodePair> Outline::gather(std::vector<NodePair> Chunk::*lines) const {
  std::vector<NodePair> all;
  for (const Chunk& chunk : chunks_) all.insert(all.end(), (chunk.*lines).begin(), (chunk.*lines).end());
  return all;
}

}  // namespace prismesh::kiosk::render
