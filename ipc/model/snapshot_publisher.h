// Copies generations into shared memory; chunks that an earlier snapshot in use holds aren't copied again.
#pragma once

#include <memory>

#include "ipc/model/snapshot.h"
#include "mesh/document/document.h"

namespace prismesh::ipc {

struct PublishedSnapshot {
  std::uint64_t lease = 0;
  Descriptor table;                     ///< sealed
  std::vector<std::uint64_t> segments;  ///< ids, in the table's order
};

/// Thread-safe. A daemon has one publisher for all documents it opens.
class SnapshotPublisher {
 public:
  /// Chunk versions and segment numbers count up from `first_number`. Each start of a daemon needs its own (a time is enough), so that a
  /// view that outlives the daemon never mistakes a new chunk for one it has.
  explicit SnapshotPublisher(std::uint64_t first_number = 1);
  ~SnapshotPublisher();

  /// Costs the chunks that changed since the snapshots still leased or current, and a pointer a chunk.
  /// The generation published last stays current (its memory isn't reused) without a lease. Publishing it again costs nothing.
  Result<PublishedSnapshot> publish(const mesh::document::Document& document, bool changed);
  /// Publishes another generation of the document, leased; the current one stays current. Costs the chunks that no snapshot in use has.
  Result<PublishedSnapshot> publish_other(const mesh::document::Document& document, std::size_t generation, bool changed);
  /// Forgets the current generation, after the document was closed.
  void forget();
  /// Returns a lease: the snapshot's memory may be reused.
  void release(std::uint64_t lease);
  /// A duplicate of a segment's descriptor, to send to a client that doesn't have it. A leased snapshot's segments exist.
  Result<Descriptor> segment(std::uint64_t id) const;
  std::size_t bytes_copied() const;  ///< over the publisher's life; for tests and figures
  std::size_t bytes_held() const;    ///< in all segments, used or free

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prismesh::ipc
