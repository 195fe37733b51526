#include "drivers/eye_tracker/dynasight/simulator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "drivers/eye_tracker/dynasight/tracker.h"

namespace prismesh::drivers::eye_tracker::dynasight {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kBitsPerByteSent = 10;

}  // namespace

DynasightSimulator::DynasightSimulator(port::BytePort& line, HeadSource head, const Options& options)
    : line_(&line), head_(std::move(head)), options_(options), random_(options.seed) {}

std::int64_t DynasightSimulator::byte_ns() const { return kBitsPerByteSent * kSecondNs / options_.baud; }

bool DynasightSimulator::happens(double chance) { return chance > 0 && std::uniform_real_distribution<double>(0, 1)(random_) < chance; }

void DynasightSimulator::run_until(std::int64_t now_ns) {
  now_ns_ = now_ns;
  if (!started_) {
    started_ = true;
    start_ns_ = now_ns;
    set_power(power_);
  }
  if (!power_ || now_ns < awake_ns_) {
    std::array<std::byte, 64> ignored;
    while (line_->read(ignored).bytes > 0) continue;
    return;
  }
  read_commands();
  send_due();
  // After a long pause of the caller, skips the records of that time.
  const std::int64_t period = std::llround(static_cast<double>(kSecondNs) / options_.rate_hz);
  if (mode_ == Mode::streaming && due_ns_ < now_ns - kSecondNs) due_ns_ += (now_ns - due_ns_) / period * period;
  while (out_count_ == out_sent_ && due_ns_ <= now_ns && (mode_ == Mode::streaming || requested_)) {
    begin_record();
    if (mode_ == Mode::streaming) due_ns_ += period;
    send_due();
  }
}

void DynasightSimulator::set_power(bool on) {
  power_ = on;
  mode_ = on && options_.streams_at_power_up ? Mode::streaming : Mode::waiting;
  interrupts_ = 0;
  requested_ = false;
  out_count_ = out_sent_ = 0;
  awake_ns_ = now_ns_ + options_.power_up_ns;
  due_ns_ = awake_ns_;
  lost_since_ns_ = lost_until_ns_ = 0;
}

void DynasightSimulator::read_commands() {
  std::array<std::byte, 64> commands;
  for (;;) {
    const port::PortCount got = line_->read(commands);
    for (std::size_t i = 0; i < got.bytes; ++i) handle_command(commands[i]);
    if (got.bytes < commands.size()) return;
  }
}

void DynasightSimulator::handle_command(std::byte command) {
  if (command == kInterrupt) {
    if (++interrupts_ >= 3) {
      mode_ = Mode::waiting;
      requested_ = false;
    }
    return;
  }
  interrupts_ = 0;
  const std::byte stream = options_.dialect == settings::TrackerDialect::d4d ? kStreamD4d : kStreamDynasight;
  if (command == stream && mode_ == Mode::waiting) {
    mode_ = Mode::streaming;
    due_ns_ = now_ns_;
  } else if (command == kPolled && mode_ == Mode::waiting) {
    mode_ = Mode::polled;
  } else if (command == kRequestRecord && mode_ == Mode::polled) {
    requested_ = true;
    due_ns_ = now_ns_;
  } else {
    ++unknown_commands_;
  }
}

Record DynasightSimulator::measure(std::int64_t at_ns) {
  const SimulatedHead head = head_(static_cast<double>(at_ns - start_ns_) / static_cast<double>(kSecondNs));
  if (at_ns >= lost_until_ns_ && happens(options_.faults.drop_out)) {
    lost_since_ns_ = at_ns;
    lost_until_ns_ = at_ns + std::llround(options_.faults.drop_out_s * static_cast<double>(kSecondNs));
  }
  if (!head.visible || at_ns < lost_until_ns_) {
    const bool coasts =
        head.visible && static_cast<double>(at_ns - lost_since_ns_) < options_.faults.coast_s * static_cast<double>(kSecondNs);
    return record_for(last_seen_mm_, coasts ? Status::coast : Status::search, options_.target);
  }
  std::normal_distribution<double> noise(0, 1);
  Eigen::Vector3d seen = head.between_eyes_mm - options_.offset_mm;
  for (int axis = 0; axis < 3; ++axis) seen[axis] += options_.noise_mm * noise(random_);
  last_seen_mm_ = seen;
  return record_for(seen, happens(options_.faults.caution) ? Status::caution : Status::track, options_.target);
}

void DynasightSimulator::queue(std::byte byte) {
  if (out_count_ < out_.size()) out_[out_count_++] = byte;
}

// The record's bytes are sent one after the other. The record holds the head's position at the end of its last byte, minus the latency.
void DynasightSimulator::begin_record() {
  requested_ = false;
  out_count_ = out_sent_ = 0;
  if (happens(options_.faults.garbage)) {
    const int count = std::uniform_int_distribution<int>(1, 7)(random_);
    for (int i = 0; i < count; ++i) queue(static_cast<std::byte>(std::uniform_int_distribution<int>(0, 255)(random_)));
  }
  const std::int64_t last_byte_ns = due_ns_ + static_cast<std::int64_t>(out_count_ + kRecordBytes) * byte_ns();
  for (const std::byte byte : encode(measure(last_byte_ns - options_.latency_ns))) {
    if (happens(options_.faults.lost_byte)) continue;
    const bool damaged = happens(options_.faults.damaged_byte);
    queue(damaged ? byte ^ static_cast<std::byte>(1 << std::uniform_int_distribution<int>(0, 7)(random_)) : byte);
  }
  out_ns_ = due_ns_;
  ++records_sent_;
}

void DynasightSimulator::send_due() {
  std::size_t due = out_sent_;
  while (due < out_count_ && out_ns_ + static_cast<std::int64_t>(due - out_sent_) * byte_ns() <= now_ns_) ++due;
  if (due == out_sent_) return;
  // Bytes that the line doesn't accept are lost, as on a real line.
  line_->write(std::span(out_).subspan(out_sent_, due - out_sent_));
  out_ns_ += static_cast<std::int64_t>(due - out_sent_) * byte_ns();
  out_sent_ = due;
}

}  // namespace prismesh::drivers::eye_tracker::dynasight
