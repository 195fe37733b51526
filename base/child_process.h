// Starts programs and tells how they ended.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

#include "base/error.h"

namespace prismesh {

/// The program that runs now, by its path.
Result<std::filesystem::path> own_program();

/// The program of this name in the folder of this one. `what`: "which draws pictures"; `package`: the one that has it. Errors: it isn't
/// there.
Result<std::filesystem::path> program_beside(const std::string& name, const std::string& what, const std::string& package);

/// Starts a program, found by PATH if its name has no slash, with standard input from /dev/null and its outputs into files. `cores`: the
/// processors that it may use; empty: ours. Errors: it can't be started, a file can't be written.
Result<pid_t> start_program(const std::vector<std::string>& arguments, const std::filesystem::path& out, const std::filesystem::path& err,
                            const std::vector<std::size_t>& cores = {});

/// The processors that this process may use.
std::vector<std::size_t> own_cores();

/// Why a program that ended with this wait status failed: "ended by signal 9", "ended with status 1"; nothing: it succeeded.
std::optional<std::string> failure_words(int status);

/// The last line that isn't empty of a text file; empty without one.
std::string last_line(const std::filesystem::path& file);

}  // namespace prismesh
