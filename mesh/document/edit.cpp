#include "mesh/document/edit.h"

namespace prismesh::mesh::document {

namespace {

std::string_view action_name(VisibilityAction action) {
  switch (action) {
    case VisibilityAction::hide: return "hide";
    case VisibilityAction::show: return "show";
    case VisibilityAction::only: return "only";
    case VisibilityAction::reverse: return "reverse";
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
  std::string_view operator()(const Slide&) const { return "slide"; }
  std::string_view operator()(const Rotate&) const { return "rotate"; }
  std::string_view operator()(const Relax&) const { return "relax"; }
  std::string_view operator()(const Repair&) const { return "repair"; }
  std::string_view operator()(const Restructure& edit) const { return repair::name(edit.operation); }
  std::string_view operator()(const Undo&) const { return "undo"; }
  std::string_view operator()(const Redo&) const { return "redo"; }
};

}  // namespace

std::string_view name(const Edit& edit) { return std::visit(Namer{}, edit); }

Shaping* shaping_of(Edit& edit) {
  return std::visit(
      [](auto& each) -> Shaping* {
        if constexpr (requires { each.shaping; })
          return &each.shaping;
        else
          return nullptr;
      },
      edit);
}

const Shaping* shaping_of(const Edit& edit) { return shaping_of(const_cast<Edit&>(edit)); }

Displacement displacement_of(const Edit& edit) {
  Displacement displacement;
  if (const auto* translate = std::get_if<Translate>(&edit)) displacement.by = translate->by;
  if (const auto* slide = std::get_if<Slide>(&edit)) displacement.by = slide->by;
  if (const auto* lift = std::get_if<Lift>(&edit)) displacement.distance = lift->distance;
  if (const auto* rotate = std::get_if<Rotate>(&edit)) displacement.degrees = rotate->degrees;
  return displacement;
}

void set_displacement(Edit& edit, const Displacement& displacement) {
  if (auto* translate = std::get_if<Translate>(&edit)) translate->by = displacement.by;
  if (auto* slide = std::get_if<Slide>(&edit)) slide->by = displacement.by;
  if (auto* lift = std::get_if<Lift>(&edit)) lift->distance = displacement.distance;
  if (auto* rotate = std::get_if<Rotate>(&edit)) rotate->degrees = displacement.degrees;
}

}  // namespace prismesh::mesh::document
