// The device's side of a Falcon: FTDI chip, boot loader, firmware, arms and a hand, behind any simulated USB cable. In virtual time. What a
// real one does when its host falls silent isn't known, so this one can do either.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "drivers/haptic_pen/falcon/packet.h"
#include "drivers/haptic_pen/simulated_pen.h"
#include "drivers/port/memory_usb.h"

namespace prismesh::drivers::haptic_pen::falcon {

/// When no packet comes any more.
enum class Silence : std::uint8_t { holds_last_force, lets_go };

struct SimulatedFalconOptions {
  SimulatedPenOptions pen{.quantum_mm = 0, .max_newton = 12, .workspace_mm = 42};  ///< its encoders have steps of their own
  Silence silence = Silence::holds_last_force;
  std::int64_t lets_go_after_ns = 50'000'000;
  bool runs = false;             ///< firmware has been loaded already
  bool homed = false;            ///< the same for homing
  std::size_t piece_bytes = 62;  ///< of answers in a packet: short ones are cut, long ones merged
};

/// Called for each force packet that arrives.
using FalconWatcher = std::function<void(std::int64_t now_ns, const ForcePacket& packet)>;

class SimulatedFalcon final : public port::UsbDevice {
 public:
  SimulatedFalcon(const SimulatedFalconOptions& options, HandSource hand, FalconWatcher watcher = {});

  bool control(std::int64_t now_ns, const port::UsbControl& request) override;
  void receive(std::int64_t now_ns, std::span<const std::byte> bytes) override;
  std::size_t send(std::int64_t now_ns, std::span<std::byte> to) override;

  const SimulatedPen& pen() const { return pen_; }
  bool runs() const { return state_ == State::runs; }
  std::uint8_t homed() const { return homed_; }
  const std::vector<std::byte>& loaded() const { return loaded_; }  ///< all that the boot loader got the last time
  /// The force that the motors make now.
  const Eigen::Vector3d& newton() const { return newton_; }

  // Faults: each holds until it is taken back.
  void lose_power();  ///< forgets firmware and homing
  void lose_homing() { homed_ = 0; }
  void damage_echo(std::size_t at) { damaged_echo_ = at; }
  void be_deaf(bool deaf) { deaf_ = deaf; }
  void answer_late_by(std::int64_t ns) { late_ns_ = ns; }
  void lose_next_answers(std::uint32_t count) { answers_to_lose_ = count; }
  /// Puts bytes into what the host will read.
  void inject(std::int64_t now_ns, std::span<const std::byte> bytes);

 private:
  enum class State : std::uint8_t { off, greets, waits_for_lock, loads, refuses, runs };
  struct Answer {
    std::byte byte{};
    std::int64_t due_ns = 0;
  };

  void take(std::int64_t now_ns, std::byte byte);
  void load(std::int64_t now_ns, std::byte byte);
  void answer_force(std::int64_t now_ns, const ForcePacket& packet);
  void put(std::int64_t now_ns, std::byte byte);
  void move(std::int64_t now_ns);

  SimulatedFalconOptions options_;
  SimulatedPen pen_;
  FalconWatcher watcher_;
  State state_ = State::off;
  bool rts_low_ = false, dtr_ = false, deaf_ = false;
  std::uint16_t baud_ = 0;
  std::int64_t latency_ns_ = 16'000'000, packet_due_ns_ = 0, late_ns_ = 0;
  std::deque<Answer> answers_;
  std::vector<std::byte> heard_;
  std::vector<std::byte> loaded_;
  std::size_t words_left_ = 0;  ///< of the block that the loader copies
  std::uint8_t homed_ = 0;
  std::array<int, 3> origin_{};  ///< what the encoders call 0, in true counts
  std::array<int, 3> last_counts_{};
  bool placed_ = false;
  std::size_t damaged_echo_ = static_cast<std::size_t>(-1);
  std::uint32_t answers_to_lose_ = 0;
  std::int64_t told_ns_ = 0;
  Eigen::Vector3d newton_ = Eigen::Vector3d::Zero();
  PacketFinder finder_;
};

/// A stream that the boot loader takes, for tests: not a Falcon's firmware.
std::vector<std::byte> pretended_firmware(std::size_t words);

/// A hand that homes the device at first, then follows `then`.
HandSource homing_hand(HandSource then);

}  // namespace prismesh::drivers::haptic_pen::falcon
