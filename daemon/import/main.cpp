// prismesh-import, which reads one deck in a sandbox and ends. The rest is in importer.h.
#include <sys/socket.h>
#include <unistd.h>

#include <cstdio>

#include "daemon/common/program.h"
#include "daemon/import/importer.h"

namespace {

constexpr const char* kUsage =
    "usage: prismesh-import\n"
    "  Reads one deck that nobody vouches for, locked in, and hands it over. Other programs of Prismesh start it: its standard input is a\n"
    "  connected socket, on which the request comes and the answer goes (docs/remote.md).\n";

bool is_socket(int descriptor) {
  int type = 0;
  socklen_t size = sizeof type;
  return ::getsockopt(descriptor, SOL_SOCKET, SO_TYPE, &type, &size) == 0 && type == SOCK_STREAM;
}

}  // namespace

int main(int argc, char** argv) {
  const auto serve = [](const prismesh::ProgramOptions&) -> prismesh::Result<int> {
    if (!is_socket(STDIN_FILENO))
      return prismesh::fail("prismesh-import", "standard input is no socket: other programs start this one (docs/remote.md)");
    if (prismesh::Result<void> served = prismesh::importer::serve(prismesh::ipc::Descriptor(STDIN_FILENO)); !served)
      std::fprintf(stderr, "prismesh-import: %s\n", served.error().text().c_str());
    // The kernel frees a large model faster, and locked in there is nothing else to put in order.
    ::_exit(0);
  };
  return prismesh::daemon::run({"prismesh-import", kUsage, {}, serve}, argc, argv);
}
