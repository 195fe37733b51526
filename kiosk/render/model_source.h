// Interface to the model that the renderer draws: a snapshot's arrays in chunks with versions.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ipc/model/snapshot.h"

namespace prismesh::kiosk::render {

/// Arrays as in ipc::SnapshotView. Their content isn't trusted: what has an index out of range isn't drawn.
class ModelSource {
 public:
  virtual ~ModelSource() = default;
  virtual std::size_t size(ipc::SnapshotArray array) const = 0;  ///< elements
  /// Equal versions mean equal content, also across sources of one document.
  virtual std::uint64_t chunk_version(ipc::SnapshotArray array, std::size_t chunk) const = 0;
  virtual std::span<const std::byte> chunk_bytes(ipc::SnapshotArray array, std::size_t chunk) const = 0;
  virtual std::size_t part_count() const = 0;
  virtual bool part_hidden(std::size_t part) const = 0;
  /// Of the part's thinnest and thickest shell, deck's length unit; 0 if not all have a thickness.
  virtual std::array<float, 2> part_thickness(std::size_t part) const = 0;
  /// Differs between documents. Versions of two documents can't be compared.
  virtual std::uint64_t document_key() const = 0;

  std::size_t chunk_count(ipc::SnapshotArray array) const { return (size(array) + mesh::kChunkSize - 1) / mesh::kChunkSize; }
  template <class T>
  std::span<const T> chunk(ipc::SnapshotArray array, std::size_t chunk) const {
    const std::span<const std::byte> bytes = chunk_bytes(array, chunk);
    return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
  }
  template <class T>
  T at(ipc::SnapshotArray array, std::size_t i) const {
    return chunk<T>(array, i / mesh::kChunkSize)[i % mesh::kChunkSize];
  }
};

/// Makes a source of a snapshot. `hidden`: by PartIndex, 1 = hidden, instead of the snapshot's flag; parts beyond its end keep the
/// snapshot's.
std::shared_ptr<const ModelSource> snapshot_source(std::shared_ptr<const ipc::SnapshotView> view, std::vector<std::uint8_t> hidden = {});

}  // namespace prismesh::kiosk::render
