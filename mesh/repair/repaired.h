// The result of a repair.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/repair/cluster_state.h"
#include "mesh/repair/operation.h"
#include "mesh/repair/restructuring.h"

namespace prismesh::mesh::repair {

struct Unrepaired {
  ShellIndex shell;  ///< of the model, or a new one: shell_count() + i is Restructuring::new_shells[i]
  std::string why;   ///< "no operation makes it better", "every operation makes a neighbour fail", ...
};

/// Where a repair was stopped. The same repair with `Options::stop_at` at this step gives the same result, whatever the number of threads.
struct StoppedAt {
  std::vector<std::uint64_t> steps;  ///< of each piece, from 1; 0: it had been finished
};

/// Two nodes, those of the model or new ones: node_count() + i is Restructuring::new_nodes[i].
using NodePair = std::pair<NodeIndex, NodeIndex>;

struct Repaired {
  Restructuring change;
  std::array<std::size_t, kOperationCount> done{};  ///< accepted operations, by Operation
  std::size_t relaxed = 0;                          ///< nodes that moved
  std::size_t bad_left = 0;                         ///< shells of the scope that fail or warn now
  std::size_t bad_before = 0;                       ///< shells of the scope that failed or warned
  std::size_t clusters_before = 0;                  ///< nodes of the scope with too many triangles about them
  std::vector<ClusterLeft> clusters_left;           ///< those that are left, and those that the repair made
  std::vector<Unrepaired> unrepaired;               ///< still failing, ascending by shell
  std::vector<NodePair> triangle_pairs;             ///< edges between two triangles that the repair had to make, so that shells pass
  int rounds = 0;                                   ///< begun
  std::optional<StoppedAt> stopped;                 ///< before it was finished; `change` is what it had reached
};

}  // namespace prismesh::mesh::repair
