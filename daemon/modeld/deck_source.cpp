#include "daemon/modeld/deck_source.h"

#include <utility>

#include "base/log.h"
#include "daemon/modeld/paths.h"

namespace prismesh::modeld {

namespace {

namespace fs = std::filesystem;
using mesh::deck::OpenedDeck;

Result<OpenedDeck> import(const fs::path& path, const ipc::ImportOptions& options) {
  Result<ipc::ImportedDeck> imported = ipc::import_deck(path, options);
  if (!imported) return fail(std::move(imported.error()));
  for (const std::string& sentence : imported->unguarded) logging::warn("{}: {}", path.string(), sentence);
  return std::move(imported->opened);
}

}  // namespace

Result<OpenedDeck> DeckSource::open(const fs::path& path, bool sandboxed, const Progress& progress) const {
  return sandboxed ? import(path, options(progress)) : mesh::deck::open(path, progress);
}

Result<OpenedDeck> DeckSource::open(const mesh::deck::StagedSave& save, const fs::path& path, bool sandboxed,
                                    const Progress& progress) const {
  if (!sandboxed) return save.open(progress);
  ipc::ImportOptions how = options(progress);
  const fs::path folder = path.parent_path();
  for (const auto& [file, by] : save.waiting())
    how.stand_ins.push_back({file.lexically_relative(folder).string(), by.lexically_relative(folder).string()});
  return import(path, how);
}

mesh::deck::TextMaker DeckSource::text_maker(bool sandboxed) const {
  if (!sandboxed) return mesh::deck::text_changes;
  return [source = *this](const mesh::deck::Deck& deck, const mesh::Model& original, const mesh::Model& model, const Progress& progress) {
    return ipc::rewrite_deck(deck, original, model, source.options(progress));
  };
}

mesh::document::DeckReader DeckSource::variant_reader(bool sandboxed) const {
  return [source = *this, sandboxed](const fs::path& path, const Progress& progress) { return source.open(path, sandboxed, progress); };
}

ipc::ImportOptions DeckSource::options(const Progress& progress) const {
  ipc::ImportOptions how;
  how.program = importer_.program;
  if (!importer_.socket.empty() && is_there(importer_.socket)) how.socket = importer_.socket;
  how.progress = progress;
  return how;
}

}  // namespace prismesh::modeld
