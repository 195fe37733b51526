#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <libusb-1.0/libusb.h>

#include "base/clock.h"
#include "base/ring.h"
#include "drivers/port/open_error.h"
#include "drivers/port/usb_port.h"

namespace prismesh::drivers::port {

namespace {

constexpr int kInterface = 0;
/// Transfers that wait for the device's packets at the same time: none is missed while another is being read.
constexpr std::size_t kReadsAhead = 4;
constexpr unsigned kControlPatienceMs = 1000;
constexpr std::int64_t kDrainNs = 100'000'000;
/// After this long cancelled transfers that haven't come back are given up: the kernel ends them when the device is closed.
constexpr std::int64_t kReapNs = 1'000'000'000;
constexpr int kClaimTries = 5;
constexpr useconds_t kClaimPauseUs = 20'000;

struct ContextEnd {
  void operator()(libusb_context* context) const { libusb_exit(context); }
};
using Context = std::unique_ptr<libusb_context, ContextEnd>;

std::string numbers(const UsbWanted& wanted) { return fmt::format("{:04x}:{:04x}", wanted.vendor, wanted.product); }

Result<Context> make_context() {
  libusb_context* made = nullptr;
  if (const int error = libusb_init(&made); error != 0)
    return fail("USB", std::string("libusb can't be used here: ") + libusb_strerror(static_cast<libusb_error>(error)));
  return Context(made);
}

struct FoundDevice {
  std::string path;
  libusb_device_descriptor descriptor;
};

std::vector<FoundDevice> find_devices(libusb_context* context, const UsbWanted& wanted) {
  std::vector<FoundDevice> found;
  libusb_device** list = nullptr;
  const ssize_t count = libusb_get_device_list(context, &list);
  for (ssize_t i = 0; i < count; ++i) {
    FoundDevice device;
    if (libusb_get_device_descriptor(list[i], &device.descriptor) != 0) continue;
    if (device.descriptor.idVendor != wanted.vendor || device.descriptor.idProduct != wanted.product) continue;
    device.path = fmt::format("/dev/bus/usb/{:03}/{:03}", libusb_get_bus_number(list[i]), libusb_get_device_address(list[i]));
    found.push_back(std::move(device));
  }
  if (count >= 0) libusb_free_device_list(list, 1);
  std::sort(found.begin(), found.end(), [](const FoundDevice& a, const FoundDevice& b) { return a.path < b.path; });
  return found;
}

/// The errno that a libusb error stands for, so that all ports explain themselves in the same words.
int errno_of(int error) {
  switch (error) {
    case LIBUSB_ERROR_ACCESS: return EACCES;
    case LIBUSB_ERROR_NO_DEVICE:
    case LIBUSB_ERROR_NOT_FOUND: return ENODEV;
    case LIBUSB_ERROR_BUSY: return EBUSY;
    case LIBUSB_ERROR_NO_MEM: return ENOMEM;
    default: return EIO;
  }
}

/// A device that is open with its interface claimed. Descriptor and libusb's handle are closed in order.
class OpenDevice {
 public:
  static Result<std::unique_ptr<OpenDevice>> open(const UsbWanted& wanted) {
    Result<Context> context = make_context();
    if (!context) return fail(std::move(context.error()));
    const std::vector<FoundDevice> found = find_devices(context->get(), wanted);
    const std::string who = wanted.name + " (USB " + numbers(wanted) + ")";
    if (found.empty()) return fail(who, "there is no such device; is it plugged in, and has it its own power supply?");
    if (found.size() > 1)
      return fail(who, fmt::format("{} are plugged in ({} and {}): leave one",
                                   found.size() == 2 ? std::string("two") : std::to_string(found.size()), found[0].path, found[1].path));
    const std::string& path = found[0].path;
    auto device = std::unique_ptr<OpenDevice>(new OpenDevice(std::move(*context)));
    device->descriptor_ = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
    if (device->descriptor_ < 0) return fail(usb_open_error(wanted.name, path, errno));
    // A device opened by us: its descriptor can be duplicated for another process.
    if (const int error = libusb_wrap_sys_device(device->context(), device->descriptor_, &device->handle_); error != 0)
      return fail(usb_open_error(wanted.name, path, errno_of(error)));
    if (Result<void> same = device->check(wanted, found[0].descriptor, path); !same) return fail(std::move(same.error()));
    libusb_set_auto_detach_kernel_driver(device->handle_, 1);
    int claimed = LIBUSB_ERROR_OTHER;
    for (int tries = 0; tries < kClaimTries; ++tries) {
      claimed = libusb_claim_interface(device->handle_, kInterface);
      if (claimed == 0 || claimed == LIBUSB_ERROR_NO_DEVICE || claimed == LIBUSB_ERROR_BUSY) break;
      ::usleep(kClaimPauseUs);  // it was announced before it was ready
    }
    if (claimed != 0) return fail(usb_open_error(wanted.name, path, errno_of(claimed)));
    device->claimed_ = true;
    return device;
  }

