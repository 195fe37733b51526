// Records what the pen's loop does, and runs its safety again on a record. Inner to cli.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include "cli/commands.h"
#include "cli/context.h"

namespace prismesh::cli {

/// Writes the ticks that the pen's process still has, some four seconds, and those of the next `more`, or until the user stops it. Returns
/// what was written, in words. Errors: nobody drives a pen, no loop has begun yet, the file can't be written.
Result<std::string> record_pen(const DevicesOptions& options, const Context& context);

/// A record in words, and whether the safety decides as it did then.
struct ReplayedPen {
  std::string text;
  bool same = true;
};
/// Errors: of the file.
Result<ReplayedPen> replay_pen(const std::filesystem::path& file, bool as_json);

}  // namespace prismesh::cli
