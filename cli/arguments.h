// Arguments to commands. Inner to cli.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "base/error.h"
#include "cli/context.h"

namespace prismesh::cli {

/// What the arguments ask for: a command ready to run, or text to print (--help, --version).
using Action = std::function<int(const Context&)>;

/// Error: wrong usage, in a sentence; its file is the command ("prismesh edit").
Result<Action> parse_arguments(std::span<const std::string> args);

}  // namespace prismesh::cli
