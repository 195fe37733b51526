#include "mesh/document/edit_kinds.h"

#include <algorithm>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace prismesh::mesh::document {

std::span<const EditKind> edit_kinds() {
  static const std::vector<EditKind> table = [] {
    using enum EditGroup;
    using repair::Operation;
    std::vector<EditKind> kinds{
        {"select", selection, Select{}},
        {"select_region", selection, SelectRegion{}},
        {"select_lasso", selection, SelectLasso{}},
        {"select_flange", selection, SelectFlange{}},
        {"grow", selection, Grow{}},
        {"shrink", selection, Shrink{}},
        {"invert", selection, Invert{}},
        {"hide", parts, SetParts{VisibilityAction::hide, {}}},
        {"show", parts, SetParts{VisibilityAction::show, {}}},
        {"only", parts, SetParts{VisibilityAction::only, {}}},
        {"reverse", parts, SetParts{VisibilityAction::reverse, {}}},
        {"lock", parts, SetParts{VisibilityAction::lock, {}}},
        {"unlock", parts, SetParts{VisibilityAction::unlock, {}}},
        {"set_target_size", parts, SetTargetSize{}},
        {"set_criteria", parts, SetCriteria{}},
        {"translate", shaping, Translate{}},
        {"lift", shaping, Lift{}},
        {"slide", shaping, Slide{}},
        {"rotate", shaping, Rotate{}},
        {"move", shaping, Move{}},
        {"relax", mending, Relax{}},
        {"repair", mending, Repair{}},
        {"separate", EditGroup::contact, Separate{}},
        {"weld", joining, Weld{}},
        {"bond", joining, Bond{}},
        {"repair_welds", joining, RepairWelds{}},
        {"replace_part", exchange, ReplacePart{}},
        {"undo", step, Undo{}},
        {"redo", step, Redo{}},
        {"branch", step, TakeBranch{}},
    };
    for (const Operation by_hand : {Operation::split, Operation::collapse, Operation::merge, Operation::swap})
      kinds.push_back({repair::name(by_hand), mending, Restructure{by_hand, {}}});
    std::sort(kinds.begin(), kinds.end(), [](const EditKind& a, const EditKind& b) { return a.name < b.name; });
    return kinds;
  }();
  return table;
}

const EditKind& kind_of(const Edit& edit) {
  const auto is_of = [&](const EditKind& kind) {
    if (kind.blank.index() != edit.index()) return false;
    if (const auto* parts = std::get_if<SetParts>(&edit)) return std::get<SetParts>(kind.blank).action == parts->action;
    if (const auto* by_hand = std::get_if<Restructure>(&edit)) return std::get<Restructure>(kind.blank).operation == by_hand->operation;
    return true;
  };
  const std::span<const EditKind> kinds = edit_kinds();
  const auto found = std::find_if(kinds.begin(), kinds.end(), is_of);
  if (found == kinds.end()) throw std::logic_error("an edit by hand with an operation that isn't done by hand");
  return *found;
}

std::string_view name(const Edit& edit) { return kind_of(edit).name; }

const EditKind* find_edit_kind(std::string_view name) {
  const std::span<const EditKind> kinds = edit_kinds();
  const auto at =
      std::lower_bound(kinds.begin(), kinds.end(), name, [](const EditKind& kind, std::string_view n) { return kind.name < n; });
  return at != kinds.end() && at->name == name ? &*at : nullptr;
}

SelectionUse selection_use(const Edit& edit) {
  const bool writes = kind_of(edit).group == EditGroup::selection;
  return std::visit(
      [&](const auto& each) -> SelectionUse {
        if constexpr (std::is_same_v<std::decay_t<decltype(each)>, Separate>)
          return {};  // without an expression it acts on all
        else if constexpr (requires { each.on; })
          return {!each.on, writes};
        else if constexpr (requires { each.shaping; })
          return {!each.shaping.on, writes};
        else if constexpr (requires { each.scope; })
          return {each.scope == Scope::selection || each.scope == Scope::part, writes};
        else if constexpr (requires { each.mode != SelectMode::set; })
          return {each.mode != SelectMode::set, writes};
        else
          return {writes, writes};
      },
      edit);
}

}  // namespace prismesh::mesh::document
