#include "tests/drivers/serial/fake_line.h"

#include <asm/termbits.h>
#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <umockdev.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <thread>

namespace prismesh::drivers::port {

namespace {

namespace fs = std::filesystem;

constexpr char kUsbDevice[] = "/devices/pci0000:00/usb1/1-1";

std::string description(const std::string& name, int minor, const std::string& serial) {
  const std::string usb = kUsbDevice;
  const std::string port = usb + "/1-1:1.0/" + name;
  return "P: " + usb + "\nE: DEVTYPE=usb_device\nE: SUBSYSTEM=usb\nA: idVendor=0403\\n\nA: idProduct=6014\\n\nA: serial=" + serial +
         "\\n\nA: busnum=1\\n\nA: devnum=4\\n\n\nP: " + usb + "/1-1:1.0\nE: DEVTYPE=usb_interface\nE: SUBSYSTEM=usb\n\nP: " + port +
         "\nE: SUBSYSTEM=usb-serial\nA: latency_timer=16\\n\n\nP: " + port + "/tty/" + name + "\nN: " + name + "\nE: DEVNAME=/dev/" + name +
         "\nE: SUBSYSTEM=tty\nE: MAJOR=188\nE: MINOR=" + std::to_string(minor) + "\nA: dev=188:" + std::to_string(minor) + "\n\n";
}

/// Copies an ioctl's argument from the host's memory (`in`) or into it.
template <class T>
void exchange(UMockdevIoctlClient* client, T& value, bool in) {
  UMockdevIoctlData* argument = umockdev_ioctl_client_get_arg(client);
  UMockdevIoctlData* data = umockdev_ioctl_data_resolve(argument, 0, sizeof(T), nullptr);
  if (in)
    std::memcpy(&value, data->data, sizeof(T));
  else
    std::memcpy(data->data, &value, sizeof(T));
  umockdev_ioctl_data_unref(data);
}

}  // namespace

struct FakeLine::Testbed {
  UMockdevTestbed* bed = umockdev_testbed_new();
  UMockdevIoctlBase* handler = umockdev_ioctl_base_new();
  std::string root;  // replaces / where umockdev doesn't redirect, as when folders and links are created
  int device = -1;
  mutable std::mutex mutex;
  int modem = TIOCM_CTS | TIOCM_DSR | TIOCM_CD;
  bool exclusive = false;
  std::vector<std::string> unknown;

  Testbed() {
    gchar* folder = umockdev_testbed_get_root_dir(bed);
    root = folder;
    g_free(folder);
    g_signal_connect(handler, "handle-ioctl", G_CALLBACK(handle), this);
  }
  ~Testbed() {
    g_object_unref(handler);
    g_object_unref(bed);
  }

  static gboolean handle(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
    return static_cast<Testbed*>(self)->play(client) ? TRUE : FALSE;
  }

  bool play(UMockdevIoctlClient* client) {
    const std::scoped_lock lock(mutex);
    const unsigned long request = umockdev_ioctl_client_get_request(client);
    if (!play_modem(client, request) && !play_mode(client, request)) {
      if (request == TCFLSH) return false;  // the pseudo-terminal itself handles this
      char text[32];
      std::snprintf(text, sizeof text, "0x%lx", request);
      unknown.emplace_back(text);
      return false;
    }
    umockdev_ioctl_client_complete(client, 0, 0);
    return true;
  }

  bool play_modem(UMockdevIoctlClient* client, unsigned long request) {
    int bits = modem;
    switch (request) {
      case TIOCMGET: exchange(client, bits, false); return true;
      case TIOCMSET: exchange(client, modem, true); return true;
      case TIOCMBIS:
        exchange(client, bits, true);
        modem |= bits;
        return true;
      case TIOCMBIC:
        exchange(client, bits, true);
        modem &= ~bits;
        return true;
      case TIOCEXCL: exclusive = true; return true;
      case TIOCNXCL: exclusive = false; return true;
      default: return false;
    }
  }

  /// The underlying pseudo-terminal stores the mode; its master may set it as well.
  bool play_mode(UMockdevIoctlClient* client, unsigned long request) {
    termios2 mode{};
    switch (request) {
      case TCGETS2:
        terminal(TCGETS2, mode);
        exchange(client, mode, false);
        return true;
      case TCSETS2:
        exchange(client, mode, true);
        terminal(TCSETS2, mode);
        return true;
      default: return false;
    }
  }

