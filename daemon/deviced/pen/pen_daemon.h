// The process that drives the haptic pen, and nothing else: joins its socket, line, guard, loop and state page.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "base/error.h"

namespace prismesh::deviced::pen {

struct PenDaemonOptions {
  std::filesystem::path runtime_directory;
  std::filesystem::path state_directory;
  std::optional<std::filesystem::path> config;  ///< a settings file that overrides the system's and the user's
};

/// Exit status when the guard has ended or the loop hangs, so that the supervisor restarts the process.
inline constexpr int kUnguardedStatus = 71;

class PenDaemon {
 public:
  /// Forks the guard, so the process must have one thread. Errors: another one holds the folder; settings can't be used (file and line); no
  /// memory, process or state folder. Without a pen in the settings it serves and does nothing else.
  static Result<PenDaemon> start(const PenDaemonOptions& options);
  PenDaemon(PenDaemon&&) noexcept;
  /// Sends zero before it returns.
  ~PenDaemon();

  /// Serves until SIGTERM, SIGINT, a terminal's SIGHUP or `stop`. Returns the exit status.
  int run();
  void stop();

 private:
  struct Impl;
  explicit PenDaemon(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace prismesh::deviced::pen
