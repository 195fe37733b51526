#include "drivers/eye_tracker/opentrack/tracker.h"

#include <algorithm>
#include <array>

#include "drivers/eye_tracker/plausible.h"

namespace prismesh::drivers::eye_tracker::opentrack {
namespace {

constexpr int kDatagramsAPoll = 64;  // a quarter of a second of opentrack's datagrams; the rest waits for the next poll

}  // namespace

OpentrackTracker::OpentrackTracker(port::DatagramPort& port, const Options& options) : port_(&port), options_(options) {}

EyeTracker::Polled OpentrackTracker::poll(std::int64_t now_ns) {
  Polled polled;
  std::array<std::byte, 2 * kDatagramBytes> buffer;  // longer than a pose, so that a truncated longer datagram isn't taken for a pose
  const std::uint64_t before = counts_.records;
  for (int i = 0; i < kDatagramsAPoll; ++i) {
    const port::Datagram datagram = port_->receive(buffer);
    polled.status = datagram.status;
    if (!datagram.arrived) break;
    take(std::span(buffer).first(datagram.bytes), datagram.full_length, polled);
  }
  if (counts_.records != before) {
    receiving_ = true;
    received_ns_ = now_ns;
  } else if (receiving_ && now_ns - received_ns_ > options_.silence_ns) {
    receiving_ = false;
    last_.reset();
    ++counts_.resyncs;
  }
  if (polled.fresh) polled.sample.measured_ns = now_ns - options_.latency_ns;
  return polled;
}

void OpentrackTracker::take(std::span<const std::byte> datagram, std::size_t full_length, Polled& polled) {
  const std::optional<Pose> pose = decode(datagram);
  if (!pose) {
    counts_.bytes_skipped += full_length;
    return;
  }
  ++counts_.records;
  if (last_ == pose) {
    ++counts_.without_head;
    return;
  }
  last_ = pose;
  const Eigen::Vector3d position_mm = screen_position_mm(*pose) + options_.offset_mm;
  if (!plausible_head(position_mm)) {
    ++counts_.rejected;
    return;
  }
  polled.fresh = true;
  polled.sample.between_eyes_mm = position_mm;
  polled.sample.toward_right = toward_right(*pose).normalized();
}

}  // namespace prismesh::drivers::eye_tracker::opentrack
