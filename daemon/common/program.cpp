#include "daemon/common/program.h"

#include <csignal>
#include <cstdio>

#include "base/log.h"
#include "base/supervisor.h"

namespace prismesh::daemon {

int run(const Program& program, int argc, char** argv) {
  const ProgramOptions given = program_options({program.name, program.usage, program.with_path}, argc, argv);
  if (given.end) return *given.end;
  // A closed log pipe (SIGPIPE) and a journal beyond the file size limit (SIGXFSZ) are write errors, and must not end the process.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  logging::start(program.name.substr(program.name.find('-') + 1));
  const Result<int> status = program.serve(given);
  if (!status) {
    std::fprintf(stderr, "%s\n", status.error().text().c_str());
    supervisor::wait_before_failing();
    return 1;
  }
  logging::info("ended");
  return *status;
}

}  // namespace prismesh::daemon
