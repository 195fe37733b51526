// Any bytes as a plan and as a script with parameters: no crash, errors say file and line, and what is read has values for every sample.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "mesh/batch/samples.h"
#include "mesh/batch/script.h"
#include "tests/fuzz/require.h"

using namespace prismesh;  // NOLINT: a fuzz target is a program of its own

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mesh::batch;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  // the part behind the first zero byte is a script
  const std::size_t end = text.find('\0');
  const Script script{"s.jsonl", std::string(end == std::string_view::npos ? text : text.substr(end + 1))};
  const auto plan = parse_plan(text.substr(0, end), "/proc/self/plan.toml");
  std::vector<Parameter> parameters{{"a", {}, 0, 1}};
  std::vector<ParameterValue> values{1.5};
  if (!plan) {
    require(plan.error().file == "/proc/self/plan.toml" && !plan.error().message.empty());
  } else {
    require(variant_count(*plan) >= 1 && variant_count(*plan) <= kMaxVariants);
    if (sample_count(*plan) <= 10'000) {
      const Samples samples(*plan);
      for (const std::size_t sample : {std::size_t{0}, sample_count(*plan) - 1}) {
        values = samples.at(sample);
        require(values.size() == plan->parameters.size());
      }
      parameters = plan->parameters;
    }
  }
  const auto edits = edits_with(script, parameters, values);
  if (!edits) require(edits.error().file == "s.jsonl" && edits.error().line >= 1 && !edits.error().message.empty());
  if (edits) require(parameters_named(script).has_value());
  return 0;
}
