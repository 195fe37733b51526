// prismesh-deviced, the daemon for eye tracker and prism servo: options and logging. The rest is in daemon.h.
#include <sys/prctl.h>

#include "base/log.h"
#include "daemon/common/program.h"
#include "daemon/deviced/daemon.h"
#include "ipc/wire/runtime_directory.h"

namespace {

constexpr const char* kUsage =
    "usage: prismesh-deviced [--runtime-dir FOLDER] [--config FILE]\n"
    "  --runtime-dir  for the socket; default $RUNTIME_DIRECTORY, $XDG_RUNTIME_DIR/prismesh or /tmp/prismesh-UID\n"
    "  --config       settings that go before those in /etc/prismesh/prismesh.toml and ~/.config/prismesh/prismesh.toml\n";

}  // namespace

int main(int argc, char** argv) {
  const auto serve = [](const prismesh::ProgramOptions& given) -> prismesh::Result<int> {
    // Writing a core file takes seconds, during which the ports would stay open without a loop.
    ::prctl(PR_SET_DUMPABLE, 0);
    const prismesh::deviced::DaemonOptions options{prismesh::ipc::runtime_directory(given.path("--runtime-dir")), given.path("--config")};
    prismesh::Result<prismesh::deviced::Daemon> daemon = prismesh::deviced::Daemon::start(options);
    if (!daemon) return prismesh::fail(daemon.error());
    prismesh::logging::info("listening in {}", options.runtime_directory.string());
    daemon->run();
    return 0;
  };
  return prismesh::daemon::run({"prismesh-deviced", kUsage, {"--runtime-dir", "--config"}, serve}, argc, argv);
}
