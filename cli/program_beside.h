// Finds programs that commands start.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"

namespace prismesh::cli {

/// The program of this name in the folder of this one. `what`: "which draws pictures"; `package`: the one that has it. Errors: it isn't
/// there.
Result<std::filesystem::path> program_beside(const std::string& name, const std::string& what, const std::string& package);

}  // namespace prismesh::cli
