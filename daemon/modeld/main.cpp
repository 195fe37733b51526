// prismesh-modeld, the document daemon: options and logging. The rest is in daemon.h.
#include <chrono>
#include <filesystem>
#include <optional>
#include <system_error>

#include "base/log.h"
#include "daemon/common/program.h"
#include "daemon/modeld/daemon.h"
#include "daemon/modeld/state_folder.h"
#include "drivers/settings/settings.h"
#include "ipc/wire/runtime_directory.h"

namespace {

constexpr const char* kUsage =
    "usage: prismesh-modeld [--runtime-dir FOLDER] [--state-dir FOLDER] [--config FILE]\n"
    "  --runtime-dir  for the socket; default $RUNTIME_DIRECTORY, $XDG_RUNTIME_DIR/prismesh or /tmp/prismesh-UID\n"
    "  --state-dir    for journals; default $STATE_DIRECTORY, $XDG_STATE_HOME/prismesh or ~/.local/state/prismesh\n"
    "  --config       settings that go before the system's and the user's prismesh.toml (docs/settings.md)\n";

}  // namespace

int main(int argc, char** argv) {
  const auto serve = [](const prismesh::ProgramOptions& given) -> prismesh::Result<int> {
    const std::optional<std::filesystem::path> config = given.path("--config");
    prismesh::Result<prismesh::drivers::settings::StationSettings> settings = prismesh::drivers::settings::read_settings(config);
    if (!settings && config) return prismesh::fail(settings.error());
    // An error in a device's settings must not prevent opening a deck.
    if (!settings) {
      prismesh::logging::warn("the settings are left aside: {}", settings.error().text());
      settings = prismesh::drivers::settings::StationSettings{};
    }
    prismesh::modeld::DaemonOptions options;
    std::error_code unknown;
    options.runtime_directory = prismesh::ipc::runtime_directory(given.path("--runtime-dir"));
    options.state_directory = prismesh::ipc::state_directory(given.path("--state-dir"));
    options.intake = options.runtime_directory / "intake.sock";
    // The service manager's socket, if it has one; else the program beside this one.
    options.importer.socket = options.runtime_directory / "import.sock";
    options.importer.program = std::filesystem::read_symlink("/proc/self/exe", unknown).parent_path() / "prismesh-import";
    options.history_bytes = static_cast<std::size_t>(settings->document.history_mb) << 20;
    options.hang_limit = std::chrono::seconds(settings->document.hang_s);
    prismesh::Result<prismesh::modeld::Daemon> daemon = prismesh::modeld::Daemon::start(options);
    if (!daemon) return prismesh::fail(daemon.error());
    prismesh::logging::info("listening in {}, journals in {}", options.runtime_directory.string(), options.state_directory.string());
    daemon->run();
    return 0;
  };
  return prismesh::daemon::run({"prismesh-modeld", kUsage, {"--runtime-dir", "--state-dir", "--config"}, serve}, argc, argv);
}
