#include "mesh/document/damage.h"

#include "mesh/document/judge_parts.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::document {

std::shared_ptr<const Generation> opened_as_judged(const Document& document, const Generation& generation) {
  const Generation& opened = *document.opened;
  if (opened.judging == generation.judging || !opened.judging || !generation.judging) return document.opened;
  auto judged = std::make_shared<Generation>(opened);
  judge_by(generation.judging, *judged);
  return judged;
}

ShellSet damaged_shells(const Document& document) {
  const std::shared_ptr<const Generation> as_opened = opened_as_judged(document, document.current());
  const Generation &opened = *as_opened, &now = document.current();
  ShellSet damaged;
  const std::size_t of_deck = opened.quality.size();
  for (std::size_t c = 0; c < now.quality.chunk_count(); ++c) {
    // The pointers are compared instead of shares_chunk: arrays of different sizes may share all chunks but the last.
    if (c < opened.quality.chunk_count() && now.quality.chunk_owner(c) == opened.quality.chunk_owner(c) && (c + 1) * kChunkSize <= of_deck)
      continue;
    const std::span<const quality::ShellState> states = now.quality.chunk(c);
    for (std::size_t i = 0; i < states.size(); ++i) {
      if (states[i].grade() == quality::Grade::ok) continue;
      const ShellIndex shell(c * kChunkSize + i);
      if (now.model.is_removed(shell)) continue;
      const quality::ShellState was = opened.quality[deck_ancestor(now.model, shell).value];
      const bool fails_now = (states[i].fail & ~was.fail) != 0;
      const bool warns_now = (states[i].warn & ~was.warn) != 0;
      if (fails_now || warns_now) damaged.push_back(shell);
    }
  }
  return damaged;
}

}  // namespace prismesh::mesh::document
