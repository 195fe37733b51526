#include "daemon/modeld/deck_files.h"

#include <algorithm>

namespace prismesh::modeld {

std::vector<ipc::DeckFile> files_with_shells(const mesh::document::Document& document) {
  const mesh::deck::Deck& deck = *document.deck;
  const mesh::Model& model = document.opened->model;
  const std::vector<mesh::Part>& parts = *model.parts;
  std::vector<ipc::DeckFile> files(deck.files.size());
  const std::size_t shells = std::min(model.shell_count(), deck.shell_line.size());
  for (std::size_t r = 0; r < deck.shell_runs.size(); ++r) {
    const mesh::deck::CardRun& run = deck.shell_runs[r];
    const std::size_t end = r + 1 < deck.shell_runs.size() ? deck.shell_runs[r + 1].first : shells;
    ipc::DeckFile& file = files[run.file];
    mesh::PartIndex last;
    for (std::size_t s = run.first; s < end; ++s) {
      ++file.shells;
      const mesh::PartIndex part = model.shell_parts[s];
      if (part != last && part.valid()) file.parts.push_back(parts[part.value].id);
      last = part;
    }
  }
  for (std::size_t f = 0; f < files.size(); ++f) {
    files[f].name = deck.files[f].relative.string();
    std::sort(files[f].parts.begin(), files[f].parts.end());
    files[f].parts.erase(std::unique(files[f].parts.begin(), files[f].parts.end()), files[f].parts.end());
  }
  std::erase_if(files, [](const ipc::DeckFile& file) { return file.shells == 0; });
  return files;
}

}  // namespace prismesh::modeld
