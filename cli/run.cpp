#include "cli/run.h"

#include <ostream>

#include "cli/arguments.h"
#include "cli/report_text.h"

namespace prismesh::cli {

int run(std::span<const std::string> args, const Surroundings& surroundings) {
  const Result<Action> action = parse_arguments(args);
  if (!action) {
    say(surroundings, action.error());
    return kWrongUsage;
  }
  const int status = (*action)(surroundings);
  return status == kDone && !output_is_good(surroundings) ? kFailed : status;
}

int run(std::span<const std::string> args, std::ostream& out, std::ostream& err) { return run(args, Surroundings{out, err}); }

}  // namespace prismesh::cli
