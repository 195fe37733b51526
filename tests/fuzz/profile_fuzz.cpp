// Any bytes as a display profile: no crash, errors say file and line, and what is read can be written and read again.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "drivers/display/profile.h"
#include "tests/fuzz/require.h"

using namespace prismesh;  // NOLINT: a fuzz target is a program of its own

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace drivers::display;
  const auto profile = parse_profile({reinterpret_cast<const char*>(data), size}, "profile.toml");
  if (!profile) {
    require(profile.error().file == "profile.toml" && profile.error().line >= 1 && !profile.error().message.empty());
    return 0;
  }
  const auto again = parse_profile(profile_text(*profile), "profile.toml");
  require(again.has_value() && *again == *profile);
  const Eigen::Vector3d eye(-30, 10, 600);
  const WindowRow row = window_row(profile->optics, eye, 0, 400);
  require(row.spacing_mm > 0 && row.first_mm == row.first_mm);
  return 0;
}
