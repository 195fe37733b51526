#include "mesh/deck/sample.h"

#include "cli/commands.h"
#include "cli/progress_bar.h"
#include "cli/report_text.h"

namespace prismesh::cli {

namespace {

Result<void> write_watched(const SampleOptions& options, const Context& context) {
  MonotonicClock clock;
  ProgressBar bar(context, "making " + options.output.filename().string(), clock);
  return mesh::deck::write_sample(options.output, options.elements.value_or(mesh::deck::kSampleShellsDefault), bar.progress());
}

}  // namespace

int sample(const SampleOptions& options, const Common&, const Context& context) {
  if (const Result<void> written = write_watched(options, context); !written) {
    say(context, written.error());
    return kFailed;
  }
  return kDone;
}

}  // namespace prismesh::cli