  ~OpenDevice() {
    if (claimed_) libusb_release_interface(handle_, kInterface);
    if (handle_ != nullptr) libusb_close(handle_);
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  OpenDevice(const OpenDevice&) = delete;
  OpenDevice& operator=(const OpenDevice&) = delete;

  libusb_context* context() const { return context_.get(); }
  libusb_device_handle* handle() const { return handle_; }
  int descriptor() const { return descriptor_; }

 private:
  explicit OpenDevice(Context context) : context_(std::move(context)) {}

  Result<void> check(const UsbWanted& wanted, const libusb_device_descriptor& descriptor, const std::string& path) const {
    std::array<unsigned char, 256> text{};
    std::string calls_itself;
    if (descriptor.iProduct != 0) {
      const int length = libusb_get_string_descriptor_ascii(handle_, descriptor.iProduct, text.data(), static_cast<int>(text.size()));
      if (length > 0) calls_itself.assign(reinterpret_cast<const char*>(text.data()), static_cast<std::size_t>(length));
    }
    const auto other = [&](const std::string& why) {
      return fail(path, "has the numbers of a " + wanted.name + " (" + numbers(wanted) + "), but " + why +
                            ": it is another device, and is left alone");
    };
    if (!wanted.product_text.empty() && !calls_itself.empty() && calls_itself != wanted.product_text)
      return other("calls itself \"" + calls_itself + "\", not \"" + wanted.product_text + "\"");
    libusb_config_descriptor* config = nullptr;
    if (libusb_get_active_config_descriptor(libusb_get_device(handle_), &config) != 0) return other("has no configuration");
    bool in = false, out = false;
    if (config->bNumInterfaces > 0 && config->interface[0].num_altsetting > 0) {
      const libusb_interface_descriptor& first = config->interface[0].altsetting[0];
      for (int i = 0; i < first.bNumEndpoints; ++i) {
        const libusb_endpoint_descriptor& end = first.endpoint[i];
        const bool bulk = (end.bmAttributes & LIBUSB_TRANSFER_TYPE_MASK) == LIBUSB_TRANSFER_TYPE_BULK;
        in |= bulk && end.bEndpointAddress == wanted.in_endpoint;
        out |= bulk && end.bEndpointAddress == wanted.out_endpoint;
      }
    }
    libusb_free_config_descriptor(config);
    if (!in || !out) return other("doesn't have its endpoints");
    return {};
  }

  Context context_;
  int descriptor_ = -1;
  libusb_device_handle* handle_ = nullptr;
  bool claimed_ = false;
};

struct Packet {
  std::array<std::byte, kUsbPacketBytes> bytes;
  std::size_t count;
  std::int64_t valid_until_ns;
  bool is_control;
  UsbControl control;
};

class LibusbPort final : public UsbPort {
 public:
  LibusbPort(std::unique_ptr<OpenDevice> device, const UsbWanted& wanted, UsbGate gate, int realtime_priority)
      : device_(std::move(device)),
        out_endpoint_(wanted.out_endpoint),
        in_endpoint_(wanted.in_endpoint),
        gate_(std::move(gate)),
        realtime_priority_(realtime_priority) {}

  /// False: no descriptor or memory is left.
  bool start() {
    wake_ = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (wake_ < 0) return false;
    for (Reading& reading : readings_) {
      reading.port = this;
      reading.transfer = libusb_alloc_transfer(0);
      if (reading.transfer == nullptr) return false;
    }
    sending_.transfer = libusb_alloc_transfer(0);
    if (sending_.transfer == nullptr) return false;
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
    return true;
  }

