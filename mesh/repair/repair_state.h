// The data that the passes of a repair work on.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "mesh/repair/cluster_state.h"
#include "mesh/repair/operation.h"
#include "mesh/repair/patch.h"
#include "mesh/repair/strips.h"

namespace prismesh::mesh::repair {

/// How much work a round spends on each shell.
struct Effort {
  int sweeps;                         ///< of node smoothing in a full trial
  std::size_t max_trials;             ///< full trials while no candidate is acceptable
  std::size_t max_trials_once_found;  ///< full trials once one is
  double min_gain_at_first;           ///< per shell that a candidate changes, before smoothing: others get no trial
  bool along_lines;                   ///< a second strip pass and what follows also move nodes on feature lines
};
inline constexpr Effort kQuickEffort{4, 12, 4, -1, false}, kThoroughEffort{10, 40, 12, -1.2, true};

/// The accepted changes so far.
struct ChangeHistory {
  std::vector<std::uint8_t> in_scope;      ///< by shell, for the shells that the patch began with; later ones are in scope
  std::vector<std::uint32_t> last_change;  ///< by shell: the number of its last change by an operation, from 1; 0 or no entry: none
  std::vector<std::uint8_t> is_moved;      ///< by shell: relaxing moved a node of it; no entry: it didn't
  std::vector<std::uint8_t> was_bad;       ///< by shell, for the shells that the patch began with: in scope, and warned or failed
  std::vector<std::uint8_t> is_reshaped;   ///< by shell: it got other corners; no entry: it didn't
  std::uint32_t changes = 0;
  long triangles = 0;  ///< of the whole model
  long max_triangles = 0;
  long max_triangles_by_split = 0;  ///< where only halves of a failing quad pass
  int added_triangle_pairs = 0;     ///< edges between two triangles, now less those at the start
};

/// What the trials so far have shown. `refused_at` of each kind: ChangeHistory::changes when every candidate there was refused.
struct TrialRecord {
  std::map<LocalShell, std::uint32_t> refused_at;
  std::map<LocalShell, std::uint32_t> tidying_refused_at;
  /// First without, then with moves along lines.
  std::array<std::map<std::pair<Operation, std::vector<StripQuad>>, std::uint32_t>, 2> strip_refused_at;
  std::map<LocalShell, std::string_view> reason;        ///< the last reason for that
  std::array<std::size_t, kOperationCount> accepted{};  ///< by Operation

  void forget_refused() {
    refused_at.clear();
    tidying_refused_at.clear();
    for (auto& refused : strip_refused_at) refused.clear();
  }
};

/// Progress over the rounds, and why the repair stopped early.
struct RoundProgress {
  const Progress& progress;
  std::optional<std::uint64_t> stop_at = std::nullopt;  ///< Options::stop_at
  std::function<std::size_t()> bad_left = {};           ///< counts the shells of the scope that fail or warn
  int round = 0;                                        ///< from 0
  std::uint64_t step = 0;                               ///< begun so far; between two steps the patch is as valid as after a repair
  std::optional<Error> stopped = std::nullopt;
};

struct RepairState {
  ChangeHistory history;
  TrialRecord record;
  RoundProgress progress;
  ClusterState clusters{};
  Effort effort = kQuickEffort;
  bool along_lines = false;                                         ///< node smoothing also moves nodes on feature lines
  std::optional<std::uint32_t> relaxing_refused_at = std::nullopt;  ///< ChangeHistory::changes when a relaxation was taken back
};

}  // namespace prismesh::mesh::repair
