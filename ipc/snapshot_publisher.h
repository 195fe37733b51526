// Puts generations into shared memory, copying only chunks that no earlier snapshot in use already holds.
#pragma once

#include <memory>

#include "ipc/snapshot.h"

namespace prismesh::ipc {

struct PublishedSnapshot {
  std::uint64_t lease = 0;
  Descriptor table;                     ///< sealed
  std::vector<std::uint64_t> segments;  ///< ids, in the table's order
};

class SnapshotPublisher {
 public:
  SnapshotPublisher();
  ~SnapshotPublisher();

  /// Costs the chunks that changed since the snapshots still leased or current, and a pointer a chunk.
  Result<PublishedSnapshot> publish(const mesh::document::Document& document, bool changed);
  /// The memory of a snapshot may be reused.
  void release(std::uint64_t lease);
  /// A segment's descriptor, to be sent to a client that lacks it.
  const Descriptor& segment(std::uint64_t id) const;
  std::size_t bytes_copied() const;  ///< over the publisher's life; for tests and figures

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace prismesh::ipc
