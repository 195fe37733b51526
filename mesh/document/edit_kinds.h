// The kinds of edits, one row each: the one place that says which there are, how they are named and what they change.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "mesh/document/edit.h"

namespace prismesh::mesh::document {

enum class EditGroup : std::uint8_t {
  selection,  ///< changes the selection alone
  parts,      ///< changes the parts' states
  shaping,    ///< moves nodes to a new shape that relaxing and repairing then keep; has a Shaping and a Displacement, can be dragged
  mending,    ///< relaxes nodes or changes the structure, and keeps the shape
  step,       ///< goes to another generation of the history
};

struct EditKind {
  std::string_view name;  ///< as in its JSON ("translate", "hide", ...)
  EditGroup group = EditGroup::selection;
  Edit blank;  ///< with its defaults; for the part edits with the action, for those by hand with the operation
};

/// All kinds, ascending by name.
std::span<const EditKind> edit_kinds();
const EditKind& kind_of(const Edit& edit);
std::string_view name(const Edit& edit);
/// Null if there is none of that name.
const EditKind* find_edit_kind(std::string_view name);

/// What an edit has to do with the selection.
struct SelectionUse {
  bool reads = false;   ///< it acts on the selection, or starts from it
  bool writes = false;  ///< it makes another one
};
SelectionUse selection_use(const Edit& edit);

}  // namespace prismesh::mesh::document
