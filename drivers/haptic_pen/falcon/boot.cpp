#include "drivers/haptic_pen/falcon/boot.h"

#include <algorithm>
#include <array>

#include "drivers/haptic_pen/falcon/ftdi.h"

namespace prismesh::drivers::haptic_pen::falcon {
namespace {

constexpr std::int64_t kMs = 1'000'000;
/// What an earlier program has asked may still be answered.
constexpr std::int64_t kSettleNs = 50 * kMs;
/// All questions are answered, also those that were asked before it ran: an answer too many would shift all that follow.
constexpr std::int64_t kMaxDrainNs = 2000 * kMs;
constexpr std::int64_t kAskNs = 300 * kMs, kAskAgainNs = 20 * kMs;
/// The firmware begins within this.
constexpr std::int64_t kStartNs = 2000 * kMs;
constexpr std::int64_t kGreetNs = 100 * kMs;
constexpr int kGreetings = 20;
constexpr std::int64_t kLockNs = 1000 * kMs, kEchoNs = 1000 * kMs, kPauseNs = 500 * kMs;
/// After the last attempt.
constexpr std::int64_t kRestNs = 10'000 * kMs;
/// A full-speed packet of the answer holds two bytes of status.
constexpr std::size_t kChunk = 62;

constexpr std::array kGreeting{std::byte{0x0A}, std::byte{0x43}, std::byte{0x0D}};
constexpr std::array kGreetingAnswer{std::byte{0x0A}, std::byte{0x44}, std::byte{0x2C}, std::byte{0x0D}};
constexpr std::array kLock{std::byte{'A'}};  // the loader measures the baud rate with it

}  // namespace

BootPhase Boot::step(std::int64_t now_ns) {
  if (!begun_) begin(now_ns);
  if (progress_.phase.load() == BootPhase::failed && progress_.fault.load() != BootFault::needs_firmware && now_ns >= until_ns_) {
    // Its power may have come meanwhile.
    progress_.attempt = 1;
    progress_.phase = BootPhase::working;
    begin(now_ns);
  }
  if (progress_.phase.load() != BootPhase::working) return progress_.phase.load();
  receive(now_ns);
  // Time counts from when the bus has taken everything.
  if (progress_.phase.load() != BootPhase::working || port_.pending() > 0) return progress_.phase.load();
  if (step_ == Step::ask && now_ns >= again_ns_) {
    again_ns_ = now_ns + kAskAgainNs;
    send(encode(ForcePacket{}));
  }
  if (now_ns >= until_ns_) out_of_time(now_ns);
  return progress_.phase.load();
}

void Boot::enter(Step step, std::int64_t now_ns, std::int64_t patience_ns) {
  step_ = step;
  until_ns_ = now_ns + patience_ns;
  again_ns_ = 0;
  matched_ = 0;
  finder_.clear();
}

void Boot::request(std::uint8_t what, std::uint16_t value) { (void)port_.control({ftdi::kToDevice, what, value, 0}); }

void Boot::begin(std::int64_t now_ns) {
  begun_ = true;
  loaded_ = false;
  set_up_running();
  enter(Step::settle, now_ns, kSettleNs);
}

void Boot::set_up_running() {
  request(ftdi::kSetLatency, 1);
  request(ftdi::kSetBaud, ftdi::kBaudRunning);
  request(ftdi::kReset, ftdi::kPurgeReceived);
  request(ftdi::kReset, ftdi::kPurgeToSend);
}

void Boot::begin_loading(std::int64_t now_ns) {
  if (firmware_.empty()) return fail(BootFault::needs_firmware, now_ns);
  request(ftdi::kSetLatency, 16);
  request(ftdi::kSetBaud, ftdi::kBaud9600);
  request(ftdi::kSetData, ftdi::kEightNoneOne);
  request(ftdi::kSetFlow, 0);
  request(ftdi::kModem, ftdi::kRtsLow);
  request(ftdi::kModem, ftdi::kDtrLow);
  request(ftdi::kModem, ftdi::kDtrHigh);
  greetings_ = 1;
  send(kGreeting);
  enter(Step::greet, now_ns, kGreetNs);
}

void Boot::send_chunk(std::int64_t now_ns) {
  const auto chunk = firmware_.subspan(sent_, std::min(kChunk, firmware_.size() - sent_));
  send(chunk);
  sent_ += chunk.size();
  until_ns_ = now_ns + kEchoNs;
}

void Boot::receive(std::int64_t now_ns) {
  std::array<std::byte, port::kUsbPacketBytes> packet{};
  // What is left then is read in the next tick.
  for (std::size_t i = 0; i < port::kUsbPackets; ++i) {
    const port::PortCount got = port_.read(packet);
    if (got.bytes == 0) return;
    for (std::size_t at = ftdi::kStatusBytes; at < got.bytes; ++at) take(packet[at], now_ns);
  }
}

void Boot::take(std::byte byte, std::int64_t now_ns) {
  switch (step_) {
    case Step::settle:
    case Step::pause: return;
    case Step::ask:
      if (const auto bytes = finder_.take(byte); bytes && decode_pose(*bytes)) {
        enter(Step::drain, now_ns, kSettleNs);
        drained_by_ns_ = now_ns + kMaxDrainNs;
      }
      return;
    case Step::drain: until_ns_ = std::min(now_ns + kSettleNs, drained_by_ns_); return;
    case Step::greet:
      matched_ = byte == kGreetingAnswer[matched_] ? matched_ + 1 : byte == kGreetingAnswer[0] ? 1 : 0;
      if (matched_ < kGreetingAnswer.size()) return;
      request(ftdi::kModem, ftdi::kDtrLow);
      request(ftdi::kSetBaud, ftdi::kBaudLoader);
      send(kLock);
      return enter(Step::lock, now_ns, kLockNs);
    case Step::lock:
      if (byte != kLock[0]) return;
      sent_ = echoed_ = 0;
      progress_.percent = 0;
      progress_.loading = true;
      enter(Step::load, now_ns, kEchoNs);
      return send_chunk(now_ns);
    case Step::load:
      if (echoed_ >= sent_ || byte != firmware_[echoed_]) return fail(BootFault::wrong_echo, now_ns);
      ++echoed_;
      progress_.percent = static_cast<std::uint32_t>(echoed_ * 100 / firmware_.size());
      if (echoed_ < sent_) return;
      if (sent_ < firmware_.size()) return send_chunk(now_ns);
      progress_.loading = false;
      loaded_ = true;
      set_up_running();
      return enter(Step::ask, now_ns, kStartNs);
  }
}

void Boot::out_of_time(std::int64_t now_ns) {
  switch (step_) {
    case Step::settle: return enter(Step::ask, now_ns, kAskNs);
    case Step::ask: return loaded_ ? fail(BootFault::no_start, now_ns) : begin_loading(now_ns);
    case Step::drain: progress_.phase = BootPhase::running; return;
    case Step::greet:
      if (greetings_ >= kGreetings) return fail(BootFault::no_greeting, now_ns);
      ++greetings_;
      send(kGreeting);
      return enter(Step::greet, now_ns, kGreetNs);
    case Step::lock: return fail(BootFault::no_loader, now_ns);
    case Step::load: return fail(BootFault::no_echo, now_ns);
    case Step::pause: return begin(now_ns);
  }
}

void Boot::fail(BootFault fault, std::int64_t now_ns) {
  progress_.loading = false;
  progress_.fault = fault;
  if (fault == BootFault::needs_firmware || progress_.attempt.load() >= kBootAttempts) {
    progress_.phase = BootPhase::failed;
    until_ns_ = now_ns + kRestNs;
    return;
  }
  progress_.attempt.fetch_add(1);
  enter(Step::pause, now_ns, kPauseNs);
}

}  // namespace prismesh::drivers::haptic_pen::falcon
