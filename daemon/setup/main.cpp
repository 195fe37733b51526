// prismesh-setup, which writes what the kiosk sets a station up with, and ends. The rest is in setup.h.
#include <sys/socket.h>
#include <unistd.h>

#include "daemon/common/program.h"
#include "daemon/setup/setup.h"

namespace {

constexpr const char* kUsage =
    "usage: prismesh-setup [--root FOLDER] [--kiosk USER]\n"
    "  Carries out one request of the kiosk: its standard input is a connected socket, on which the answer goes (docs/appliance.md).\n"
    "  --root   write beneath this folder, and leave the running machine alone; default /\n"
    "  --kiosk  the user who may ask, beside root and the program's own\n";

bool is_socket(int descriptor) {
  int type = 0;
  socklen_t size = sizeof type;
  return ::getsockopt(descriptor, SOL_SOCKET, SO_TYPE, &type, &size) == 0 && type == SOCK_STREAM;
}

}  // namespace

int main(int argc, char** argv) {
  const auto serve = [](const prismesh::ProgramOptions& options) -> prismesh::Result<int> {
    if (!is_socket(STDIN_FILENO))
      return prismesh::fail("prismesh-setup", "standard input is no socket: systemd starts this program (docs/appliance.md)");
    const prismesh::setup::StationFiles files(options.path("--root").value_or("/"));
    const prismesh::Result<void> served =
        prismesh::setup::serve(prismesh::ipc::Descriptor(STDIN_FILENO), files, options.path("--kiosk").value_or("").string());
    return served ? 0 : 1;
  };
  return prismesh::daemon::run({"prismesh-setup", kUsage, {"--root", "--kiosk"}, serve}, argc, argv);
}
