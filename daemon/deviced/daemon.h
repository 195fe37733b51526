// deviced put together: the socket, the station with its loop, the state page.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "base/error.h"

namespace prismesh::deviced {

struct DaemonOptions {
  std::filesystem::path runtime_directory;
  std::optional<std::filesystem::path> config;  ///< a settings file, read after the system's and the user's
};

/// The exit status when the device loop hangs: whoever supervises the daemon starts it again.
inline constexpr int kStuckStatus = 70;

class Daemon {
 public:
  /// Errors: another daemon holds the folder; settings or profile that can't be used (file and line); no memory.
  static Result<Daemon> start(const DaemonOptions& options);
  Daemon(Daemon&&) noexcept;
  /// The motor is let go before this returns.
  ~Daemon();

  /// Serves until SIGTERM, SIGINT or a terminal's SIGHUP, or `stop`.
  void run();
  /// From any thread.
  void stop();

 private:
  struct State;
  explicit Daemon(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace prismesh::deviced
