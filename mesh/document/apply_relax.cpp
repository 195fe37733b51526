#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <span>

#include "base/counted.h"
#include "base/readable_number.h"
#include "mesh/document/apply.h"
#include "mesh/document/contact_rule.h"
#include "mesh/document/dependents_report.h"
#include "mesh/document/edit_targets.h"
#include "mesh/document/pins.h"
#include "mesh/document/scope.h"
#include "mesh/document/selection.h"
#include "mesh/model/adjacency.h"
#include "mesh/relax/relax.h"

namespace prismesh::mesh::document {

namespace {

constexpr int kTriesOfRing = 3;      ///< after so many the neighbours in one ring more stay
constexpr double kThreshold = 0.15;  ///< of the target size, if the edit has none

Result<void> refuse_unsound(const Relax& edit) {
  const auto positive = [](const std::optional<double>& value) { return !value || (*value > 0 && std::isfinite(*value)); };
  const std::optional<double>& line = edit.max_move.line;  // 0: nodes on feature lines stay
  if (!positive(edit.max_move.free) || (line && !(*line >= 0 && std::isfinite(*line))))
    return fail("", "relax: max_move must be greater than 0, or 0 on lines");
  if (!positive(edit.threshold)) return fail("", "relax: the threshold must be greater than 0");
  if (!(edit.angle > 0 && edit.angle <= 180)) return fail("", "relax: the angle must be above 0 and at most 180 degrees");
  if (edit.mode == RelaxMode::from && !edit.at) return fail("", "relax: mode \"from\" needs \"at\", the node to begin with");
  return {};
}

/// The shells and nodes of the edit's scope, before any are left out.
struct Reach {
  ShellSet shells;
  NodeSet nodes;
};

Result<Reach> find_reach(const Document& document, const Relax& edit) {
  const Generation& current = document.current();
  const bool by_selection = edit.scope == Scope::selection && (edit.mode == RelaxMode::full || current.selected_nodes > 0);
  Result<ShellSet> shells = shells_in(document, by_selection || edit.scope != Scope::selection ? edit.scope : Scope::all, "relax");
  if (!shells) return fail(shells.error());
  Reach reach;
  if (by_selection) {
    reach.nodes = selected_nodes(current);
    reach.shells = shells_touching(current.model, reach.nodes);
    return reach;
  }
  reach.nodes = nodes_of(current.model, *shells);
  if (edit.scope == Scope::damaged || edit.scope == Scope::failed) {
    *shells = shells_touching(current.model, reach.nodes);
    reach.nodes = nodes_of(current.model, *shells);
  }
  reach.shells = std::move(*shells);
  return reach;
}

/// The nodes that may move; notes how many may not.
NodeSet movable_of(const Generation& generation, const NodeSet& nodes, EditReport& report) {
  const Pins pins(generation);
  std::array<std::size_t, kWhyStays.size()> stay{};
  NodeSet movable;
  movable.reserve(nodes.size());
  for (const NodeIndex node : nodes) {
    const Stays why = pins.of(node);
    if (why == Stays::goes)
      movable.push_back(node);
    else
      ++stay[static_cast<std::size_t>(why)];
  }
  for (std::size_t i = 0; i < stay.size(); ++i)
    if (stay[i] > 0)
      report.notes.push_back(counted(stay[i], "node") + " " + std::string(kWhyStays[i]) + (stay[i] == 1 ? " stays" : " stay"));
  return movable;
}

/// The min target size of the parts that meet at a node.
double target_size_at(const Document& document, NodeIndex node) {
  const quality::SizedCriteria criteria = judged_by(document);
  const Model& model = document.current().model;
  double size = std::numeric_limits<double>::infinity();
  for (const ShellIndex shell : model.adjacency->shells_of(node))
    size = std::min(size, criteria.of(model.shell_parts[shell.value]).target_size);
  return std::isfinite(size) ? size : criteria.target_size;
}

void say_how(const relax::Relaxed& relaxed, EditReport& report) {
  if (relaxed.nodes.empty())
    report.notes.push_back("nothing to relax: every node is where it is best");
  else
    report.notes.push_back((relaxed.converged ? "at rest after " : "not yet at rest after ") +
                           counted(static_cast<std::size_t>(relaxed.rounds), "round") + "; the farthest node moved " +
                           readable(relaxed.farthest, 3));
  if (relaxed.held_back > 0)
    report.notes.push_back(counted(relaxed.held_back, "node") + " held back, so that no element becomes worse than it may");
  if (relaxed.limited > 0) report.notes.push_back(counted(relaxed.limited, "node") + " stopped at max_move");
}

/// The nodes that make a contact when they are relaxed; with their neighbours in `rings` rings. Ascending.
NodeSet makers_of(const Model& model, const std::vector<contact::NewContact>& contacts, int rings) {
  ShellSet shells;
  for (const contact::NewContact& contact : contacts) shells.insert(shells.end(), contact.by.begin(), contact.by.end());
  std::sort(shells.begin(), shells.end());
  shells.erase(std::unique(shells.begin(), shells.end()), shells.end());
  for (int ring = 0; ring < rings; ++ring) shells = shells_touching(model, nodes_of(model, shells));
  return nodes_of(model, shells);
}

/// Relaxes under a rule on contact: nodes that would make one stay, and the others are relaxed again, until there is none. Errors: as
/// relaxing; refused.
Result<relax::Relaxed> relax_under(ContactRule rule, const Generation& current, NodeSet movable, EditReport& report,
                                   const std::function<Result<relax::Relaxed>(const NodeSet&)>& relax) {
  Result<relax::Relaxed> relaxed = relax(movable);
  if (rule == ContactRule::allow || !relaxed || relaxed->nodes.empty()) return relaxed;
  const ContactsOf before(current);
  std::string why;
  std::size_t stay = 0;
  for (int tries = 1; relaxed && !relaxed->nodes.empty(); ++tries) {
    Generation trial = current;
    for (std::size_t i = 0; i < relaxed->nodes.size(); ++i) trial.model.positions.set(relaxed->nodes[i].value, relaxed->positions[i]);
    const std::vector<contact::NewContact> found = before.new_in(trial);
    if (found.empty()) break;
    if (rule == ContactRule::refuse) return fail(refused_contact("relax", current.model, found));
    if (why.empty()) why = contact::in_words(current.model, found);
    // Each try holds at least one node more. The rings grow, so that few tries are enough.
    const NodeSet makers = makers_of(current.model, found, tries / kTriesOfRing);
    NodeSet left;
    std::set_difference(movable.begin(), movable.end(), makers.begin(), makers.end(), std::back_inserter(left));
    stay += movable.size() - left.size();
    movable = std::move(left);
    relaxed = relax(movable);
  }
  if (relaxed && stay > 0) report.notes.push_back(counted(stay, "node") + " left in place: " + why);
  return relaxed;
}

void put_positions(const Document& document, const relax::Relaxed& relaxed, Generation& next, EditReport& report) {
  for (std::size_t i = 0; i < relaxed.nodes.size(); ++i) next.model.positions.set(relaxed.nodes[i].value, relaxed.positions[i]);
  const NodeSet followed = let_middles_follow(document.current().model, relaxed.nodes, next);
  NodeSet moved;
  std::set_union(relaxed.nodes.begin(), relaxed.nodes.end(), followed.begin(), followed.end(), std::back_inserter(moved));
  report.nodes_moved = moved.size();
  report.largest_move = largest_move(document.current().model, next.model, moved);
  const ShellSet touched = shells_touching(next.model, relaxed.nodes);
  quality::rejudge(next.model, judged_by(document), touched, next.quality, next.counts);
  update_weight(document.current(), touched, next);
  report_dependents(document.current(), next, moved, report);
}

}  // namespace

Result<void> apply_edit(const Document& document, const Relax& edit, Generation& next, EditReport& report, const Progress& progress) {
  if (const Result<void> sound = refuse_unsound(edit); !sound) return sound;
  const Generation& current = document.current();
  NodeIndex at;
  if (edit.mode == RelaxMode::from) {
    const Result<NodeIndex> found = find_referenced_node(current.model, *edit.at);
    if (!found) return fail("", "relax: " + found.error().message);
    at = *found;
  }
  const Result<Reach> reach = find_reach(document, edit);
  if (!reach) return fail(reach.error());
  const NodeSet movable = movable_of(current, reach->nodes, report);
  if (movable.empty()) {
    report.notes.push_back(!reach->nodes.empty()          ? "nothing to relax: every node in the scope stays"
                           : edit.scope == Scope::damaged ? "nothing to relax: no edit made an element fail or warn"
                                                          : "nothing to relax: no element in the scope");
    return {};
  }
  relax::Options options;
  options.feature_angle = edit.angle;
  options.max_move_on_surface = edit.max_move.free;
  options.max_move_on_line = edit.max_move.line;
  const quality::SizedCriteria criteria = judged_by(document);
  const relax::ReferenceSurface surface = surface_about(current, reach->shells, edit.angle);
  const double threshold = edit.threshold ? *edit.threshold : at.valid() ? kThreshold * target_size_at(document, at) : 0;
  const relax::RelaxInput input{current.model, surface, criteria, options};
  const Result<relax::Relaxed> relaxed =
      relax_under(edit.contact.value_or(ContactRule::allow), current, movable, report, [&](const NodeSet& nodes) {
        return edit.mode == RelaxMode::from ? relax::relax_from(input, {at, threshold}, nodes, progress)
                                            : relax::relax(input, nodes, progress);
      });
  if (!relaxed) return fail(relaxed.error());
  say_how(*relaxed, report);
  put_positions(document, *relaxed, next, report);
  return {};
}

}  // namespace prismesh::mesh::document
