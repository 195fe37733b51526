// Loaded into a whole program (LD_PRELOAD), this records its file calls: below PRISMESH_FILE_CALLS_BELOW, into PRISMESH_FILE_CALLS_LOG. It
// can also let one call hang.
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

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

extern "C" int accept4(int socket, sockaddr* address, socklen_t* size, int flags) {
  prismesh::test::hang_where_told("accept");
  return static_cast<int>(::syscall(SYS_accept4, socket, address, size, flags));
}