  ~LibusbPort() override {
    if (thread_.joinable()) {
      thread_.request_stop();
      wake();
      thread_.join();
    }
    for (Reading& reading : readings_)
      if (!reading.flies) libusb_free_transfer(reading.transfer);
    if (!sending_.flies) libusb_free_transfer(sending_.transfer);
    if (wake_ >= 0) ::close(wake_);
  }
  LibusbPort(const LibusbPort&) = delete;
  LibusbPort& operator=(const LibusbPort&) = delete;

  // --- called by the user's thread ---

  PortCount read(std::span<std::byte> to) override {
    if (const auto packet = arrived_.pop()) {
      const std::size_t count = std::min(to.size(), packet->count);
      std::copy_n(packet->bytes.begin(), count, to.begin());
      return {count, PortStatus::ok};
    }
    return {0, gone() ? PortStatus::gone : PortStatus::ok};
  }

  PortStatus write(std::span<const std::byte> packet, std::int64_t valid_until_ns) override {
    Packet sent{};
    sent.count = std::min(packet.size(), kUsbPacketBytes);
    std::copy_n(packet.begin(), sent.count, sent.bytes.begin());
    sent.valid_until_ns = valid_until_ns;
    return add(sent);
  }

  PortStatus control(const UsbControl& request) override {
    Packet sent{};
    sent.valid_until_ns = kUsbForever;
    sent.is_control = true;
    sent.control = request;
    return add(sent);
  }

  std::size_t pending() const override { return pending_.load(std::memory_order_acquire); }
  std::uint64_t finished() const override { return finished_.load(std::memory_order_acquire); }
  int last_error() const override { return last_error_.load(std::memory_order_acquire); }
  int descriptor() const override { return device_->descriptor(); }

 private:
  struct Reading {
    LibusbPort* port = nullptr;
    libusb_transfer* transfer = nullptr;
    bool flies = false;
    std::array<unsigned char, kUsbPacketBytes> bytes{};
  };
  struct Sending {
    libusb_transfer* transfer = nullptr;
    bool flies = false;
    std::array<unsigned char, LIBUSB_CONTROL_SETUP_SIZE + kUsbPacketBytes> bytes{};
  };

  bool gone() const { return last_error() != 0; }

  PortStatus add(const Packet& packet) {
    if (gone()) return PortStatus::gone;
    pending_.fetch_add(1, std::memory_order_acq_rel);
    if (!waiting_.push(packet)) {
      pending_.fetch_sub(1, std::memory_order_acq_rel);
      return PortStatus::full;
    }
    wake();
    return PortStatus::ok;
  }

  /// Writing to an eventfd doesn't block; libusb's own way to wake its thread takes a lock.
  void wake() const {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t put = ::write(wake_, &one, sizeof one);
  }

  // --- called by the I/O thread ---

  void run(const std::stop_token& stop) {
    ::pthread_setname_np(::pthread_self(), "usb i/o");
    if (realtime_priority_ > 0) {
      sched_param priority{};
      priority.sched_priority = realtime_priority_;
      ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &priority);  // where it isn't granted, it does without
    }
    for (Reading& reading : readings_) begin_reading(reading);
    std::int64_t drained_by_ns = 0;
    for (;;) {
      send_next();
      if (stop.stop_requested()) {
        if (drained_by_ns == 0) drained_by_ns = clock_.now_ns() + kDrainNs;
        if (gone() || (!sending_.flies && pending() == 0) || clock_.now_ns() > drained_by_ns) break;
      }
      wait(stop.stop_requested() ? 5 : 1000);
    }
    cancel();
  }

  void wait(int patience_ms) {
    std::array<pollfd, 16> watched{};
    std::size_t count = 0;
    watched[count++] = {wake_, POLLIN, 0};
    if (const libusb_pollfd** of_libusb = libusb_get_pollfds(device_->context())) {
      for (const libusb_pollfd** each = of_libusb; *each != nullptr && count < watched.size(); ++each)
        watched[count++] = {(*each)->fd, (*each)->events, 0};
      libusb_free_pollfds(of_libusb);
    }
    timeval next{};
    if (libusb_get_next_timeout(device_->context(), &next) == 1)
      patience_ms = std::min(patience_ms, static_cast<int>(next.tv_sec * 1000 + next.tv_usec / 1000 + 1));
    ::poll(watched.data(), count, patience_ms);
    std::uint64_t ignored = 0;
    [[maybe_unused]] const ssize_t got = ::read(wake_, &ignored, sizeof ignored);
    handle_events();
  }

