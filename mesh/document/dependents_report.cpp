#include "mesh/document/dependents_report.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "base/counted.h"
#include "base/readable_number.h"
#include "mesh/deck/editing/names.h"
#include "mesh/document/deck_relations.h"
#include "mesh/model/adjacency.h"
#include "mesh/spatial/closest_point.h"

namespace prismesh::mesh::document {

namespace {

constexpr std::size_t kMaxNamedInReport = 5;  ///< cards and nodes that a note names
constexpr std::size_t kMaxLost = 100;         ///< connections that a report lists
constexpr int kRingsSearched = 4;             ///< max distance along its sheet at which a node is still found

bool contains(const NodeSet& nodes, NodeIndex node) { return std::binary_search(nodes.begin(), nodes.end(), node); }

std::string card_of(const DeckRelations& relations, std::uint32_t referrer) {
  return deck::card_name(relations.deck->format, relations.deck->references->referrers()[referrer]);
}

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

/// The shells around one, by rings over shared nodes.
ShellSet around(const Model& model, ShellIndex shell) {
  ShellSet shells{shell};
  for (int ring = 0; ring < kRingsSearched; ++ring) shells = shells_touching(model, nodes_of(model, shells));
  return shells;
}

/// The distance of the node from the sheet it lies on; checks the shell alone first.
double gap_at(const Model& model, const NodeOnSheet& rest) {
  if (model.is_removed(rest.node) || model.is_removed(rest.shell)) return 0;  // there is no connection to lose
  const Vec3& point = model.position(rest.node);
  const auto distance = [&](const ShellSet& shells) {
    const auto on = spatial::ShellTree(model, shells).closest(point);
    return on ? on->distance : std::numeric_limits<double>::infinity();
  };
  const double close = distance({rest.shell});
  return close <= rest.reach ? close : std::min(close, distance(around(model, rest.shell)));
}

/// Three digits are enough for a gap.
std::string short_length(double length) { return readable(length, 3); }

std::string lost_connection(const Generation& before, const NodeOnSheet& rest, double gap) {
  const Model& model = before.model;
  const std::string node = "node:" + std::to_string(model.node_ids[rest.node.value]);
  std::string what;
  if (rest.tied)
    what = node + ", which " + card_of(*before.relations, rest.of) + " ties,";
  else
    what = std::string(name(rest.element_class)) + ":" +
           std::to_string(model.elements[static_cast<std::size_t>(rest.element_class)]->id[rest.of]) + " at " + node;
  std::string why =
      " no longer lies on shell:" + std::to_string(model.shell_ids[rest.shell.value]) + ", it is " + short_length(gap) + " away";
  if ((before.node_marks[rest.node.value] & kLocked) != 0)
    why += " (it belongs to a locked part)";
  else if (model.node_holds[rest.node.value] != 0)
    why += " (it " + std::string(why_held(model.node_holds[rest.node.value])) + ")";
  return what + why;
}

/// Lists the nodes that lay on a sheet and no longer do.
void list_lost(const Generation& before, const Generation& after, const NodeSet& moved, EditReport& report) {
  const Dependents& dependents = before.relations->dependents;
  if (dependents.on_sheets.empty()) return;
  std::vector<std::uint32_t> doubtful;
  auto rest = dependents.on_sheets.begin();
  for (const NodeIndex node : moved) {
    rest = std::lower_bound(rest, dependents.on_sheets.end(), node, [](const NodeOnSheet& r, NodeIndex n) { return r.node < n; });
    if (rest == dependents.on_sheets.end()) break;
    if (rest->node == node) doubtful.push_back(static_cast<std::uint32_t>(rest - dependents.on_sheets.begin()));
  }
  auto by_shell = dependents.on_sheets_by_shell.begin();
  for (const ShellIndex shell : shells_touching(before.model, moved)) {
    by_shell = std::lower_bound(by_shell, dependents.on_sheets_by_shell.end(), shell,
                                [&](std::uint32_t r, ShellIndex s) { return dependents.on_sheets[r].shell < s; });
    for (; by_shell != dependents.on_sheets_by_shell.end() && dependents.on_sheets[*by_shell].shell == shell; ++by_shell)
      doubtful.push_back(*by_shell);
  }
  std::sort(doubtful.begin(), doubtful.end());
  doubtful.erase(std::unique(doubtful.begin(), doubtful.end()), doubtful.end());
  std::size_t carried = 0;
  for (const std::uint32_t r : doubtful) {
    const NodeOnSheet& each = dependents.on_sheets[r];
    const double gap = gap_at(after.model, each);
    if (gap <= each.reach) {
      carried += !each.tied && contains(moved, each.node);
      continue;
    }
    if (gap_at(before.model, each) > each.reach) continue;  // lost before
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
