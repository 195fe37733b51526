#include "mesh/document/judge_parts.h"

#include <vector>

namespace prismesh::mesh::document {

namespace {

bool judge_alike(const quality::PartCriteria& a, const quality::PartCriteria& b) {
  return a.target_size == b.target_size && a.criteria == b.criteria;
}

}  // namespace

void rejudge_parts(const Model& model, const quality::Criteria& criteria, const Judging& before, const Judging& now,
                   ChunkedArray<quality::ShellState>& states, quality::Counts& counts) {
  std::vector<bool> is_changed(now.parts.size(), false);
  for (std::size_t p = 0; p < now.parts.size(); ++p)
    is_changed[p] = !judge_alike(before.by_part.of(PartIndex(p)), now.by_part.of(PartIndex(p)));
  ShellSet shells;
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    const PartIndex part = model.shell_parts[s];
    const bool changed = part.valid() ? is_changed[part.value] : before.deck_size != now.deck_size;
    if (changed && !model.is_removed(ShellIndex(s))) shells.emplace_back(s);
  }
  if (!shells.empty()) quality::rejudge(model, sized(criteria, now), shells, states, counts);
}

}  // namespace prismesh::mesh::document
