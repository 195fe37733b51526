#include "tests/drivers/usb/fake_usb.h"

#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <umockdev.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <map>
#include <mutex>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "base/clock.h"

namespace prismesh::drivers::port {

namespace {

constexpr unsigned kStringOfProduct = 2;
/// How long the host waits in a call for a transfer that isn't finished: the descriptor of a simulated device always looks ready.
constexpr int kPatienceTurns = 10;
constexpr useconds_t kTurnUs = 100;

/// Upper case, or umockdev doesn't take it.
std::string descriptors_hex(const FakeUsbOptions& options) {
  const auto low = [](unsigned value) { return value & 0xFF; };
  return fmt::format(
      "1201000200000040{:02X}{:02X}{:02X}{:02X}00040{}0{}0001"
      "09022000010100A02D"
      "0904000002FFFFFF00"
      "0705{:02X}02400000"
      "0705{:02X}02400000",
      low(options.vendor), options.vendor >> 8, low(options.product), options.product >> 8, 1, kStringOfProduct, options.in_endpoint,
      options.out_endpoint);
}

}  // namespace

struct FakeUsb::Bus {
  struct Transfer {
    UMockdevIoctlData* urb = nullptr;  // of the host's memory, until it is reaped
    UMockdevIoctlData* buffer = nullptr;
    usbdevfs_urb& of() const { return *reinterpret_cast<usbdevfs_urb*>(urb->data); }
  };
  struct Device {
    Bus* bus = nullptr;
    int number = 0;
    UsbDevice* device = nullptr;
    FakeUsbOptions options;
    UMockdevIoctlBase* handler = umockdev_ioctl_base_new();
    bool plugged_in = true, claimed_by_another = false, found_nothing = true;
    std::deque<Transfer> waiting, done;
    std::mutex mutex;
    std::string path() const { return fmt::format("/dev/bus/usb/001/{:03}", number); }
    std::string sys_path() const { return fmt::format("/devices/usb1/1-{}", number); }
  };

  UMockdevTestbed* bed = umockdev_testbed_new();
  MonotonicClock clock;
  int next_number = 2;
  std::map<int, std::unique_ptr<Device>> devices;

  ~Bus() {
    for (auto& [number, device] : devices)
      if (device->plugged_in) unplug(*device);
    g_object_unref(bed);
    for (auto& [number, device] : devices) {
      drop_all(*device);
      g_object_unref(device->handler);
    }
  }

  static void drop(Transfer& transfer) {
    if (transfer.buffer != nullptr) umockdev_ioctl_data_unref(transfer.buffer);
    if (transfer.urb != nullptr) umockdev_ioctl_data_unref(transfer.urb);
    transfer = {};
  }
  static void drop_all(Device& device) {
    for (auto* queue : {&device.waiting, &device.done}) {
      for (Transfer& each : *queue) drop(each);
      queue->clear();
    }
  }

  void unplug(Device& device) {
    {
      const std::lock_guard lock(device.mutex);
      device.plugged_in = false;
      // As the kernel does: what waits comes back with an error.
      for (Transfer& each : device.waiting) {
        each.of().status = -ENODEV;
        device.done.push_back(each);
      }
      device.waiting.clear();
    }
    umockdev_testbed_uevent(bed, ("/sys" + device.sys_path()).c_str(), "remove");
    umockdev_testbed_remove_device(bed, ("/sys" + device.sys_path()).c_str());
  }

  static void complete_reads(Device& device) {
    while (!device.waiting.empty() && device.plugged_in) {
      Transfer& first = device.waiting.front();
      const std::span<std::byte> to(reinterpret_cast<std::byte*>(first.buffer->data), static_cast<std::size_t>(first.of().buffer_length));
      const std::size_t count = device.device->send(device.bus->clock.now_ns(), to);
      if (count == 0) return;
      first.of().actual_length = static_cast<int>(count);
      first.of().status = 0;
      device.done.push_back(first);
      device.waiting.pop_front();
    }
  }

