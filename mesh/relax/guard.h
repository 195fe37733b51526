// What relaxing may not do: make an element fail or warn that didn't, or the worst worse. Private to mesh/relax.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "mesh/quality/limits.h"
#include "mesh/quality/sheet.h"
#include "mesh/quality/shell_state.h"
#include "mesh/relax/net.h"

namespace prismesh::mesh::relax {

/// Shells and nodes by their local numbers; `places` are those of all nodes of the net.
class Guard {
 public:
  Guard(const Model& model, const Net& net, const quality::SizedCriteria& criteria);

  /// Whether the shells of a movable node may be as they are with it at `place`.
  bool allows(std::uint32_t node, const Vec3& place, const std::vector<Vec3>& places) const;

  struct Held {
    std::vector<std::uint32_t> shells;  ///< that were too bad, ascending
    std::vector<std::uint32_t> nodes;   ///< that were taken back, ascending
  };
  /// Takes nodes of shells that became too bad back to where they were at `good`, by halves and then altogether, or to their start, until
  /// no shell is. Looks at shells with a node that isn't where it was at `good`. `land(node, point)` puts one as near to a point as it may
  /// be, on the surface; by any thread. Nothing if `goes_on` says no, with nodes anywhere.
  std::optional<Held> hold_back(const std::vector<Vec3>& good, std::vector<Vec3>& places,
                                const std::function<void(std::uint32_t node, const Vec3& point)>& land,
                                const std::function<bool()>& goes_on) const;

  std::span<const std::uint32_t> shells_of(std::uint32_t node) const {
    return std::span(shells_).subspan(first_shell_[node], first_shell_[node + 1] - first_shell_[node]);
  }

 private:
  struct Verdict {
    quality::ShellState state;
    float composite = 1;
  };
  /// `sink(i, verdict)` for each of `shells`; `place_of(local node)` is where it is.
  template <class PlaceOf, class Sink>
  void measure(std::span<const std::uint32_t> shells, const PlaceOf& place_of, const Sink& sink) const;
  template <class PlaceOf>
  bool is_bad(std::uint32_t shell, const Verdict& verdict, const PlaceOf& place_of) const;
  void find_shells_of_nodes();
  std::vector<std::uint8_t> find_bad(std::span<const std::uint32_t> shells, const std::vector<Vec3>& places) const;
  std::vector<std::uint32_t> shells_off(const std::vector<Vec3>& good, const std::vector<Vec3>& places) const;

  const Net& net_;
  quality::Limits limits_;
  std::vector<quality::Sheet> sheets_;      ///< empty if not needed
  std::vector<quality::ShellState> state_;  ///< at the start
  std::vector<float> least_;                ///< composite that each must keep
  std::vector<std::uint32_t> first_shell_;  ///< of each movable node, and one more
  std::vector<std::uint32_t> shells_;
};

}  // namespace prismesh::mesh::relax
