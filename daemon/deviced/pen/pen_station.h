// A pen on a line: opens the line, runs the loop on it, and opens it again when it was lost.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "base/clock.h"
#include "daemon/deviced/pen/field_reader.h"
#include "daemon/deviced/pen/line_guard.h"
#include "daemon/deviced/pen/open_pen.h"
#include "daemon/deviced/pen/pen_thread.h"
#include "daemon/deviced/pen/record_store.h"
#include "drivers/haptic_pen/framed/simulated_device.h"
#include "drivers/settings/settings.h"

namespace prismesh::deviced::pen {

/// For the main thread.
class PenStation {
 public:
  /// All must outlive it. Errors: no pseudo-terminal for a simulated pen.
  static Result<std::unique_ptr<PenStation>> start(const drivers::settings::HapticPenSettings& settings, LineGuard& guard,
                                                   FieldReader& fields, ipc::PenPage& page, RecordStore& records, bool memory_locked);
  /// Sends zero, and stores that the pen was put down in order.
  ~PenStation();
  PenStation(const PenStation&) = delete;
  PenStation& operator=(const PenStation&) = delete;

  /// Call it every few milliseconds: opens the line, stores the safety's state when it changes.
  void poll();
  /// Stores that the pen is armed, then asks the loop. The answer is on the page. Errors: the line isn't open, the state can't be stored.
  Result<void> arm();
  Result<void> disarm();
  void use(const drivers::haptics::Feel& feel);

  const std::string& where() const { return port_; }
  /// Why the line isn't open, or what the device waits for.
  std::string trouble() const { return trouble_.empty() && pen_ ? pen_->pen().advice() : trouble_; }
  const std::string& refused() const { return refused_; }  ///< as PenThread::refused
  const daemon::Heartbeat* heartbeat() const { return thread_ ? &thread_->heartbeat() : nullptr; }

 private:
  PenStation(const drivers::settings::HapticPenSettings& settings, LineGuard& guard, FieldReader& fields, ipc::PenPage& page,
             RecordStore& records);
  void open_line();
  void close_line();
  void show_absent();
  void store_record();

  drivers::settings::HapticPenSettings settings_;
  LineGuard& guard_;
  FieldReader& fields_;
  ipc::PenPage& page_;
  RecordStore& records_;
  ipc::PenHealth health_;
  drivers::haptics::Feel feel_;
  MonotonicClock clock_;
  std::string port_, trouble_, refused_;
  std::int64_t next_try_ns_ = 0, opened_ns_ = 0;
  std::int64_t heard_ns_ = 0;  ///< of a device that sets itself up
  bool arming_ = false;        ///< stored as armed, and the loop hasn't answered
  std::uint64_t arms_before_ = 0;
  std::unique_ptr<drivers::haptic_pen::framed::SimulatedDeviceThread> device_;
  std::unique_ptr<drivers::port::UsbWatch> plugs_;  ///< null: nothing tells of plugs here
  std::uint64_t plugs_seen_ = 0;
  std::unique_ptr<OpenPen> pen_;
  std::optional<PenLoop> loop_;
  std::unique_ptr<PenThread> thread_;
};

}  // namespace prismesh::deviced::pen
