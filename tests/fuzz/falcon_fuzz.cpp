// Bytes from a false Falcon or host, and false firmware files: a packet that is found can be written again as it was, a file that is taken
// ends where its last block says, and no packet leads to a place that isn't finite.
#include <cmath>
#include <cstdint>
#include <span>

#include "drivers/haptic_pen/falcon/firmware.h"
#include "drivers/haptic_pen/falcon/kinematics.h"
#include "drivers/haptic_pen/falcon/packet.h"
#include "tests/fuzz/require.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prismesh::drivers::haptic_pen::falcon;
  const auto bytes = std::as_bytes(std::span(data, size));
  PacketFinder finder;
  std::size_t found = 0;
  for (const std::byte each : bytes) {
    const auto packet = finder.take(each);
    if (!packet) continue;
    ++found;
    if (const auto force = decode_force(*packet)) {
      const auto again = decode_force(encode(*force));
      require(again && again->motors == force->motors && again->lights == force->lights && again->homing == force->homing);
    }
    if (const auto pose = decode_pose(*packet)) {
      const auto again = decode_pose(encode(*pose));
      require(again && again->encoders == pose->encoders && again->buttons == pose->buttons && again->homed == pose->homed);
      const Eigen::Vector3d angles(angle_of_count(pose->encoders[0]), angle_of_count(pose->encoders[1]), angle_of_count(pose->encoders[2]));
      const auto place = forward_kinematics(angles);
      require(!place || (place->position.allFinite() && place->jacobian.allFinite() && place->position.norm() < 1));
    }
  }
  require(found * kPacketBytes + finder.skipped() <= size);
  if (const auto firmware = parse_firmware(bytes, "firmware")) {
    require(firmware->bytes.size() == size && size >= 30 && size % 2 == 0);
    // Nothing may be missing at its end.
    require(!parse_firmware(bytes.first(size - 1), "firmware") && !parse_firmware(bytes.first(size - 2), "firmware"));
  }
  return 0;
}
