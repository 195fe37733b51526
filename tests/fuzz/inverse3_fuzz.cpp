// Messages of a false Haply Inverse Service: whatever is taken is finite and bounded, a device that is chosen can be told a force, and no
// force is longer than it was.
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "drivers/haptic_pen/inverse3/messages.h"
#include "tests/fuzz/require.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prismesh::drivers::haptic_pen::inverse3;
  const auto state = read_message({reinterpret_cast<const char*>(data), size});
  if (!state) {
    require(!state.error().message.empty());
    return 0;
  }
  for (const DeviceState& device : state->devices) {
    require(!device.id.empty() && device.id.size() <= 32);
    require(!device.position_m || (device.position_m->allFinite() && to_pen_axes(*device.position_m).norm() < 20));
  }
  for (const GripState& grip : state->grips) {
    require(grip.buttons < 8);
    require(!grip.orientation || std::abs(to_pen_axes(*grip.orientation).norm() - 1) < 1e-9);
  }
  const auto chosen = choose_device(*state);
  if (!chosen) return 0;
  require(state->devices.size() == 1);
  // What is sent is a message of the same kind, with one device.
  const auto sent = read_message(force_message(*chosen, {1, -2, 0.5}, state->has_session));
  require(sent && sent->devices.size() == 1 && sent->devices.front().id == *chosen);
  require(text_frame(force_message(*chosen, {0, 0, 0}, true)).size() <= 160);
  return 0;
}
