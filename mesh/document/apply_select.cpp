#include <algorithm>
#include <iterator>

#include "mesh/document/apply.h"
#include "mesh/document/selecting.h"
#include "mesh/select/region.h"

namespace prismesh::mesh::document {

namespace {

using select::Kind;

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

/// Elements meet elements as elements; as soon as one side is nodes, nodes meet nodes.
Picked combine(const Model& model, const Picked& old, Picked added, SelectMode mode) {
  if (mode == SelectMode::set) return added;
  const bool nothing_yet = old.nodes.empty();
  const bool as_nodes = added.kind == Kind::node || (old.kind == Kind::node && !nothing_yet);
  if (as_nodes) return {combined(old.nodes, added.nodes, mode), {}, Kind::node};
  // Nodes of a selected part's beams and solids belong to no selected shell; they are combined by themselves, since a shell that
  // stays keeps all its nodes.
  const auto beyond_shells = [&](const Picked& set) { return combined(set.nodes, nodes_of(model, set.shells), SelectMode::subtract); };
  Picked out;
  out.kind = nothing_yet || old.kind == added.kind ? added.kind : Kind::element;
  out.shells = combined(old.shells, added.shells, mode);
  out.nodes = combined(nodes_of(model, out.shells), combined(beyond_shells(old), beyond_shells(added), mode), SelectMode::add);
  return out;
}

void select_into(const Document& document, Picked added, SelectMode mode, Generation& next, EditReport& report) {
  const Picked before = picked(document.current());
  const Picked after = combine(next.model, before, std::move(added), mode);
  put_selection(next, before, after);
  if (after.nodes.empty()) report.notes.push_back("nothing is selected now");
}

/// The selection with its nodes replaced; elements stay those whose nodes are all in.
Picked follow_nodes(const Model& model, const Picked& before, NodeSet nodes) {
  if (before.kind == Kind::node) return {std::move(nodes), {}, Kind::node};
  Picked after{{}, shells_inside(model, nodes), Kind::element};
  after.nodes = nodes_of(model, after.shells);
  return after;
}

bool hidden(const Generation& generation, NodeIndex node) { return (generation.node_marks[node.value] & kHidden) != 0; }

bool in_hidden_part(const Generation& generation, ShellIndex shell) {
  const PartIndex part = generation.model.shell_parts[shell.value];
  return part.valid() && (*generation.parts)[part.value].hidden;
}

Result<void> need_selection(const Generation& generation, std::string_view edit) {
  if (generation.selected_nodes == 0) return fail("", std::string(edit) + ": nothing is selected");
  return {};
}

}  // namespace

Result<void> apply_edit(const Document& document, const Select& edit, Generation& next, EditReport& report) {
  Result<select::Chosen> chosen = select::evaluate(next.model, edit.expr, edit.kind);
  if (!chosen) return fail(chosen.error());
  Picked added{std::move(chosen->nodes), {}, edit.kind};
  if (edit.kind != Kind::node) added.shells = std::move(chosen->shells);
  select_into(document, std::move(added), edit.mode, next, report);
  return {};
}

Result<void> apply_edit(const Document& document, const SelectRegion& edit, Generation& next, EditReport& report) {
  Result<ShellSet> shells = visible_region(next, edit);
  if (!shells) return fail(shells.error());
  Picked added{nodes_of(next.model, *shells), std::move(*shells), Kind::element};
  select_into(document, std::move(added), edit.mode, next, report);
  return {};
}

Result<void> apply_edit(const Document& document, const SelectLasso& edit, Generation& next, EditReport& report) {
  Result<NodeSet> nodes = visible_in_outline(next, edit);
  if (!nodes) return fail(nodes.error());
  select_into(document, {std::move(*nodes), {}, Kind::node}, edit.mode, next, report);
  return {};
}

Result<void> apply_edit(const Document& document, const Grow& edit, Generation& next, EditReport&) {
  if (const Result<void> some = need_selection(next, "grow"); !some) return some;
  const Picked before = picked(document.current());
  Picked after{{}, {}, before.kind == Kind::node ? Kind::node : Kind::element};
  if (before.kind == Kind::node) {
    NodeSet grown = select::grow(next.model, before.nodes, edit.rings);
    std::erase_if(grown, [&](NodeIndex node) { return hidden(next, node); });
    after.nodes = combined(before.nodes, grown, SelectMode::add);
  } else {
    after.nodes = before.nodes;
    after.shells = before.shells;
    for (int ring = 0; ring < edit.rings; ++ring) {
      ShellSet around = shells_touching(next.model, after.nodes);
      std::erase_if(around, [&](ShellIndex shell) { return in_hidden_part(next, shell); });
      ShellSet grown = combined(after.shells, around, SelectMode::add);
      if (grown.size() == after.shells.size()) break;
      after.shells = std::move(grown);
      after.nodes = nodes_of(next.model, after.shells);
    }
  }
  put_selection(next, before, after);
  return {};
}

Result<void> apply_edit(const Document& document, const Shrink& edit, Generation& next, EditReport& report) {
  if (const Result<void> some = need_selection(next, "shrink"); !some) return some;
  const Picked before = picked(document.current());
  const Picked after = follow_nodes(next.model, before, select::shrink(next.model, before.nodes, edit.rings));
  put_selection(next, before, after);
  if (after.nodes.empty()) report.notes.push_back("nothing is selected now");
  return {};
}

Result<void> apply_edit(const Document& document, const Invert&, Generation& next, EditReport& report) {
  const Picked before = picked(document.current());
  Picked after{{}, {}, before.kind == Kind::node ? Kind::node : Kind::element};
  if (before.kind == Kind::node) {
    after.nodes = select::invert(next.model, before.nodes);
    std::erase_if(after.nodes, [&](NodeIndex node) { return hidden(next, node); });
  } else {
    for (std::size_t s = 0, b = 0; s < next.model.shell_count(); ++s) {
      const bool was = b < before.shells.size() && before.shells[b].value == s;
      if (was) ++b;
      if (!was && !in_hidden_part(next, ShellIndex(s))) after.shells.emplace_back(s);
    }
    after.nodes = nodes_of(next.model, after.shells);
  }
  put_selection(next, before, after);
  if (after.nodes.empty()) report.notes.push_back("nothing is selected now");
  return {};
}

}  // namespace prismesh::mesh::document
