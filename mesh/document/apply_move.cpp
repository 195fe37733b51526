#include <algorithm>
#include <array>
#include <optional>

#include "base/counted.h"
#include "base/readable_number.h"
#include "mesh/document/apply.h"
#include "mesh/document/contact_rule.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/dependents_report.h"
#include "mesh/document/edit_kinds.h"
#include "mesh/document/inverted_shells.h"
#include "mesh/document/plan_motion.h"

namespace prismesh::mesh::document {

namespace {

constexpr int kDigitsOfShare = 3;

/// Writes the positions that differ; returns the nodes that moved.
NodeSet put_positions(const NodeSet& nodes, const std::vector<Vec3>& positions, ChunkedArray<Vec3>& into) {
  NodeSet moved;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (into[nodes[i].value] != positions[i]) {
      moved.push_back(nodes[i]);
      into.set(nodes[i].value, positions[i]);
    }
  return moved;
}

/// Notes how many elements of each other class moved at shared nodes.
void note_attached(const std::vector<ElementUse>& element_uses, const NodeSet& moved, EditReport& report) {
  std::array<std::vector<std::uint32_t>, kElementClassCount> elements;
  auto use = element_uses.begin();
  for (const NodeIndex node : moved) {
    use = std::lower_bound(use, element_uses.end(), node, [](const ElementUse& u, NodeIndex n) { return u.node < n; });
    for (; use != element_uses.end() && use->node == node; ++use)
      elements[static_cast<std::size_t>(use->element_class)].push_back(use->element);
  }
  for (int c = 0; c < kElementClassCount; ++c) {
    auto& of_class = elements[static_cast<std::size_t>(c)];
    std::sort(of_class.begin(), of_class.end());
    of_class.erase(std::unique(of_class.begin(), of_class.end()), of_class.end());
    if (of_class.empty()) continue;
    std::string noun(mesh::name(static_cast<ElementClass>(c)));
    if (static_cast<ElementClass>(c) == ElementClass::other || static_cast<ElementClass>(c) == ElementClass::discrete) noun += " element";
    report.notes.push_back(counted(of_class.size(), noun) + " moved along at shared nodes");
  }
}

/// `inverted`: shells of `model`.
void report_inverted(const Model& model, const ShellSet& inverted, EditReport& report) {
  report.inverted = inverted.size();
  if (inverted.empty()) return;
  std::string note =
      counted(inverted.size(), "element") + " turned over or folded: shell:" + std::to_string(model.shell_ids[inverted[0].value]);
  for (std::size_t i = 1; i < std::min<std::size_t>(inverted.size(), 5); ++i)
    note += ", shell:" + std::to_string(model.shell_ids[inverted[i].value]);
  report.notes.push_back(note + (inverted.size() > 5 ? ", ..." : ""));
}

/// Notes what "free_ends": "weighted" would do otherwise: scripts of earlier versions rely on it.
void note_free_endings(const Model& model, const Motion& motion, EditReport& report) {
  const auto id = [&](NodeIndex node) { return "node:" + std::to_string(model.node_ids[node.value]); };
  if (motion.free_ending > 0)
    report.notes.push_back(counted(motion.free_ending, "node") +
                           " of a free ending moved by the whole displacement; \"free_ends\": \"weighted\" weights them by distance");
  if (!motion.other_edge.valid()) return;
  if (motion.edge.valid())
    report.notes.push_back("the origin is the free edge at " + id(motion.edge) + ", not the nearest one, at " + id(motion.other_edge) +
                           "; \"origin_at\" chooses another");
  else
    report.notes.push_back("the origin is only what lies beyond the grab: the free edge at " + id(motion.other_edge) +
                           " begins at the rim; \"origin\": \"free_edge\" takes all of it");
}

/// Puts the positions, as far as the edit's rule on contact lets it go.
Result<AllowedWay> go(const Generation& current, const Motion& motion, const Edit& edit, std::vector<Vec3>& positions, EditReport& report) {
  const ContactRule rule = shaping_of(edit)->contact.value_or(ContactRule::allow);
  std::optional<ContactsOf> before;
  if (rule != ContactRule::allow) before.emplace(current);
  AllowedWay way = positions_under(rule, before ? &*before : nullptr, motion, displacement_of(edit), positions);
  if (way.ahead.empty()) return way;
  const std::string_view edit_name = name(edit);
  if (rule == ContactRule::refuse) return fail(refused_contact(edit_name, current.model, way.ahead));
  const std::string why = contact::in_words(current.model, way.ahead);
  if (way.share == 0) return fail("", std::string(edit_name) + ": no share of the way is free: " + why);
  report.notes.push_back("stopped at " + readable(100 * way.share, kDigitsOfShare) + " % of the way: farther on, " + why);
  return way;
}

Result<void> move(const Document& document, const Edit& edit, Generation& next, EditReport& report) {
  const Result<Motion> motion = plan_motion(document.current(), edit, document.deck.get());
  if (!motion) return fail(motion.error());
  std::vector<Vec3> positions(motion->nodes.size());
  const Result<AllowedWay> way = go(document.current(), *motion, edit, positions, report);
  if (!way) return fail(way.error());
  for (const Vec3& position : positions)
    if (!position.allFinite()) return fail("", std::string(name(edit)) + ": the displacement is too large to be a coordinate");
  const NodeSet moved = put_positions(motion->nodes, positions, next.model.positions);
  report.nodes_moved = moved.size();
  report.largest_move = largest_move(document.current().model, next.model, moved);
  next.surface = std::make_shared<const Model>(next.model);
  const ShellSet touched = shells_touching(next.model, moved);
  quality::rejudge(next.model, judged_by(document), touched, next.quality, next.counts);
  update_weight(document.current(), touched, next);
  if (motion->unreached > 0)
    report.notes.push_back(counted(motion->unreached, "node") + " can't be reached from the grab along what is moved; left in place");
  note_free_endings(next.model, *motion, report);
  if (motion->without_image > 0)
    report.notes.push_back(counted(motion->without_image, "node") + " without an image on the other side of the plane of symmetry");
  if (way->held_back > 0) report.notes.push_back(counted(way->held_back, "node") + " held back by max_move");
  note_attached(document.current().relations->element_uses, moved, report);
  report_dependents(document.current(), next, moved, report);
  const Model& before = document.current().model;
  report_inverted(before, inverted_shells(before, next.model, touched, *motion, way->share * displacement_of(edit).degrees), report);
  return {};
}

}  // namespace

void update_weight(const Generation& before, const ShellSet& shells, Generation& next) {
  next.weight -= quality::mass_properties(before.model, shells);
  next.weight += quality::mass_properties(next.model, shells);
}

Result<void> apply_edit(const Document& document, const Translate& edit, Generation& next, EditReport& report) {
  return move(document, edit, next, report);
}

Result<void> apply_edit(const Document& document, const Lift& edit, Generation& next, EditReport& report) {
  return move(document, edit, next, report);
}

Result<void> apply_edit(const Document& document, const Slide& edit, Generation& next, EditReport& report) {
  return move(document, edit, next, report);
}

Result<void> apply_edit(const Document& document, const Rotate& edit, Generation& next, EditReport& report) {
  return move(document, edit, next, report);
}

Result<void> apply_edit(const Document& document, const Move& edit, Generation& next, EditReport& report) {
  return move(document, edit, next, report);
}

}  // namespace prismesh::mesh::document
