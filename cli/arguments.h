// Parses arguments into commands. Inner to cli.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "base/error.h"
#include "cli/context.h"

namespace prismesh::cli {

/// A command with its options, ready to run, or one that prints a text (--help, --version).
using Action = std::function<int(const Context&)>;

/// Parses the arguments. Errors: wrong usage, as a sentence; the error's file is the command ("prismesh edit").
Result<Action> parse_arguments(std::span<const std::string> args);

}  // namespace prismesh::cli
