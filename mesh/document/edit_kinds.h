// The table of the kinds of edits: their names and what they change.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "mesh/document/edit.h"

namespace prismesh::mesh::document {

enum class EditGroup : std::uint8_t {
  selection,  ///< changes the selection alone
  parts,      ///< changes the parts' states, or what they are judged by
  shaping,    ///< changes the shape, which relaxing and repairing then keep; has a Shaping and a Displacement, can be dragged
  mending,    ///< relaxes nodes or changes the structure, and keeps the shape
  joining,    ///< adds connections between sheets
  contact,    ///< moves shells apart, which changes the shape
  exchange,   ///< gives a part another mesh, and so another shape
  step,       ///< goes to another generation of the history
};

struct EditKind {
  std::string_view name;  ///< as in its JSON ("translate", "hide", ...)
  EditGroup group = EditGroup::selection;
  Edit blank;  ///< with its defaults, and for SetParts and Restructure its action or operation
};

/// All kinds, ascending by name.
std::span<const EditKind> edit_kinds();
const EditKind& kind_of(const Edit& edit);
std::string_view name(const Edit& edit);
/// Null if there is none of that name.
const EditKind* find_edit_kind(std::string_view name);

/// How an edit uses the selection.
struct SelectionUse {
  bool reads = false;   ///< it acts on the selection, or changes it
  bool writes = false;  ///< it makes a new one
};
SelectionUse selection_use(const Edit& edit);

}  // namespace prismesh::mesh::document
