// A USB device for a virtual machine, spoken over QEMU's usb-redir: its kernel, libusb and hidraw see a real device. Usage: usb_device
// falcon|space-mouse SOCKET, where QEMU has `-chardev socket,id=a,path=SOCKET,server=on,wait=off -device usb-redir,chardev=a`. Reads
// commands, a line each, and answers each with a line:
//   plug, unplug
//   send 01 5E 01 ..   (space-mouse) a report, as the device sends it
//   state              what the host has done with the device
//   pump, rest         (falcon) the hand passes the marks of all arms again and again; lets the grip rest at the middle
// Ends with its input. `usb_device firmware FILE` writes a file that has the form of a Falcon's firmware.
#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/timerfd.h>
#include <sys/un.h>
#include <unistd.h>
#include <usbredirparser.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "base/clock.h"
#include "drivers/haptic_pen/falcon/simulated_falcon.h"

namespace prismesh {
namespace {

namespace falcon = drivers::haptic_pen::falcon;
using Bytes = std::vector<std::uint8_t>;

Bytes joined(Bytes first, const Bytes& second) {
  for (const std::uint8_t each : second) first.push_back(each);
  return first;
}

struct Endpoint {
  std::uint8_t address = 0, type = 0, interval = 0;
  std::uint16_t packet_bytes = 0;
};

struct Description {
  std::uint8_t speed = usb_redir_speed_full;
  Bytes device, configuration;  ///< as the device tells them
  std::vector<std::string> strings;
  std::uint8_t interface_class = 0;
  std::vector<Endpoint> endpoints;
  std::uint16_t word(std::size_t at) const { return static_cast<std::uint16_t>(device[at] | device[at + 1] << 8); }
};

/// What a device does beyond what all devices do.
class Device {
 public:
  virtual ~Device() = default;
  virtual const Description& description() const = 0;
  /// A request that isn't one for descriptors of the whole device. False: refused.
  virtual bool control(std::int64_t now_ns, const usb_redir_control_packet_header& request, Bytes& answer) = 0;
  virtual void bulk_out(std::int64_t, std::span<const std::byte>) {}
  /// The next packet of the bulk endpoint; empty: none now.
  virtual Bytes bulk_in(std::int64_t) { return {}; }
  virtual Bytes interrupt_in() { return {}; }
  virtual void unplugged() {}
  virtual std::string state() const = 0;
  /// Empty: no such command.
  virtual std::string command(const std::string& name, std::istream& arguments) = 0;
};

// --- SpaceNavigator: descriptors as owners have recorded them ---

constexpr std::uint8_t kReportDescriptor[] = {
    0x05, 0x01, 0x09, 0x08, 0xA1, 0x01, 0xA1, 0x00, 0x85, 0x01, 0x16, 0xA2, 0xFE, 0x26, 0x5E, 0x01, 0x36, 0x88, 0xFA, 0x46, 0x78, 0x05,
    0x55, 0x0C, 0x65, 0x11, 0x09, 0x30, 0x09, 0x31, 0x09, 0x32, 0x75, 0x10, 0x95, 0x03, 0x81, 0x06, 0xC0, 0xA1, 0x00, 0x85, 0x02, 0x09,
    0x33, 0x09, 0x34, 0x09, 0x35, 0x75, 0x10, 0x95, 0x03, 0x81, 0x06, 0xC0, 0xA1, 0x02, 0x85, 0x03, 0x05, 0x01, 0x05, 0x09, 0x19, 0x01,
    0x29, 0x02, 0x15, 0x00, 0x25, 0x01, 0x35, 0x00, 0x45, 0x01, 0x75, 0x01, 0x95, 0x02, 0x81, 0x02, 0x95, 0x0E, 0x81, 0x03, 0xC0, 0xA1,
    0x02, 0x85, 0x04, 0x05, 0x08, 0x09, 0x4B, 0x15, 0x00, 0x25, 0x01, 0x95, 0x01, 0x75, 0x01, 0x91, 0x02, 0x95, 0x01, 0x75, 0x07, 0x91,
    0x03, 0xC0, 0x06, 0x00, 0xFF, 0x09, 0x01, 0xA1, 0x02, 0x15, 0x80, 0x25, 0x7F, 0x75, 0x08, 0x09, 0x3A, 0xA1, 0x02, 0x85, 0x05, 0x09,
    0x20, 0x95, 0x01, 0xB1, 0x02, 0xC0, 0xA1, 0x02, 0x85, 0x06, 0x09, 0x21, 0x95, 0x01, 0xB1, 0x02, 0xC0, 0xA1, 0x02, 0x85, 0x07, 0x09,
    0x22, 0x95, 0x01, 0xB1, 0x02, 0xC0, 0xA1, 0x02, 0x85, 0x08, 0x09, 0x23, 0x95, 0x07, 0xB1, 0x02, 0xC0, 0xA1, 0x02, 0x85, 0x09, 0x09,
    0x24, 0x95, 0x07, 0xB1, 0x02, 0xC0, 0xA1, 0x02, 0x85, 0x0A, 0x09, 0x25, 0x95, 0x07, 0xB1, 0x02, 0xC0, 0xA1, 0x02, 0x85, 0x0B, 0x09,
    0x26, 0x95, 0x01, 0xB1, 0x02, 0xC0, 0xA1, 0x02, 0x85, 0x13, 0x09, 0x2E, 0x95, 0x01, 0xB1, 0x02, 0xC0, 0xC0, 0xC0};
static_assert(sizeof kReportDescriptor == 217);

class SpaceNavigator final : public Device {
 public:
  SpaceNavigator() {
    made_.speed = usb_redir_speed_low;
    made_.device = {18, 1, 0x00, 0x02, 0, 0, 0, 8, 0x6D, 0x04, 0x26, 0xC6, 0x31, 0x04, 1, 2, 0, 1};
    made_.configuration = joined(joined({9, 2, 34, 0, 1, 1, 0, 0x80, 50, 9, 4, 0, 0, 1, 3, 0, 0, 0}, kHid), {7, 5, 0x81, 3, 8, 0, 8});
    made_.strings = {"", "3Dconnexion", "SpaceNavigator"};
    made_.interface_class = 3;
    made_.endpoints = {{0x81, usb_redir_type_interrupt, 8, 8}};
  }
  const Description& description() const override { return made_; }

