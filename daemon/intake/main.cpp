// prismesh-intake, which takes models from the network: options and settings. The rest is in daemon.h.
#include <filesystem>

#include "daemon/common/program.h"
#include "daemon/intake/daemon.h"
#include "ipc/wire/runtime_directory.h"

namespace {

constexpr const char* kUsage =
    "usage: prismesh-intake [--runtime-dir FOLDER] [--state-dir FOLDER] [--store FOLDER] [--work FOLDER] [--config FILE]\n"
    "  Takes models from the network into a store, where the settings say so (docs/remote.md).\n"
    "  --runtime-dir  for the socket; default $RUNTIME_DIRECTORY, $XDG_RUNTIME_DIR/prismesh or /tmp/prismesh-UID\n"
    "  --state-dir    for key, tokens and audit log; default $STATE_DIRECTORY, $XDG_STATE_HOME/prismesh or ~/.local/state/prismesh\n"
    "  --store        for the models; default: store, in the folder of --state-dir\n"
    "  --work         stored models are edited in folders beneath it; default: work, in the folder of --state-dir\n"
    "  --config       settings that go before the system's and the user's prismesh.toml (docs/settings.md)\n";

}  // namespace

int main(int argc, char** argv) {
  const auto serve = [](const prismesh::ProgramOptions& given) -> prismesh::Result<int> {
    const auto settings = prismesh::drivers::settings::read_settings(given.path("--config"));
    if (!settings) return prismesh::fail(settings.error());
    auto options = prismesh::intake::intake_options(settings->remote, prismesh::ipc::state_directory(given.path("--state-dir")));
    if (!options) return prismesh::fail(options.error());
    if (const auto store = given.path("--store")) options->store = *store;
    if (const auto work = given.path("--work")) options->work = *work;
    options->work = std::filesystem::absolute(options->work);
    // Other programs are told of it.
    options->store = std::filesystem::absolute(options->store);
    auto daemon = prismesh::intake::Daemon::start({prismesh::ipc::runtime_directory(given.path("--runtime-dir")), *options});
    if (!daemon) return prismesh::fail(daemon.error());
    daemon->run();
    return 0;
  };
  return prismesh::daemon::run({"prismesh-intake", kUsage, {"--runtime-dir", "--state-dir", "--store", "--work", "--config"}, serve}, argc,
                               argv);
}