  /// Bypasses umockdev, which would call this class again.
  void terminal(unsigned long request, termios2& mode) const {
    if (::syscall(SYS_ioctl, device, request, &mode) != 0) throw std::runtime_error("the pseudo-terminal refuses its mode");
  }
};

bool FakeLine::possible() { return umockdev_in_mock_environment() != FALSE; }

FakeLine::FakeLine(std::string serial) : serial_(std::move(serial)), testbed_(std::make_unique<Testbed>()) {}

FakeLine::~FakeLine() = default;

void FakeLine::plug_in() {
  name_ = "ttyUSB" + std::to_string(++minor_);
  testbed_->modem &= ~(TIOCM_DTR | TIOCM_RTS);
  testbed_->exclusive = false;
  GError* error = nullptr;
  umockdev_testbed_add_from_string(testbed_->bed, description(name_, minor_, serial_).c_str(), &error);
  if (error == nullptr) umockdev_testbed_attach_ioctl(testbed_->bed, path().c_str(), testbed_->handler, &error);
  if (error != nullptr) throw std::runtime_error(error->message);
  testbed_->device = umockdev_testbed_get_dev_fd(testbed_->bed, path().c_str());
  // What udev's own rules create: a stable name and its folder.
  fs::create_directories(testbed_->root + "/dev/serial/by-id");
  fs::create_symlink("../../" + name_, testbed_->root + by_id_path());
  // umockdev finds a device's number by the requested path, not through links.
  std::string node = by_id_path().substr(5);
  std::replace(node.begin(), node.end(), '/', '_');
  fs::remove(testbed_->root + "/dev/.node/" + node);
  fs::create_symlink("188:" + std::to_string(minor_), testbed_->root + "/dev/.node/" + node);
}

void FakeLine::unplug() {
  fs::remove_all(testbed_->root + "/dev/serial");
  umockdev_testbed_detach_ioctl(testbed_->bed, path().c_str(), nullptr);
  const std::string usb = "/sys" + std::string(kUsbDevice), port = usb + "/1-1:1.0/" + name_;
  for (const std::string& part : {port + "/tty/" + name_, port, usb + "/1-1:1.0", usb})
    umockdev_testbed_remove_device(testbed_->bed, part.c_str());
  for (const fs::directory_entry& left_over : fs::directory_iterator(testbed_->root + "/dev/.ptymap")) fs::remove(left_over.path());
  // Simulates the hang-up: closes the pseudo-terminal's master, while its descriptor number stays reserved for umockdev.
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  ::dup2(nothing, testbed_->device);
  ::close(nothing);
}

void FakeLine::send(std::string_view text) {
  if (::write(testbed_->device, text.data(), text.size()) != static_cast<ssize_t>(text.size()))
    throw std::runtime_error("the line is full");
}

std::string FakeLine::receive(std::size_t length) {
  std::string text(length, '\0');
  std::size_t got = 0;
  for (int i = 0; i < 10'000 && got < length; ++i) {
    const ssize_t more = ::read(testbed_->device, text.data() + got, length - got);
    if (more > 0)
      got += static_cast<std::size_t>(more);
    else
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  text.resize(got);
  return text;
}

LineState FakeLine::state() const {
  const std::scoped_lock lock(testbed_->mutex);
  termios2 mode{};
  testbed_->terminal(TCGETS2, mode);
  LineState state;
  state.baud = static_cast<int>(mode.c_ospeed);
  state.raw = (mode.c_lflag & (ICANON | ECHO | ISIG | IEXTEN)) == 0 && (mode.c_oflag & OPOST) == 0 &&
              (mode.c_iflag & (ICRNL | INLCR | IGNCR | ISTRIP)) == 0;
  state.eight_n_one = (mode.c_cflag & (CSIZE | PARENB | CSTOPB)) == CS8;
  state.flow_control = (mode.c_cflag & CRTSCTS) != 0 || (mode.c_iflag & (IXON | IXOFF)) != 0;
  state.dtr = (testbed_->modem & TIOCM_DTR) != 0;
  state.rts = (testbed_->modem & TIOCM_RTS) != 0;
  state.exclusive = testbed_->exclusive;
  state.unknown_requests = testbed_->unknown;
  return state;
}

}  // namespace prismesh::drivers::port
