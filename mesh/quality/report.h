// Quality of a model, of a part or of some shells: the state of each shell, and figures for a report.
#pragma once

#include <optional>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/quality/criteria.h"
#include "mesh/quality/shell_state.h"

namespace prismesh::mesh::quality {

struct Counts {
  std::size_t ok = 0;
  std::size_t warn = 0;  ///< shells whose worst grade is warn
  std::size_t fail = 0;
  bool operator==(const Counts&) const = default;
};

/// State of every shell; a removed one has ShellState::removed().
ChunkedArray<ShellState> judge_model(const Model& model, const SizedCriteria& criteria);
/// Updates `states` and `counts` for the given shells (ascending) and those that were added since `states` was made. Removed shells don't
/// count any more.
void rejudge(const Model& model, const SizedCriteria& criteria, const ShellSet& shells, ChunkedArray<ShellState>& states, Counts& counts);
Counts count(const ChunkedArray<ShellState>& states);  ///< without removed shells

struct MetricSummary {
  double min = 0, mean = 0, max = 0;
  std::size_t measured = 0;        ///< shells the metric applies to, without those that have a defect
  std::size_t warn = 0, fail = 0;  ///< a shell counts in one of the two
  std::optional<ShellIndex> worst;
};
struct TimeStep {
  double seconds = 0;  ///< in the deck's time unit
  ShellIndex shell;
};
struct Report {
  std::size_t elements = 0;
  Counts counts;
  double triangles_percent = 0;
  std::array<MetricSummary, kMetricCount> metrics;
  std::array<std::size_t, kDefectCount> defects{};  ///< by kDefects; a shell may have several
  double min_composite = 1;                         ///< mesh/quality/composite.h; 1 without shells
  double mean_composite = 1;
  std::optional<double> mass;             ///< of the shells whose thickness and density are known; absent if none is
  std::optional<Vec3> centre_of_gravity;  ///< of that mass
  std::optional<TimeStep> time_step;      ///< the smallest, with TSSFAC, before any mass scaling
  std::optional<double> added_mass;       ///< what DT2MS adds to these shells at the start; absent without mass scaling
};

/// Figures of the given shells; nullptr: of all. Deterministic, whatever the number of threads.
Report report(const Model& model, const SizedCriteria& criteria, const TimeStepControl& control, const ShellSet* shells = nullptr);

struct PartReport {
  PartIndex part;
  Report report;
};
/// The same by part, ascending, for parts with at least one of the shells.
std::vector<PartReport> report_by_part(const Model& model, const SizedCriteria& criteria, const TimeStepControl& control,
                                       const ShellSet* shells = nullptr);

}  // namespace prismesh::mesh::quality
