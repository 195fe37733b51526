// Runs the command line; a function, so that tests can call it.
#pragma once

#include <iosfwd>
#include <span>
#include <string>

#include "cli/context.h"

namespace prismesh::cli {

/// Runs `prismesh ARGS..`, `args` without the program's name. Returns the exit status.
int run(std::span<const std::string> args, const Context& context);
int run(std::span<const std::string> args, std::ostream& out, std::ostream& err);

}  // namespace prismesh::cli
