#include "drivers/eye_tracker/dynasight/tracker.h"

#include <algorithm>

#include "drivers/eye_tracker/plausible.h"

namespace prismesh::drivers::eye_tracker::dynasight {
namespace {

constexpr std::size_t kReadBytes = 256;
constexpr int kReadsAPoll = 4;                        // one second of records at full rate; the rest waits for the next poll
constexpr std::int64_t kBitsAByte = 10;               // start bit, 8 data bits, stop bit
constexpr std::int64_t kRecordPeriodNs = 16'666'667;  // the device's rate of 60 Hz

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
    polled.sample.between_eyes_mm = reading.position_mm;
    polled.sample.doubtful = reading.doubtful;
    last_measured_ns_ = polled.sample.measured_ns;
  }
  if (polled.status == port::PortStatus::gone) return polled;
  run_dialogue(now_ns);
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
  ++bytes_since_request_;
  const std::optional<SynchronisedRecord> synchronised = synchroniser_.take(byte);
  if (!synchronised) return;
  record_ns_ = now_ns;
  ++counts_.records;
  if (!synchronised->record.sees_head()) {
    ++counts_.without_head;
    return;
  }
  if (stage_ != Stage::listen) return;  // a record from before the (re)start, of unknown age
  const Eigen::Vector3d position_mm = synchronised->record.position_mm() + options_.offset_mm;
  if (!synchronised->plausible || !plausible_head(position_mm)) {
    ++counts_.rejected;
    return;
  }
  reading.sampled = true;
  reading.sample_end = reading.bytes;
  reading.position_mm = position_mm;
  reading.doubtful = synchronised->record.status != Status::track;
}

// Bytes read after the record in the same poll followed it on the line, so its last byte arrived at least their transmission time earlier.
// Complete records among them are one measuring period apart.
std::int64_t DynasightTracker::measured_ns(std::int64_t now_ns, const Reading& reading) const {
  const std::int64_t byte_ns = kBitsAByte * 1'000'000'000 / std::max(options_.baud, 1);
  const auto after = static_cast<std::int64_t>(reading.bytes - reading.sample_end);
  constexpr auto kLength = static_cast<std::int64_t>(kRecordBytes);
  const std::int64_t waited_ns = after / kLength * std::max(kRecordPeriodNs, kLength * byte_ns) + after % kLength * byte_ns;
  return now_ns - waited_ns - options_.latency_ns;
}

void DynasightTracker::run_dialogue(std::int64_t now_ns) {
  if (stage_ == Stage::listen && now_ns - record_ns_ > options_.times.silence_ns) {
    ++counts_.restarts;
    stage_ = Stage::begin;
  }
  if (stage_ == Stage::begin) {
    unsent_count_ = 0;
    for (int i = 0; i < 3; ++i) queue_command(kInterrupt);
    stage_ = Stage::settle;
    stage_ns_ = now_ns;
  } else if (stage_ == Stage::settle && now_ns - stage_ns_ >= options_.times.settle_ns) {
    port_->discard_input();  // the rest of the previous output
    synchroniser_.reset();
    const bool d4d = options_.dialect == settings::TrackerDialect::d4d;
    queue_command(options_.polled ? kPolled : d4d ? kStreamD4d : kStreamDynasight);
    if (options_.polled) request_record(now_ns);
    stage_ = Stage::listen;
    record_ns_ = now_ns;
  } else if (stage_ == Stage::listen && options_.polled) {
    const bool answered = bytes_since_request_ >= kRecordBytes;
    if (answered || now_ns - requested_ns_ > options_.times.answer_ns) request_record(now_ns);
  }
}

void DynasightTracker::request_record(std::int64_t now_ns) {
  queue_command(kRequestRecord);
  requested_ns_ = now_ns;
  bytes_since_request_ = 0;
}

// The queue is full only if the line accepts nothing for long. Then the device is silent, and the dialogue restarts.
void DynasightTracker::queue_command(std::byte command) {
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