  bool control(std::int64_t, const usb_redir_control_packet_header& request, Bytes& answer) override {
    if (request.requesttype == 0x81 && request.request == 6 && request.value >> 8 == 0x22)
      answer.assign(std::begin(kReportDescriptor), std::end(kReportDescriptor));
    else if (request.requesttype == 0x81 && request.request == 6 && request.value >> 8 == 0x21)
      answer = kHid;
    else if (request.requesttype == 0x21 && request.request == 10)
      ++idle_;  // reports come on change only
    else
      return false;
    return true;
  }
  Bytes interrupt_in() override {
    if (reports_.empty()) return {};
    Bytes report = std::move(reports_.front());
    reports_.pop_front();
    ++sent_;
    return report;
  }
  void unplugged() override { reports_.clear(); }
  std::string state() const override { return "idle=" + std::to_string(idle_) + " sent=" + std::to_string(sent_); }
  std::string command(const std::string& name, std::istream& arguments) override {
    if (name != "send") return {};
    Bytes report;
    for (unsigned each = 0; arguments >> std::hex >> each;) report.push_back(static_cast<std::uint8_t>(each));
    reports_.push_back(report);
    return "ok";
  }

 private:
  const Bytes kHid{9, 0x21, 0x11, 0x01, 0, 1, 0x22, sizeof kReportDescriptor, 0};
  Description made_;
  std::deque<Bytes> reports_;
  int idle_ = 0, sent_ = 0;
};

// --- Novint Falcon: the simulated device of the drivers' tests, behind an FTDI chip's descriptors ---

class Falcon final : public Device {
 public:
  Falcon() {
    made_.device = {18, 1, 0x00, 0x02, 0, 0, 0, 64, 0x03, 0x04, 0x48, 0xCB, 0x00, 0x04, 1, 2, 0, 1};
    made_.configuration = {9,    2, 32, 0, 1,    1, 0,  0xA0, 45, 9, 4, 0,    0, 2,  0xFF, 0xFF,
                           0xFF, 0, 7,  5, 0x02, 2, 64, 0,    0,  7, 5, 0x81, 2, 64, 0,    0};
    made_.strings = {"", "Novint", "FALCON HAPTIC"};
    made_.interface_class = 0xFF;
    made_.endpoints = {{0x02, usb_redir_type_bulk, 0, 64}, {0x81, usb_redir_type_bulk, 0, 64}};
    plug();
  }
  const Description& description() const override { return made_; }

