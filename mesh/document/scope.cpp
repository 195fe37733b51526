#include "mesh/document/scope.h"

#include <algorithm>

#include "mesh/document/damage.h"
#include "mesh/document/selection.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::document {

namespace {

constexpr int kRingsAboutScope = 4;  ///< around the scope: its neighbours may change with it

ShellSet failing(const Generation& generation) {
  ShellSet shells;
  for (std::size_t c = 0; c < generation.quality.chunk_count(); ++c) {
    const std::span<const quality::ShellState> states = generation.quality.chunk(c);
    for (std::size_t i = 0; i < states.size(); ++i) {
      const ShellIndex shell(c * kChunkSize + i);
      if (states[i].grade() == quality::Grade::fail && !generation.model.is_removed(shell)) shells.push_back(shell);
    }
  }
  return shells;
}

ShellSet of_parts(const Model& model, const ShellSet& of) {
  std::vector<std::uint8_t> wanted(model.parts->size(), 0);
  for (const ShellIndex shell : of)
    if (const PartIndex part = model.shell_parts[shell.value]; part.valid()) wanted[part.value] = 1;
  ShellSet shells;
  for (std::size_t s = 0; s < model.shell_count(); ++s)
    if (const PartIndex part = model.shell_parts[s]; part.valid() && wanted[part.value] != 0 && !model.is_removed(ShellIndex(s)))
      shells.emplace_back(s);
  return shells;
}

ShellSet selected(const Generation& generation) {
  if (generation.selection_kind != select::EntityKind::node) return selected_shells(generation);
  return shells_touching(generation.model, selected_nodes(generation));
}

/// The shell of an earlier model that a shell descends from, or the shell itself.
ShellIndex ancestor_in(const Model& earlier, const Model& model, ShellIndex shell) {
  while (shell.value >= earlier.shell_count())
    shell = model.topology_change->shell_parents[shell.value - model.topology_change->deck_shells];
  return shell;
}

}  // namespace

Result<ShellSet> shells_in(const Document& document, Scope scope, std::string_view edit) {
  const Generation& current = document.current();
  switch (scope) {
    case Scope::damaged: return damaged_shells(document);
    case Scope::failed: return failing(current);
    case Scope::all: {
      ShellSet shells;
      for (std::size_t s = 0; s < current.model.shell_count(); ++s)
        if (!current.model.is_removed(ShellIndex(s))) shells.emplace_back(s);
      return shells;
    }
    case Scope::selection:
    case Scope::part: break;
  }
  const ShellSet shells = selected(current);
  if (shells.empty())
    return fail("", std::string(edit) + ": " + (current.selected_nodes == 0 ? "nothing is selected" : "no shell is at what is selected"));
  return scope == Scope::part ? of_parts(current.model, shells) : shells;
}

relax::ReferenceSurface surface_about(const Generation& generation, const ShellSet& shells, double feature_angle) {
  const Model& surface = *generation.surface;
  ShellSet about;
  about.reserve(shells.size());
  for (const ShellIndex shell : shells)
    if (const ShellIndex there = ancestor_in(surface, generation.model, shell); !surface.is_removed(there)) about.push_back(there);
  std::sort(about.begin(), about.end());
  about.erase(std::unique(about.begin(), about.end()), about.end());
  for (int ring = 0; ring < kRingsAboutScope && about.size() < live_shells(surface); ++ring)
    about = shells_touching(surface, nodes_of(surface, about));
  return relax::ReferenceSurface(surface, about, feature_angle);
}

}  // namespace prismesh::mesh::document
