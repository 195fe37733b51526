// Weighs the pen of the settings with its user: says what to do on a terminal, and ends with the setting that makes its forces true.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/error.h"

namespace prismesh::deviced::pen {

struct WeighPenOptions {
  std::filesystem::path state_directory;
  std::optional<std::filesystem::path> config;
  double grams = 0;
  int input = 0;  ///< a descriptor: each line that comes in goes on
};

/// Grams from the command line. Errors: no number.
Result<double> grams_of(const std::string& text);

/// Writes to standard output. The line has its guard, as in operation: whatever ends this process ends the force. Errors, each a sentence:
/// the settings, no pen in them, the weight doesn't fit, another process drives the pen, it can't be opened, the weighing failed, the input
/// ended.
Result<void> weigh_pen(const WeighPenOptions& options);

}  // namespace prismesh::deviced::pen