  bool control(std::int64_t now_ns, const usb_redir_control_packet_header& request, Bytes&) override {
    return device_->control(now_ns, {request.requesttype, request.request, request.value, request.index});
  }
  void bulk_out(std::int64_t now_ns, std::span<const std::byte> bytes) override { device_->receive(now_ns, bytes); }
  Bytes bulk_in(std::int64_t now_ns) override {
    Bytes packet(64);
    packet.resize(device_->send(now_ns, {reinterpret_cast<std::byte*>(packet.data()), packet.size()}));
    return packet;
  }
  void unplugged() override { plug(); }  // both plugs
  std::string state() const override {
    std::ostringstream text;
    text << "runs=" << device_->runs() << " homed=" << int{device_->homed()}
         << " loaded=" << (device_->loaded() == falcon::pretended_firmware(kWords)) << " packets=" << packets_ << " forces=" << forces_
         << " last_is_zero=" << last_is_zero_ << " grip=" << device_->pen().position_mm().transpose();
    return text.str();
  }
  std::string command(const std::string& name, std::istream&) override {
    if (name == "pump" || name == "rest") {
      pumps_ = name == "pump";
      return "ok";
    }
    return {};
  }
  static void write_firmware(const std::string& path) {
    const std::vector<std::byte> bytes = falcon::pretended_firmware(kWords);
    std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }

