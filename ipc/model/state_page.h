// The state page: shared memory in which modeld publishes its health, for clients to read without a request. modeld sends its descriptor
// with Welcome.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "base/error.h"
#include "ipc/wire/sealed_page.h"
#include "ipc/wire/seqlock.h"

namespace prismesh::ipc {

/// The health of a daemon.
struct Health {
  std::int64_t heartbeat_ns = 0;  ///< CLOCK_MONOTONIC when this was written; modeld writes at least every kHeartbeatPeriodNs
  std::int64_t pid = 0;
  std::uint64_t generation = 0;  ///< published last; 0: no document
  std::uint64_t clients = 0;
  double progress = 0;  ///< of the work under way, 0..1
  bool open = false;
  bool busy = false;
  bool dragging = false;
};
inline constexpr std::int64_t kHeartbeatPeriodNs = 500'000'000;

/// The page's layout in memory.
struct StatePageLayout {
  static constexpr const char* kName = "prismesh-state";
  static constexpr std::uint64_t kMagic = 0x3145'5441'5453'5250;  // "PRSTATE1"
  static constexpr std::uint64_t kVersion = 1;
  std::uint64_t magic = 0;
  std::uint64_t version = 0;
  SeqlockSlot<Health> health;
};

class StatePage {
 public:
  static Result<StatePage> create() {
    return SealedPage<StatePageLayout>::create().map([](auto page) { return StatePage(std::move(page)); });
  }
  /// One thread writes.
  void set_health(const Health& health) { page_->health.write(health); }
  const Descriptor& descriptor() const { return page_.descriptor(); }

 private:
  explicit StatePage(SealedPage<StatePageLayout> page) : page_(std::move(page)) {}
  SealedPage<StatePageLayout> page_;
};

class StatePageReader {
 public:
  static Result<StatePageReader> map(const Descriptor& descriptor) {
    return SealedPageReader<StatePageLayout>::map(descriptor).map([](auto page) { return StatePageReader(std::move(page)); });
  }
  std::optional<Health> health() const { return page_->health.read(); }

 private:
  explicit StatePageReader(SealedPageReader<StatePageLayout> page) : page_(std::move(page)) {}
  SealedPageReader<StatePageLayout> page_;
};

}  // namespace prismesh::ipc
