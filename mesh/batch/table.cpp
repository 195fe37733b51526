#include "mesh/batch/table.h"

#include <algorithm>

namespace prismesh::mesh::batch {

std::string_view name(RowState state) {
  switch (state) {
    case RowState::failed: return "failed";
    case RowState::missing: return "missing";
    case RowState::refused: return "refused";
    case RowState::done: break;
  }
  return "done";
}

std::size_t Table::count(RowState state) const {
  return static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), [&](const Row& row) { return row.state == state; }));
}

}  // namespace prismesh::mesh::batch