 private:
  static constexpr std::size_t kWords = 1500;
  void plug() {
    device_ = std::make_unique<falcon::SimulatedFalcon>(
        falcon::SimulatedFalconOptions{},
        [this](double seconds) {
          drivers::haptic_pen::SimulatedHand hand;
          hand.goal_mm = pumps_ ? Eigen::Vector3d(5 * std::sin(2 * seconds), 0, 38 * std::sin(5 * seconds)) : Eigen::Vector3d(10, -20, 5);
          return hand;
        },
        [this](std::int64_t, const falcon::ForcePacket& packet) {
          ++packets_;
          last_is_zero_ = packet.motors == std::array<std::int16_t, 3>{};
          forces_ += last_is_zero_ ? 0 : 1;
        });
  }
  Description made_;
  bool pumps_ = true, last_is_zero_ = true;
  int packets_ = 0, forces_ = 0;
  std::unique_ptr<falcon::SimulatedFalcon> device_;
};

// --- the cable ---

class Cable {
 public:
  Cable(Device& device, int link) : device_(device), link_(link), parser_(usbredirparser_create()) {
    parser_->priv = this;
    parser_->log_func = [](void*, int level, const char* text) {
      if (level <= usbredirparser_warning) std::fprintf(stderr, "%s\n", text);
    };
    parser_->read_func = [](void* self, std::uint8_t* to, int count) {
      return of(self).transfer(::read(of(self).link_, to, static_cast<std::size_t>(count)), true);
    };
    parser_->write_func = [](void* self, std::uint8_t* from, int count) {
      return of(self).transfer(::write(of(self).link_, from, static_cast<std::size_t>(count)), false);
    };
    parser_->hello_func = [](void* self, usb_redir_hello_header*) { of(self).is_met_ = true; };
    parser_->reset_func = [](void* self) { of(self).forget(); };
    parser_->control_packet_func = [](void* self, std::uint64_t id, usb_redir_control_packet_header* request, std::uint8_t* data, int) {
      of(self).control(id, *request);
      usbredirparser_free_packet_data(of(self).parser_, data);
    };
    parser_->bulk_packet_func = [](void* self, std::uint64_t id, usb_redir_bulk_packet_header* packet, std::uint8_t* data, int count) {
      of(self).bulk(id, *packet, {reinterpret_cast<const std::byte*>(data), static_cast<std::size_t>(count)});
      usbredirparser_free_packet_data(of(self).parser_, data);
    };
    parser_->interrupt_packet_func = [](void* self, std::uint64_t, usb_redir_interrupt_packet_header*, std::uint8_t* data, int) {
      usbredirparser_free_packet_data(of(self).parser_, data);
    };
    parser_->set_configuration_func = [](void* self, std::uint64_t id, usb_redir_set_configuration_header* what) {
      usb_redir_configuration_status_header status{usb_redir_success, what->configuration};
      usbredirparser_send_configuration_status(of(self).parser_, id, &status);
    };
    parser_->get_configuration_func = [](void* self, std::uint64_t id) {
      usb_redir_configuration_status_header status{usb_redir_success, 1};
      usbredirparser_send_configuration_status(of(self).parser_, id, &status);
    };
    parser_->set_alt_setting_func = [](void* self, std::uint64_t id, usb_redir_set_alt_setting_header* what) {
      usb_redir_alt_setting_status_header status{usb_redir_success, what->interface, what->alt};
      usbredirparser_send_alt_setting_status(of(self).parser_, id, &status);
    };
    parser_->get_alt_setting_func = [](void* self, std::uint64_t id, usb_redir_get_alt_setting_header* what) {
      usb_redir_alt_setting_status_header status{usb_redir_success, what->interface, 0};
      usbredirparser_send_alt_setting_status(of(self).parser_, id, &status);
    };
    parser_->start_interrupt_receiving_func = [](void* self, std::uint64_t id, usb_redir_start_interrupt_receiving_header* what) {
      of(self).is_listened_to_ = true;
      usb_redir_interrupt_receiving_status_header status{usb_redir_success, what->endpoint};
      usbredirparser_send_interrupt_receiving_status(of(self).parser_, id, &status);
    };
    parser_->stop_interrupt_receiving_func = [](void* self, std::uint64_t id, usb_redir_stop_interrupt_receiving_header* what) {
      of(self).is_listened_to_ = false;
      usb_redir_interrupt_receiving_status_header status{usb_redir_success, what->endpoint};
      usbredirparser_send_interrupt_receiving_status(of(self).parser_, id, &status);
    };
    parser_->cancel_data_packet_func = [](void* self, std::uint64_t id) { of(self).cancel(id); };
    parser_->device_disconnect_ack_func = [](void* self) { of(self).is_leaving_ = false; };
    parser_->filter_reject_func = [](void*) {};
    parser_->filter_filter_func = [](void*, usbredirfilter_rule* rules, int) { std::free(rules); };
    std::uint32_t can[USB_REDIR_CAPS_SIZE] = {};
    for (const int each : {usb_redir_cap_connect_device_version, usb_redir_cap_filter, usb_redir_cap_device_disconnect_ack,
                           usb_redir_cap_ep_info_max_packet_size, usb_redir_cap_64bits_ids, usb_redir_cap_32bits_bulk_length})
      usbredirparser_caps_set_cap(can, each);
    usbredirparser_init(parser_, "prismesh test device", can, USB_REDIR_CAPS_SIZE, usbredirparser_fl_usb_host);
  }
  ~Cable() { usbredirparser_destroy(parser_); }
  Cable(const Cable&) = delete;
  Cable& operator=(const Cable&) = delete;

  bool is_gone() const { return is_gone_; }
  bool is_ready() const { return is_met_ && !is_leaving_; }
  bool is_plugged() const { return is_plugged_; }
  bool is_listened_to() const { return is_listened_to_; }
  bool has_to_write() const { return usbredirparser_has_data_to_write(parser_) > 0; }
  void read() { (void)usbredirparser_do_read(parser_); }
  void write() { (void)usbredirparser_do_write(parser_); }

