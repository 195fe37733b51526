// Measures a tick of the prism control: where the mask goes, and the servo's bytes in and out; and the same while it is set up and flies
// back.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstring>

#include "drivers/prism_servo/dynamixel/servo.h"
#include "drivers/prism_servo/mask_control.h"

namespace prismesh::drivers::prism_servo {
namespace {

using dynamixel::Instruction;
using dynamixel::Packet;
using dynamixel::Parser;

constexpr std::int64_t kTickNs = 5'000'000;

/// Answers whatever is asked, at once: a healthy servo that is always where it was told to be.
class AnsweringPort final : public port::BytePort {
 public:
  port::PortCount read(std::span<std::byte> to) override {
    const std::size_t count = std::min(to.size(), size_);
    std::memcpy(to.data(), answer_.data(), count);
    size_ = 0;
    return {count, port::PortStatus::ok};
  }
  port::PortCount write(std::span<const std::byte> from) override {
    parser_.take(from);
    while (const Packet* packet = parser_.next()) carry_out(*packet);
    return {from.size(), port::PortStatus::ok};
  }
  void discard_input() override { size_ = 0; }
  bool set_baud(int) override { return true; }
  int last_error() const override { return 0; }

 private:
  void carry_out(const Packet& packet) {
    const std::uint32_t address = dynamixel::number_at(packet.data(), 0, 2);
    if (packet.instruction == Instruction::ping) {
      const std::array<std::uint8_t, 3> who = {0x06, 0x04, 45};
      size_ = dynamixel::encode_status(1, 0, who, answer_);
    } else if (packet.instruction == Instruction::write) {
      for (std::size_t i = 2; i < packet.count; ++i) table_[(address + i - 2) % table_.size()] = packet.parameters[i];
      if (address == dynamixel::kGoalPosition.address) std::memcpy(&table_[132], &table_[116], 4);
    } else if (packet.instruction == Instruction::read) {
      if (address == dynamixel::kVelocityLimit.address) table_[45] = 4;
      const std::size_t count = dynamixel::number_at(packet.data(), 2, 2);
      size_ = dynamixel::encode_status(1, 0, std::span(table_).subspan(address, count), answer_);
    }
  }

  Parser parser_;
  std::array<std::uint8_t, 256> table_{};
  std::array<std::byte, dynamixel::kMaxPacketLength> answer_{};
  std::size_t size_ = 0;
};

void a_tick_of_servo_and_mask(benchmark::State& state) {
  AnsweringPort port;
  dynamixel::Servo servo(port, {});
  MaskLimits limits;
  limits.travel_mm = static_cast<double>(state.range(0)) / 100;
  MaskControl control({}, limits);
  MaskControl::Input input;
  MaskControl::Output output;
  input.now_ns = 1'000'000'000;
  input.head_seen = true;
  input.servo_lag_ns = 20'000'000;
  std::int64_t ready = 0, flying = 0;
  for (auto _ : state) {
    input.now_ns += kTickNs;
    input.head.time_ns = input.now_ns - 20'000'000;
    const double seconds = static_cast<double>(input.now_ns) * 1e-9;
    input.head.between_eyes_mm = {150 * std::sin(seconds), 0, 650};
    input.head.velocity_mm_s = {150 * std::cos(seconds), 0, 0};
    input.servo = servo.tick(input.now_ns, output.goal_mm, output.powered);
    output = control.step(input);
    benchmark::DoNotOptimize(output);
    ready += input.servo.phase == ServoPhase::ready ? 1 : 0;
    flying += output.state.phase == MaskPhase::flying_back ? 1 : 0;
  }
  state.counters["ready_share"] = static_cast<double>(ready) / static_cast<double>(state.iterations());
  state.counters["flying_share"] = static_cast<double>(flying) / static_cast<double>(state.iterations());
}
BENCHMARK(a_tick_of_servo_and_mask)->ArgName("travel_mm_100")->Arg(200)->Arg(40);

void an_exchange_of_packets(benchmark::State& state) {
  std::array<std::byte, 256> line;
  const std::array<std::uint8_t, 8> motion = {1, 0, 0, 0, 0, 8, 0, 0};
  Parser parser;
  for (auto _ : state) {
    std::size_t size = dynamixel::encode_write(1, 116, 2048, 4, line);
    size += dynamixel::encode_read(1, 128, 8, std::span(line).subspan(size));
    size += dynamixel::encode_status(1, 0, motion, std::span(line).subspan(size));
    parser.take(std::span(line).first(size));
    while (const Packet* packet = parser.next()) benchmark::DoNotOptimize(packet);
  }
}
BENCHMARK(an_exchange_of_packets);

}  // namespace
}  // namespace prismesh::drivers::prism_servo
