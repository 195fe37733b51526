#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/counted.h"
#include "base/readable_number.h"
#include "mesh/deck/editing/new_ids.h"
#include "mesh/deck/editing/text_changes.h"
#include "mesh/document/apply.h"
#include "mesh/document/connections_kept.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/exchange_relations.h"
#include "mesh/document/part_exchange.h"
#include "mesh/document/read_variant.h"
#include "mesh/document/restructure.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::document {

namespace {

constexpr std::size_t kMaxLostConnections = 100;  ///< that a report lists
constexpr double kMaxTolerance = 12;              ///< in default ones: nine sides of the new shells

/// The part that gets the mesh. Errors: it isn't there, is locked, or has what this version can't exchange.
Result<PartIndex> find_part_to_replace(const Document& document, const ReplacePart& edit) {
  const Generation& now = document.current();
  const Model& model = now.model;
  const std::string words = "part:" + std::to_string(edit.part);
  if (!document.deck->references || document.deck->files.empty()) return fail("", "replace_part: the document has no deck");
  if (document.deck->format != deck::Format::ls_dyna && document.deck->format != deck::Format::radioss)
    return fail("", "replace_part: this version exchanges parts of LS-DYNA and Radioss decks, not of " +
                        std::string(deck::name(document.deck->format)) + " decks");
  const PartIndex part = model.find_part(edit.part);
  if (!part.valid()) return fail("", "replace_part: there is no " + words);
  if ((*now.parts)[part.value].locked) return fail("", "replace_part: " + words + " is locked");
  for (std::size_t c = 1; c < model.elements.size(); ++c)
    if (const auto& block = model.elements[c]; block && std::find(block->part.begin(), block->part.end(), part) != block->part.end())
      return fail("", "replace_part: " + words + " has elements that are no shells (" + std::string(name(static_cast<ElementClass>(c))) +
                          "); this version exchanges shells alone");
  bool has_shells = false;
  for (std::size_t s = 0; s < model.shell_count() && !has_shells; ++s)
    has_shells = model.shell_parts[s] == part && !model.is_removed(ShellIndex(s));
  if (!has_shells) return fail("", "replace_part: " + words + " has no shells");
  for (const MidsideNodes& midside : *model.midside)
    if (model.shell_parts[midside.shell.value] == part && !model.is_removed(midside.shell))
      return fail("", "replace_part: " + words + " has shells with mid-side nodes, which this version can't exchange");
  return part;
}

/// Errors: a shell has a node that the mesh doesn't bring, or has one twice; a number is given twice; a place is no number.
Result<void> check_mesh(const VariantMesh& mesh) {
  std::unordered_set<std::int64_t> ids;
  for (const VariantMesh::Node& node : mesh.nodes) {
    if (!ids.insert(node.id).second) return fail("", "replace_part: the mesh has the node " + std::to_string(node.id) + " twice");
    for (const double each : node.at)
      if (!std::isfinite(each))
        return fail("", "replace_part: the mesh has the node " + std::to_string(node.id) + " at a place that is no number");
  }
  for (const VariantMesh::Shell& shell : mesh.shells)
    for (std::size_t c = 0; c < 4; ++c) {
      const std::string words = "shell " + std::to_string(shell.id) + " of the mesh has the node " + std::to_string(shell.node[c]);
      if (!ids.contains(shell.node[c])) return fail("", "replace_part: " + words + ", which it doesn't bring");
      for (std::size_t d = 0; d < c; ++d)
        if (shell.node[c] == shell.node[d] && !(c == 3 && d == 2)) return fail("", "replace_part: " + words + " twice");
    }
  return {};
}

/// New numbers where those of the variant couldn't be kept.
struct Renumbered {
  std::size_t count = 0;
  std::string first;

  void note(std::int64_t from, std::int64_t to) {
    if (count++ == 0) first = std::to_string(from) + " became " + std::to_string(to);
  }
};

class PartExchanger {
 public:
  PartExchanger(const Document& document, const VariantMesh& mesh, const PartExchange& plan, Model& model)
      : mesh_(mesh), plan_(plan), model_(model), ids_(*document.deck, model) {}

  /// Errors: no ids are left.
  Result<void> exchange() {
    if (const Result<void> added = add_nodes(); !added) return added;
    if (const Result<void> added = add_shells(); !added) return added;
    for (const ShellIndex shell : plan_.removed_shells) remove_shell(model_, shell);
    for (const NodeIndex node : plan_.removed_nodes) remove_node(model_, node);
    return {};
  }
  NodeIndex node_of(std::int64_t id) const { return node_of_.at(id); }
  const Renumbered& nodes_renumbered() const { return nodes_renumbered_; }
  const Renumbered& shells_renumbered() const { return shells_renumbered_; }

