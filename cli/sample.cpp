#include "mesh/deck/sample.h"

#include "cli/commands.h"
#include "cli/report_text.h"

namespace prismesh::cli {

int sample(const SampleOptions& options, const Common&, const Surroundings& surroundings) {
  const std::size_t elements = options.elements.value_or(mesh::deck::kSampleShellsDefault);
  if (const Result<void> written = mesh::deck::write_sample(options.output, elements); !written) {
    say(surroundings, written.error());
    return kFailed;
  }
  return kDone;
}

}  // namespace prismesh::cli
