// Gets a Falcon from its plug to its first pose: asks whether firmware runs, else loads it. A state machine on a port, stepped once a tick:
// it neither blocks nor allocates. The requests and bytes are those of libnifalcon (FalconCommLibUSB.cpp, FalconFirmware.cpp).
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/haptic_pen/falcon/packet.h"
#include "drivers/port/usb_port.h"

namespace prismesh::drivers::haptic_pen::falcon {

/// Why it failed the last time.
enum class BootFault : std::uint8_t {
  none,
  needs_firmware,  ///< none runs, and the user gave none
  no_greeting,     ///< the device didn't answer at 9600 baud
  no_loader,       ///< its boot loader didn't take the baud rate
  no_echo,         ///< the loader stopped echoing within the firmware
  wrong_echo,      ///< what it echoed isn't what was sent
  no_start,        ///< the firmware was taken whole, but doesn't answer
};

enum class BootPhase : std::uint8_t { working, running, failed };

/// For another thread.
struct BootProgress {
  std::atomic<BootPhase> phase = BootPhase::working;
  std::atomic<BootFault> fault = BootFault::none;  ///< of the last attempt; with `working`: another one is under way
  std::atomic<std::uint32_t> attempt = 1;
  std::atomic<std::uint32_t> percent = 0;  ///< of the firmware, while it is loaded
  std::atomic<bool> loading = false;
};

inline constexpr std::uint32_t kBootAttempts = 3;

class Boot {
 public:
  /// Both must outlive it. `firmware` may be empty.
  Boot(port::UsbPort& port, std::span<const std::byte> firmware) : port_(port), firmware_(firmware) {}

  /// Call it once a tick. After `running` the port belongs to the pen.
  BootPhase step(std::int64_t now_ns);
  const BootProgress& progress() const { return progress_; }

 private:
  enum class Step : std::uint8_t { settle, ask, drain, greet, lock, load, pause };

  void enter(Step step, std::int64_t now_ns, std::int64_t patience_ns);
  void begin(std::int64_t now_ns);
  void set_up_running();
  void begin_loading(std::int64_t now_ns);
  void send_chunk(std::int64_t now_ns);
  void fail(BootFault fault, std::int64_t now_ns);
  void receive(std::int64_t now_ns);
  void take(std::byte byte, std::int64_t now_ns);
  void out_of_time(std::int64_t now_ns);
  void send(std::span<const std::byte> bytes) { (void)port_.write(bytes); }
  void request(std::uint8_t what, std::uint16_t value);

  port::UsbPort& port_;
  std::span<const std::byte> firmware_;
  BootProgress progress_;
  Step step_ = Step::settle;
  bool begun_ = false, loaded_ = false;
  std::int64_t until_ns_ = 0, again_ns_ = 0, drained_by_ns_ = 0;
  int greetings_ = 0;
  std::size_t matched_ = 0;            ///< bytes of the greeting's answer
  std::size_t sent_ = 0, echoed_ = 0;  ///< bytes of the firmware
  PacketFinder finder_;
};

}  // namespace prismesh::drivers::haptic_pen::falcon