  void handle_events() {
    timeval none{};
    if (libusb_handle_events_timeout_completed(device_->context(), &none, nullptr) == LIBUSB_ERROR_NO_DEVICE) fail_with(ENODEV);
  }

  void begin_reading(Reading& reading) {
    libusb_fill_bulk_transfer(reading.transfer, device_->handle(), in_endpoint_, reading.bytes.data(), static_cast<int>(kUsbPacketBytes),
                              packet_came, &reading, 0);
    if (const int error = libusb_submit_transfer(reading.transfer); error != 0)
      fail_with(errno_of(error));
    else
      reading.flies = true;
  }

  static void LIBUSB_CALL packet_came(libusb_transfer* transfer) {
    Reading& reading = *static_cast<Reading*>(transfer->user_data);
    LibusbPort& port = *reading.port;
    reading.flies = false;
    if (transfer->status == LIBUSB_TRANSFER_CANCELLED) return;
    if (transfer->status != LIBUSB_TRANSFER_COMPLETED) return port.fail_with(transfer->status == LIBUSB_TRANSFER_NO_DEVICE ? ENODEV : EIO);
    if (transfer->actual_length > 0) {
      Packet packet{};
      packet.count = static_cast<std::size_t>(transfer->actual_length);
      std::copy_n(reinterpret_cast<const std::byte*>(reading.bytes.data()), packet.count, packet.bytes.begin());
      port.arrived_.push(packet);  // a reader that doesn't come for 64 packets loses the newest
    }
    if (!port.ending_) port.begin_reading(reading);
  }

  /// One transfer at a time, so that packets and requests keep their order, and none is older than it looks.
  void send_next() {
    while (!sending_.flies && !gone()) {
      const auto packet = waiting_.pop();
      if (!packet) return;
      if (!packet->is_control && clock_.now_ns() > packet->valid_until_ns) {
        finish();
        continue;
      }
      if (packet->is_control) {
        libusb_fill_control_setup(sending_.bytes.data(), packet->control.type, packet->control.request, packet->control.value,
                                  packet->control.index, 0);
        libusb_fill_control_transfer(sending_.transfer, device_->handle(), sending_.bytes.data(), sent, this, kControlPatienceMs);
      } else {
        std::copy_n(reinterpret_cast<const unsigned char*>(packet->bytes.data()), packet->count, sending_.bytes.begin());
        libusb_fill_bulk_transfer(sending_.transfer, device_->handle(), out_endpoint_, sending_.bytes.data(),
                                  static_cast<int>(packet->count), sent, this, kControlPatienceMs);
      }
      if (!gate_.begin()) {
        finish();
        continue;
      }
      // The way to the kernel ends within the call: a process that is stopped after it has nothing left to send.
      const int error = libusb_submit_transfer(sending_.transfer);
      gate_.end();
      if (error != 0) {
        finish();
        fail_with(errno_of(error));
      } else {
        sending_.flies = true;
      }
    }
  }

  static void LIBUSB_CALL sent(libusb_transfer* transfer) {
    LibusbPort& port = *static_cast<LibusbPort*>(transfer->user_data);
    port.sending_.flies = false;
    port.finish();
    if (transfer->status == LIBUSB_TRANSFER_COMPLETED || transfer->status == LIBUSB_TRANSFER_CANCELLED) return;
    port.fail_with(transfer->status == LIBUSB_TRANSFER_NO_DEVICE   ? ENODEV
                   : transfer->status == LIBUSB_TRANSFER_TIMED_OUT ? ETIMEDOUT
                                                                   : EIO);
  }

  void finish() {
    finished_.fetch_add(1, std::memory_order_acq_rel);
    pending_.fetch_sub(1, std::memory_order_acq_rel);
  }

  void fail_with(int error) {
    int none = 0;
    last_error_.compare_exchange_strong(none, error);
  }

