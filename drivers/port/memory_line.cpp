#include "drivers/port/memory_line.h"

#include <algorithm>
#include <cerrno>
#include <random>

namespace prismesh::drivers::port {

namespace {

constexpr std::int64_t kBitsPerByte = 10;  // start bit, 8 data bits, stop bit

/// A receiver at the wrong baud rate gets a different byte, always the same one for the same input.
std::byte scrambled(std::byte byte) { return (byte << 3 | byte >> 5) ^ std::byte{0xA5}; }

template <class T>
class Ring {
 public:
  explicit Ring(std::size_t capacity) : slots_(capacity) {}
  bool empty() const { return count_ == 0; }
  bool full() const { return count_ == slots_.size(); }
  std::size_t size() const { return count_; }
  const T& front() const { return slots_[first_]; }
  void push(const T& value) { slots_[(first_ + count_++) % slots_.size()] = value; }
  void pop() {
    first_ = (first_ + 1) % slots_.size();
    --count_;
  }
  void clear() { count_ = 0; }

 private:
  std::vector<T> slots_;
  std::size_t first_ = 0, count_ = 0;
};

}  // namespace

/// One direction of the cable: bytes in transit with their arrival times, and bytes that have arrived and aren't read yet.
class MemoryLine::Lane {
 public:
  explicit Lane(const MemoryLineSettings& settings)
      : latency_ns_(settings.latency_ns), in_transit_(settings.queue_bytes), arrived_(settings.input_bytes) {}

  void set_noise(double flip, double loss, std::uint64_t seed) {
    flip_ = flip;
    loss_ = loss;
    random_.seed(seed);
  }

  /// Returns the number of bytes accepted.
  std::size_t send(std::span<const std::byte> bytes, std::int64_t now, int baud) {
    settle(now);
    std::size_t taken = 0;
    while (taken < bytes.size() && !in_transit_.full()) put(bytes[taken++], now, baud);
    return taken;
  }

  std::size_t receive(std::span<std::byte> to, std::int64_t now, int baud) {
    settle(now);
    std::size_t got = 0;
    for (; got < to.size() && !arrived_.empty(); arrived_.pop()) {
      const Slot& slot = arrived_.front();
      to[got++] = slot.baud == baud ? slot.byte : scrambled(slot.byte);
    }
    return got;
  }

  void discard_arrived(std::int64_t now) {
    settle(now);
    arrived_.clear();
  }
  void clear() {
    in_transit_.clear();
    arrived_.clear();
    line_free_ns_ = 0;
  }
  std::uint64_t overrun() const { return overrun_; }
  std::optional<std::int64_t> next_arrival_ns(std::int64_t now) const {
    if (!arrived_.empty()) return now;
    if (in_transit_.empty()) return std::nullopt;
    return std::max(now, in_transit_.front().arrives_ns);
  }

 private:
  struct Slot {
    std::byte byte{};
    int baud = 0;
    std::int64_t arrives_ns = 0;
  };

  void put(std::byte byte, std::int64_t now, int baud) {
    line_free_ns_ = std::max(line_free_ns_, now) + kBitsPerByte * 1'000'000'000 / baud;  // end of the byte's last bit
    std::uniform_real_distribution<double> chance(0, 1);
    if (loss_ > 0 && chance(random_) < loss_) return;
    if (flip_ > 0 && chance(random_) < flip_) byte ^= std::byte{1} << (random_() % 8);
    in_transit_.push({byte, baud, line_free_ns_ + latency_ns_});
  }

  void settle(std::int64_t now) {
    for (; !in_transit_.empty() && in_transit_.front().arrives_ns <= now; in_transit_.pop())
      arrived_.full() ? void(++overrun_) : arrived_.push(in_transit_.front());
  }

  std::int64_t latency_ns_;
  Ring<Slot> in_transit_, arrived_;
  std::int64_t line_free_ns_ = 0;
  std::uint64_t overrun_ = 0;
  double flip_ = 0, loss_ = 0;
  std::mt19937_64 random_;
};

class MemoryLine::HostEnd final : public BytePort {
 public:
  explicit HostEnd(MemoryLine& line) : line_(line), generation_(line.generation_) {}

