// What the process that drives the pen and the process that guards its line share.
#pragma once

#include <atomic>
#include <cstdint>

namespace prismesh::deviced::pen {

/// Who may write to the line. The loop takes `writing` from `idle` for each frame and gives it back. The guard takes `tripped` from `idle`:
/// from then on the loop can't write. So no frame of the loop follows a zero of the guard, wherever the loop was stopped.
enum class LineToken : std::uint32_t { idle, writing, tripped };

struct GuardPage {
  std::atomic<std::uint64_t> beats = 0;  ///< ticks of the loop
  std::atomic<LineToken> token = LineToken::idle;
  std::atomic<std::uint32_t> holds_line = 0;
  std::atomic<std::uint64_t> trips = 0;
  std::atomic<std::uint64_t> zeros = 0;      ///< frames that the guard has written
  std::atomic<std::int64_t> silence_ns = 0;  ///< how long the heartbeat had been missing at the last trip

  bool begin_writing() {
    LineToken free = LineToken::idle;
    return token.compare_exchange_strong(free, LineToken::writing);
  }
  void end_writing() { token.store(LineToken::idle); }
  bool is_tripped() const { return token.load() == LineToken::tripped; }
  /// The loop sends no force any more: the guard may give the line back.
  void acknowledge() {
    LineToken tripped = LineToken::tripped;
    token.compare_exchange_strong(tripped, LineToken::idle);
  }
};

static_assert(std::atomic<std::uint64_t>::is_always_lock_free && std::atomic<LineToken>::is_always_lock_free);

}  // namespace prismesh::deviced::pen
