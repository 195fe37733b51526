// A generation in shared memory, for views: what a picture needs, in the model's chunks. Chunk versions tell a view which chunks changed
// since the last snapshot, so that it uploads only those.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "ipc/model/snapshot_info.h"
#include "ipc/wire/descriptor.h"

namespace prismesh::ipc {

/// A snapshot as a view maps it: read-only. The descriptors' sizes are checked before anything is read.
class SnapshotView {
 public:
  /// `table` is the snapshot's table of contents, `segments` the shared memory it points into, in the table's order.
  static Result<std::shared_ptr<const SnapshotView>> map(const Descriptor& table, std::span<const std::shared_ptr<const Mapping>> segments);

  const SnapshotInfo& info() const { return info_; }
  std::size_t size(SnapshotArray array) const;  ///< elements
  std::size_t chunk_count(SnapshotArray array) const;
  /// Two chunks with the same version have the same content, in all snapshots of a document.
  std::uint64_t chunk_version(SnapshotArray array, std::size_t chunk) const;
  /// The used bytes of a chunk (kChunkSize elements but for the last).
  std::span<const std::byte> chunk_bytes(SnapshotArray array, std::size_t chunk) const;

  template <class T>
  std::span<const T> chunk(SnapshotArray array, std::size_t chunk) const {
    const std::span<const std::byte> bytes = chunk_bytes(array, chunk);
    return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
  }
  template <class T>
  const T& at(SnapshotArray array, std::size_t i) const {
    return chunk<T>(array, i / mesh::kChunkSize)[i % mesh::kChunkSize];
  }

  std::size_t node_count() const { return size(SnapshotArray::positions); }
  std::size_t shell_count() const { return size(SnapshotArray::shell_nodes); }
  const mesh::Vec3& position(std::size_t node) const { return at<mesh::Vec3>(SnapshotArray::positions, node); }
  std::int64_t node_id(std::size_t node) const { return at<std::int64_t>(SnapshotArray::node_ids, node); }
  bool selected(std::size_t node) const { return (at<std::uint8_t>(SnapshotArray::node_marks, node) & mesh::document::kSelected) != 0; }
  const mesh::ShellNodes& shell(std::size_t shell) const { return at<mesh::ShellNodes>(SnapshotArray::shell_nodes, shell); }
  std::int64_t shell_id(std::size_t shell) const { return at<std::int64_t>(SnapshotArray::shell_ids, shell); }
  mesh::PartIndex shell_part(std::size_t shell) const { return at<mesh::PartIndex>(SnapshotArray::shell_parts, shell); }
  mesh::quality::ShellState shell_quality(std::size_t shell) const {
    return at<mesh::quality::ShellState>(SnapshotArray::shell_quality, shell);
  }
  mesh::quality::ShellState shell_damage(std::size_t shell) const {
    return at<mesh::quality::ShellState>(SnapshotArray::shell_damage, shell);
  }
  // line_nodes: pairs of NodeIndex, drawn as lines: beams, discrete elements and the edges of solids' outer faces; line_parts: the
  // PartIndex of each pair (invalid where the card names none).
  // Indices in the arrays aren't checked: compare one with node_count() or info().parts.size() before using it.

 private:
  struct Piece {
    const std::byte* data = nullptr;
    std::uint64_t version = 0;
  };
  struct ArrayTable {
    std::size_t count = 0;
    std::size_t element_size = 0;
    std::vector<Piece> chunks;
  };
  SnapshotInfo info_;
  std::vector<ArrayTable> arrays_;
  std::vector<std::shared_ptr<const Mapping>> keep_;
};

}  // namespace prismesh::ipc
