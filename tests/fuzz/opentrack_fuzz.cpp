// Datagrams from any process on this machine: no sample out of range, accepted datagrams can be encoded again byte for byte. A byte of
// length goes before each datagram.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "drivers/eye_tracker/opentrack/tracker.h"
#include "drivers/eye_tracker/plausible.h"

namespace {

using namespace prismesh::drivers;
using namespace prismesh::drivers::eye_tracker;

void check(bool holds) {
  if (!holds) std::abort();
}

class FuzzedPort final : public port::DatagramPort {
 public:
  explicit FuzzedPort(std::span<const std::byte> input) : input_(input) {}
  port::Datagram receive(std::span<std::byte> to) override {
    if (input_.empty()) return {};
    const std::size_t length = std::min<std::size_t>(std::to_integer<std::size_t>(input_[0]), input_.size() - 1);
    const std::span<const std::byte> datagram = input_.subspan(1, length);
    input_ = input_.subspan(1 + length);
    if (const auto pose = opentrack::decode(datagram)) {
      const auto again = opentrack::encode(*pose);
      check(std::equal(again.begin(), again.end(), datagram.begin(), datagram.end()));
    }
    const std::size_t bytes = std::min(to.size(), length);
    std::copy_n(datagram.begin(), bytes, to.begin());
    return {.arrived = true, .bytes = bytes, .full_length = length};
  }
  void discard_input() override { input_ = {}; }
  int last_error() const override { return 0; }
  bool empty() const { return input_.empty(); }

 private:
  std::span<const std::byte> input_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzedPort port(std::as_bytes(std::span(data, size)));
  opentrack::OpentrackTracker tracker(port, {});
  for (std::int64_t now_ns = 0; !port.empty(); now_ns += 5'000'000) {
    const EyeTracker::Polled polled = tracker.poll(now_ns);
    const LineCounts& counts = tracker.counts();
    check(counts.without_head + counts.rejected <= counts.records);
    if (!polled.fresh) continue;
    check(plausible_head(polled.sample.between_eyes_mm));
    check(std::abs(polled.sample.toward_right.norm() - 1) < 1e-9);
  }
  return 0;
}
