// Any bytes as a criteria file: no crash, errors say file and line, and whatever is read judges shells without a NaN.
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "mesh/quality/composite.h"
#include "mesh/quality/judge.h"
#include "mesh/quality/measure.h"
#include "tests/fuzz/require.h"

using namespace prismesh;  // NOLINT: a fuzz target is a program of its own

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mesh::quality;
  const auto criteria = parse_criteria({reinterpret_cast<const char*>(data), size}, "criteria.toml");
  if (!criteria) {
    require(criteria.error().file == "criteria.toml" && criteria.error().line >= 1 && !criteria.error().message.empty());
    return 0;
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::vector<mesh::Vec3>> shells = {{{0, 0, 0}, {5, 0, 0}, {6, 4, 1}, {0, 5, 0}},
                                                       {{0, 0, 0}, {5, 0, 0}, {0, 3, 0}},
                                                       {{0, 0, 0}, {5, 0, 0}, {9, 0, 0}},
                                                       {{0, 0, 0}, {5, 0, nan}, {6, 4, 1}, {0, 5, 0}}};
  for (const auto& shell : shells)
    for (const ShellProperties& properties : {ShellProperties(), ShellProperties(1.5, 5.4e6)}) {
      const Values values = measure(shell);
      const ShellState state = judge(values, {*criteria, 5.0}, properties);
      const float rated = composite(values, {*criteria, 5.0}, properties);
      require((state.fail & ~state.warn) == 0);
      require(rated >= -1 && rated <= 1);
      require((rated < 0) == (state.grade() == Grade::fail));
      require((rated == -1) == state.has_defect());
    }
  return 0;
}
