// prismesh-deviced, the daemon for eye tracker and prism servo: options and logging. The rest is in daemon.h.
#include <csignal>
#include <cstdio>

#include <sys/prctl.h>

#include "base/log.h"
#include "base/program_options.h"
#include "daemon/deviced/daemon.h"
#include "ipc/wire/runtime_directory.h"

namespace {

constexpr const char* kUsage =
    "usage: prismesh-deviced [--runtime-dir FOLDER] [--config FILE]\n"
    "  --runtime-dir  for the socket; default $RUNTIME_DIRECTORY, $XDG_RUNTIME_DIR/prismesh or /tmp/prismesh-UID\n"
    "  --config       settings that go before those in /etc/prismesh/prismesh.toml and ~/.config/prismesh/prismesh.toml\n";

}  // namespace

int main(int argc, char** argv) {
  const prismesh::ProgramOptions given = prismesh::program_options({"prismesh-deviced", kUsage, {"--runtime-dir", "--config"}}, argc, argv);
  if (given.end) return *given.end;
  // A closed log pipe is a write error, and must not end the process.
  std::signal(SIGPIPE, SIG_IGN);
  // Writing a core file takes seconds, during which the ports would stay open without a loop.
  ::prctl(PR_SET_DUMPABLE, 0);
  prismesh::logging::start("deviced");

  const prismesh::deviced::DaemonOptions options{prismesh::ipc::runtime_directory(given.path("--runtime-dir")), given.path("--config")};
  prismesh::Result<prismesh::deviced::Daemon> daemon = prismesh::deviced::Daemon::start(options);
  if (!daemon) {
    std::fprintf(stderr, "%s\n", daemon.error().text().c_str());
    return 1;
  }
  prismesh::logging::info("listening in {}", options.runtime_directory.string());
  daemon->run();
  prismesh::logging::info("ended");
  return 0;
}