  /// The control endpoint. The buffer begins with the eight bytes of set-up; an answer follows them.
  static void control(Device& device, Transfer& transfer) {
    unsigned char* bytes = transfer.buffer->data;
    usbdevfs_urb& urb = transfer.of();
    const auto word = [&](std::size_t at) { return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8); };
    urb.status = 0;
    urb.actual_length = 0;
    if (bytes[0] == 0x80 && bytes[1] == 6 && bytes[3] == 3) {  // a string
      std::vector<unsigned char> answer{0, 3};
      if (bytes[2] == 0)
        answer.insert(answer.end(), {0x09, 0x04});
      else
        for (const char each : device.options.product_text) answer.insert(answer.end(), {static_cast<unsigned char>(each), 0});
      answer[0] = static_cast<unsigned char>(answer.size());
      const std::size_t count = std::min<std::size_t>(answer.size(), word(6));
      std::memcpy(bytes + 8, answer.data(), count);
      urb.actual_length = static_cast<int>(count);
    } else if ((bytes[0] & 0x60) == 0x40) {
      if (!device.device->control(device.bus->clock.now_ns(), {bytes[0], bytes[1], word(2), word(4)})) urb.status = -EPIPE;
    } else {
      urb.status = -EPIPE;
    }
  }

  /// False: the host has ended within the call, and its memory with it.
  static bool submit(Device& device, UMockdevIoctlData* argument) {
    Transfer transfer;
    transfer.urb = umockdev_ioctl_data_resolve(argument, 0, sizeof(usbdevfs_urb), nullptr);
    if (transfer.urb == nullptr) return false;
    usbdevfs_urb& urb = transfer.of();
    transfer.buffer =
        umockdev_ioctl_data_resolve(transfer.urb, offsetof(usbdevfs_urb, buffer), static_cast<gsize>(urb.buffer_length), nullptr);
    if (transfer.buffer == nullptr) {
      drop(transfer);
      return false;
    }
    if (urb.type == USBDEVFS_URB_TYPE_CONTROL) {
      control(device, transfer);
      device.done.push_back(transfer);
    } else if ((urb.endpoint & 0x80) != 0) {
      device.waiting.push_back(transfer);
    } else {
      device.device->receive(device.bus->clock.now_ns(),
                             {reinterpret_cast<const std::byte*>(transfer.buffer->data), static_cast<std::size_t>(urb.buffer_length)});
      urb.actual_length = urb.buffer_length;
      urb.status = 0;
      device.done.push_back(transfer);
    }
    complete_reads(device);
    return true;
  }

  static gboolean handle(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
    Device& device = *static_cast<Device*>(self);
    std::unique_lock lock(device.mutex);
    const auto answer = [&](long result, int error) {
      umockdev_ioctl_client_complete(client, result, error);
      return TRUE;
    };
    UMockdevIoctlData* argument = umockdev_ioctl_client_get_arg(client);
    const unsigned long request = umockdev_ioctl_client_get_request(client);
    if (!device.plugged_in && request != USBDEVFS_REAPURBNDELAY && request != USBDEVFS_RELEASEINTERFACE) return answer(-1, ENODEV);
    switch (request) {
      case USBDEVFS_GET_CAPABILITIES: {
        UMockdevIoctlData* data = umockdev_ioctl_data_resolve(argument, 0, sizeof(std::uint32_t), nullptr);
        if (data == nullptr) return answer(-1, EFAULT);
        const std::uint32_t can = USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_BULK_CONTINUATION | USBDEVFS_CAP_NO_PACKET_SIZE_LIM |
                                  USBDEVFS_CAP_BULK_SCATTER_GATHER | USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
        std::memcpy(data->data, &can, sizeof can);
        umockdev_ioctl_data_unref(data);
        return answer(0, 0);
      }
      case USBDEVFS_CONNECTINFO: {
        UMockdevIoctlData* data = umockdev_ioctl_data_resolve(argument, 0, sizeof(usbdevfs_connectinfo), nullptr);
        if (data == nullptr) return answer(-1, EFAULT);
        const usbdevfs_connectinfo info{static_cast<unsigned>(device.number), 0};
        std::memcpy(data->data, &info, sizeof info);
        umockdev_ioctl_data_unref(data);
        return answer(0, 0);
      }
      case USBDEVFS_CONTROL: {  // which configuration is active
        UMockdevIoctlData* data = umockdev_ioctl_data_resolve(argument, 0, sizeof(usbdevfs_ctrltransfer), nullptr);
        if (data == nullptr) return answer(-1, EFAULT);
        const auto& asked = *reinterpret_cast<const usbdevfs_ctrltransfer*>(data->data);
        const bool known = asked.bRequestType == 0x80 && asked.bRequest == 8 && asked.wLength == 1;
        if (known) {
          UMockdevIoctlData* to = umockdev_ioctl_data_resolve(data, offsetof(usbdevfs_ctrltransfer, data), 1, nullptr);
          if (to == nullptr) return answer(-1, EFAULT);
          to->data[0] = 1;
          umockdev_ioctl_data_unref(to);
        }
        umockdev_ioctl_data_unref(data);
        return known ? answer(1, 0) : answer(-1, EPIPE);
      }
      case USBDEVFS_CLAIMINTERFACE:
      case USBDEVFS_DISCONNECT_CLAIM: return device.claimed_by_another ? answer(-1, EBUSY) : answer(0, 0);
      case USBDEVFS_RELEASEINTERFACE: return answer(0, 0);
      case USBDEVFS_IOCTL: return answer(-1, ENODATA);  // there is no driver of the kernel
      case USBDEVFS_SUBMITURB: return submit(device, argument) ? answer(0, 0) : answer(-1, EFAULT);
      case USBDEVFS_REAPURBNDELAY: {
        // Only the first call after one that found nothing waits: libusb goes on as long as it finds something.
        complete_reads(device);
        for (int turn = 0; device.found_nothing && device.done.empty() && turn < kPatienceTurns && device.plugged_in; ++turn) {
          complete_reads(device);
          if (!device.done.empty()) break;
          lock.unlock();
          ::usleep(kTurnUs);
          lock.lock();
        }
        device.found_nothing = device.done.empty();
        if (device.done.empty()) return answer(-1, device.plugged_in ? EAGAIN : ENODEV);
        Transfer transfer = device.done.front();
        device.done.pop_front();
        UMockdevIoctlData* to = umockdev_ioctl_data_resolve(argument, 0, sizeof(gpointer), nullptr);
        if (to == nullptr) return answer(-1, EFAULT);
        umockdev_ioctl_data_set_ptr(to, 0, transfer.urb);
        answer(0, 0);
        umockdev_ioctl_data_unref(to);
        drop(transfer);
        return TRUE;
      }
      case USBDEVFS_DISCARDURB: {
        const auto found = std::find_if(device.waiting.begin(), device.waiting.end(), [&](const Transfer& each) {
          return each.urb->client_addr == reinterpret_cast<gulong>(*reinterpret_cast<void**>(argument->data));
        });
        if (found == device.waiting.end()) return answer(-1, EINVAL);
        found->of().status = -ENOENT;
        device.done.push_back(*found);
        device.waiting.erase(found);
        return answer(0, 0);
      }
      default: return FALSE;
    }
  }
};

