// Loaded into a whole program (LD_PRELOAD), this records its file calls: below PRISMESH_FILE_CALLS_BELOW, into PRISMESH_FILE_CALLS_LOG.
#include <cstdlib>

#include "tests/faults/file_calls.h"

namespace {

struct Begin {
  Begin() {
    const char* const below = std::getenv("PRISMESH_FILE_CALLS_BELOW");
    const char* const log = std::getenv("PRISMESH_FILE_CALLS_LOG");
    if (below != nullptr && log != nullptr) prismesh::test::record_file_calls(below, log);
  }
};
const Begin begin;

}  // namespace
