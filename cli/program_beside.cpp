#include "cli/program_beside.h"

#include <system_error>

#include <unistd.h>

namespace prismesh::cli {

Result<std::filesystem::path> program_beside(const std::string& name, const std::string& what, const std::string& package) {
  std::error_code error;
  const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", error);
  std::filesystem::path program = own.parent_path() / name;
  if (error || access(program.c_str(), X_OK) != 0)
    return fail(program.string(), name + ", " + what + ", isn't beside this program; the package " + package + " has it");
  return program;
}

}  // namespace prismesh::cli
