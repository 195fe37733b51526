#include "daemon/modeld/retiring.h"

#include "daemon/modeld/paths.h"

namespace prismesh::modeld {

namespace fs = std::filesystem;

std::optional<std::uint64_t> records_in(const fs::path& journal) {
  const Result<mesh::document::JournalIntents> intents = mesh::document::read_intents(journal);
  // A file without a header, an empty one for example, is read as a script and names no deck.
  if (!intents || intents->damage || intents->deck_hash.empty()) return std::nullopt;
  return intents->edits.size();
}

Result<void> retire_open(const StateFolder& folder, const mesh::document::Journal& journal, const char* ending) {
  if (!is_there(journal.path())) return {};
  const Result<fs::path> retired = folder.retire(journal.path(), journal.is_whole() ? ending : kDamaged);
  if (!retired) return fail(retired.error());
  return {};
}

Result<fs::path> retire_unopened(const StateFolder& folder, const fs::path& journal, const char* ending) {
  return folder.retire(journal, records_in(journal) ? ending : kDamaged);
}

}  // namespace prismesh::modeld
