#include "mesh/deck/lsdyna/warnings.h"

#include <algorithm>

#include "mesh/deck/lsdyna/keyword.h"

namespace prismesh::mesh::deck::lsdyna {

void Warnings::note(std::string_view kind, std::uint32_t file, std::size_t offset, std::string message, std::size_t count) {
  const auto at = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.kind == kind; });
  if (at != entries_.end())
    at->count += count;
  else
    entries_.push_back({std::string(kind), file, offset, std::move(message), count});
}

std::vector<Warning> Warnings::finish(std::span<const SourceFile> files) const {
  std::vector<Warning> out;
  for (const Entry& entry : entries_) {
    const SourceFile& file = files[entry.file];
    out.push_back({file.path.string(), line_number(file.bytes.text(), entry.offset), entry.kind, entry.message, entry.count});
  }
  return out;
}

}  // namespace prismesh::mesh::deck::lsdyna