  void plug() {
    const Description& what = device_.description();
    usb_redir_interface_info_header interfaces{};
    interfaces.interface_count = 1;
    interfaces.interface_class[0] = what.interface_class;
    usb_redir_ep_info_header endpoints{};
    std::fill(std::begin(endpoints.type), std::end(endpoints.type), static_cast<std::uint8_t>(usb_redir_type_invalid));
    const auto put = [&](const Endpoint& each) {
      const std::size_t at = (each.address & 15u) | (each.address & 0x80u) >> 3;
      endpoints.type[at] = each.type;
      endpoints.interval[at] = each.interval;
      endpoints.max_packet_size[at] = each.packet_bytes;
    };
    for (const std::uint8_t way : Bytes{0x00, 0x80}) put({way, usb_redir_type_control, 0, what.device[7]});
    for (const Endpoint& each : what.endpoints) put(each);
    usbredirparser_send_interface_info(parser_, &interfaces);
    usbredirparser_send_ep_info(parser_, &endpoints);
    usb_redir_device_connect_header connect{};
    connect.speed = what.speed;
    connect.vendor_id = what.word(8);
    connect.product_id = what.word(10);
    connect.device_version_bcd = what.word(12);
    usbredirparser_send_device_connect(parser_, &connect);
    is_plugged_ = true;
  }
  void unplug() {
    forget();
    device_.unplugged();
    usbredirparser_send_device_disconnect(parser_);
    is_plugged_ = false;
    is_leaving_ = true;
  }
  /// Sends what the device has by now.
  void turn() {
    while (!asked_.empty()) {
      Bytes packet = device_.bulk_in(clock_.now_ns());
      if (packet.empty()) break;
      usb_redir_bulk_packet_header answer = asked_.front().second;
      answer.status = usb_redir_success;
      answer.length = static_cast<std::uint16_t>(packet.size());
      answer.length_high = 0;
      usbredirparser_send_bulk_packet(parser_, asked_.front().first, &answer, packet.data(), static_cast<int>(packet.size()));
      asked_.pop_front();
    }
    while (is_listened_to_) {
      Bytes report = device_.interrupt_in();
      if (report.empty()) break;
      usb_redir_interrupt_packet_header packet{0x81, usb_redir_success, static_cast<std::uint16_t>(report.size())};
      usbredirparser_send_interrupt_packet(parser_, 0, &packet, report.data(), static_cast<int>(report.size()));
    }
  }

 private:
  static Cable& of(void* self) { return *static_cast<Cable*>(self); }
  int transfer(ssize_t count, bool ends_with_zero) {
    if (count > 0) return static_cast<int>(count);
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
    if (count == 0 && !ends_with_zero) return 0;
    is_gone_ = true;
    return -1;
  }
  void forget() {
    asked_.clear();
    is_listened_to_ = false;
  }
  void control(std::uint64_t id, usb_redir_control_packet_header request) {
    const Description& what = device_.description();
    Bytes answer;
    bool taken = true;
    const unsigned kind = request.value >> 8, number = request.value & 0xFF;
    if (request.requesttype == 0x80 && request.request == 6 && kind == 1) {
      answer = what.device;
    } else if (request.requesttype == 0x80 && request.request == 6 && kind == 2) {
      answer = what.configuration;
    } else if (request.requesttype == 0x80 && request.request == 6 && kind == 3 && number < what.strings.size()) {
      const std::string text = number == 0 ? "\x09" : what.strings[number];  // 0: the languages, and 0x0409 is the only one
      for (const char each : text) {
        answer.push_back(static_cast<std::uint8_t>(each));
        answer.push_back(number == 0 ? 0x04 : 0);
      }
      answer = joined({static_cast<std::uint8_t>(answer.size() + 2), 3}, answer);
    } else if ((request.requesttype & 0x80) != 0 && request.request == 0) {
      answer = {0, 0};  // status
    } else if ((request.requesttype & 0x60) == 0 && (request.request == 1 || request.request == 3)) {
      // features: an endpoint's halt ends
    } else {
      taken = device_.control(clock_.now_ns(), request, answer);
    }
    answer.resize(std::min<std::size_t>(answer.size(), request.length));
    request.status = taken ? usb_redir_success : usb_redir_stall;
    if ((request.requesttype & 0x80) != 0) request.length = static_cast<std::uint16_t>(answer.size());
    usbredirparser_send_control_packet(parser_, id, &request, answer.empty() ? nullptr : answer.data(), static_cast<int>(answer.size()));
  }
  void bulk(std::uint64_t id, usb_redir_bulk_packet_header packet, std::span<const std::byte> bytes) {
    if ((packet.endpoint & 0x80) != 0) {
      asked_.emplace_back(id, packet);
      return;
    }
    device_.bulk_out(clock_.now_ns(), bytes);
    packet.status = usb_redir_success;
    usbredirparser_send_bulk_packet(parser_, id, &packet, nullptr, 0);
  }
  void cancel(std::uint64_t id) {
    const auto found = std::find_if(asked_.begin(), asked_.end(), [&](const auto& each) { return each.first == id; });
    if (found == asked_.end()) return;
    usb_redir_bulk_packet_header answer = found->second;
    answer.status = usb_redir_cancelled;
    answer.length = answer.length_high = 0;
    usbredirparser_send_bulk_packet(parser_, id, &answer, nullptr, 0);
    asked_.erase(found);
  }

