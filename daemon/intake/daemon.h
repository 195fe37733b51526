// The process prismesh-intake: the service for the network, and the socket by which this machine's programs ask about it.
#pragma once

#include <filesystem>
#include <memory>

#include "base/error.h"
#include "daemon/intake/intake.h"
#include "drivers/settings/settings.h"

namespace prismesh::intake {

struct DaemonOptions {
  std::filesystem::path runtime_directory;  ///< of the socket
  IntakeOptions intake;
};

/// What the settings say. Errors: `remote.listen` isn't set.
Result<IntakeOptions> intake_options(const drivers::settings::RemoteSettings& settings, const std::filesystem::path& state_directory);

class Daemon {
 public:
  /// Errors: those of Intake::start; the socket.
  static Result<Daemon> start(const DaemonOptions& options);
  Daemon(Daemon&&) noexcept;
  ~Daemon();

  Intake& intake();
  /// Serves until SIGTERM, SIGINT or `stop`.
  void run();
  /// May be called from any thread.
  void stop();

 private:
  struct Impl;
  explicit Daemon(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace prismesh::intake
