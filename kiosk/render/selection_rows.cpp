#include "kiosk/render/selection_rows.h"

#include <algorithm>

#include "mesh/document/generation.h"

namespace prismesh::kiosk::render {

using ipc::SnapshotArray;
using mesh::kChunkSize;

Result<void> SelectionRows::update(const ModelTable& table, const mesh::Vec3& origin, bool all, std::span<const std::uint32_t> moved_chunks,
                                   const std::function<const std::vector<std::uint8_t>&()>& visible, const Covered* covered) {
  const ModelSource& source = table.source();
  const std::size_t chunks = std::min(source.chunk_count(SnapshotArray::node_marks), source.chunk_count(SnapshotArray::positions));
  const Result<bool> anew = texture_.reserve(table.node_count(), "selected nodes");
  if (!anew) return fail(anew.error());
  if (*anew || all) known_.clear();
  known_.resize(chunks);
  chunks_.resize(chunks);
  std::vector<std::uint32_t> nodes;
  for (std::size_t c = 0; c < chunks; ++c) {
    const std::uint64_t version = source.chunk_version(SnapshotArray::node_marks, c);
    const bool moved = std::binary_search(moved_chunks.begin(), moved_chunks.end(), static_cast<std::uint32_t>(c));
    const bool others =
        covered != nullptr && std::binary_search(covered->changed.begin(), covered->changed.end(), static_cast<std::uint32_t>(c));
    if (known_[c].known && known_[c].version == version && !others && !(moved && chunks_[c].count > 0)) continue;
    known_[c] = {version, true};
    chunks_[c] = {};
    nodes.clear();
    const auto marks = source.chunk<std::uint8_t>(SnapshotArray::node_marks, c);
    const std::size_t begin = c * kChunkSize, end = std::min(begin + marks.size(), table.node_count());
    for (std::size_t node = begin; node < end; ++node) {
      if ((marks[node - begin] & mesh::document::kSelected) == 0) continue;
      if (table.any_hidden() && visible()[node] == 0) continue;
      if (covered != nullptr && node < covered->nodes.size() && covered->nodes[node] != 0) continue;
      const mesh::Vec3 at = table.position(node) - origin;
      if (!finite(at)) continue;
      if (nodes.size() % kBlockSize == 0) chunks_[c].blocks.emplace_back();
      nodes.push_back(static_cast<std::uint32_t>(node));
      chunks_[c].blocks.back().add(at);
    }
    chunks_[c].count = static_cast<std::uint32_t>(nodes.size());
    texture_.upload_row(c, std::as_bytes(std::span(nodes)));
  }
  count_ = 0;
  for (const Chunk& chunk : chunks_) count_ += chunk.count;
  return {};
}

}  // namespace prismesh::kiosk::render
