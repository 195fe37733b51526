#include "cli/run.h"

#include <new>
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
  try {
    const int status = (*action)(surroundings);
    return status == kDone && !output_is_good(surroundings) ? kFailed : status;
  } catch (const std::bad_alloc&) {
    say(surroundings, Error{"prismesh " + args[0], 0, "there isn't enough memory to do this"});
    return kFailed;
  }
}

int run(std::span<const std::string> args, std::ostream& out, std::ostream& err) { return run(args, Surroundings{out, err}); }

}  // namespace prismesh::cli
