// Finds the free edges, branching edges and creases of the visible shells. An update visits only the chunks that changed.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kiosk/render/model_table.h"

namespace prismesh::kiosk::render {

using NodePair = std::array<std::uint32_t, 2>;

class Outline {
 public:
  static constexpr double kCreaseDegrees = 30;

  /// Takes over a model. `topology_changed`: shells or the number of nodes changed; `visibility_changed`: hidden parts changed;
  /// `moved_chunks`: chunks of positions that differ.
  void update(const ModelTable& table, bool topology_changed, bool visibility_changed, std::span<const std::uint32_t> moved_chunks);

  /// Edges with one visible shell, and those with three or more.
  std::vector<NodePair> borders() const { return gather(&Chunk::borders); }
  /// The rim of the shells that `is_in` holds: edges at which an odd number of them ends. Only nodes with `corners` not 0 are looked at,
  /// those of these shells.
  std::vector<NodePair> rim(std::span<const std::uint8_t> corners, const std::function<bool(std::uint32_t)>& is_in) const;
  /// Edges with two visible shells that bend by more than kCreaseDegrees, independent of the sense of the normals.
  std::vector<NodePair> creases() const { return gather(&Chunk::creases); }

 private:
  struct HalfEdge {
    std::uint32_t high = 0;
    std::uint32_t shell = 0;
  };
  /// The edges whose lower node is in one chunk of nodes.
  struct Chunk {
    std::vector<std::uint32_t> depends_on;  ///< chunks of positions that its shells use, ascending
    std::vector<NodePair> borders;
    std::vector<NodePair> creases;
  };

  void build_half_edges(const ModelTable& table);
  void find_dependencies(const ModelTable& table);
  void classify(const ModelTable& table, std::size_t chunk);
  std::vector<NodePair> gather(std::vector<NodePair> Chunk::*lines) const;

  std::vector<std::uint32_t> first_;  ///< node n is the lower end of half_edges_[first_[n] .. first_[n+1])
  std::vector<HalfEdge> half_edges_;  ///< by lower node, then higher node, then shell
  std::vector<Chunk> chunks_;
};

}  // namespace prismesh::kiosk::render
