// Keeps a device's port open: opens it, tries again when that fails, and closes what died, all outside the real-time loop, which takes the
// open port and gives the dead one back without locks.
//
// Two sides. The real-time side calls `port` each tick and `give_back` when a read or write said `gone`. The other side calls `work`,
// either from a test that owns the clock, or through `KeeperThread`. One thread on each side.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "base/clock.h"
#include "base/error.h"
#include "drivers/port/byte_port.h"

namespace prismesh::drivers::port {

/// Waits between attempts: `first_wait_ns`, doubled up to `longest_wait_ns`. A port that lived for `proven_after_ns` starts over.
struct BackOff {
  std::int64_t first_wait_ns = 50'000'000;
  std::int64_t longest_wait_ns = 1'000'000'000;
  std::int64_t proven_after_ns = 1'000'000'000;
};

/// For a person or a status page; not for the tick.
struct KeeperReport {
  bool open = false;            ///< a port is out with the real-time side, or waits there to be taken
  std::uint64_t attempts = 0;   ///< calls of the maker
  std::uint64_t openings = 0;   ///< those that succeeded
  std::optional<Error> reason;  ///< why it isn't open: as the last attempt said it, or that it went away
};

/// `Port` is BytePort or DatagramPort.
template <class Port>
class BasicKeeper {
 public:
  using Maker = std::function<Result<std::unique_ptr<Port>>()>;

  /// `maker` opens the port; only `work` calls it. `path` is the device's file, for `KeeperThread` to watch; may be empty.
  BasicKeeper(Clock& clock, Maker maker, std::string path = {}, BackOff back_off = {});
  ~BasicKeeper();
  BasicKeeper(const BasicKeeper&) = delete;
  BasicKeeper& operator=(const BasicKeeper&) = delete;

  // --- the real-time side: no locks, no allocation ---

  /// The open port, or null while there is none. The pointer stays good until `give_back`.
  Port* port();
  /// The port is gone; it'll be closed by the other side. Nothing if there is none.
  void give_back();

  // --- the other side ---

  /// Closes what came back, and opens when it's time. Returns when to call again at the latest (the clock's ns).
  std::int64_t work();
  /// The device has just appeared or changed: the next `work` tries at once, whatever the back-off says.
  void hurry();
  KeeperReport report() const;
  const std::string& path() const { return path_; }
  /// Called from `give_back`, so it must neither block nor allocate; `KeeperThread` wakes itself with it.
  void on_give_back(void (*call)(void*), void* with);

 private:
  void close_returned(std::int64_t now);
  void try_to_open(std::int64_t now);

  Clock& clock_;
  Maker maker_;
  std::string path_;
  BackOff back_off_;

  std::atomic<Port*> offered_{nullptr};   // other side -> real-time side
  std::atomic<Port*> returned_{nullptr};  // real-time side -> other side
  Port* held_ = nullptr;                  // the real-time side's own
  void (*notify_)(void*) = nullptr;
  void* notify_with_ = nullptr;

  bool out_ = false;
  std::int64_t opened_ns_ = 0;
  std::int64_t next_try_ns_ = 0;
  std::int64_t wait_ns_ = 0;
  mutable std::mutex report_mutex_;
  KeeperReport report_;
};

class DatagramPort;
using PortKeeper = BasicKeeper<BytePort>;
using DatagramKeeper = BasicKeeper<DatagramPort>;

}  // namespace prismesh::drivers::port
