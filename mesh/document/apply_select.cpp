#include <algorithm>
#include <iterator>

#include "mesh/document/apply.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/edit_targets.h"
#include "mesh/document/flanges.h"
#include "mesh/document/part_marks.h"
#include "mesh/document/selection.h"
#include "mesh/select/region.h"

namespace prismesh::mesh::document {

namespace {

using select::EntityKind;

template <class IndexType>
std::vector<IndexType> combined(const std::vector<IndexType>& a, const std::vector<IndexType>& b, SelectMode mode) {
  std::vector<IndexType> out;
  switch (mode) {
    case SelectMode::set: return b;
    case SelectMode::add: std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(out)); break;
    case SelectMode::subtract: std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(out)); break;
    case SelectMode::intersect: std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(out)); break;
  }
  return out;
}

/// Combines elements with elements; if one side is nodes, combines the nodes of both.
Selection combine(const Model& model, const Selection& old, Selection added, SelectMode mode) {
  if (mode == SelectMode::set) return added;
  const bool nothing_yet = old.nodes.empty();
  const bool as_nodes = added.kind == EntityKind::node || (old.kind == EntityKind::node && !nothing_yet);
  if (as_nodes) return {combined(old.nodes, added.nodes, mode), {}, EntityKind::node};
  // Nodes of a selected part's beams and solids belong to no selected shell; they are combined separately, since a shell that stays
  // keeps all its nodes.
  const auto beyond_shells = [&](const Selection& set) { return combined(set.nodes, nodes_of(model, set.shells), SelectMode::subtract); };
  Selection out;
  out.kind = nothing_yet || old.kind == added.kind ? added.kind : EntityKind::element;
  out.shells = combined(old.shells, added.shells, mode);
  out.nodes = combined(nodes_of(model, out.shells), combined(beyond_shells(old), beyond_shells(added), mode), SelectMode::add);
  return out;
}

void select_into(const Document& document, Selection added, SelectMode mode, Generation& next, EditReport& report) {
  const Selection before = selection_of(document.current());
  const Selection after = combine(next.model, before, std::move(added), mode);
  put_selection(next, before, after);
  if (after.nodes.empty()) report.notes.push_back("nothing is selected now");
}

/// The selection with other shells. Nodes of a selected part's beams and solids, which belong to no shell, stay.
Selection with_shells(const Model& model, const Selection& before, ShellSet shells) {
  const NodeSet beyond = combined(before.nodes, nodes_of(model, before.shells), SelectMode::subtract);
  Selection after{combined(nodes_of(model, shells), beyond, SelectMode::add), {}, EntityKind::element};
  after.shells = std::move(shells);
  return after;
}

bool hidden(const Generation& generation, NodeIndex node) { return (generation.node_marks[node.value] & kHidden) != 0; }

Result<void> need_selection(const Generation& generation, std::string_view edit) {
  if (generation.selected_nodes == 0) return fail("", std::string(edit) + ": nothing is selected");
  return {};
}

}  // namespace

Result<void> apply_edit(const Document& document, const Select& edit, Generation& next, EditReport& report, const Progress& progress) {
  Result<select::Chosen> chosen = select::evaluate(next.model, edit.expr, edit.kind, next.relations->names, progress);
  if (!chosen) return fail(chosen.error());
  Selection added{std::move(chosen->nodes), {}, edit.kind};
  if (edit.kind != EntityKind::node) added.shells = std::move(chosen->shells);
  select_into(document, std::move(added), edit.mode, next, report);
  return {};
}

Result<void> apply_edit(const Document& document, const SelectRegion& edit, Generation& next, EditReport& report) {
  Result<Selection> added = region_at(next, edit);
  if (!added) return fail(added.error());
  select_into(document, std::move(*added), edit.mode, next, report);
  return {};
}

Result<void> apply_edit(const Document& document, const SelectLasso& edit, Generation& next, EditReport& report) {
  Result<NodeSet> nodes = nodes_in_outline(next, edit);
  if (!nodes) return fail(nodes.error());
  select_into(document, {std::move(*nodes), {}, EntityKind::node}, edit.mode, next, report);
  return {};
}

Result<void> apply_edit(const Document& document, const SelectFlange& edit, Generation& next, EditReport& report,
                        const Progress& progress) {
  Result<Selection> added = flange_at(next, edit, progress);
  if (!added) return fail(added.error());
  select_into(document, std::move(*added), edit.mode, next, report);
  return {};
}

Result<void> apply_edit(const Document& document, const Grow& edit, Generation& next, EditReport&) {
  if (const Result<void> some = need_selection(next, "grow"); !some) return some;
  const Selection before = selection_of(document.current());
  const std::vector<std::uint8_t> out_of_sight = hidden_parts(next);
  Selection after{{}, {}, EntityKind::node};
  if (before.kind == EntityKind::node)
    after.nodes = select::grow(next.model, before.nodes, edit.rings, out_of_sight);
  else
    after = with_shells(next.model, before, select::grow_shells(next.model, before.shells, edit.rings, out_of_sight));
  put_selection(next, before, after);
  return {};
}

Result<void> apply_edit(const Document& document, const Shrink& edit, Generation& next, EditReport& report) {
  if (const Result<void> some = need_selection(next, "shrink"); !some) return some;
  const Selection before = selection_of(document.current());
  const std::vector<std::uint8_t> out_of_sight = hidden_parts(next);
  Selection after{{}, {}, EntityKind::node};
  if (before.kind == EntityKind::node)
    after.nodes = select::shrink(next.model, before.nodes, edit.rings, out_of_sight);
  else
    after = with_shells(next.model, before, select::shrink_shells(next.model, before.shells, edit.rings, out_of_sight));
  put_selection(next, before, after);
  if (after.nodes.empty()) report.notes.push_back("nothing is selected now");
  return {};
}

Result<void> apply_edit(const Document& document, const Invert&, Generation& next, EditReport& report) {
  const Selection before = selection_of(document.current());
  Selection after{{}, {}, before.kind == EntityKind::node ? EntityKind::node : EntityKind::element};
  if (before.kind == EntityKind::node) {
    after.nodes = select::invert(next.model, before.nodes);
    std::erase_if(after.nodes, [&](NodeIndex node) { return hidden(next, node); });
  } else {
    const std::vector<std::uint8_t> out_of_sight = hidden_parts(next);
    for (std::size_t s = 0, b = 0; s < next.model.shell_count(); ++s) {
      const bool was = b < before.shells.size() && before.shells[b].value == s;
      if (was) ++b;
      if (!was && in_sight(next.model, ShellIndex(s), out_of_sight)) after.shells.emplace_back(s);
    }
    after.nodes = nodes_of(next.model, after.shells);
  }
  put_selection(next, before, after);
  if (after.nodes.empty()) report.notes.push_back("nothing is selected now");
  return {};
}

}  // namespace prismesh::mesh::document
