// Bytes from a false pen or host: whatever is found in them is a frame that can be written again as it was, and no force is longer than a
// frame can hold.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "drivers/haptic_pen/framed/frame.h"
#include "tests/fuzz/require.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prismesh::drivers::haptic_pen::framed;
  FrameFinder finder;
  std::size_t at = 0, found = 0;
  while (at < size) {
    const std::size_t count = std::min(finder.space().size(), size - at);
    require(count > 0);
    std::memcpy(finder.space().data(), data + at, count);
    finder.received(count);
    at += count;
    while (const auto bytes = finder.next()) {
      ++found;
      if (const auto force = decode_force(*bytes)) {
        require(force->newton.cwiseAbs().maxCoeff() < 32.769);
        const auto again = decode_force(encode(*force));
        require(again && again->number == force->number && (again->newton - force->newton).norm() < 0.002);
      }
      if (const auto pose = decode_pose(*bytes)) {
        require(pose->position_mm.cwiseAbs().maxCoeff() <= 2000);
        require(decode_pose(encode(*pose))->position_mm.isApprox(pose->position_mm, 1e-9) || pose->position_mm.isZero(1e-9));
      }
    }
  }
  require(found * kFrameBytes + finder.skipped() <= size);
  return 0;
}
