// Locks this process in, for good: from then on it can read files beneath one folder, compute, fill memory that it has, and answer on its
// socket. Nothing else, whatever a hostile deck makes of it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"

namespace prismesh::importer {

struct SandboxLimits {
  std::uint64_t memory_bytes = 0;  ///< address space
  std::uint64_t cpu_s = 0;         ///< processor time of all threads; the kernel ends the process after it
};

/// The open descriptors that the process keeps, besides standard error; all others are closed.
struct SandboxDescriptors {
  int folder = -1;  ///< files beneath it may be read
  int socket = -1;  ///< messages may be sent on it
  int memory = -1;  ///< may be made shorter and sealed
};

/// Call it before the process has threads: they would stay free. Returns what this kernel can't forbid, as sentences. Errors: a limit or
/// the filter of system calls can't be set; then nothing that isn't trusted may be read.
Result<std::vector<std::string>> lock_in(const SandboxDescriptors& kept, const SandboxLimits& limits);

}  // namespace prismesh::importer
