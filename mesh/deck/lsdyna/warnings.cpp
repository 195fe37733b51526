#include "mesh/deck/lsdyna/warnings.h"

#include <algorithm>

#include "mesh/deck/lsdyna/keyword.h"

namespace prismesh::mesh::deck::lsdyna {

namespace {

constexpr std::size_t kMostOfAKind = 100;

}  // namespace

void Warnings::note(std::string_view kind, std::uint32_t file, std::size_t offset, std::string message, std::size_t count) {
  const auto at = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.kind == kind; });
  if (at != entries_.end())
    at->count += count;
  else
    entries_.push_back({std::string(kind), file, offset, std::move(message), count});
}

void Warnings::note_each(std::string_view kind, std::uint32_t file, std::size_t offset, std::string message) {
  std::size_t of_kind = 0;
  Entry* last = nullptr;
  for (Entry& entry : entries_) {
    if (entry.kind != kind) continue;
    if (entry.file == file && entry.message == message) {
      ++entry.count;
      return;
    }
    ++of_kind;
    last = &entry;
  }
  if (of_kind > kMostOfAKind)
    ++last->count;
  else if (of_kind == kMostOfAKind)
    entries_.push_back({std::string(kind), file, offset, "there are more like these from here on", 1});
  else
    entries_.push_back({std::string(kind), file, offset, std::move(message), 1});
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
