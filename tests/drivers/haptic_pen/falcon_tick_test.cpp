// A tick of the Falcon's driver allocates nothing, whatever comes: its loop runs in real time.
#include <gtest/gtest.h>

#include "drivers/haptic_pen/falcon/falcon_pen.h"
#include "drivers/haptic_pen/falcon/ftdi.h"
#include "tests/drivers/port/allocations.h"

namespace prismesh::drivers::haptic_pen::falcon {
namespace {

/// Answers each packet at once, with the same pose.
class PromptPort final : public port::UsbPort {
 public:
  port::PortCount read(std::span<std::byte> to) override {
    if (answers_ == 0) return {};
    --answers_;
    const PacketBytes bytes = encode(PosePacket{.encoders = {-500, -500, -500}, .homed = kAllHomed});
    std::copy(bytes.begin(), bytes.end(), to.begin() + ftdi::kStatusBytes);
    return {ftdi::kStatusBytes + bytes.size(), port::PortStatus::ok};
  }
  port::PortStatus write(std::span<const std::byte>, std::int64_t) override {
    ++answers_;
    return port::PortStatus::ok;
  }
  port::PortStatus control(const port::UsbControl&) override { return port::PortStatus::ok; }
  std::size_t pending() const override { return 0; }
  std::uint64_t finished() const override { return 0; }
  int last_error() const override { return 0; }

 private:
  int answers_ = 0;
};

TEST(FalconTicks, allocate_nothing) {
  PromptPort port;
  FalconPen pen(port, {});
  const std::uint64_t before = port::allocations_of_this_thread();
  std::uint32_t fresh = 0;
  for (std::int64_t tick = 1; tick < 2000; ++tick) {
    fresh += pen.read(tick * 1'000'000).fresh ? 1 : 0;
    pen.send(tick * 1'000'000, {{0.5, 0.1, -1}, (tick + 3) * 1'000'000});
  }
  EXPECT_EQ(port::allocations_of_this_thread(), before);
  EXPECT_GT(fresh, 1800u);
}

}  // namespace
}  // namespace prismesh::drivers::haptic_pen::falcon
