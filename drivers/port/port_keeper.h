// Keeps a device's port open: opens it, retries after a failure, and closes a port that is gone. All of this happens outside the real-time
// loop, which takes the open port and gives a dead one back without locks.
//
// A keeper has two sides, with one thread each. The real-time side calls `port` in each tick, and `give_back` after a read or write
// returned `gone`. The other side calls `work`, either from a test that controls the clock or through `KeeperThread`.
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

/// Waiting times between attempts: `first_wait_ns`, doubled each time up to `max_wait_ns`. After a port has been open for
/// `proven_after_ns`, the waiting time starts again at `first_wait_ns`.
struct BackOff {
  std::int64_t first_wait_ns = 50'000'000;
  std::int64_t max_wait_ns = 1'000'000'000;
  std::int64_t proven_after_ns = 1'000'000'000;
};

/// Status for users and status pages; not for the real-time side.
struct KeeperReport {
  bool open = false;            ///< the real-time side has a port, or can take one
  std::uint64_t attempts = 0;   ///< calls of the maker
  std::uint64_t openings = 0;   ///< successful calls of the maker
  std::optional<Error> reason;  ///< why no port is open: the last attempt's error, or that the port went away
};

/// `Port` is BytePort or DatagramPort.
template <class Port>
class BasicKeeper {
 public:
  using Maker = std::function<Result<std::unique_ptr<Port>>()>;

  /// `maker` opens the port; only `work` calls it. `path` is the device's file, which `KeeperThread` watches; it may be empty.
  BasicKeeper(Clock& clock, Maker maker, std::string path = {}, BackOff back_off = {});
  ~BasicKeeper();
  BasicKeeper(const BasicKeeper&) = delete;
  BasicKeeper& operator=(const BasicKeeper&) = delete;

  // --- called by the real-time side: no locks, no allocation ---

  /// Returns the open port, or null if there is none. The pointer is valid until `give_back`.
  Port* port();
  /// Gives back a port that is gone; the other side closes it. Does nothing without a port.
  void give_back();

  // --- called by the other side ---

  /// Closes a port that was given back, and opens a new one when an attempt is due. Returns when to call again at the latest (ns of the
  /// clock).
  std::int64_t work();
  /// Makes the next `work` attempt at once, without waiting for the back-off, because the device has just appeared or changed.
  void retry_now();
  KeeperReport report() const;
  const std::string& path() const { return path_; }
  /// Sets a callback for `give_back`. It must neither block nor allocate. `KeeperThread` uses it to wake itself.
  void on_give_back(void (*call)(void*), void* with);

 private:
  void close_returned(std::int64_t now);
  void try_to_open(std::int64_t now);

  Clock& clock_;
  Maker maker_;
  std::string path_;
  BackOff back_off_;

  std::atomic<Port*> offered_{nullptr};   // from the other side to the real-time side
  std::atomic<Port*> returned_{nullptr};  // from the real-time side to the other side
  Port* held_ = nullptr;                  // owned by the real-time side
  void (*notify_)(void*) = nullptr;
  void* notify_with_ = nullptr;

  bool handed_out_ = false;
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
