// Which shells a repair has to work on, after the changes so far.
#pragma once

#include <vector>

#include "mesh/quality/shell_state.h"
#include "mesh/repair/repair_state.h"

namespace prismesh::mesh::repair {

bool is_in_scope(const ChangeHistory& history, LocalShell shell);

/// Whether the shell was in scope and warned or failed when the piece's repair began.
bool was_bad(const ChangeHistory& history, LocalShell shell);

/// Whether an accepted change made the shell or gave it other corners.
bool is_reshaped(const Patch& patch, const ChangeHistory& history, LocalShell shell);

/// Whether an accepted change made or changed the shell, or relaxing moved a node of it.
bool is_changed(const Patch& patch, const ChangeHistory& history, LocalShell shell);

/// The number of the last accepted operation that made or changed the shell; 0: none.
std::uint32_t last_change(const ChangeHistory& history, LocalShell shell);

/// Whether an operation after number `since` reached the shells about the shell or those about them.
bool changed_nearby(const Patch& patch, const ChangeHistory& history, LocalShell shell, std::uint32_t since);

/// Live shells in scope whose grade is `min_grade` or worse, by ascending composite.
std::vector<LocalShell> bad_shells(const Patch& patch, const ChangeHistory& history, quality::Grade min_grade);

/// Keeps the patch's current change and records it. A shell outside of the scope whose grade it worsened joins the scope.
void keep_change(Patch& patch, ChangeHistory& history);

/// The same for nodes that relaxing moved. What was refused before isn't tried again for that: it seldom helps.
void keep_moves(Patch& patch, ChangeHistory& history);

}  // namespace prismesh::mesh::repair
