#include "cli/run.h"

#include <new>
#include <ostream>

#include "cli/arguments.h"
#include "cli/report_text.h"

namespace prismesh::cli {

int run(std::span<const std::string> args, const Context& context) {
  const Result<Action> action = parse_arguments(args);
  if (!action) {
    say(context, action.error());
    return kWrongUsage;
  }
  try {
    const int status = (*action)(context);
    return status == kDone && !output_is_good(context) ? kFailed : status;
  } catch (const std::bad_alloc&) {
    say(context, Error{"prismesh " + args[0], 0, "there isn't enough memory to do this"});
    return kFailed;
  }
}

int run(std::span<const std::string> args, std::ostream& out, std::ostream& err) { return run(args, Context{out, err}); }

}  // namespace prismesh::cli