 private:
  Result<void> add_nodes() {
    // The variant's numbers first, so that no new one takes them.
    std::vector<std::int64_t> ids(mesh_.nodes.size(), 0);
    for (std::size_t n = 0; n < ids.size(); ++n) {
      if (plan_.node[n].valid()) continue;
      const Result<bool> taken = ids_.take_node(plan_.origin[n], mesh_.nodes[n].id);
      if (!taken) return fail(taken.error());
      if (*taken) ids[n] = mesh_.nodes[n].id;
    }
    for (std::size_t n = 0; n < ids.size(); ++n) {
      NodeIndex node = plan_.node[n];
      const std::array<double, 3>& at = mesh_.nodes[n].at;
      const Vec3 place(at[0], at[1], at[2]);
      if (node.valid()) {
        if (plan_.keeps_place[n] == 0) model_.positions.set(node.value, place);
      } else {
        if (ids[n] == 0) {
          const Result<std::int64_t> id = ids_.node(plan_.origin[n]);
          if (!id) return fail(id.error());
          ids[n] = *id;
        }
        node = add_node(model_, ids[n], place, plan_.origin[n]);
      }
      if (model_.node_ids[node.value] != mesh_.nodes[n].id) nodes_renumbered_.note(mesh_.nodes[n].id, model_.node_ids[node.value]);
      node_of_[mesh_.nodes[n].id] = node;
    }
    return {};
  }

  Result<void> add_shells() {
    std::vector<std::int64_t> ids(mesh_.shells.size(), 0);
    for (std::size_t s = 0; s < ids.size(); ++s) {
      if (plan_.shell[s].valid()) continue;
      const Result<bool> taken = ids_.take_shell(plan_.parent[s], mesh_.shells[s].id);
      if (!taken) return fail(taken.error());
      if (*taken) ids[s] = mesh_.shells[s].id;
    }
    for (std::size_t s = 0; s < ids.size(); ++s) {
      ShellNodes nodes;
      for (std::size_t c = 0; c < 4; ++c) nodes.node[c] = node_of_.at(mesh_.shells[s].node[c]);
      ShellIndex shell = plan_.shell[s];
      if (shell.valid()) {
        set_shell_nodes(model_, shell, nodes);
      } else {
        if (ids[s] == 0) {
          const Result<std::int64_t> id = ids_.shell(plan_.parent[s]);
          if (!id) return fail(id.error());
          ids[s] = *id;
        }
        shell = add_shell(model_, ids[s], nodes, plan_.parent[s]);
      }
      if (model_.shell_ids[shell.value] != mesh_.shells[s].id) shells_renumbered_.note(mesh_.shells[s].id, model_.shell_ids[shell.value]);
    }
    return {};
  }

  const VariantMesh& mesh_;
  const PartExchange& plan_;
  Model& model_;
  deck::NewIds ids_;
  std::unordered_map<std::int64_t, NodeIndex> node_of_;
  Renumbered nodes_renumbered_, shells_renumbered_;
};

void note_numbers(const PartExchanger& exchanger, const PartExchange& plan, EditReport& report) {
  if (plan.joined_by_elements > 0)
    report.notes.push_back(counted(plan.joined_by_elements, "node") + " of other parts and elements joined to the new mesh");
  if (plan.joined_by_cards > 0)
    report.notes.push_back(counted(plan.joined_by_cards, "node") + " that cards name joined to the new mesh, with the deck's numbers");
  if (const Renumbered& nodes = exchanger.nodes_renumbered(); nodes.count > 0)
    report.notes.push_back(counted(nodes.count, "node") + " couldn't keep the variant's numbers; the first: " + nodes.first);
  if (const Renumbered& shells = exchanger.shells_renumbered(); shells.count > 0)
    report.notes.push_back(counted(shells.count, "shell") + " couldn't keep the variant's numbers; the first: " + shells.first);
}

/// Lists what isn't connected any more.
void list_loose(const Generation& before, const Generation& next, const PartExchange& plan, const std::vector<NodeOnSheet>& off_sheets,
                double tolerance, const std::string& part, const std::function<NodeIndex(std::size_t)>& node_of, EditReport& report) {
  const Model& model = before.model;
  const auto add = [&](std::string words) {
    if (++report.lost_connections <= kMaxLostConnections) report.lost.push_back(std::move(words));
  };
  for (const LostNode& each : plan.lost)
    add("node:" + std::to_string(model.node_ids[each.node.value]) + ", which " + each.user + (each.by_element ? " has" : " names") +
        ", is no longer connected: the nearest new node is " + readable(each.nearest, 3) + " away, " +
        (each.nearest > tolerance ? "more than " + readable(tolerance, 3) : std::string("and has the place of another")));
  for (const NodeBetween& each : plan.between)
    add("node:" + std::to_string(next.model.node_ids[node_of(each.node).value]) + " lies between node:" +
        std::to_string(model.node_ids[each.ends[0].value]) + " and node:" + std::to_string(model.node_ids[each.ends[1].value]) + " of " +
        (each.part.valid() ? "part:" + std::to_string((*model.parts)[each.part.value].id) : std::string("another shell")) +
        ", which doesn't have it");
  for (const ShellIndex each : plan.lost_segments)
    add("the segment at shell:" + std::to_string(model.shell_ids[each.value]) + " is gone: no new shell has its centre on it");
  for (const NodeOnSheet& each : off_sheets) {
    const std::string name_of_node = "node:" + std::to_string(model.node_ids[each.node.value]);
    const std::string what = each.tied
                                 ? name_of_node + ", which " + card_of(*before.relations, each.of) + " ties,"
                                 : std::string(name(each.element_class)) + ":" +
                                       std::to_string(next.model.elements[static_cast<std::size_t>(each.element_class)]->id[each.of]) +
                                       " at " + name_of_node;
    add(what + " no longer lies on " + part);
  }
  if (report.lost_connections > 0)
    report.notes.push_back(counted(report.lost_connections, "connection") + " lost: " + report.lost.front() +
                           (report.lost_connections > 1 ? ", ..." : ""));
}

}  // namespace

