// The local fits of a model's sheets, one for each node and each sheet that meets there, made when they are first asked for. Private to
// mesh/relax.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>

#include "mesh/model/model.h"
#include "mesh/relax/local_fit.h"

namespace prismesh::mesh::relax {

class Sheets {
 public:
  /// `model` must outlive it.
  Sheets(const Model& model, double cos_limit);

  /// The fit at a shell's corner. By any thread.
  const LocalFit& at(ShellIndex shell, int corner) const;
  /// Whether all edges at a node are smooth.
  bool is_smooth(NodeIndex node) const;
  /// As relax::across, quicker where a node has been asked before.
  ShellIndex beyond(ShellIndex shell, NodeIndex a, NodeIndex b) const;

 private:
  using Slot = std::atomic<const LocalFit*>;
  struct Free {
    void operator()(void* memory) const;
  };
  const LocalFit& make(ShellIndex shell, int corner) const;

  const Model& model_;
  double cos_limit_;
  // zeroed by the system where they are touched, so that a large model costs nothing before
  std::unique_ptr<Slot[], Free> slots_;                             ///< four a shell
  std::unique_ptr<std::atomic<std::uint8_t>[], Free> node_states_;  ///< 0: not known
  mutable std::mutex mutex_;
  mutable std::deque<LocalFit> fits_;
};

/// Mean length of the edges of the shells at a node; 0 if there is none.
double mean_edge(const Model& model, NodeIndex node);
/// The unit normal by a shell's diagonals (a triangle's sides); zero if it has none.
Vec3 shell_normal(const Model& model, const ShellNodes& shell);

}  // namespace prismesh::mesh::relax
