#include "mesh/deck/save.h"

#include <utility>

#include "mesh/deck/editing/text_changes.h"
#include "mesh/deck/staged_save.h"

namespace prismesh::mesh::deck {

Result<void> can_save(const Deck& deck, const Model& original, const Model& model) {
  const Result<TextChanges> text = text_changes(deck, original, model);
  if (!text) return fail(text.error());
  return {};
}

Result<SaveReport> save(const Deck& deck, const Model& original, const Model& model, const std::filesystem::path& target,
                        const Progress& progress) {
  Result<StagedSave> staged = StagedSave::write(deck, original, model, target, progress);
  if (!staged) return fail(std::move(staged.error()));
  if (Result<void> placed = staged->put_in_place_or_leave(); !placed) return fail(std::move(placed.error()));
  return staged->report();
}

}  // namespace prismesh::mesh::deck
