// The daemon deviced: joins the socket, the station with its device loop, and the state page.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "base/error.h"

namespace prismesh::deviced {

struct DaemonOptions {
  std::filesystem::path runtime_directory;
  std::optional<std::filesystem::path> config;  ///< a settings file that overrides the system's and the user's
};

/// Exit status when the device loop hangs, so that the supervisor restarts the daemon.
inline constexpr int kStuckStatus = 70;

class Daemon {
 public:
  /// Errors: another daemon holds the folder; settings or profile can't be used (file and line); no memory.
  static Result<Daemon> start(const DaemonOptions& options);
  Daemon(Daemon&&) noexcept;
  /// Switches the motor's torque off before it returns.
  ~Daemon();

  /// Serves clients until SIGTERM, SIGINT, a terminal's SIGHUP or `stop`.
  void run();
  /// May be called from any thread.
  void stop();

 private:
  struct Impl;
  explicit Daemon(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace prismesh::deviced
