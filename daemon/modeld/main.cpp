// prismesh-modeld: the document's daemon. Options and logging; the rest is in daemon.h.
#include <csignal>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "daemon/modeld/daemon.h"
#include "daemon/modeld/state_folder.h"
#include "ipc/client.h"

namespace {

constexpr const char* kUsage =
    "usage: prismesh-modeld [--runtime-dir FOLDER] [--state-dir FOLDER]\n"
    "  --runtime-dir  for the socket; default $RUNTIME_DIRECTORY, $XDG_RUNTIME_DIR/prismesh or /tmp/prismesh-UID\n"
    "  --state-dir    for journals; default $STATE_DIRECTORY, $XDG_STATE_HOME/prismesh or ~/.local/state/prismesh\n";

struct Arguments {
  std::optional<std::filesystem::path> runtime_directory;
  std::optional<std::filesystem::path> state_directory;
};

std::optional<Arguments> parse(int count, char** values) {
  Arguments arguments;
  for (int i = 1; i < count; ++i) {
    const std::string_view option = values[i];
    auto* target = option == "--runtime-dir" ? &arguments.runtime_directory
                   : option == "--state-dir" ? &arguments.state_directory
                                             : nullptr;
    if (target == nullptr || i + 1 == count) return std::nullopt;
    *target = values[++i];
  }
  return arguments;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::string_view(argv[1]) == "--help") {
    std::fputs(kUsage, stdout);
    return 0;
  }
  if (argc == 2 && std::string_view(argv[1]) == "--version") {
    std::puts("prismesh-modeld " PRISMESH_VERSION);
    return 0;
  }
  const std::optional<Arguments> arguments = parse(argc, argv);
  if (!arguments) {
    std::fputs(kUsage, stderr);
    return 2;
  }
  // Whoever read the log may go away, and a journal may grow beyond what a file may hold: both are errors of writing, no end.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  spdlog::set_default_logger(spdlog::stderr_logger_mt("modeld"));
  spdlog::set_pattern("%Y-%m-%dT%H:%M:%S.%e modeld %l: %v");

  const prismesh::modeld::DaemonOptions options{prismesh::ipc::runtime_directory(arguments->runtime_directory),
                                                prismesh::modeld::state_directory(arguments->state_directory)};
  prismesh::Result<prismesh::modeld::Daemon> daemon = prismesh::modeld::Daemon::start(options);
  if (!daemon) {
    std::fprintf(stderr, "%s\n", daemon.error().text().c_str());
    return 1;
  }
  spdlog::info("listening in {}, journals in {}", options.runtime_directory.string(), options.state_directory.string());
  daemon->run();
  spdlog::info("ended");
  return 0;
}
