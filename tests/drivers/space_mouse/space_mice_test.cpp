// SpaceMouse devices that come, move, send nonsense and go, in virtual time and memory; and spacenavd's stream over a real socket.
#include "drivers/space_mouse/space_mice.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace prismesh::drivers::space_mouse {
namespace {

using Bytes = std::vector<std::byte>;

Bytes bytes_of(std::initializer_list<int> values) {
  Bytes made;
  for (const int each : values) made.push_back(static_cast<std::byte>(each));
  return made;
}

/// What a device has sent and nobody has read; `plugged` false: a read fails as the kernel's does.
struct FakeHid {
  std::deque<Bytes> reports;
  bool plugged = true;
  bool permitted = true;
  std::uint16_t vendor = 0x046D, product = 0xC626;
  int opened = 0;
};

class FakeHidPort final : public port::HidPort {
 public:
  explicit FakeHidPort(std::shared_ptr<FakeHid> device) : device_(std::move(device)) {}
  port::PortCount read(std::span<std::byte> to) override {
    if (!device_->plugged) return {0, port::PortStatus::gone};
    if (device_->reports.empty()) return {};
    const Bytes report = device_->reports.front();
    device_->reports.pop_front();
    const std::size_t count = std::min(report.size(), to.size());
    std::copy_n(report.begin(), count, to.begin());
    return {count, port::PortStatus::ok};
  }
  int descriptor() const override { return 7; }
  int last_error() const override { return device_->plugged ? 0 : ENODEV; }

 private:
  std::shared_ptr<FakeHid> device_;
};

class SpaceMiceTest : public ::testing::Test {
 protected:
  std::shared_ptr<FakeHid> plug(const std::string& path, std::uint16_t vendor = 0x046D, std::uint16_t product = 0xC626) {
    auto device = std::make_shared<FakeHid>();
    device->vendor = vendor;
    device->product = product;
    return devices_[path] = device;
  }
  SpaceMouseSources sources() {
    return {[this] {
              std::vector<port::HidDevice> found;
              for (const auto& [path, device] : devices_)
                if (device->plugged) found.push_back({path, device->vendor, device->product, "as it calls itself"});
              return found;
            },
            [this](const std::string& path, const std::string& name) -> Result<std::unique_ptr<port::HidPort>> {
              FakeHid& device = *devices_.at(path);
              if (!device.permitted) return fail(name + " (" + path + ")", "this user may not open it: 60-prismesh.rules");
              ++device.opened;
              return std::make_unique<FakeHidPort>(devices_.at(path));
            },
            [this]() -> Result<std::unique_ptr<port::HidPort>> {
              if (!spnav_ || !spnav_->plugged) return fail("spnav.sock", "nobody listens");
              return std::make_unique<FakeHidPort>(spnav_);
            }};
  }
  void later(std::int64_t ms) {
    clock_.advance_ns(ms * 1'000'000);
    mice_.turn();
  }

