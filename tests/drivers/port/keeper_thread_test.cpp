#include "drivers/port/keeper_thread.h"

#include <atomic>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "drivers/port/open_port.h"
#include "drivers/port/pty_pair.h"
#include "drivers/port/udp_port.h"
#include "tests/drivers/port/bytes.h"

namespace prismesh::drivers::port {
namespace {

namespace fs = std::filesystem;

class KeeperThreadTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "prismesh-keeper-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  void TearDown() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  fs::path folder_;
  MonotonicClock clock_;
};

/// A device behind a link that appears and disappears with it, as with udev.
struct Device {
  explicit Device(fs::path where) : link(std::move(where)) {}
  void plug_in() {
    pty = std::move(*open_pty_pair());
    fs::create_directories(link.parent_path());
    fs::create_symlink(pty.slave_path, link);
  }
  void unplug() {
    fs::remove_all(link.parent_path());  // udev removes the empty folder
    pty = {};
  }
  fs::path link;
  PtyPair pty;
};

TEST_F(KeeperThreadTest, opens_a_device_each_time_it_appears) {
  Device device(folder_ / "serial" / "by-id" / "usb-tracker");
  PortKeeper keeper(
      clock_, [&] { return open_port(device.link.string(), 9600); }, device.link.string());
  const KeeperThread thread(clock_, {work_of(keeper)});
  for (int round = 0; round < 5; ++round) {
    ASSERT_EQ(keeper.port(), nullptr);
    device.plug_in();
    ASSERT_TRUE(eventually([&] { return keeper.port() != nullptr; }));
    device.pty.master->write(bytes_of("hello"));
    EXPECT_EQ(read_soon(*keeper.port(), 5), "hello");
    device.unplug();
    std::array<std::byte, 8> buffer{};
    ASSERT_TRUE(eventually([&] { return keeper.port()->read(buffer).status == PortStatus::gone; }));
    keeper.give_back();
  }
  EXPECT_EQ(keeper.report().openings, 5u);
}

TEST_F(KeeperThreadTest, opens_an_appearing_device_before_the_next_attempt_is_due) {
  const fs::path path = folder_ / "by-id" / "usb-servo";
  std::atomic<int> attempts = 0;
  PortKeeper keeper(clock_,
                    [&]() -> Result<std::unique_ptr<BytePort>> {
                      ++attempts;
                      return fail(path.string(), "not yet");
                    },
                    path.string(), {3'600'000'000'000, 3'600'000'000'000, 0});  // the next attempt would be in an hour
  const KeeperThread thread(clock_, {work_of(keeper)});
  ASSERT_TRUE(eventually([&] { return attempts == 1; }));
  fs::create_directories(path.parent_path());
  std::ofstream(path) << "x";
  ASSERT_TRUE(eventually([&] { return attempts >= 2; }));
  const int before = attempts;
  fs::permissions(path, fs::perms::owner_read);  // as when udev sets the permissions a moment after the file has appeared
  EXPECT_TRUE(eventually([&] { return attempts > before; }));
}

TEST_F(KeeperThreadTest, several_devices_share_the_thread) {
  Device device(folder_ / "a");
  device.pty = std::move(*open_pty_pair());
  const auto number = (*UdpPort::open(0))->udp_port();
  PortKeeper serial(
      clock_, [&] { return open_port(device.pty.slave_path, 9600); }, device.pty.slave_path);
  DatagramKeeper udp(clock_, [&]() -> Result<std::unique_ptr<DatagramPort>> { return UdpPort::open(number); });
  const KeeperThread thread(clock_, {work_of(serial), work_of(udp)});
  EXPECT_TRUE(eventually([&] { return serial.port() != nullptr && udp.port() != nullptr; }));
}

TEST_F(KeeperThreadTest, hands_ports_over_safely_between_two_threads) {
  std::atomic<int> openings = 0;
  PtyPair pty = std::move(*open_pty_pair());
  const BackOff quick{1000, 1000, 0};
  PortKeeper keeper(
      clock_,
      [&] {
        ++openings;
        return open_port(pty.slave_path, 9600);
      },
      {}, quick);
  const KeeperThread thread(clock_, {work_of(keeper)});
  // This thread acts as the real-time loop and finds each port dead.
  int taken = 0;
  ASSERT_TRUE(eventually([&] {
    for (int i = 0; i < 100 && taken < 500; ++i)
      if (keeper.port() != nullptr) {
        ++taken;
        keeper.give_back();
      }
    return taken == 500;
  }));
  EXPECT_GE(openings, taken);
}

TEST(FileWatch, watches_missing_paths_before_and_after_they_existed) {
  std::string name = (fs::temp_directory_path() / "prismesh-watch-XXXXXX").string();
  const fs::path folder = ::mkdtemp(name.data());
  const fs::path path = folder / "a" / "b" / "device", neighbour = folder / "here";
  FileWatch watch({path.string(), neighbour.string(), ""});
  using Changed = std::vector<std::size_t>;
  EXPECT_EQ(watch.changed_paths(), Changed{});
  for (int round = 0; round < 3; ++round) {
    fs::create_directory(folder / "a");
    EXPECT_EQ(watch.changed_paths(), Changed{}) << "a folder on the way is not the device";
    fs::create_directory(folder / "a" / "b");
    std::ofstream(path) << "x";
    EXPECT_EQ(watch.changed_paths(), Changed{0});
    EXPECT_EQ(watch.changed_paths(), Changed{}) << "reported once";
    std::ofstream(folder / "other") << "x";
    fs::remove(folder / "other");
    EXPECT_EQ(watch.changed_paths(), Changed{}) << "a change of another file";
    std::ofstream(neighbour) << "x";
    EXPECT_EQ(watch.changed_paths(), Changed{1});
    fs::remove(neighbour);
    fs::remove_all(folder / "a");
    EXPECT_EQ(watch.changed_paths(), Changed{});
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace prismesh::drivers::port
