#include "kiosk/tools/parts/part_errors.h"

#include <algorithm>

namespace prismesh::kiosk::tools::parts {

using ipc::SnapshotArray;
using mesh::quality::Grade;
using mesh::quality::ShellState;

std::vector<Errors> PartErrors::count(const render::ModelSource& source) {
  if (document_ != source.document_key()) chunks_.clear();
  document_ = source.document_key();
  chunks_.resize(source.chunk_count(SnapshotArray::shell_quality));
  std::vector<Errors> all(source.part_count());
  for (std::size_t c = 0; c < chunks_.size(); ++c) {
    Chunk& chunk = chunks_[c];
    const std::uint64_t quality = source.chunk_version(SnapshotArray::shell_quality, c);
    const std::uint64_t parts =
        c < source.chunk_count(SnapshotArray::shell_parts) ? source.chunk_version(SnapshotArray::shell_parts, c) : 0;
    if (!chunk.known || chunk.quality_version != quality || chunk.parts_version != parts) {
      chunk = {parts, quality, true, {}};
      const auto states = source.chunk<ShellState>(SnapshotArray::shell_quality, c);
      const auto of_part = c < source.chunk_count(SnapshotArray::shell_parts) ? source.chunk<mesh::PartIndex>(SnapshotArray::shell_parts, c)
                                                                              : std::span<const mesh::PartIndex>();
      for (std::size_t i = 0; i < std::min(states.size(), of_part.size()); ++i) {
        const Grade grade = states[i].grade();
        if (states[i].is_removed() || (grade != Grade::warn && grade != Grade::fail)) continue;
        const std::uint32_t part = of_part[i].value;
        if (chunk.errors.empty() || chunk.errors.back().first != part) chunk.errors.push_back({part, {}});
        Errors& its = chunk.errors.back().second;
        ++(grade == Grade::fail ? its.fail : its.warn);
      }
    }
    for (const auto& [part, errors] : chunk.errors)
      if (part < all.size()) all[part].warn += errors.warn, all[part].fail += errors.fail;
  }
  return all;
}

}  // namespace prismesh::kiosk::tools::parts
