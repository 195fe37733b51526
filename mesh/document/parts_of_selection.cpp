#include "mesh/document/parts_of_selection.h"

#include "mesh/document/deck_relations.h"
#include "mesh/document/selection.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::document {

namespace {

void flag_parts_of(const Model& model, const ShellSet& shells, PartFlags& flags) {
  for (const ShellIndex shell : shells)
    if (const PartIndex part = model.shell_parts[shell.value]; part.valid()) flags[part.value] = 1;
}

}  // namespace

PartFlags parts_of_selection(const Document& document) {
  const Generation& current = document.current();
  const Model& model = current.model;
  PartFlags flags(model.parts->size(), 0);
  const Selection selected = selection_of(current);
  if (selected.kind != select::EntityKind::node) {
    flag_parts_of(model, selected.shells, flags);
    return flags;
  }
  const ShellSet inside = shells_inside(model, selected.nodes);
  flag_parts_of(model, inside.empty() ? shells_touching(model, selected.nodes) : inside, flags);
  for (const NodeIndex node : selected.nodes) {
    if (!model.adjacency->shells_of(node).empty()) continue;
    for (const ElementUse& use : uses_at(*current.relations, node)) {
      const PartIndex part = model.elements[static_cast<std::size_t>(use.element_class)]->part[use.element];
      if (part.valid()) flags[part.value] = 1;
    }
  }
  return flags;
}

}  // namespace prismesh::mesh::document