bool FakeUsb::possible() { return umockdev_in_mock_environment() != 0; }

FakeUsb::FakeUsb() : bus_(std::make_unique<Bus>()) {}
FakeUsb::~FakeUsb() = default;

int FakeUsb::plug_in(UsbDevice& device, const FakeUsbOptions& options) {
  const int number = bus_->next_number++;
  auto& made = bus_->devices[number] = std::make_unique<Bus::Device>();
  made->bus = bus_.get();
  made->number = number;
  made->device = &device;
  made->options = options;
  g_signal_connect(made->handler, "handle-ioctl", G_CALLBACK(Bus::handle), made.get());
  GError* error = nullptr;
  const auto check = [&](bool done) {
    if (!done) throw std::runtime_error(error != nullptr ? error->message : "umockdev refuses a device");
  };
  check(umockdev_testbed_attach_ioctl(bus_->bed, made->path().c_str(), made->handler, &error) != 0);
  const std::string hex = descriptors_hex(options);
  const std::string text = fmt::format(
      "P: {0}\nN: bus/usb/001/{1:03}={2}\nE: SUBSYSTEM=usb\nE: DRIVER=usb\nE: BUSNUM=001\nE: DEVNUM={1:03}\nE: "
      "DEVNAME=/dev/bus/usb/001/{1:03}\n"
      "E: DEVTYPE=usb_device\nA: bConfigurationValue=1\\n\nA: busnum=1\\n\nA: devnum={1}\\n\nA: speed=12\\n\nH: descriptors={2}\n",
      made->sys_path(), number, hex);
  check(umockdev_testbed_add_from_string(bus_->bed, text.c_str(), &error) != 0);
  return number;
}

void FakeUsb::unplug(int number) { bus_->unplug(*bus_->devices.at(number)); }

void FakeUsb::claim_by_another(int number, bool claimed) {
  Bus::Device& device = *bus_->devices.at(number);
  const std::lock_guard lock(device.mutex);
  device.claimed_by_another = claimed;
}

std::string FakeUsb::path(int number) const { return bus_->devices.at(number)->path(); }

}  // namespace prismesh::drivers::port
