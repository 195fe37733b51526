// A daemon's main function: options, log, signals, and serving until it is told to end.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/program_options.h"

namespace prismesh::daemon {

struct Program {
  std::string name;                         ///< "prismesh-modeld"
  std::string usage;                        ///< lines of text
  std::vector<std::string_view> with_path;  ///< options that each take a path
  /// Starts the daemon and serves until its end. Returns the exit status. Errors are printed to standard error.
  std::function<Result<int>(const ProgramOptions&)> serve;
};

/// Returns the exit status.
int run(const Program& program, int argc, char** argv);

}  // namespace prismesh::daemon
