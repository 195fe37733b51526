// A tracker's line with anything on it, cut into reads at any place: no sample out of range or back in time, the counts balance, and clean
// records are read again. The first byte chooses dialect and mode; after it, pairs of a length and a pause go before each read's bytes.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <deque>

#include "drivers/eye_tracker/dynasight/tracker.h"
#include "drivers/eye_tracker/plausible.h"

namespace {

using namespace prismesh::drivers;
using namespace prismesh::drivers::eye_tracker;

constexpr std::int64_t kMs = 1'000'000;

void check(bool holds) {
  if (!holds) std::abort();
}

class FuzzedPort final : public port::BytePort {
 public:
  port::PortCount read(std::span<std::byte> to) override {
    std::size_t got = 0;
    for (; got < to.size() && !arrived.empty(); ++got) {
      to[got] = arrived.front();
      arrived.pop_front();
    }
    taken += got;
    return {got, port::PortStatus::ok};
  }
  port::PortCount write(std::span<const std::byte> from) override {
    const std::size_t accepted = std::min(from.size(), room);
    return {accepted, accepted == from.size() ? port::PortStatus::ok : port::PortStatus::full};
  }
  void discard_input() override { arrived.clear(); }
  bool set_baud(int) override { return true; }
  int last_error() const override { return 0; }

  std::deque<std::byte> arrived;
  std::uint64_t taken = 0;
  std::size_t room = 8;
};

class Run {
 public:
  explicit Run(unsigned choice)
      : tracker_(port_, {.dialect = (choice & 1) != 0 ? settings::TrackerDialect::d4d : settings::TrackerDialect::dynasight,
                         .polled = (choice & 2) != 0,
                         .offset_mm = (choice & 4) != 0 ? Eigen::Vector3d(30, -200, 40) : Eigen::Vector3d::Zero()}) {
    port_.room = choice >> 4;
  }
  void hear(std::span<const std::byte> bytes) { port_.arrived.insert(port_.arrived.end(), bytes.begin(), bytes.end()); }
  bool poll(std::int64_t pause_ns) {
    now_ns_ += pause_ns;
    const EyeTracker::Polled polled = tracker_.poll(now_ns_);
    check(polled.status == port::PortStatus::ok);
    const LineCounts& counts = tracker_.counts();
    const std::uint64_t accounted = counts.records * dynasight::kRecordBytes + counts.bytes_skipped;
    check(accounted <= port_.taken && port_.taken - accounted <= dynasight::kRecordBytes);
    check(counts.without_head + counts.rejected <= counts.records);
    if (!polled.fresh) return false;
    check(plausible_head(polled.sample.between_eyes_mm));
    check(polled.sample.toward_right == Eigen::Vector3d::UnitX());
    check(polled.sample.measured_ns > last_ns_ && polled.sample.measured_ns <= std::max(now_ns_, last_ns_ + 1));
    last_ns_ = polled.sample.measured_ns;
    return true;
  }

 private:
  FuzzedPort port_;
  dynasight::DynasightTracker tracker_;
  std::int64_t now_ns_ = 0;
  std::int64_t last_ns_ = -1'000 * kMs;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::span<const std::byte> input = std::as_bytes(std::span(data, size));
  if (size >= dynasight::kRecordBytes) {
    if (const auto record = dynasight::decode(input.first<dynasight::kRecordBytes>()))
      check(dynasight::decode(dynasight::encode(*record)) == record);
  }
  Run run(data[0]);
  for (std::size_t at = 1; at + 2 <= size;) {
    const std::size_t length = std::min<std::size_t>(data[at], size - at - 2);
    const std::int64_t pause_ns = data[at + 1] * kMs;
    run.hear(input.subspan(at + 2, length));
    run.poll(pause_ns);
    at += 2 + length;
  }
  for (int i = 0; i < 8; ++i) run.poll(0);  // what is left of long reads
  bool heard = false;
  for (int i = 0; i < 24 && !heard; ++i) {
    run.hear(dynasight::encode(dynasight::record_for({10, 20, 600 + 0.4 * i})));
    heard = run.poll(16 * kMs);
  }
  check(heard);
  return 0;
}
