#include "drivers/eye_tracker/dynasight/tracker.h"

#include <algorithm>

#include "drivers/eye_tracker/plausible.h"

namespace prismesh::drivers::eye_tracker::dynasight {
namespace {

constexpr std::size_t kReadBytes = 256;
constexpr int kReadsAPoll = 4;                        // a second's records at full rate; what is left waits for the next poll
constexpr std::int64_t kBitsAByte = 10;               // start bit, eight, stop bit
constexpr std::int64_t kRecordPeriodNs = 16'666'667;  // the device's own 60 Hz

}  // namespace

DynasightTracker::DynasightTracker(port::BytePort& port, const Options& options) : port_(&port), options_(options) {}

EyeTracker::Polled DynasightTracker::poll(std::int64_t now_ns) {
  Polled polled;
  Reading reading;
  polled.status = read(now_ns, reading);
  count();
  if (reading.sampled) {
    polled.fresh = true;
    polled.sample.measured_ns = std::max(measured_ns(now_ns, reading), last_measured_ns_ + 1);
    polled.sample.between_eyes_mm = reading.place_mm;
    polled.sample.doubtful = reading.doubtful;
    last_measured_ns_ = polled.sample.measured_ns;
  }
  if (polled.status == port::PortStatus::gone) return polled;
  talk(now_ns);
  polled.status = send();
  count();
  return polled;
}

port::PortStatus DynasightTracker::read(std::int64_t now_ns, Reading& reading) {
  std::array<std::byte, kReadBytes> buffer;
  for (int i = 0; i < kReadsAPoll; ++i) {
    const port::PortCount got = port_->read(buffer);
    for (std::size_t at = 0; at < got.bytes; ++at) take(buffer[at], now_ns, reading);
    if (got.status == port::PortStatus::gone) return got.status;
    if (got.bytes < buffer.size()) break;
  }
  return port::PortStatus::ok;
}

void DynasightTracker::take(std::byte byte, std::int64_t now_ns, Reading& reading) {
  ++reading.bytes;
  ++bytes_since_asked_;
  const std::optional<Heard> heard = synchroniser_.take(byte);
  if (!heard) return;
  record_ns_ = now_ns;
  ++counts_.records;
  if (!heard->record.sees_head()) {
    ++counts_.without_head;
    return;
  }
  if (stage_ != Stage::listen) return;  // of an earlier life, and who knows how old
  const Eigen::Vector3d place_mm = heard->record.place_mm() + options_.offset_mm;
  if (!heard->believed || !plausible_head(place_mm)) {
    ++counts_.rejected;
    return;
  }
  reading.sampled = true;
  reading.sample_end = reading.bytes;
  reading.place_mm = place_mm;
  reading.doubtful = heard->record.status != Status::track;
}

// Bytes that came after the record in the same read were on the line after it, so its last byte arrived at least that long ago; whole
// records among them were a measuring period apart.
std::int64_t DynasightTracker::measured_ns(std::int64_t now_ns, const Reading& reading) const {
  const std::int64_t byte_ns = kBitsAByte * 1'000'000'000 / std::max(options_.baud, 1);
  const auto after = static_cast<std::int64_t>(reading.bytes - reading.sample_end);
  constexpr auto kLength = static_cast<std::int64_t>(kRecordBytes);
  const std::int64_t waited_ns = after / kLength * std::max(kRecordPeriodNs, kLength * byte_ns) + after % kLength * byte_ns;
  return now_ns - waited_ns - options_.latency_ns;
}

void DynasightTracker::talk(std::int64_t now_ns) {
  if (stage_ == Stage::listen && now_ns - record_ns_ > options_.times.silence_ns) {
    ++counts_.restarts;
    stage_ = Stage::begin;
  }
  if (stage_ == Stage::begin) {
    unsent_count_ = 0;
    for (int i = 0; i < 3; ++i) say(kInterrupt);
    stage_ = Stage::settle;
    stage_ns_ = now_ns;
  } else if (stage_ == Stage::settle && now_ns - stage_ns_ >= options_.times.settle_ns) {
    port_->discard_input();  // the tail of what it said before
    synchroniser_.reset();
    const bool d4d = options_.dialect == settings::TrackerDialect::d4d;
    say(options_.polled ? kPolled : d4d ? kStreamD4d : kStreamDynasight);
    if (options_.polled) ask(now_ns);
    stage_ = Stage::listen;
    record_ns_ = now_ns;
  } else if (stage_ == Stage::listen && options_.polled) {
    const bool answered = bytes_since_asked_ >= kRecordBytes;
    if (answered || now_ns - asked_ns_ > options_.times.answer_ns) ask(now_ns);
  }
}

void DynasightTracker::ask(std::int64_t now_ns) {
  say(kAsk);
  asked_ns_ = now_ns;
  bytes_since_asked_ = 0;
}

// A line that takes nothing for so long that this is full has a silent device; the talk begins anew then.
void DynasightTracker::say(std::byte command) {
  if (unsent_count_ < unsent_.size()) unsent_[unsent_count_++] = command;
}

port::PortStatus DynasightTracker::send() {
  if (unsent_count_ == 0) return port::PortStatus::ok;
  const port::PortCount sent = port_->write(std::span(unsent_).first(unsent_count_));
  std::copy(unsent_.begin() + static_cast<std::ptrdiff_t>(sent.bytes), unsent_.begin() + static_cast<std::ptrdiff_t>(unsent_count_),
            unsent_.begin());
  unsent_count_ -= sent.bytes;
  return sent.status == port::PortStatus::gone ? sent.status : port::PortStatus::ok;
}

void DynasightTracker::count() {
  counts_.bytes_skipped = synchroniser_.bytes_skipped();
  counts_.resyncs = synchroniser_.losses();
}

}  // namespace prismesh::drivers::eye_tracker::dynasight
