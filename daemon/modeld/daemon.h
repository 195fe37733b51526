// modeld put together: the socket, the scheduler, the worker, the state page.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <memory>

#include "base/error.h"

namespace prismesh::modeld {

struct DaemonOptions {
  std::filesystem::path runtime_directory;
  std::filesystem::path state_directory;
  std::size_t history_bytes = std::size_t{2} << 30;  ///< what the states kept for undo and redo may take
  std::chrono::seconds hang_limit{60};               ///< without a sign of life for so long the process ends itself; 0: it never does
};

class Daemon {
 public:
  /// Takes both folders for itself. Errors: another daemon holds one of them, one can't be made or isn't private.
  static Result<Daemon> start(const DaemonOptions& options);
  Daemon(Daemon&&) noexcept;
  ~Daemon();

  /// Serves until SIGTERM or SIGINT, or `stop`.
  void run();
  /// From any thread.
  void stop();

 private:
  struct State;
  explicit Daemon(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace prismesh::modeld
