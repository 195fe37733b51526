// Keeps element quality while nodes move: no metric of a shell may fail or warn that didn't at the start, and no composite may fall below
// the min at the start. Private to mesh/relax.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "mesh/quality/limits.h"
#include "mesh/quality/shell_properties.h"
#include "mesh/quality/shell_state.h"
#include "mesh/relax/spring_net.h"

namespace prismesh::mesh::relax {

/// Shells and nodes are given by their local numbers in the net; `positions` has an entry for each node of the net.
class QualityGuard {
 public:
  QualityGuard(const Model& model, const SpringNet& net, const quality::SizedCriteria& criteria);

  /// Whether no shell of a movable node is too bad with the node at `position` and the others at `positions`.
  bool allows(std::uint32_t node, const Vec3& position, const std::vector<Vec3>& positions) const;

  struct HeldBack {
    std::vector<std::uint32_t> shells;  ///< that were too bad, ascending by number
    std::vector<std::uint32_t> nodes;   ///< that were moved back, ascending by number
  };
  /// Moves nodes of shells that became too bad back towards `good`, where no shell is: by halves, then all of the way, then to their start,
  /// until no shell is too bad. Checks only shells with a node that is not where it was at `good`. `put_near(node, point)` puts a node on
  /// the surface, as near to the point as its max move allows; any thread calls it. Returns nothing, with nodes in between, when `goes_on`
  /// returns false.
  std::optional<HeldBack> hold_back(const std::vector<Vec3>& good, std::vector<Vec3>& positions,
                                    const std::function<void(std::uint32_t node, const Vec3& point)>& put_near,
                                    const std::function<bool()>& goes_on) const;

  std::span<const std::uint32_t> shells_of(std::uint32_t node) const {
    return std::span(shells_).subspan(first_shell_[node], first_shell_[node + 1] - first_shell_[node]);
  }

 private:
  struct ShellQuality {
    quality::ShellState state;
    float composite = 1;
  };
  /// Calls `sink(i, quality)` for each of `shells`; `position_of(node)` is a node's position.
  template <class PositionOf, class Sink>
  void measure(std::span<const std::uint32_t> shells, const PositionOf& position_of, const Sink& sink) const;
  template <class PositionOf>
  bool is_bad(std::uint32_t shell, const ShellQuality& verdict, const PositionOf& position_of) const;
  void find_shells_of_nodes();
  std::vector<std::uint8_t> find_bad(std::span<const std::uint32_t> shells, const std::vector<Vec3>& positions) const;
  std::vector<std::uint32_t> moved_shells(const std::vector<Vec3>& good, const std::vector<Vec3>& positions) const;

  const SpringNet& net_;
  quality::LimitsByPart limits_;
  std::vector<quality::ShellProperties> properties_;  ///< empty if not needed
  std::vector<quality::ShellState> state_;            ///< at the start
  std::vector<float> min_composite_;                  ///< that each shell must keep
  std::vector<std::uint32_t> first_shell_;            ///< of each movable node in shells_, and the end
  std::vector<std::uint32_t> shells_;
};

}  // namespace prismesh::mesh::relax
