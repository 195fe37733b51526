#include "mesh/document/connections_kept.h"

#include <algorithm>
#include <limits>

#include "base/readable_number.h"
#include "mesh/deck/editing/names.h"
#include "mesh/document/deck_relations.h"
#include "mesh/spatial/closest_point.h"

namespace prismesh::mesh::document {

namespace {

constexpr int kRingsSearched = 4;  ///< max distance along its sheet at which a node is still found

/// The shells around one, by rings over shared nodes.
ShellSet around(const Model& model, ShellIndex shell) {
  ShellSet shells{shell};
  for (int ring = 0; ring < kRingsSearched; ++ring) shells = shells_touching(model, nodes_of(model, shells));
  return shells;
}

/// Three digits are enough for a gap.
std::string short_length(double length) { return readable(length, 3); }

}  // namespace

std::string card_of(const DeckRelations& relations, std::uint32_t referrer) {
  return deck::card_name(relations.deck->format, relations.deck->references->referrers()[referrer]);
}

/// Checks the shell alone first.
double gap_from_sheet(const Model& model, const NodeOnSheet& rest) {
  if (model.is_removed(rest.node) || model.is_removed(rest.shell)) return 0;  // there is no connection to lose
  const Vec3& point = model.position(rest.node);
  const auto distance = [&](const ShellSet& shells) {
    const auto on = spatial::ShellTree(model, shells).closest(point);
    return on ? on->distance : std::numeric_limits<double>::infinity();
  };
  const double close = distance({rest.shell});
  return close <= rest.reach ? close : std::min(close, distance(around(model, rest.shell)));
}

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

std::vector<std::uint32_t> doubtful_connections(const Dependents& dependents, const Model& model, const NodeSet& moved) {
  std::vector<std::uint32_t> doubtful;
  auto rest = dependents.on_sheets.begin();
  for (const NodeIndex node : moved) {
    rest = std::lower_bound(rest, dependents.on_sheets.end(), node, [](const NodeOnSheet& r, NodeIndex n) { return r.node < n; });
    if (rest == dependents.on_sheets.end()) break;
    if (rest->node == node) doubtful.push_back(static_cast<std::uint32_t>(rest - dependents.on_sheets.begin()));
  }
  auto by_shell = dependents.on_sheets_by_shell.begin();
  for (const ShellIndex shell : shells_touching(model, moved)) {
    by_shell = std::lower_bound(by_shell, dependents.on_sheets_by_shell.end(), shell,
                                [&](std::uint32_t r, ShellIndex s) { return dependents.on_sheets[r].shell < s; });
    for (; by_shell != dependents.on_sheets_by_shell.end() && dependents.on_sheets[*by_shell].shell == shell; ++by_shell)
      doubtful.push_back(*by_shell);
  }
  std::sort(doubtful.begin(), doubtful.end());
  doubtful.erase(std::unique(doubtful.begin(), doubtful.end()), doubtful.end());
  return doubtful;
}

}  // namespace prismesh::mesh::document
