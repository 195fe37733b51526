#include "mesh/deck/data/derived.h"

#include <algorithm>
#include <string>

namespace prismesh::mesh::deck {

namespace {

/// Finds the largest id of each file's entities.
template <class Ids, class Field>
void find_last_ids(const Ids& ids, const std::vector<CardRun>& runs, Field field, std::vector<LastIds>& last) {
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const std::size_t end = r + 1 < runs.size() ? runs[r + 1].first : ids.size();
    std::int64_t& greatest = last[runs[r].file].*field;
    for (std::size_t i = runs[r].first; i < end; ++i) greatest = std::max(greatest, ids[i]);
  }
}

}  // namespace

Hash128 content_hash(std::span<const SourceFile> files, std::span<const Hash128> hashes) {
  std::string all;
  for (std::size_t i = 0; i < files.size(); ++i) {
    all += hashes[i].hex();
    // The main file may be renamed without becoming another deck.
    if (i > 0) all += files[i].relative.generic_string();
    all += '\n';
  }
  return hash128(std::as_bytes(std::span(all)));
}

std::vector<LastIds> last_ids_of(const Deck& deck, const Model& model) {
  std::vector<LastIds> last(deck.files.size());
  find_last_ids(model.node_ids, deck.node_runs, &LastIds::node, last);
  find_last_ids(model.shell_ids, deck.shell_runs, &LastIds::shell, last);
  return last;
}

}  // namespace prismesh::mesh::deck
