// The daemon modeld: joins the socket, the scheduler, the worker and the state page.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <memory>

#include "base/error.h"
#include "daemon/modeld/deck_source.h"

namespace prismesh::modeld {

struct DaemonOptions {
  std::filesystem::path runtime_directory;
  std::filesystem::path state_directory;
  std::filesystem::path intake{};                    ///< socket of prismesh-intake
  ImporterPlace importer{};                          ///< for decks that nobody vouches for
  std::size_t history_bytes = std::size_t{2} << 30;  ///< max. memory of the states kept for undo and redo
  std::chrono::seconds hang_limit{60};               ///< the process aborts after so long without a heartbeat; 0: never
};

class Daemon {
 public:
  /// Locks both folders. Errors: another daemon holds one of them; one can't be made or isn't private.
  static Result<Daemon> start(const DaemonOptions& options);
  Daemon(Daemon&&) noexcept;
  ~Daemon();

  /// Serves clients until SIGTERM, SIGINT or `stop`.
  void run();
  /// May be called from any thread.
  void stop();

 private:
  struct Impl;
  explicit Daemon(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace prismesh::modeld
