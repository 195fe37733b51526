#include "mesh/repair/change_history.h"

#include <algorithm>

#include "mesh/repair/acceptance.h"

namespace prismesh::mesh::repair {

bool is_in_scope(const ChangeHistory& history, LocalShell shell) {
  return shell.value >= history.in_scope.size() || history.in_scope[shell.value] != 0;
}

bool was_bad(const ChangeHistory& history, LocalShell shell) {
  return shell.value < history.was_bad.size() && history.was_bad[shell.value] != 0;
}

bool is_changed(const Patch& patch, const ChangeHistory& history, LocalShell shell) {
  return !patch.shell(shell).model.valid() || last_change(history, shell) != 0 ||
         (shell.value < history.is_moved.size() && history.is_moved[shell.value] != 0);
}

bool is_reshaped(const Patch& patch, const ChangeHistory& history, LocalShell shell) {
  return !patch.shell(shell).model.valid() || (shell.value < history.is_reshaped.size() && history.is_reshaped[shell.value] != 0);
}

std::uint32_t last_change(const ChangeHistory& history, LocalShell shell) {
  return shell.value < history.last_change.size() ? history.last_change[shell.value] : 0;
}

bool changed_nearby(const Patch& patch, const ChangeHistory& history, LocalShell shell, std::uint32_t since) {
  for (const LocalNode corner : patch.shell(shell).corners)
    for (const LocalShell near : patch.node(corner).shells)
      for (const LocalNode node : patch.shell(near).corners)
        for (const LocalShell other : patch.node(node).shells)
          if (last_change(history, other) > since) return true;
  return false;
}

std::vector<LocalShell> bad_shells(const Patch& patch, const ChangeHistory& history, quality::Grade min_grade) {
  std::vector<LocalShell> bad;
  for (std::size_t s = 0; s < patch.shell_count(); ++s) {
    const PatchShell& shell = patch.shell(LocalShell(s));
    if (shell.is_alive && shell.state.grade() >= min_grade && is_in_scope(history, LocalShell(s))) bad.push_back(LocalShell(s));
  }
  std::stable_sort(bad.begin(), bad.end(), [&](LocalShell a, LocalShell b) { return patch.shell(a).composite < patch.shell(b).composite; });
  return bad;
}

namespace {

/// A shell outside of the scope whose grade the patch's change worsened joins the scope.
void extend_scope(const Patch& patch, ChangeHistory& history) {
  for (const auto& [changed, was] : patch.old_shells())
    if (patch.shell(changed).is_alive && patch.shell(changed).state.grade() > was.state.grade() && changed.value < history.in_scope.size())
      history.in_scope[changed.value] = 1;
}

}  // namespace

void keep_change(Patch& patch, ChangeHistory& history) {
  const Cost before = cost_before(patch), now = cost_now(patch);
  history.triangles += now.triangles - before.triangles;
  history.added_triangle_pairs += now.triangle_pairs - before.triangle_pairs;
  history.last_change.resize(patch.shell_count(), 0);
  history.is_reshaped.resize(patch.shell_count(), 0);
  ++history.changes;
  for (const LocalShell changed : patch.changed_shells()) history.last_change[changed.value] = history.changes;
  for (const auto& [changed, was] : patch.old_shells())
    if (patch.shell(changed).corners != was.corners) history.is_reshaped[changed.value] = 1;
  extend_scope(patch, history);
  patch.keep();
}

void keep_moves(Patch& patch, ChangeHistory& history) {
  history.is_moved.resize(patch.shell_count(), 0);
  ++history.changes;
  for (const LocalShell changed : patch.changed_shells()) history.is_moved[changed.value] = 1;
  extend_scope(patch, history);
  patch.keep();
}

}  // namespace prismesh::mesh::repair
