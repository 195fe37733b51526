// prismesh-deviced, the daemon for eye tracker and prism servo, and as a process of its own for the haptic pen: options and logging. The
// rest is in daemon.h and pen/pen_daemon.h.
#include <sys/prctl.h>

#include "base/log.h"
#include "daemon/common/program.h"
#include "daemon/deviced/daemon.h"
#include "daemon/deviced/pen/pen_daemon.h"
#include "daemon/deviced/pen/weigh.h"
#include "ipc/wire/runtime_directory.h"

namespace {

constexpr const char* kUsage =
    "usage: prismesh-deviced [--only PROCESS] [--weigh GRAMS] [--runtime-dir FOLDER] [--state-dir FOLDER] [--config FILE]\n"
    "  --only         pen: drives the haptic pen, and nothing else; without it, everything but the pen\n"
    "  --weigh        with --only pen: weighs it with so many grams, says what to do, prints the setting, and ends\n"
    "  --runtime-dir  for the socket; default $RUNTIME_DIRECTORY, $XDG_RUNTIME_DIR/prismesh or /tmp/prismesh-UID\n"
    "  --state-dir    for the pen's latch; default $STATE_DIRECTORY, $XDG_STATE_HOME/prismesh or ~/.local/state/prismesh\n"
    "  --config       settings that go before those in /etc/prismesh/prismesh.toml and ~/.config/prismesh/prismesh.toml\n";

prismesh::Result<int> serve_pen(const prismesh::ProgramOptions& given) {
  const prismesh::deviced::pen::PenDaemonOptions options{prismesh::ipc::runtime_directory(given.path("--runtime-dir")),
                                                         prismesh::ipc::state_directory(given.path("--state-dir")), given.path("--config")};
  prismesh::Result<prismesh::deviced::pen::PenDaemon> daemon = prismesh::deviced::pen::PenDaemon::start(options);
  if (!daemon) return prismesh::fail(daemon.error());
  prismesh::logging::info("listening in {}", options.runtime_directory.string());
  return daemon->run();
}

prismesh::Result<int> weigh(const prismesh::ProgramOptions& given) {
  const prismesh::Result<double> grams = prismesh::deviced::pen::grams_of(given.path("--weigh")->string());
  if (!grams) return prismesh::fail(grams.error());
  const prismesh::deviced::pen::WeighPenOptions options{prismesh::ipc::state_directory(given.path("--state-dir")), given.path("--config"),
                                                        *grams};
  if (prismesh::Result<void> weighed = prismesh::deviced::pen::weigh_pen(options); !weighed) return prismesh::fail(weighed.error());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const auto serve = [](const prismesh::ProgramOptions& given) -> prismesh::Result<int> {
    // Writing a core file takes seconds, during which the ports would stay open without a loop.
    ::prctl(PR_SET_DUMPABLE, 0);
    if (const auto only = given.path("--only")) {
      if (*only == "pen") return given.path("--weigh") ? weigh(given) : serve_pen(given);
      return prismesh::fail("--only", "must be pen, not " + only->string());
    }
    if (given.path("--weigh")) return prismesh::fail("--weigh", "goes with --only pen");
    const prismesh::deviced::DaemonOptions options{prismesh::ipc::runtime_directory(given.path("--runtime-dir")), given.path("--config")};
    prismesh::Result<prismesh::deviced::Daemon> daemon = prismesh::deviced::Daemon::start(options);
    if (!daemon) return prismesh::fail(daemon.error());
    prismesh::logging::info("listening in {}", options.runtime_directory.string());
    daemon->run();
    return 0;
  };
  return prismesh::daemon::run({"prismesh-deviced", kUsage, {"--only", "--weigh", "--runtime-dir", "--state-dir", "--config"}, serve}, argc,
                               argv);
}
