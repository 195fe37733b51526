// The pen's state page: pose, force, phase, the loop's timing and its last ticks, in shared memory that clients read without a request.
// Each process that drives the pen makes a new page.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "drivers/haptics/pen_record.h"
#include "drivers/haptics/safety.h"
#include "ipc/wire/sealed_page.h"
#include "ipc/wire/seqlock.h"

namespace prismesh::ipc {

enum class PenStage : std::uint8_t {
  none,        ///< no pen is configured
  absent,      ///< configured, but its line can't be opened or went away
  setting_up,  ///< the line is open, and the device isn't ready
  homing,      ///< the user has to move it to its stops
  disarmed,    ///< ready; the force is zero
  armed,
  latched,  ///< the force is zero after a fault, until the user arms again
};

std::string_view name(PenStage stage);

/// Written at each tick. Millimetres in the pen's own space.
struct PenState {
  std::int64_t time_ns = 0;      ///< CLOCK_MONOTONIC of the tick that wrote this
  std::int64_t measured_ns = 0;  ///< of the newest pose; 0: never
  std::array<double, 3> position_mm{};
  std::array<double, 4> orientation{1, 0, 0, 0};  ///< w x y z
  bool has_orientation = false;
  PenStage stage = PenStage::none;
  drivers::haptics::SafetyFault fault = drivers::haptics::SafetyFault::none;  ///< of a latch
  std::uint32_t buttons = 0;
  std::array<double, 3> newton{};  ///< sent in this tick
  bool touching = false;
  bool damping_only = false;
  bool tank_limited = false;
  std::array<double, 3> proxy_mm{};
  std::array<double, 3> normal{};
  std::int32_t element = -1;           ///< that is touched; the mesh's index
  std::uint64_t field_number = 0;      ///< that was read in this tick; 0: none
  std::uint64_t field_generation = 0;  ///< the writer should say what has moved since this one
  std::int64_t field_ns = 0;           ///< its time
  std::uint64_t arms_answered = 0;     ///< requests to arm, since the process began
  bool arm_refused = false;            ///< the newest of them
  std::int64_t round_trip_ns = 0;      ///< from a force to the pose that answers it
};

/// Of the loop.
struct PenHealth {
  std::int64_t heartbeat_ns = 0;
  std::int64_t pid = 0;
  std::int64_t guard_pid = 0;
  std::uint64_t guard_trips = 0;      ///< the guard has taken the line so often
  std::int64_t guard_silence_ns = 0;  ///< the heartbeat's absence at the last of them
  std::uint64_t ticks = 0;
  std::uint64_t ticks_late = 0;  ///< by more than a period
  std::int64_t worst_late_ns = 0;
  std::int64_t late_p99_ns = 0;  ///< this and the next: of the last thousand ticks, in whole microseconds
  std::int64_t cpu_p50_ns = 0, cpu_p99_ns = 0;
  bool realtime = false;  ///< SCHED_FIFO was granted
  bool memory_locked = false;
};

/// The last ticks of the loop, some four seconds: what happened before a fault can still be read after it. Written at each tick.
class PenTickRing {
 public:
  static constexpr std::uint64_t kTicks = 4096;

  void write(const drivers::haptics::PenTick& tick) {
    std::array<std::uint64_t, kWords> words{};
    std::memcpy(words.data(), &tick, sizeof tick);
    const std::uint64_t count = count_.load();
    store_words(words_[count % kTicks].data(), words.data(), kWords);
    count_.store(count + 1);
  }
  /// Ticks that were written since the page was made.
  std::uint64_t count() const { return count_.load(); }
  /// Copies tick `number`, from 0. Empty: it was not written yet, or others have taken its place.
  std::optional<drivers::haptics::PenTick> read(std::uint64_t number) const {
    const std::uint64_t before = count_.load();
    if (number >= before || before >= number + kTicks) return std::nullopt;
    std::array<std::uint64_t, kWords> words;
    load_words(words.data(), words_[number % kTicks].data(), kWords);
    if (count_.load() >= number + kTicks) return std::nullopt;
    drivers::haptics::PenTick tick;
    std::memcpy(static_cast<void*>(&tick), words.data(), sizeof tick);
    return tick;
  }

 private:
  static constexpr std::size_t kWords = (sizeof(drivers::haptics::PenTick) + 7) / 8;
  alignas(64) TurnCount count_;
  std::array<std::array<std::uint64_t, kWords>, kTicks> words_{};
};

struct PenPageLayout {
  static constexpr const char* kName = "prismesh-pen";
  static constexpr std::uint64_t kMagic = 0x3145'4741'504E'4550;  // "PENPAGE1"
  static constexpr std::uint64_t kVersion = 2;
  std::uint64_t magic = 0;
  std::uint64_t version = 0;
  SeqlockSlot<PenState> state;
  SeqlockSlot<PenHealth> health;
  SeqlockSlot<drivers::haptics::PenRecordLimits> limits;  ///< of the loop
  PenTickRing ticks;
};

class PenPage {
 public:
  static Result<PenPage> create() {
    return SealedPage<PenPageLayout>::create().map([](auto page) { return PenPage(std::move(page)); });
  }
  /// One thread writes each slot.
  void set_state(const PenState& state) { page_->state.write(state); }
  void set_health(const PenHealth& health) { page_->health.write(health); }
  void set_limits(const drivers::haptics::PenRecordLimits& limits) { page_->limits.write(limits); }
  void add_tick(const drivers::haptics::PenTick& tick) { page_->ticks.write(tick); }
  PenState state() { return page_->state.read().value_or(PenState{}); }
  PenHealth health() { return page_->health.read().value_or(PenHealth{}); }
  const Descriptor& descriptor() const { return page_.descriptor(); }

 private:
  explicit PenPage(SealedPage<PenPageLayout> page) : page_(std::move(page)) {}
  SealedPage<PenPageLayout> page_;
};

class PenPageReader {
 public:
  static Result<PenPageReader> map(const Descriptor& descriptor) {
    return SealedPageReader<PenPageLayout>::map(descriptor).map([](auto page) { return PenPageReader(std::move(page)); });
  }
  std::optional<PenState> state() const { return page_->state.read(); }
  std::optional<PenHealth> health() const { return page_->health.read(); }
  /// Nothing: no loop has begun yet.
  std::optional<drivers::haptics::PenRecordLimits> limits() const { return page_->limits.read(); }
  const PenTickRing& ticks() const { return page_->ticks; }

 private:
  explicit PenPageReader(SealedPageReader<PenPageLayout> page) : page_(std::move(page)) {}
  SealedPageReader<PenPageLayout> page_;
};

}  // namespace prismesh::ipc
