// Reports of a false SpaceMouse: a first byte gives each one's length. No axis goes beyond its end, and what is cut changes nothing. The
// same bytes are also a stream of spacenavd, whose pieces say the same as the whole.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "drivers/space_mouse/report.h"
#include "drivers/space_mouse/response.h"
#include "drivers/space_mouse/spnav.h"
#include "tests/fuzz/require.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prismesh::drivers::space_mouse;
  const auto none = [](const SpaceMouseState&) {};
  SpnavEvents whole, pieces;
  SpaceMouseState from_whole, from_pieces;
  SpaceMouseState state;
  whole.take(std::as_bytes(std::span(data, size)), from_whole, none);
  auto rest = std::as_bytes(std::span(data, size));
  while (!rest.empty()) {
    const std::size_t length = std::min<std::size_t>(std::to_integer<std::size_t>(rest[0]) % 65, rest.size() - 1);
    const SpaceMouseState before = state;
    const auto kind = take_report(rest.subspan(1, length), state);
    require((kind && *kind != ReportKind::other) || state == before);
    for (const auto* axes : {&state.shift, &state.turn})
      for (const int each : *axes) require(std::abs(each) <= kFullDeflection);
    const SpaceMouseMotion motion = motion_of(state, {});
    for (const auto* parts : {&motion.shift, &motion.turn})
      for (const double each : *parts) require(std::abs(each) <= 1);
    pieces.take(rest.first(1 + length), from_pieces, none);
    rest = rest.subspan(1 + length);
  }
  require(from_whole == from_pieces);
  for (const auto* axes : {&from_whole.shift, &from_whole.turn})
    for (const int each : *axes) require(std::abs(each) <= kFullDeflection);
  return 0;
}
