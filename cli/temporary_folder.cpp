#include "cli/temporary_folder.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

namespace prismesh::cli {

Result<TemporaryFolder> TemporaryFolder::make() {
  std::error_code error;
  const std::filesystem::path parent = std::filesystem::temp_directory_path(error);
  if (error) {
    const char* given = std::getenv("TMPDIR");
    return fail(given != nullptr ? given : "/tmp", "is no folder for temporary files: " + error.message() + " (set TMPDIR to another one)");
  }
  std::string name = (parent / "prismesh-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    const int reason = errno;
    return fail(parent.string(),
                std::string("no temporary folder can be made here: ") + std::strerror(reason) + " (set TMPDIR to another folder)");
  }
  return TemporaryFolder(name);
}

TemporaryFolder::TemporaryFolder(TemporaryFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
}

}  // namespace prismesh::cli
