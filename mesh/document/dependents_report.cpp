#include "mesh/document/dependents_report.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/counted.h"
#include "mesh/document/connections_kept.h"
#include "mesh/document/deck_relations.h"

namespace prismesh::mesh::document {

namespace {

constexpr std::size_t kMaxNamedInReport = 5;  ///< cards and nodes that a note names
constexpr std::size_t kMaxLost = 100;         ///< connections that a report lists

bool contains(const NodeSet& nodes, NodeIndex node) { return std::binary_search(nodes.begin(), nodes.end(), node); }

/// Notes the joining cards of which only some nodes moved.
void note_split_joins(const Generation& before, const NodeSet& moved, EditReport& report) {
  const Dependents& dependents = before.relations->dependents;
  std::map<std::uint32_t, std::size_t> moved_of;
  auto at = dependents.joined_nodes.begin();
  for (const NodeIndex node : moved) {
    if (at == dependents.joined_nodes.end()) break;
    at = std::lower_bound(at, dependents.joined_nodes.end(), node, [](const JoinedNode& j, NodeIndex n) { return j.node < n; });
    for (; at != dependents.joined_nodes.end() && at->node == node; ++at) ++moved_of[at->card];
  }
  std::size_t named = 0, more = 0;
  for (const auto& [join, count] : moved_of) {
    const NodeSet& nodes = dependents.joining_cards[join].nodes;
    if (count == nodes.size()) continue;
    if (named++ >= kMaxNamedInReport) {
      ++more;
      continue;
    }
    std::string note = card_of(*before.relations, dependents.joining_cards[join].referrer) + ": " + std::to_string(count) + " of its " +
                       std::to_string(nodes.size()) + " nodes moved; left in place: ";
    std::size_t left = 0;
    for (const NodeIndex node : nodes) {
      if (contains(moved, node)) continue;
      if (left++ < kMaxNamedInReport) note += (left > 1 ? ", node:" : "node:") + std::to_string(before.model.node_ids[node.value]);
    }
    if (left > kMaxNamedInReport) note += " and " + std::to_string(left - kMaxNamedInReport) + " more";
    report.notes.push_back(std::move(note));
  }
  if (more > 0) report.notes.push_back("so it is with " + counted(more, "more card") + " that join nodes");
}

/// Lists the nodes that lay on a sheet and no longer do.
void list_lost(const Generation& before, const Generation& after, const NodeSet& moved, EditReport& report) {
  const Dependents& dependents = before.relations->dependents;
  if (dependents.on_sheets.empty()) return;
  std::size_t carried = 0;
  for (const std::uint32_t r : doubtful_connections(dependents, before.model, moved)) {
    const NodeOnSheet& each = dependents.on_sheets[r];
    const double gap = gap_from_sheet(after.model, each);
    if (gap <= each.reach) {
      carried += !each.tied && contains(moved, each.node);
      continue;
    }
    if (gap_from_sheet(before.model, each) > each.reach) continue;  // lost before
    if (++report.lost_connections <= kMaxLost) report.lost.push_back(lost_connection(before, each, gap));
  }
  if (carried > 0) report.notes.push_back(counted(carried, "node") + " of welds moved along with the sheets they lie on");
  if (report.lost_connections > 0)
    report.notes.push_back(counted(report.lost_connections, "connection") + " would be lost: " + report.lost.front() +
                           (report.lost_connections > 1 ? ", ..." : ""));
}

}  // namespace

void report_dependents(const Generation& before, const Generation& after, const NodeSet& moved, EditReport& report) {
  note_split_joins(before, moved, report);
  list_lost(before, after, moved, report);
}

}  // namespace prismesh::mesh::document
