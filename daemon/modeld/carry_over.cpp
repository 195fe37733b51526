#include "daemon/modeld/carry_over.h"

#include <memory>
#include <string>

#include "mesh/document/edit_kinds.h"
#include "mesh/document/prepare.h"
#include "mesh/select/expression.h"

namespace prismesh::modeld {

namespace {

using namespace mesh::document;

std::string part_expression(const Generation& generation, bool PartState::*state) {
  std::vector<std::int64_t> ids;
  for (std::size_t p = 0; p < generation.parts->size(); ++p)
    if ((*generation.parts)[p].*state) ids.push_back((*generation.model.parts)[p].id);
  return mesh::select::to_expression(std::move(ids));
}

std::string selected_expression(const Generation& generation) {
  std::vector<std::int64_t> ids;
  const bool nodes = generation.selection_kind == mesh::select::EntityKind::node;
  const auto& marks = nodes ? generation.node_marks : generation.shell_marks;
  const auto& names = nodes ? generation.model.node_ids : generation.model.shell_ids;
  for (std::size_t i = 0; i < marks.size(); ++i)
    if ((marks[i] & kSelected) != 0) ids.push_back(names[i]);
  return mesh::select::to_expression(std::move(ids));
}

std::vector<Edit> steps_to(const Generation& generation) {
  std::vector<Edit> steps;
  if (std::string hidden = part_expression(generation, &PartState::hidden); !hidden.empty())
    steps.emplace_back(SetParts{VisibilityAction::hide, std::move(hidden)});
  if (std::string locked = part_expression(generation, &PartState::locked); !locked.empty())
    steps.emplace_back(SetParts{VisibilityAction::lock, std::move(locked)});
  if (generation.selected_nodes > 0 || generation.selected_shells > 0) {
    Select select;
    select.expr = selected_expression(generation);
    select.kind =
        generation.selection_kind == mesh::select::EntityKind::node ? mesh::select::EntityKind::node : mesh::select::EntityKind::element;
    if (!select.expr.empty()) steps.emplace_back(std::move(select));
  }
  return steps;
}

}  // namespace

std::size_t steps_to_carry(const Generation& current) { return steps_to(current).size(); }

Result<void> carry_over(const Generation& current, Document& recorded, Journal& journal) {
  for (const Edit& step : steps_to(current)) {
    // The first step's delta holds the whole change; the other steps add the intents.
    auto next = std::make_shared<Generation>(current);
    next->number = recorded.next_number;
    next->made_by = name(step);
    Prepared prepared;
    prepared.next = std::move(next);
    if (Result<void> appended = journal.append(recorded, step, prepared); !appended) return appended;
    commit(recorded, std::move(prepared));
  }
  return {};
}

Result<void> carry_over_by_ids(const Generation& current, Document& recorded, Journal& journal) {
  for (const Edit& step : steps_to(current)) {
    Result<Prepared> prepared = prepare(recorded, step);
    if (!prepared) return fail(prepared.error());
    if (Result<void> appended = journal.append(recorded, step, *prepared); !appended) return appended;
    commit(recorded, std::move(*prepared));
  }
  return {};
}

}  // namespace prismesh::modeld
