#include "ipc/model/snapshot.h"

#include "ipc/model/snapshot_table.h"

namespace prismesh::ipc {

namespace {

constexpr std::size_t kMaxTable = std::size_t{256} << 20;

}  // namespace

Result<std::shared_ptr<const SnapshotView>> SnapshotView::map(const Descriptor& table_descriptor,
                                                              std::span<const std::shared_ptr<const Mapping>> segments) {
  const Result<Mapping> mapping = Mapping::map(table_descriptor, false);
  if (!mapping) return fail(mapping.error());
  if (mapping->bytes().size() > kMaxTable) return fail("snapshot", "its table of contents is larger than any document's");
  // Decoded from a copy, so that the writer of the table can't change it between check and use.
  const std::vector<std::byte> bytes(mapping->bytes().begin(), mapping->bytes().end());
  Result<SnapshotTable> table = decode_table(bytes);
  if (!table) return fail(std::move(table.error()));

  auto view = std::make_shared<SnapshotView>();
  view->info_ = std::move(table->info);
  view->keep_.assign(segments.begin(), segments.end());
  for (int i = 0; i < kSnapshotArrayCount; ++i) {
    const TableArray& source = table->arrays[static_cast<std::size_t>(i)];
    ArrayTable array;
    array.count = static_cast<std::size_t>(source.count);
    array.element_size = ipc::element_size(static_cast<SnapshotArray>(i));
    array.chunks.reserve(source.pieces.size());
    for (std::size_t c = 0; c < source.pieces.size(); ++c) {
      const TablePiece& piece = source.pieces[c];
      if (piece.segment >= segments.size() || !segments[piece.segment]) return fail("snapshot", "a segment of it is missing");
      const std::span<const std::byte> segment = segments[piece.segment]->bytes();
      const std::size_t used = std::min(mesh::kChunkSize, array.count - c * mesh::kChunkSize) * array.element_size;
      if (piece.offset > segment.size() || used > segment.size() - piece.offset)
        return fail("snapshot", "a chunk of it lies outside its segment");
      array.chunks.push_back({segment.data() + piece.offset, piece.version});
    }
    view->arrays_.push_back(std::move(array));
  }
  return view;
}

std::size_t SnapshotView::size(SnapshotArray array) const { return arrays_[static_cast<std::size_t>(array)].count; }

std::size_t SnapshotView::chunk_count(SnapshotArray array) const { return arrays_[static_cast<std::size_t>(array)].chunks.size(); }

std::uint64_t SnapshotView::chunk_version(SnapshotArray array, std::size_t chunk) const {
  return arrays_[static_cast<std::size_t>(array)].chunks[chunk].version;
}

std::span<const std::byte> SnapshotView::chunk_bytes(SnapshotArray array, std::size_t chunk) const {
  const ArrayTable& table = arrays_[static_cast<std::size_t>(array)];
  const std::size_t elements = std::min(mesh::kChunkSize, table.count - chunk * mesh::kChunkSize);
  return {table.chunks[chunk].data, elements * table.element_size};
}

}  // namespace prismesh::ipc
