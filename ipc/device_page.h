// The device daemon's state page: where the eyes are, where the mask is, and how the devices are, in shared memory that readers
// look at without asking. A page belongs to one life of the daemon: a new daemon makes a new page.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "base/error.h"
#include "drivers/eye_tracker/filter.h"
#include "drivers/prism_servo/mask_control.h"
#include "ipc/descriptor.h"
#include "ipc/seqlock.h"

namespace prismesh::ipc {

enum class EyesPhase : std::uint8_t {
  none,       ///< no tracker is configured
  absent,     ///< configured, but its port can't be opened or went away
  silent,     ///< the port is open, but nothing sensible comes
  searching,  ///< the tracker works and sees no head
  tracking,
};

/// The eyes, written at each tick.
struct EyesState {
  std::int64_t time_ns = 0;      ///< CLOCK_MONOTONIC of the tick that wrote this
  std::int64_t measured_ns = 0;  ///< of the newest measurement; 0: never. Its age is what tells fresh from stale
  std::array<double, 3> between_eyes_mm{};
  std::array<double, 3> velocity_mm_s{};
  std::array<double, 3> toward_right{1, 0, 0};
  double eye_separation_mm = 63;
  EyesPhase phase = EyesPhase::none;
  std::uint64_t records = 0, bytes_skipped = 0, resyncs = 0, times_lost = 0;

  drivers::eye_tracker::HeadState head() const;
};

using PrismState = drivers::prism_servo::MaskState;

/// How the daemon itself is.
struct DeviceHealth {
  std::int64_t heartbeat_ns = 0;
  std::int64_t pid = 0;
  std::uint64_t ticks = 0;
  std::uint64_t ticks_late = 0;  ///< by more than a period
  std::int64_t worst_late_ns = 0;
  std::int64_t tick_cpu_ns = 0;  ///< median of late
  bool realtime = false;         ///< SCHED_FIFO was granted
  bool memory_locked = false;
  bool simulated = false;  ///< at least one device is
};

struct DevicePageLayout {
  std::uint64_t magic = 0;
  std::uint64_t version = 0;
  SeqlockSlot<EyesState> eyes;
  SeqlockSlot<PrismState> prism;
  SeqlockSlot<DeviceHealth> health;
};

class DevicePage {
 public:
  static Result<DevicePage> create();
  /// One thread writes each slot.
  void set_eyes(const EyesState& eyes) { layout_->eyes.write(eyes); }
  void set_prism(const PrismState& prism) { layout_->prism.write(prism); }
  void set_health(const DeviceHealth& health) { layout_->health.write(health); }
  const Descriptor& descriptor() const { return descriptor_; }

 private:
  Descriptor descriptor_;
  Mapping mapping_;
  DevicePageLayout* layout_ = nullptr;
};

class DevicePageReader {
 public:
  static Result<DevicePageReader> map(const Descriptor& descriptor);
  std::optional<EyesState> eyes() const { return layout_->eyes.read(); }
  std::optional<PrismState> prism() const { return layout_->prism.read(); }
  std::optional<DeviceHealth> health() const { return layout_->health.read(); }

 private:
  Mapping mapping_;
  const DevicePageLayout* layout_ = nullptr;
};

}  // namespace prismesh::ipc
