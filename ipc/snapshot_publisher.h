// Puts generations into shared memory, copying only chunks that no earlier snapshot in use already holds.
#pragma once

#include <memory>

#include "ipc/snapshot.h"
#include "mesh/document/document.h"

namespace prismesh::ipc {

struct PublishedSnapshot {
  std::uint64_t lease = 0;
  Descriptor table;                     ///< sealed
  std::vector<std::uint64_t> segments;  ///< ids, in the table's order
};

/// Safe to use from several threads. One publisher serves a daemon's whole life, whatever documents it opens.
class SnapshotPublisher {
 public:
  /// Chunk versions and segment numbers count up from `first_number`: give each start of a daemon its own (a time will do), so
  /// that a view which outlives the daemon never takes a new chunk for one it knows.
  explicit SnapshotPublisher(std::uint64_t first_number = 1);
  ~SnapshotPublisher();

  /// Costs the chunks that changed since the snapshots still leased or current, and a pointer a chunk.
  /// The generation published last stays current (its memory isn't reused) without a lease. Publishing it again costs nothing.
  Result<PublishedSnapshot> publish(const mesh::document::Document& document, bool changed);
  /// Another generation of the document than its current one, leased; what is current stays so. Costs what no snapshot in use has.
  Result<PublishedSnapshot> publish_other(const mesh::document::Document& document, std::size_t generation, bool changed);
  /// The document was closed: nothing is current any more.
  void forget();
  /// The memory of a snapshot may be reused.
  void release(std::uint64_t lease);
  /// A duplicate of a segment's descriptor, to be sent to a client that lacks it. A leased snapshot's segments exist.
  Result<Descriptor> segment(std::uint64_t id) const;
  std::size_t bytes_copied() const;  ///< over the publisher's life; for tests and figures
  std::size_t bytes_held() const;    ///< in all segments, used or free

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace prismesh::ipc
