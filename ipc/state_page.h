// The state page: a page of shared memory in which a daemon says how it is, for anyone to look at without asking. modeld sends
// its descriptor with Welcome.
#pragma once

#include <cstdint>
#include <optional>

#include "base/error.h"
#include "ipc/descriptor.h"
#include "ipc/seqlock.h"

namespace prismesh::ipc {

/// How a daemon is.
struct Health {
  std::int64_t heartbeat_ns = 0;  ///< CLOCK_MONOTONIC when this was written; modeld writes at least every kHeartbeatPeriodNs
  std::int64_t pid = 0;
  std::uint64_t generation = 0;  ///< published last; 0: no document
  std::uint64_t clients = 0;
  double progress = 0;  ///< of what it is busy with, 0..1
  bool open = false;
  bool busy = false;
  bool dragging = false;
};
inline constexpr std::int64_t kHeartbeatPeriodNs = 500'000'000;

/// The page as it lies in memory.
struct StatePageLayout {
  std::uint64_t magic = 0;
  std::uint64_t version = 0;
  SeqlockSlot<Health> health;
};

class StatePage {
 public:
  static Result<StatePage> create();
  /// One thread writes.
  void set_health(const Health& health) { layout_->health.write(health); }
  const Descriptor& descriptor() const { return descriptor_; }

 private:
  Descriptor descriptor_;
  Mapping mapping_;
  StatePageLayout* layout_ = nullptr;
};

class StatePageReader {
 public:
  static Result<StatePageReader> map(const Descriptor& descriptor);
  std::optional<Health> health() const { return layout_->health.read(); }

 private:
  Mapping mapping_;
  const StatePageLayout* layout_ = nullptr;
};

}  // namespace prismesh::ipc