  ManualClock clock_;
  std::map<std::string, std::shared_ptr<FakeHid>> devices_;
  std::shared_ptr<FakeHid> spnav_;
  SpaceMice mice_{clock_, sources(), {.dead_zone = 0.1, .exponent = 1}};
};

const Bytes kFullRight = bytes_of({1, 0x5E, 1, 0, 0, 0, 0});           // 350
const Bytes kHalfTowardUser = bytes_of({1, 0, 0, 0xAF, 0, 0, 0});      // 175
const Bytes kTurnedLeftFully = bytes_of({2, 0, 0, 0, 0, 0xA2, 0xFE});  // -350
const Bytes kRests = bytes_of({1, 0, 0, 0, 0, 0, 0});
const Bytes kSecondButton = bytes_of({3, 2, 0});
const Bytes kNoButton = bytes_of({3, 0, 0});

TEST_F(SpaceMiceTest, a_device_is_found_within_a_second_after_it_is_plugged_in) {
  later(0);
  EXPECT_FALSE(mice_.any());
  const auto device = plug("/dev/hidraw3");
  plug("/dev/hidraw1", 0x046D, 0xC52B);  // an ordinary mouse
  later(999);
  EXPECT_FALSE(mice_.any()) << "it isn't looked for at each turn";
  later(1);
  EXPECT_TRUE(mice_.any());
  EXPECT_EQ(mice_.names(), "SpaceNavigator");
  EXPECT_EQ(mice_.descriptors(), std::vector<int>{7});
  EXPECT_EQ(mice_.changes(), 1u);
  later(5000);
  EXPECT_EQ(device->opened, 1);
  EXPECT_EQ(mice_.changes(), 1u);
}

TEST_F(SpaceMiceTest, its_cap_moves_beyond_the_dead_zone_and_keeps_moving_while_it_is_held) {
  const auto device = plug("/dev/hidraw3");
  device->reports = {kFullRight, kTurnedLeftFully};
  later(0);
  EXPECT_EQ(mice_.motion().shift[0], 1);
  EXPECT_EQ(mice_.motion().turn[2], -1);
  later(300);
  EXPECT_EQ(mice_.motion().shift[0], 1) << "no report says that anything has changed";
  device->reports = {kHalfTowardUser};
  later(10);
  EXPECT_EQ(mice_.motion().shift[0], 0);
  EXPECT_NEAR(mice_.motion().shift[1], (0.5 - 0.1) / 0.9, 1e-12);
  device->reports = {bytes_of({1, 34, 0, 0, 0, 0, 0}), bytes_of({2, 0, 0, 0, 0, 0, 0})};
  later(10);
  EXPECT_TRUE(mice_.motion().at_rest()) << "34 of 350 is within the dead zone";
}

TEST_F(SpaceMiceTest, a_report_cut_short_changes_nothing) {
  const auto device = plug("/dev/hidraw3");
  device->reports = {kFullRight};
  later(0);
  for (std::size_t length = 1; length < kHalfTowardUser.size(); ++length)
    device->reports.emplace_back(kHalfTowardUser.begin(), kHalfTowardUser.begin() + static_cast<std::ptrdiff_t>(length));
  device->reports.push_back(bytes_of({3}));
  later(10);
  EXPECT_EQ(mice_.motion().shift, (std::array<double, 3>{1, 0, 0}));
  EXPECT_EQ(mice_.take_presses(), 0u);
}

TEST_F(SpaceMiceTest, one_that_is_unplugged_in_the_midst_stops_the_motion_and_may_come_back) {
  const auto device = plug("/dev/hidraw3");
  device->reports = {kFullRight};
  later(0);
  device->plugged = false;
  later(10);
  EXPECT_TRUE(mice_.motion().at_rest());
  EXPECT_FALSE(mice_.any());
  EXPECT_EQ(mice_.changes(), 2u);
  device->plugged = true;
  later(1000);
  EXPECT_TRUE(mice_.any());
  EXPECT_TRUE(mice_.motion().at_rest()) << "what it did before it went is forgotten";
}

TEST_F(SpaceMiceTest, two_devices_add_up_and_one_that_goes_leaves_the_other) {
  const auto first = plug("/dev/hidraw3"), second = plug("/dev/hidraw4", 0x256F, 0xC635);
  first->reports = {kFullRight};
  second->reports = {kFullRight, kHalfTowardUser, kFullRight};
  later(0);
  EXPECT_EQ(mice_.names(), "SpaceNavigator, SpaceMouse Compact");
  EXPECT_EQ(mice_.motion().shift[0], 1) << "cut at the full speed";
  second->reports = {kHalfTowardUser};
  later(10);
  EXPECT_EQ(mice_.motion().shift[0], 1);
  EXPECT_GT(mice_.motion().shift[1], 0.4);
  first->plugged = false;
  later(10);
  EXPECT_EQ(mice_.motion().shift[0], 0);
  EXPECT_GT(mice_.motion().shift[1], 0.4);
}

TEST_F(SpaceMiceTest, a_button_is_told_once_however_long_it_is_down) {
  const auto device = plug("/dev/hidraw3");
  device->reports = {kSecondButton};
  later(0);
  EXPECT_EQ(mice_.take_presses(), 2u);
  device->reports = {kSecondButton, kSecondButton};
  later(10);
  EXPECT_EQ(mice_.take_presses(), 0u);
  device->reports = {kNoButton, kSecondButton, kNoButton};  // all between two turns
  later(10);
  EXPECT_EQ(mice_.take_presses(), 2u);
}

TEST_F(SpaceMiceTest, one_without_permission_is_told_at_the_second_look_and_opened_once_it_is_allowed) {
  const auto device = plug("/dev/hidraw3");
  device->permitted = false;
  later(0);
  EXPECT_EQ(mice_.trouble(), "") << "udev may be about to open it";
  later(1000);
  EXPECT_EQ(mice_.trouble(), "SpaceNavigator (/dev/hidraw3): this user may not open it: 60-prismesh.rules");
  const std::uint64_t told = mice_.changes();
  later(1000);
  EXPECT_EQ(mice_.changes(), told) << "told once";
  device->permitted = true;
  later(1000);
  EXPECT_EQ(mice_.trouble(), "");
  EXPECT_TRUE(mice_.any());
}

TEST_F(SpaceMiceTest, a_device_that_sends_without_end_holds_no_turn_up) {
  const auto device = plug("/dev/hidraw3");
  for (int i = 0; i < 10 * SpaceMice::kMostReports; ++i) device->reports.push_back(kFullRight);
  later(0);
  EXPECT_EQ(device->reports.size(), 9u * SpaceMice::kMostReports);
}

TEST_F(SpaceMiceTest, nothing_is_heard_while_another_window_has_the_keyboard) {
  const auto device = plug("/dev/hidraw3");
  device->reports = {kFullRight, kSecondButton};
  mice_.listen(false);
  later(0);
  EXPECT_TRUE(mice_.motion().at_rest());
  mice_.listen(true);
  later(10);
  EXPECT_EQ(mice_.take_presses(), 0u) << "it was pressed for the other window";
  EXPECT_EQ(mice_.motion().shift[0], 1);
}

// --- spacenavd ---

Bytes spnav_event(std::initializer_list<std::int32_t> values) {
  Bytes event(kSpnavEventBytes);
  std::size_t at = 0;
  for (const std::int32_t each : values) {
    std::memcpy(event.data() + at, &each, 4);
    at += 4;
  }
  return event;
}

TEST_F(SpaceMiceTest, spacenavd_is_the_only_source_while_it_runs) {
  const auto device = plug("/dev/hidraw3");
  device->reports = {kFullRight};
  later(0);
  EXPECT_EQ(mice_.names(), "SpaceNavigator");
  spnav_ = std::make_shared<FakeHid>();
  spnav_->reports = {spnav_event({0, 0, 350, 0, 0, 0, 350, 16}), spnav_event({1, 1})};
  later(1000);
  EXPECT_EQ(mice_.names(), "spacenavd");
  EXPECT_EQ(mice_.motion().shift, (std::array<double, 3>{0, 0, -1})) << "its y is up; nothing counts twice";
  EXPECT_EQ(mice_.motion().turn, (std::array<double, 3>{0, -1, 0})) << "its z leads away from the user";
  EXPECT_EQ(mice_.take_presses(), 2u);
  spnav_->plugged = false;
  later(10);
  EXPECT_TRUE(mice_.motion().at_rest());
  later(1000);
  EXPECT_EQ(mice_.names(), "SpaceNavigator");
}

TEST(SpnavEventsTest, are_put_together_from_pieces_of_any_length) {
  Bytes stream;
  for (const Bytes& event : {spnav_event({0, 10, 20, 30, 40, 50, 60, 8}), spnav_event({1, 0}), spnav_event({1, 63}), spnav_event({2, 0}),
                             spnav_event({1, 64}), spnav_event({1, -1}), spnav_event({3, 1, 2}), spnav_event({-5, 9, 9, 9})})
    stream.insert(stream.end(), event.begin(), event.end());
  for (std::size_t piece = 1; piece <= 64; ++piece) {
    SpnavEvents events;
    SpaceMouseState state;
    int told = 0;
    for (std::size_t at = 0; at < stream.size(); at += piece)
      events.take(std::span(stream).subspan(at, std::min(piece, stream.size() - at)), state, [&](const SpaceMouseState&) { ++told; });
    EXPECT_EQ(state, (SpaceMouseState{{10, -30, -20}, {40, -60, -50}, std::uint64_t{1} << 63})) << piece;
    EXPECT_EQ(told, 4) << piece;
  }
}

TEST(SpnavEventsTest, axes_end_at_full_deflection) {
  SpnavEvents events;
  SpaceMouseState state;
  const Bytes far = spnav_event({0, INT32_MAX, INT32_MIN, INT32_MAX, INT32_MIN, 351, -351, 8});
  events.take(far, state, [](const SpaceMouseState&) {});
  EXPECT_EQ(state, (SpaceMouseState{{350, -350, 350}, {-350, 350, -350}, 0}));
}

TEST(SpnavSocketTest, is_read_without_waiting_until_its_server_ends) {
  std::string folder = (std::filesystem::temp_directory_path() / "prismesh-spnav-XXXXXX").string();
  ASSERT_NE(::mkdtemp(folder.data()), nullptr);
  const std::string path = folder + "/spnav.sock";
  const auto none = connect_to_spnav(path);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().text(), path + ": spacenavd can't be reached: No such file or directory");
  EXPECT_FALSE(connect_to_spnav(std::string(200, 'x')));

  const int listening = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::copy(path.begin(), path.end(), address.sun_path);
  ASSERT_EQ(::bind(listening, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(::listen(listening, 1), 0);
  auto stream = connect_to_spnav(path);
  ASSERT_TRUE(stream) << stream.error().text();
  const int server = ::accept(listening, nullptr, nullptr);
  std::array<std::byte, 64> got{};
  EXPECT_EQ((*stream)->read(got).bytes, 0u) << "nothing has been sent";
  const Bytes event = spnav_event({0, 1, 2, 3, 4, 5, 6, 8});
  ASSERT_EQ(::write(server, event.data(), 20), 20);
  EXPECT_EQ((*stream)->read(got).bytes, 20u);
  ::close(server);
  EXPECT_EQ((*stream)->read(got).status, port::PortStatus::gone);
  ::close(listening);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace prismesh::drivers::space_mouse
