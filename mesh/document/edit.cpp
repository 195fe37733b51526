#include "mesh/document/edit.h"

namespace prismesh::mesh::document {

namespace {

std::string_view action_name(VisibilityAction action) {
  switch (action) {
    case VisibilityAction::hide: return "hide";
    case VisibilityAction::show: return "show";
    case VisibilityAction::only: return "only";
    case VisibilityAction::lock: return "lock";
    case VisibilityAction::unlock: break;
  }
  return "unlock";
}

struct Namer {
  std::string_view operator()(const Select&) const { return "select"; }
  std::string_view operator()(const SelectRegion&) const { return "select_region"; }
  std::string_view operator()(const SelectLasso&) const { return "select_lasso"; }
  std::string_view operator()(const Grow&) const { return "grow"; }
  std::string_view operator()(const Shrink&) const { return "shrink"; }
  std::string_view operator()(const Invert&) const { return "invert"; }
  std::string_view operator()(const SetParts& edit) const { return action_name(edit.action); }
  std::string_view operator()(const Translate&) const { return "translate"; }
  std::string_view operator()(const Lift&) const { return "lift"; }
  std::string_view operator()(const Undo&) const { return "undo"; }
  std::string_view operator()(const Redo&) const { return "redo"; }
};

}  // namespace

std::string_view name(const Edit& edit) { return std::visit(Namer{}, edit); }

}  // namespace prismesh::mesh::document
