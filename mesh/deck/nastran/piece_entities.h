// Grid points and shells as their cards give them, and the arrays of a piece that they are added to.
#pragma once

#include <array>
#include <cstdint>

#include "mesh/deck/assembly/piece_cards.h"
#include "mesh/deck/nastran/card.h"

namespace prismesh::mesh::deck::nastran {

/// PieceRun::frame holds the id of a coordinate system until the deck's systems are known; or this, where GRDSET gives it.
inline constexpr std::uint32_t kSystemOfGrdset = 0xffffffffu;
inline constexpr std::int64_t kMaxSystem = 0xfffffffe;

struct GridEntry {
  std::int64_t id = 0;
  Vec3 position;
  std::size_t offset = 0;
  Layout layout = Layout::small;
  std::uint32_t system = 0;  ///< id of its coordinate system, or kSystemOfGrdset
};

struct ShellEntry {
  std::int64_t id = 0;
  std::int64_t part = 0;
  std::array<std::int64_t, 4> nodes{};  ///< a triangle repeats its third
  std::size_t offset = 0;
  Layout layout = Layout::small;
  float thickness = 0;  ///< 0: the property's
};

/// Adds grid points and shells to a piece. A run begins where the layout or the coordinate system changes.
class PieceEntities {
 public:
  /// `cards` must outlive this.
  explicit PieceEntities(PieceCards& cards) : cards_(cards) {}

  void add(const GridEntry& grid) {
    if (!nodes_begun_ || node_layout_ != grid.layout || node_system_ != grid.system) {
      cards_.begin_nodes(static_cast<std::uint16_t>(grid.layout), grid.system);
      nodes_begun_ = true;
      node_layout_ = grid.layout;
      node_system_ = grid.system;
    }
    cards_.node_id.push_back(grid.id);
    cards_.position.push_back(grid.position);
    cards_.node_offset.push_back(grid.offset);
  }

  void add(const ShellEntry& shell) {
    RawShells& shells = cards_.shells;
    if (!shells_begun_ || shell_layout_ != shell.layout) {
      cards_.begin_shells(static_cast<std::uint16_t>(shell.layout));
      shells_begun_ = true;
      shell_layout_ = shell.layout;
    }
    shells.id.push_back(shell.id);
    shells.part.push_back(shell.part);
    shells.nodes.push_back(shell.nodes);
    shells.offset.push_back(shell.offset);
    if (shell.thickness != 0 || !shells.thickness.empty()) {
      shells.thickness.resize(shells.id.size());
      shells.thickness.back() = shell.thickness;
    }
  }

 private:
  PieceCards& cards_;
  bool nodes_begun_ = false;
  Layout node_layout_ = Layout::small;
  std::uint32_t node_system_ = 0;
  bool shells_begun_ = false;
  Layout shell_layout_ = Layout::small;
};

}  // namespace prismesh::mesh::deck::nastran