  Device& device_;
  int link_;
  MonotonicClock clock_;
  usbredirparser* parser_;
  bool is_met_ = false, is_plugged_ = false, is_leaving_ = false, is_listened_to_ = false, is_gone_ = false;
  std::deque<std::pair<std::uint64_t, usb_redir_bulk_packet_header>> asked_;  ///< reads that wait
};

int connect_to(const std::string& path) {
  const int link = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (link < 0 || path.size() >= sizeof address.sun_path) return -1;
  std::copy(path.begin(), path.end(), address.sun_path);
  if (::connect(link, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return -1;
  ::fcntl(link, F_SETFL, O_NONBLOCK);
  return link;
}

std::string obey(Device& device, Cable& cable, const std::string& line) {
  std::istringstream words(line);
  std::string name;
  words >> name;
  if (name == "plug" || name == "unplug") {
    if (!cable.is_ready()) return "not yet";
    if (cable.is_plugged() == (name == "plug")) return "it is already";
    name == "plug" ? cable.plug() : cable.unplug();
    return "ok";
  }
  if (name == "state")
    return std::string("plugged=") + (cable.is_plugged() ? "1" : "0") + " listened=" + (cable.is_listened_to() ? "1 " : "0 ") +
           device.state();
  const std::string answer = device.command(name, words);
  return answer.empty() ? "no such command: " + line : answer;
}

int run(Device& device, int link) {
  Cable cable(device, link);
  const int timer = ::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC);
  const itimerspec each_ms{{0, 1'000'000}, {0, 1'000'000}};
  ::timerfd_settime(timer, 0, &each_ms, nullptr);
  for (std::string input; !cable.is_gone();) {
    cable.turn();
    pollfd watched[] = {
        {STDIN_FILENO, POLLIN, 0}, {link, static_cast<short>(POLLIN | (cable.has_to_write() ? POLLOUT : 0)), 0}, {timer, POLLIN, 0}};
    ::poll(watched, 3, -1);
    std::uint64_t ticks = 0;
    if (watched[2].revents != 0) [[maybe_unused]]
      const ssize_t ignored = ::read(timer, &ticks, sizeof ticks);
    if ((watched[1].revents & (POLLIN | POLLHUP)) != 0) cable.read();
    if (watched[0].revents != 0) {
      char bytes[512];
      const ssize_t count = ::read(STDIN_FILENO, bytes, sizeof bytes);
      if (count <= 0) break;
      input.append(bytes, static_cast<std::size_t>(count));
      for (std::size_t end = 0; (end = input.find('\n')) != input.npos; input.erase(0, end + 1)) {
        std::printf("%s\n", obey(device, cable, input.substr(0, end)).c_str());
        std::fflush(stdout);
      }
    }
    if (cable.has_to_write()) cable.write();
  }
  ::close(timer);
  return 0;
}

}  // namespace
}  // namespace prismesh

int main(int count, char** arguments) {
  using namespace prismesh;
  const std::string kind = count == 3 ? arguments[1] : "";
  if (kind == "firmware") {
    Falcon::write_firmware(arguments[2]);
    return 0;
  }
  if (kind != "falcon" && kind != "space-mouse") {
    std::fprintf(stderr, "usage: usb_device falcon|space-mouse SOCKET\n");
    return 2;
  }
  std::unique_ptr<Device> device;
  if (kind == "falcon")
    device = std::make_unique<Falcon>();
  else
    device = std::make_unique<SpaceNavigator>();
  const int link = connect_to(arguments[2]);
  if (link < 0) {
    std::fprintf(stderr, "%s: %s\n", arguments[2], std::strerror(errno));
    return 1;
  }
  return run(*device, link);
}
