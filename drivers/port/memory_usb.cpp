#include "drivers/port/memory_usb.h"

#include <algorithm>
#include <cerrno>

namespace prismesh::drivers::port {

class MemoryUsb::Port final : public UsbPort {
 public:
  explicit Port(MemoryUsb& cable) : cable_(cable), generation_(cable.generation_) {}

  PortCount read(std::span<std::byte> to) override {
    cable_.run();
    if (gone()) return {0, PortStatus::gone};
    auto& queue = cable_.to_host_;
    if (queue.count == 0 || queue.front().due_ns > cable_.clock_.now_ns()) return {};
    const Sent& packet = queue.front();
    const std::size_t count = std::min(to.size(), packet.count);
    std::copy_n(packet.bytes.begin(), count, to.begin());
    queue.drop();
    return {count, PortStatus::ok};
  }

  PortStatus write(std::span<const std::byte> packet, std::int64_t valid_until_ns) override {
    return add([&](Sent& sent) {
      sent.count = std::min(packet.size(), kUsbPacketBytes);
      std::copy_n(packet.begin(), sent.count, sent.bytes.begin());
      sent.valid_until_ns = valid_until_ns;
    });
  }

  PortStatus control(const UsbControl& request) override {
    return add([&](Sent& sent) {
      sent.is_control = true;
      sent.control = request;
    });
  }

  std::size_t pending() const override { return gone() ? 0 : cable_.to_device_.count; }
  std::uint64_t finished() const override { return cable_.finished_; }
  int last_error() const override { return gone() ? ENODEV : 0; }

 private:
  bool gone() const { return generation_ != cable_.generation_ || cable_.refused_; }

  template <class Fill>
  PortStatus add(Fill fill) {
    cable_.run();
    if (gone()) return PortStatus::gone;
    if (cable_.to_device_.full()) return PortStatus::full;
    Sent& sent = cable_.to_device_.add();
    sent = {};
    sent.due_ns = cable_.clock_.now_ns() + cable_.delay_ns_;
    fill(sent);
    return PortStatus::ok;
  }

  MemoryUsb& cable_;
  std::uint64_t generation_;
};

std::unique_ptr<UsbPort> MemoryUsb::open() {
  to_device_.count = to_host_.count = 0;
  refused_ = false;
  return std::make_unique<Port>(*this);
}

void MemoryUsb::run() {
  const std::int64_t now = clock_.now_ns();
  // What is kept back goes onto the bus later.
  for (std::size_t i = 0; hold_to_device_ && i < to_device_.count; ++i)
    to_device_.places[(to_device_.begin + i) % kUsbPackets].due_ns = now + delay_ns_;
  while (plugged_in_ && !hold_to_device_ && to_device_.count > 0 && to_device_.front().due_ns <= now) {
    Sent& sent = to_device_.front();
    if (sent.is_control) {
      refused_ |= !device_.control(sent.due_ns, sent.control);
    } else if (sent.due_ns - delay_ns_ <= sent.valid_until_ns) {
      const std::size_t count = bytes_left_ ? std::min(*bytes_left_, sent.count) : sent.count;
      device_.receive(sent.due_ns, std::span(sent.bytes).first(count));
      if (bytes_left_ && (*bytes_left_ -= count) == 0) {
        bytes_left_.reset();
        unplug();
      }
    }
    to_device_.drop();
    ++finished_;
  }
  while (plugged_in_ && !hold_to_host_ && !to_host_.full()) {
    Sent packet;
    packet.count = device_.send(now, packet.bytes);
    if (packet.count == 0) break;
    packet.due_ns = now + delay_ns_;
    to_host_.add() = packet;
  }
}

}  // namespace prismesh::drivers::port
