#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/counted.h"
#include "base/readable_number.h"
#include "mesh/contact/separate.h"
#include "mesh/document/apply.h"
#include "mesh/document/contacts.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/dependents_report.h"
#include "mesh/document/history.h"
#include "mesh/document/joined_sheets.h"
#include "mesh/document/pins.h"
#include "mesh/document/selection.h"
#include "mesh/document/separation_setting.h"
#include "mesh/select/expression.h"

namespace prismesh::mesh::document {

namespace {

constexpr std::size_t kMaxNotesOfLeft = 20;
constexpr int kNoteDigits = 3;

Result<void> refuse_unsound(const Separate& edit) {
  const auto sound = [](double value) { return std::isfinite(value) && value >= 0; };
  if (edit.follow != FollowUp::none && edit.gap > 0)
    return fail("", "separate: \"follow\" keeps shells apart by their thicknesses, not by a gap: leave one of the two out");
  if (!sound(edit.gap) || !sound(edit.allowed_depth)) return fail("", "separate: gap and allowed_depth must be at least 0");
  if (edit.max_move && !(sound(*edit.max_move) && *edit.max_move > 0)) return fail("", "separate: max_move must be greater than 0");
  if (edit.direction && !(edit.direction->allFinite() && edit.direction->norm() > 0))
    return fail("", "separate: the direction must not be zero");
  if (edit.kinds.empty()) return fail("", "separate: \"kinds\" names no kind of contact");
  return {};
}

Result<std::optional<ShellSet>> shells_named(const Generation& generation, const std::optional<std::string>& expression,
                                             std::string_view field) {
  if (!expression) return std::optional<ShellSet>();
  Result<select::Chosen> chosen = select::evaluate(generation.model, *expression, select::EntityKind::element, generation.relations->names);
  if (!chosen) return fail("", "separate: \"" + std::string(field) + "\": " + chosen.error().text());
  std::sort(chosen->shells.begin(), chosen->shells.end());
  return std::optional<ShellSet>(std::move(chosen->shells));
}

std::string part_reference(const Model& model, PartIndex part) {
  return part.valid() ? "part:" + std::to_string((*model.parts)[part.value].id) : "";
}

void say_what(const Model& model, const contact::Separation& done, EditReport& report) {
  Separated& separated = report.separated.emplace();
  separated.regions_before = done.regions_before;
  separated.regions_removed = done.removed();
  separated.depth_before = done.depth_before;
  separated.depth_after = done.depth_after;
  separated.largest_move = done.largest_move;
  for (const contact::LeftRegion& left : done.left)
    separated.regions_left.push_back({part_reference(model, left.part_a), part_reference(model, left.part_b), left.why});
  if (done.regions_before == 0) {
    report.notes.push_back("nothing to separate: no shells cross or are too close there");
    return;
  }
  report.notes.push_back("removed " + std::to_string(done.removed()) + " of " + counted(done.regions_before, "region") +
                         "; the greatest depth " + readable(done.depth_before, kNoteDigits) + " -> " +
                         readable(done.depth_after, kNoteDigits) + ", the farthest node moved " + readable(done.largest_move, kNoteDigits));
  const auto with = [](const std::string& part) { return part.empty() ? std::string("no part") : part; };
  for (std::size_t i = 0; i < std::min(separated.regions_left.size(), kMaxNotesOfLeft); ++i) {
    const RegionLeft& left = separated.regions_left[i];
    report.notes.push_back("left " + with(left.a) + " and " + with(left.b) + ": " + left.why);
  }
  if (separated.regions_left.size() > kMaxNotesOfLeft)
    report.notes.push_back(counted(separated.regions_left.size() - kMaxNotesOfLeft, "region") + " more left");
}

void put_positions(const Document& document, const contact::Separation& done, Generation& next, EditReport& report) {
  for (std::size_t i = 0; i < done.nodes.size(); ++i) next.model.positions.set(done.nodes[i].value, done.positions[i]);
  const NodeSet followed = let_middles_follow(document.current().model, done.nodes, next);
  NodeSet moved;
  std::set_union(done.nodes.begin(), done.nodes.end(), followed.begin(), followed.end(), std::back_inserter(moved));
  report.nodes_moved = moved.size();
  report.largest_move = largest_move(document.current().model, next.model, moved);
  next.surface = std::make_shared<const Model>(next.model);
  const ShellSet touched = shells_touching(next.model, done.nodes);
  quality::rejudge(next.model, judged_by(document), touched, next.quality, next.counts);
  update_weight(document.current(), touched, next);
  report_dependents(document.current(), next, moved, report);
}

/// Relaxes or repairs `next` about the nodes that moved, so that it makes no new contact. Errors: as these; cancelled.
Result<void> follow_up(const Document& document, FollowUp follow, const NodeSet& moved, Generation& next, EditReport& report,
                       const Progress& progress) {
  const Selection selected = selection_of(next);
  Selection about;
  about.nodes = follow == FollowUp::relax ? nodes_of(next.model, shells_touching(next.model, moved)) : moved;
  put_selection(next, selected, about);
  const Document separated = with_current(document, std::make_shared<const Generation>(next));
  EditReport more;
  const Progress forward = [&](double fraction) { return !progress || progress(fraction); };  // a stop keeps nothing
  Result<void> done;
  if (follow == FollowUp::relax) {
    Relax edit;
    edit.contact = ContactRule::keep_apart;
    done = document::apply_edit(separated, edit, next, more, forward);
  } else {
    Repair edit;
    edit.scope = Scope::selection;
    edit.contact = ContactRule::keep_apart;
    done = document::apply_edit(separated, edit, next, more, forward);
  }
  if (!done) return done;
  Selection back = selected;
  std::erase_if(back.nodes, [&](NodeIndex node) { return next.model.is_removed(node); });
  std::erase_if(back.shells, [&](ShellIndex shell) { return next.model.is_removed(shell); });
  put_selection(next, selection_of(next), back);
  const NodeSet all = moved_nodes(document.current().model, next.model);
  report.nodes_moved = all.size();
  report.largest_move = largest_move(document.current().model, next.model, all);
  report.elements_added = more.elements_added;
  report.elements_removed = more.elements_removed;
  report.triangle_pairs = more.triangle_pairs;
  report.lost_connections += more.lost_connections;
  report.lost.insert(report.lost.end(), more.lost.begin(), more.lost.end());
  for (const std::string& note : more.notes) report.notes.push_back((follow == FollowUp::relax ? "relaxed: " : "repaired: ") + note);
  return {};
}

}  // namespace

Result<void> apply_edit(const Document& document, const Separate& edit, Generation& next, EditReport& report, const Progress& progress) {
  if (const Result<void> sound = refuse_unsound(edit); !sound) return sound;
  const Generation& current = document.current();
  const Result<std::optional<ShellSet>> on = shells_named(current, edit.on, "on");
  if (!on) return fail(on.error());
  const Result<std::optional<ShellSet>> against = shells_named(current, edit.against, "against");
  if (!against) return fail(against.error());
  const auto has_kind = [&](ContactKind kind) { return std::find(edit.kinds.begin(), edit.kinds.end(), kind) != edit.kinds.end(); };
  contact::SeparationWish wish;
  wish.on = *on ? &**on : nullptr;
  wish.against = *against ? &**against : nullptr;
  if (edit.at) wish.at = Vec3((*edit.at)[0], (*edit.at)[1], (*edit.at)[2]);
  wish.perforations = has_kind(ContactKind::perforation);
  wish.penetrations = has_kind(ContactKind::penetration);
  wish.joined = edit.joined;
  wish.gap = edit.gap;
  wish.move = edit.move;
  wish.direction = edit.direction;
  wish.max_move = edit.max_move;
  wish.allowed_depth = edit.allowed_depth;
  const SeparationSetting setting(document, contact_thickness(current));
  const Result<contact::Separation> done = contact::separate(setting.input(), wish, progress);
  if (!done) return fail(done.error());
  say_what(current.model, *done, report);
  if (done->nodes.empty()) return {};
  put_positions(document, *done, next, report);
  if (edit.follow == FollowUp::none) return {};
  return follow_up(document, edit.follow, done->nodes, next, report, progress);
}

}  // namespace prismesh::mesh::document
