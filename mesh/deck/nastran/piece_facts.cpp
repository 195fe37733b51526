#include "mesh/deck/nastran/piece_facts.h"

#include <algorithm>

namespace prismesh::mesh::deck::nastran {

void PieceFacts::note(std::string_view kind, std::size_t offset, std::string message) {
  const auto at = std::find_if(notices.begin(), notices.end(), [&](const Notice& n) { return n.kind == kind && n.message == message; });
  if (at != notices.end())
    ++at->count;
  else if (notices.size() < 1000)
    notices.push_back({std::string(kind), offset, std::move(message), 1});
}

}  // namespace prismesh::mesh::deck::nastran