Result<void> apply_edit(const Document& document, const ReplacePart& edit, Generation& next, EditReport& report, const Progress& progress) {
  const Generation& before = document.current();
  const Result<PartIndex> part = find_part_to_replace(document, edit);
  if (!part) return fail(part.error());
  const Result<ReplacePart> whole = with_mesh(document, edit, progress);
  if (!whole) return fail(whole.error());
  VariantMesh mesh = *whole->mesh;
  if (const Result<void> sound = check_mesh(mesh); !sound) return sound;
  if (const Result<void> aligned = align_mesh(before.model, whole->align, mesh); !aligned) return aligned;
  const double usual = default_tolerance(mesh), tolerance = edit.tolerance.value_or(usual);
  if (!(usual > 0) || !std::isfinite(usual)) return fail("", "replace_part: the variant's shells have no size");
  if (tolerance > kMaxTolerance * usual)
    return fail("", "replace_part: the tolerance, " + readable(tolerance, 4) + ", may be " + readable(kMaxTolerance * usual, 4) +
                        " at most for shells of this size: farther away lie other places");

  const PartExchange plan = plan_exchange(document, *part, mesh, tolerance);
  PartExchanger exchanger(document, mesh, plan, next.model);
  if (const Result<void> done = exchanger.exchange(); !done) return done;
  const NodeSet moved = moved_nodes(before.model, next.model);
  NodeSet moved_of_opened;
  for (const NodeIndex node : moved)
    if (node.value < document.opened->model.node_count()) moved_of_opened.push_back(node);
  if (const Result<void> may = deck::can_restructure(*document.deck, document.opened->model, next.model, moved_of_opened); !may) return may;
  finish_restructuring(document, next, report);
  const std::vector<NodeOnSheet> off_sheets = exchange_relations(before.model, next);
  next.surface = std::make_shared<const Model>(next.model);

  const std::size_t stay = static_cast<std::size_t>(std::ranges::count_if(plan.lost, &LostNode::stays));
  report.nodes_moved = 0;  // a node that keeps its number isn't the same place any more
  report.largest_move.reset();
  report.elements_added = mesh.shells.size();
  report.elements_removed = plan.old_shells.size();
  report.notes.push_back("part:" + std::to_string(edit.part) + " got the mesh of part " + std::to_string(whole->with.value_or(0)) + " of " +
                         std::filesystem::path(edit.deck).filename().string() + ": " + counted(mesh.nodes.size(), "node") + " and " +
                         counted(mesh.shells.size(), "shell") + " in place of " + counted(plan.old_shells.size(), "shell"));
  if (const std::optional<double> own = (*before.model.parts)[part->value].thickness; own && mesh.thickness && *own != *mesh.thickness)
    report.notes.push_back("its section stays: it is " + readable(*own, 4) + " thick, the variant is " + readable(*mesh.thickness, 4));
  note_numbers(exchanger, plan, report);
  report.notes.insert(report.notes.end(), plan.notes.begin(), plan.notes.end());
  if (stay > 0) report.notes.push_back(counted(stay, "node") + " of the old mesh stay, since other elements or cards have them");
  const auto node_of = [&](std::size_t n) { return exchanger.node_of(mesh.nodes[n].id); };
  list_loose(before, next, plan, off_sheets, tolerance, "part:" + std::to_string(edit.part), node_of, report);
  return {};
}

}  // namespace prismesh::mesh::document
