// What relaxing may not do: make an element fail or warn that didn't, or the worst worse. Private to mesh/relax.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/relax/net.h"
#include "mesh/relax/relax.h"

namespace prismesh::mesh::relax {

class Guard {
 public:
  Guard(const Model& model, const Net& net, const Judge& judge);

  /// Whether each of `shells` (local numbers) may be as the places say.
  void judge(std::span<const std::uint32_t> shells, const std::vector<Vec3>& places, std::span<std::uint8_t> is_bad) const;
  /// Takes nodes of shells that became too bad back towards their start, by halves and then altogether, until none is. Returns how many
  /// nodes that were. `places` are those of all nodes of the net, of which the movable ones are on the surface again.
  std::size_t hold_back(const ReferenceSurface& surface, std::vector<Vec3>& places, std::vector<Footing>& footing) const;

 private:
  void rate(std::span<const std::uint32_t> shells, const std::vector<Vec3>& places, std::span<quality::ShellState> states,
            std::span<float> composites) const;

  const Net& net_;
  const Judge& judge_;
  std::vector<quality::Sheet> sheets_;
  std::vector<quality::ShellState> state_;  ///< at the start
  std::vector<float> least_;                ///< composite that each must keep
};

}  // namespace prismesh::mesh::relax
