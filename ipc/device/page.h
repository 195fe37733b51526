// deviced's state page: the positions of eyes and mask and the state of the devices, in shared memory that clients read without a
// request. Each process of the daemon makes a new page.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "drivers/eye_tracker/filter.h"
#include "drivers/prism_servo/mask_control.h"
#include "ipc/wire/sealed_page.h"
#include "ipc/wire/seqlock.h"

namespace prismesh::ipc {

enum class EyesPhase : std::uint8_t {
  none,       ///< no tracker is configured
  absent,     ///< configured, but its port can't be opened or went away
  silent,     ///< the port is open, but no valid data arrive
  searching,  ///< the tracker works and sees no head
  tracking,
};

std::string_view name(EyesPhase phase);

/// The eyes, written at each tick.
struct EyesState {
  std::int64_t time_ns = 0;                  ///< CLOCK_MONOTONIC of the tick that wrote this
  std::int64_t measured_ns = 0;              ///< of the newest measurement; 0: never. If it is ...
  std::int64_t lost_after_ns = 100'000'000;  ///< ... older than this, the eyes are lost; longer for slow trackers
  std::array<double, 3> between_eyes_mm{};
  std::array<double, 3> velocity_mm_s{};
  std::array<double, 3> toward_right{1, 0, 0};
  double eye_separation_mm = 63;
  EyesPhase phase = EyesPhase::none;
  std::uint64_t records = 0, bytes_skipped = 0, resyncs = 0, times_lost = 0;

  drivers::eye_tracker::HeadState head() const;
};

using PrismState = drivers::prism_servo::MaskState;

/// The health of the daemon itself.
struct DeviceHealth {
  std::int64_t heartbeat_ns = 0;
  std::int64_t pid = 0;
  std::uint64_t ticks = 0;
  std::uint64_t ticks_late = 0;  ///< by more than a period
  std::int64_t worst_late_ns = 0;
  std::int64_t tick_cpu_ns = 0;  ///< recent median
  bool realtime = false;         ///< SCHED_FIFO was granted
  bool memory_locked = false;
  bool simulated = false;  ///< at least one device is
};

struct DevicePageLayout {
  static constexpr const char* kName = "prismesh-devices";
  static constexpr std::uint64_t kMagic = 0x3153'4543'4956'4544;  // "DEVICES1"
  static constexpr std::uint64_t kVersion = 1;
  std::uint64_t magic = 0;
  std::uint64_t version = 0;
  SeqlockSlot<EyesState> eyes;
  SeqlockSlot<PrismState> prism;
  SeqlockSlot<DeviceHealth> health;
};

class DevicePage {
 public:
  static Result<DevicePage> create() {
    return SealedPage<DevicePageLayout>::create().map([](auto page) { return DevicePage(std::move(page)); });
  }
  /// One thread writes each slot.
  void set_eyes(const EyesState& eyes) { page_->eyes.write(eyes); }
  void set_prism(const PrismState& prism) { page_->prism.write(prism); }
  void set_health(const DeviceHealth& health) { page_->health.write(health); }
  const Descriptor& descriptor() const { return page_.descriptor(); }

 private:
  explicit DevicePage(SealedPage<DevicePageLayout> page) : page_(std::move(page)) {}
  SealedPage<DevicePageLayout> page_;
};

class DevicePageReader {
 public:
  static Result<DevicePageReader> map(const Descriptor& descriptor) {
    return SealedPageReader<DevicePageLayout>::map(descriptor).map([](auto page) { return DevicePageReader(std::move(page)); });
  }
  std::optional<EyesState> eyes() const { return page_->eyes.read(); }
  std::optional<PrismState> prism() const { return page_->prism.read(); }
  std::optional<DeviceHealth> health() const { return page_->health.read(); }

 private:
  explicit DevicePageReader(SealedPageReader<DevicePageLayout> page) : page_(std::move(page)) {}
  SealedPageReader<DevicePageLayout> page_;
};

}  // namespace prismesh::ipc