  /// Cancel, reap, then close: never inside a callback.
  void cancel() {
    ending_ = true;
    const auto flying = [&] {
      return sending_.flies || std::any_of(readings_.begin(), readings_.end(), [](const Reading& each) { return each.flies; });
    };
    for (const Reading& reading : readings_)
      if (reading.flies) libusb_cancel_transfer(reading.transfer);
    if (sending_.flies) libusb_cancel_transfer(sending_.transfer);
    for (const std::int64_t until = clock_.now_ns() + kReapNs; flying() && clock_.now_ns() < until;) {
      timeval patience{0, 10'000};
      libusb_handle_events_timeout_completed(device_->context(), &patience, nullptr);
    }
  }

  std::unique_ptr<OpenDevice> device_;
  std::uint8_t out_endpoint_, in_endpoint_;
  UsbGate gate_;
  int realtime_priority_;
  MonotonicClock clock_;
  int wake_ = -1;
  Ring<Packet, kUsbPackets> waiting_;
  Ring<Packet, 64> arrived_;
  std::atomic<std::size_t> pending_ = 0;
  std::atomic<std::uint64_t> finished_ = 0;
  std::atomic<int> last_error_ = 0;
  std::array<Reading, kReadsAhead> readings_;
  Sending sending_;
  bool ending_ = false;
  std::jthread thread_;  ///< last member: the others must exist as long as it runs
};

class LibusbWatch final : public UsbWatch {
 public:
  explicit LibusbWatch(Context context) : context_(std::move(context)) {}

  bool start(const UsbWanted& wanted) {
    const int events = LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED | LIBUSB_HOTPLUG_EVENT_DEVICE_LEFT;
    if (libusb_has_capability(LIBUSB_CAP_HAS_HOTPLUG) == 0 ||
        libusb_hotplug_register_callback(context_.get(), events, LIBUSB_HOTPLUG_ENUMERATE, wanted.vendor, wanted.product,
                                         LIBUSB_HOTPLUG_MATCH_ANY, changed, this, &registered_) != 0)
      return false;
    thread_ = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        timeval patience{1, 0};
        libusb_handle_events_timeout_completed(context_.get(), &patience, nullptr);
      }
    });
    return true;
  }
  ~LibusbWatch() override {
    if (!thread_.joinable()) return;
    thread_.request_stop();
    libusb_hotplug_deregister_callback(context_.get(), registered_);  // wakes the thread, too
    libusb_interrupt_event_handler(context_.get());
    thread_.join();
  }
  LibusbWatch(const LibusbWatch&) = delete;
  LibusbWatch& operator=(const LibusbWatch&) = delete;

  std::uint64_t arrived() const override { return arrived_; }
  std::uint64_t left() const override { return left_; }

 private:
  /// No I/O is allowed here: it counts.
  static int LIBUSB_CALL changed(libusb_context*, libusb_device*, libusb_hotplug_event event, void* self) {
    LibusbWatch& watch = *static_cast<LibusbWatch*>(self);
    (event == LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED ? watch.arrived_ : watch.left_).fetch_add(1);
    return 0;
  }

  Context context_;
  libusb_hotplug_callback_handle registered_ = 0;
  std::atomic<std::uint64_t> arrived_ = 0, left_ = 0;
  std::jthread thread_;  ///< last member: the others must exist as long as it runs
};

}  // namespace

Result<std::unique_ptr<UsbPort>> open_usb_port(const UsbWanted& wanted, UsbGate gate, int realtime_priority) {
  Result<std::unique_ptr<OpenDevice>> device = OpenDevice::open(wanted);
  if (!device) return fail(std::move(device.error()));
  auto port = std::make_unique<LibusbPort>(std::move(*device), wanted, std::move(gate), realtime_priority);
  if (!port->start()) return fail(wanted.name, "no memory or descriptor is left for it");
  return port;
}

Result<std::unique_ptr<UsbWatch>> watch_usb(const UsbWanted& wanted) {
  Result<Context> context = make_context();
  if (!context) return fail(std::move(context.error()));
  auto watch = std::make_unique<LibusbWatch>(std::move(*context));
  if (!watch->start(wanted)) return fail("USB", "this system doesn't report devices that are plugged in");
  return watch;
}

}  // namespace prismesh::drivers::port
