// Three targets for the prism servo's bytes. The parser: whatever it finds can be written and read again, and no byte is lost from its
// account. The simulated servo: any bytes from a host. The driver: a servo's answers with bytes put in, changed and taken out; its goals
// stay within the travel, its readings are numbers, and a clean line brings it back to work.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <span>

#include "drivers/prism_servo/dynamixel/servo.h"
#include "drivers/prism_servo/dynamixel/simulated_servo.h"

namespace {

using namespace prismesh::drivers;
using namespace prismesh::drivers::prism_servo;
using namespace prismesh::drivers::prism_servo::dynamixel;

constexpr std::int64_t kMs = 1'000'000;

void check(bool holds) {
  if (!holds) std::abort();
}

class QueuePort final : public port::BytePort {
 public:
  QueuePort(std::deque<std::byte>& in, std::deque<std::byte>& out) : in_(in), out_(out) {}
  port::PortCount read(std::span<std::byte> to) override {
    std::size_t got = 0;
    for (; got < to.size() && !in_.empty(); ++got) {
      to[got] = in_.front();
      in_.pop_front();
    }
    return {got, port::PortStatus::ok};
  }
  port::PortCount write(std::span<const std::byte> from) override {
    out_.insert(out_.end(), from.begin(), from.end());
    return {from.size(), port::PortStatus::ok};
  }
  void discard_input() override { in_.clear(); }
  bool set_baud(int) override { return true; }
  int last_error() const override { return 0; }

 private:
  std::deque<std::byte>&in_, &out_;
};

void try_parser(std::span<const std::byte> bytes) {
  Parser parser;
  std::size_t in_packets = 0;
  while (!bytes.empty()) {
    const std::size_t piece = std::min<std::size_t>(bytes.size(), 1 + std::to_integer<std::size_t>(bytes.front()) % 50);
    check(parser.take(bytes.first(piece)) == piece);
    bytes = bytes.subspan(piece);
    while (const Packet* packet = parser.next()) {
      ++in_packets;
      check(packet->count <= kMaxParameters);
      std::array<std::byte, kMaxPacketLength> again;
      const bool status = packet->instruction == Instruction::status;
      const auto error = static_cast<std::uint8_t>(packet->error | (packet->alert ? kAlertBit : 0));
      const std::size_t size =
          status ? encode_status(packet->id, error, packet->data(), again) : encode(packet->id, packet->instruction, packet->data(), again);
      check(size > 0);
      Parser other;
      check(other.take(std::span(again).first(size)) == size);
      const Packet* same = other.next();
      check(same != nullptr && same->id == packet->id && same->instruction == packet->instruction && same->error == packet->error);
      check(std::equal(same->data().begin(), same->data().end(), packet->data().begin(), packet->data().end()));
    }
  }
  check(parser.bytes_skipped() >= parser.bad_packets() || in_packets > 0 || parser.bad_packets() > 0);
}

void try_simulator(std::span<const std::byte> bytes) {
  std::deque<std::byte> to_device(bytes.begin(), bytes.end()), to_host;
  QueuePort port(to_device, to_host);
  SimulatedServo servo(port, {});
  for (int ms = 0; ms < 40; ++ms) {
    servo.step(ms * kMs);
    check(std::isfinite(servo.mask_mm()) && std::abs(servo.mask_mm()) <= SimulatedServoSettings{}.stop_mm + 0.01);
  }
}

/// What the bytes do to the line toward the host: (what, how many) pairs.
void disturb(std::deque<std::byte>& to_host, std::span<const std::byte>& script) {
  if (script.empty()) return;
  const auto next = [&]() -> unsigned {
    if (script.empty()) return 0;
    const auto value = std::to_integer<unsigned>(script.front());
    script = script.subspan(1);
    return value;
  };
  const unsigned what = next() % 8;
  if (what == 0 && !to_host.empty()) to_host.erase(to_host.begin() + next() % to_host.size());
  if (what == 1 && !to_host.empty()) to_host[next() % to_host.size()] ^= static_cast<std::byte>(1 + next() % 255);
  if (what == 2) to_host.clear();
  if (what != 3) return;
  for (unsigned left = next() % 40; left > 0 && !script.empty(); --left) to_host.push_back(static_cast<std::byte>(next()));
}

void try_driver(std::span<const std::byte> script) {
  std::deque<std::byte> to_device, to_host;
  QueuePort device(to_device, to_host), host(to_host, to_device);
  SimulatedServo simulated(device, {});
  Servo servo(host, {});
  std::int64_t now = 1'000 * kMs;
  const auto tick = [&](double goal_mm) {
    const PrismServo::Tick result = servo.tick(now, goal_mm, true);
    check(std::isfinite(result.reading.position_mm) && std::isfinite(result.reading.velocity_mm_s));
    check(result.reading.measured_ns <= now);
    for (int i = 0; i < 5; ++i) simulated.step(now += kMs);
    return result.phase;
  };
  while (!script.empty()) {
    tick(std::to_integer<int>(script.front()) / 30.0 - 4);
    disturb(to_host, script);
  }
  check(simulated.counts().goals_beyond_limits == 0);
  to_host.clear();
  // A forged answer may have made it wait for a second, or look through all speeds.
  bool ready = false;
  for (int i = 0; i < 1'500 && !ready; ++i) ready = tick(0.5) == ServoPhase::ready;
  if (servo.counts().answers > 0 && !ready) {
    // An alarm that never was stays until the motor is let go and asked again.
    for (int i = 0; i < 20; ++i) {
      servo.tick(now, 0, false);
      for (int j = 0; j < 5; ++j) simulated.step(now += kMs);
    }
    for (int i = 0; i < 1'500 && !ready; ++i) ready = tick(0.5) == ServoPhase::ready;
  }
  check(ready);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0 || size > 4096) return 0;
  const std::span<const std::byte> bytes = std::as_bytes(std::span(data, size)).subspan(1);
  switch (data[0] % 3) {
    case 0: try_parser(bytes); break;
    case 1: try_simulator(bytes); break;
    default: try_driver(bytes.first(std::min<std::size_t>(bytes.size(), 600)));
  }
  return 0;
}
