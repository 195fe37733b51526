// The local fits of a model's smooth sheets: one for each node and each sheet that meets there, computed when first used. Private to
// mesh/relax.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <deque>
#include <mutex>

#include "mesh/model/model.h"
#include "mesh/relax/local_fit.h"
#include "mesh/relax/zeroed_memory.h"

namespace prismesh::mesh::relax {

class SheetFits {
 public:
  /// `model` must outlive it.
  SheetFits(const Model& model, double cos_limit);

  /// The fit at a shell's corner. Thread-safe.
  const LocalFit& at(ShellIndex shell, int corner) const;
  /// Whether all edges at a node are smooth.
  bool is_smooth(NodeIndex node) const;
  /// As relax::smooth_neighbour, but it remembers which nodes are smooth.
  ShellIndex smooth_neighbour(ShellIndex shell, NodeIndex a, NodeIndex b) const;

 private:
  using Slot = std::atomic<const LocalFit*>;
  const LocalFit& make(ShellIndex shell, int corner) const;

  const Model& model_;
  double cos_limit_;
  ZeroedMemory<Slot> slots_;                             ///< four for each shell
  ZeroedMemory<std::atomic<std::uint8_t>> node_states_;  ///< by node; 0: not known
  mutable std::mutex mutex_;
  mutable std::deque<LocalFit> fits_;
};

/// Mean length of the edges of the shells at a node; 0 if there is none.
double mean_edge(const Model& model, NodeIndex node);
/// The unit normal by a shell's diagonals, or a triangle's sides; zero if the shell has no area.
Vec3 shell_normal(const Model& model, const ShellNodes& shell);

}  // namespace prismesh::mesh::relax
