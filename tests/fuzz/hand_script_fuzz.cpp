// Scripts of a hand from anywhere: each is refused with its line, or gives a hand that stays within the workspace at any time.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

#include "drivers/haptic_pen/hand_script.h"
#include "tests/fuzz/require.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prismesh::drivers::haptic_pen;
  const auto script = HandScript::parse({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!script) {
    require(!script.error().message.empty());
    return 0;
  }
  for (const double seconds : {-1.0, 0.0, 0.5, 1.0, 3.7, script->seconds(), script->seconds() * 2, 1e300}) {
    const SimulatedHand hand = script->at(seconds);
    require(hand.goal_mm.allFinite() && hand.goal_mm.cwiseAbs().maxCoeff() <= 65.001);
    require(hand.buttons <= 3);
  }
  return 0;
}
