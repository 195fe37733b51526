#include "mesh/repair/change_history.h"

#include <algorithm>

#include "mesh/repair/acceptance.h"

namespace prismesh::mesh::repair {

bool is_in_scope(const ChangeHistory& history, LocalShell shell) {
  return shell.value >= history.in_scope.size() || history.in_scope[shell.value] != 0;
}

bool is_changed(const Patch& patch, const ChangeHistory& history, LocalShell shell) {
  return !patch.shell(shell).model.valid() || (shell.value < history.last_change.size() && history.last_change[shell.value] != 0);
}

bool changed_nearby(const Patch& patch, const ChangeHistory& history, LocalShell shell, std::uint32_t since) {
  for (const LocalNode corner : patch.shell(shell).corners)
    for (const LocalShell near : patch.node(corner).shells)
      for (const LocalNode node : patch.shell(near).corners)
        for (const LocalShell other : patch.node(node).shells)
          if (other.value < history.last_change.size() && history.last_change[other.value] > since) return true;
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

void keep_change(Patch& patch, ChangeHistory& history) {
  const Cost before = cost_before(patch), now = cost_now(patch);
  history.triangles += now.triangles - before.triangles;
  history.added_triangle_pairs += now.triangle_pairs - before.triangle_pairs;
  history.last_change.resize(patch.shell_count(), 0);
  ++history.changes;
  for (const LocalShell changed : patch.changed_shells()) history.last_change[changed.value] = history.changes;
  for (const auto& [changed, was] : patch.old_shells())
    if (patch.shell(changed).is_alive && patch.shell(changed).state.grade() > was.state.grade() && changed.value < history.in_scope.size())
      history.in_scope[changed.value] = 1;
  patch.keep();
}

}  // namespace prismesh::mesh::repair