  PortCount read(std::span<std::byte> to) override {
    if (gone()) return {0, PortStatus::gone};
    const std::size_t wanted = line_.allowed(Direction::to_host, to.size());
    const std::size_t got = line_.to_host_->receive(to.first(wanted), line_.clock_.now_ns(), line_.host_baud_);
    line_.count(Direction::to_host, got);
    return {got, PortStatus::ok};
  }
  PortCount write(std::span<const std::byte> from) override {
    if (gone()) return {0, PortStatus::gone};
    const std::size_t wanted = line_.allowed(Direction::to_device, from.size());
    const std::size_t taken = line_.to_device_->send(from.first(wanted), line_.clock_.now_ns(), line_.host_baud_);
    line_.count(Direction::to_device, taken);
    if (taken == from.size()) return {taken, PortStatus::ok};
    return {taken, gone() ? PortStatus::gone : PortStatus::full};
  }
  void discard_input() override {
    if (!gone()) line_.to_host_->discard_arrived(line_.clock_.now_ns());
  }
  bool set_baud(int baud) override {
    if (gone() || baud <= 0) return false;
    line_.host_baud_ = baud;
    return true;
  }
  int last_error() const override { return gone() ? EIO : 0; }

 private:
  bool gone() const { return generation_ != line_.generation_; }

  MemoryLine& line_;
  std::uint64_t generation_;
};

class MemoryLine::DeviceEnd final : public BytePort {
 public:
  explicit DeviceEnd(MemoryLine& line) : line_(line) {}

  PortCount read(std::span<std::byte> to) override {
    return {line_.to_device_->receive(to, line_.clock_.now_ns(), line_.device_baud_), PortStatus::ok};
  }
  PortCount write(std::span<const std::byte> from) override {
    if (!line_.plugged_in_) return {from.size(), PortStatus::ok};
    const std::size_t taken = line_.to_host_->send(from, line_.clock_.now_ns(), line_.device_baud_);
    return {taken, taken < from.size() ? PortStatus::full : PortStatus::ok};
  }
  void discard_input() override { line_.to_device_->discard_arrived(line_.clock_.now_ns()); }
  bool set_baud(int baud) override {
    if (baud <= 0) return false;
    line_.device_baud_ = baud;
    return true;
  }
  int last_error() const override { return 0; }

 private:
  MemoryLine& line_;
};

MemoryLine::MemoryLine(Clock& clock, MemoryLineSettings settings)
    : clock_(clock),
      settings_(settings),
      host_baud_(settings.host_baud),
      device_baud_(settings.device_baud),
      to_host_(std::make_unique<Lane>(settings)),
      to_device_(std::make_unique<Lane>(settings)),
      device_(std::make_unique<DeviceEnd>(*this)) {}

MemoryLine::~MemoryLine() = default;

Result<std::unique_ptr<BytePort>> MemoryLine::open_host(std::optional<int> baud) {
  if (!plugged_in_) return fail("memory line", "there is no such device; is it plugged in and switched on?");
  ++generation_;
  host_baud_ = baud.value_or(settings_.host_baud);
  to_host_->discard_arrived(clock_.now_ns());
  return std::make_unique<HostEnd>(*this);
}

BytePort& MemoryLine::device() { return *device_; }

void MemoryLine::unplug() {
  plugged_in_ = false;
  ++generation_;
  remaining_to_host_.reset();
  remaining_to_device_.reset();
  to_host_->clear();
}

void MemoryLine::unplug_after(Direction direction, std::size_t bytes) {
  (direction == Direction::to_host ? remaining_to_host_ : remaining_to_device_) = bytes;
  count(direction, 0);
}

void MemoryLine::plug_in() { plugged_in_ = true; }

std::size_t MemoryLine::allowed(Direction direction, std::size_t wanted) const {
  const std::optional<std::size_t>& remaining = direction == Direction::to_host ? remaining_to_host_ : remaining_to_device_;
  return remaining ? std::min(*remaining, wanted) : wanted;
}

void MemoryLine::count(Direction direction, std::size_t bytes) {
  std::optional<std::size_t>& remaining = direction == Direction::to_host ? remaining_to_host_ : remaining_to_device_;
  if (!remaining) return;
  *remaining -= bytes;
  if (*remaining == 0) unplug();
}

void MemoryLine::inject(Direction direction, std::span<const std::byte> bytes) {
  const int baud = direction == Direction::to_host ? host_baud_ : device_baud_;
  if (plugged_in_) lane(direction).send(bytes, clock_.now_ns(), baud);
}

void MemoryLine::set_noise(double flip_chance, double loss_chance, std::uint64_t seed) {
  to_host_->set_noise(flip_chance, loss_chance, seed);
  to_device_->set_noise(flip_chance, loss_chance, seed + 1);
}

std::uint64_t MemoryLine::overrun(Direction direction) const { return lane(direction).overrun(); }

std::optional<std::int64_t> MemoryLine::next_arrival_ns(Direction direction) const {
  return lane(direction).next_arrival_ns(clock_.now_ns());
}

}  // namespace prismesh::drivers::port
