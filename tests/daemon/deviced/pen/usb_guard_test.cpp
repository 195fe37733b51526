// The guard of a USB device: it sends zero through the kernel's interface on a duplicate of the descriptor. This program stands in for the
// kernel: it defines `ioctl`, also for the guard, which is forked from it.
#include <linux/usbdevice_fs.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdarg>
#include <cstring>
#include <filesystem>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include "daemon/deviced/pen/line_guard.h"
#include "drivers/haptic_pen/falcon/falcon_pen.h"

namespace {

/// Shared with the guard.
struct BulkSeen {
  std::atomic<std::uint64_t> count = 0;
  std::atomic<unsigned> endpoint = 0, length = 0, timeout_ms = 0;
  std::atomic<int> error = 0;  ///< what the kernel answers
  std::array<std::byte, 64> bytes{};
};
BulkSeen* bulk_seen = nullptr;

}  // namespace

extern "C" int ioctl(int descriptor, unsigned long request, ...) noexcept {
  std::va_list rest;
  va_start(rest, request);
  void* argument = va_arg(rest, void*);
  va_end(rest);
  if (bulk_seen == nullptr || request != USBDEVFS_BULK) return static_cast<int>(::syscall(SYS_ioctl, descriptor, request, argument));
  const auto& bulk = *static_cast<const usbdevfs_bulktransfer*>(argument);
  bulk_seen->endpoint = bulk.ep;
  bulk_seen->length = bulk.len;
  bulk_seen->timeout_ms = bulk.timeout;
  std::memcpy(bulk_seen->bytes.data(), bulk.data, std::min<std::size_t>(bulk.len, bulk_seen->bytes.size()));
  bulk_seen->count.fetch_add(1);
  if (const int error = bulk_seen->error; error != 0) {
    errno = error;
    return -1;
  }
  return static_cast<int>(bulk.len);
}

namespace prismesh::deviced::pen {
namespace {

namespace fs = std::filesystem;

/// A device whose descriptor is that of nothing special.
class StandInPort final : public drivers::port::UsbPort {
 public:
  StandInPort() : descriptor_(::memfd_create("usb", MFD_CLOEXEC)) {}
  ~StandInPort() override { ::close(descriptor_); }
  StandInPort(const StandInPort&) = delete;
  StandInPort& operator=(const StandInPort&) = delete;
  drivers::port::PortCount read(std::span<std::byte>) override { return {}; }
  drivers::port::PortStatus write(std::span<const std::byte>, std::int64_t) override { return drivers::port::PortStatus::ok; }
  drivers::port::PortStatus control(const drivers::port::UsbControl&) override { return drivers::port::PortStatus::ok; }
  std::size_t pending() const override { return 0; }
  std::uint64_t finished() const override { return 0; }
  int last_error() const override { return 0; }
  int descriptor() const override { return descriptor_; }

 private:
  int descriptor_;
};

class UsbGuard : public ::testing::Test {
 protected:
  UsbGuard() {
    std::string name = (fs::temp_directory_path() / "prismesh-usb-guard-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    void* memory = ::mmap(nullptr, sizeof(BulkSeen), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    bulk_seen = new (memory) BulkSeen;
  }
  ~UsbGuard() override {
    ::munmap(std::exchange(bulk_seen, nullptr), sizeof(BulkSeen));
    fs::remove_all(folder_);
  }
  static bool wait_until(const std::function<bool()>& so) {
    for (int i = 0; i < 20'000 && !so(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return so();
  }
  static Result<void> watch(LineGuard& guard, const StandInPort& port) {
    return guard.watch(port, 0x02, drivers::haptic_pen::falcon::zero_packet());
  }

  fs::path folder_;
  StandInPort port_;
};

TEST_F(UsbGuard, sends_the_devices_own_zero_when_the_loop_is_silent) {
  LineGuard guard = LineGuard::start(folder_).value();
  ASSERT_TRUE(watch(guard, port_));
  // Nobody beats.
  ASSERT_TRUE(wait_until([] { return bulk_seen->count > 20; }));
  EXPECT_TRUE(guard.page().is_tripped());
  EXPECT_EQ(bulk_seen->endpoint, 0x02u);
  EXPECT_EQ(bulk_seen->length, 16u);
  EXPECT_GT(bulk_seen->timeout_ms, 0u);
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(bulk_seen->bytes.data()), 16), "<AAAAAAAAAAAABA>");
  // The I/O thread can't send, and can again once the loop has no force left.
  const drivers::port::UsbGate gate = usb_gate(guard.page());
  EXPECT_FALSE(gate.begin());
  guard.page().acknowledge();
  ASSERT_TRUE(gate.begin());
  gate.end();
}

TEST_F(UsbGuard, ends_with_zeros_and_bears_a_device_that_takes_nothing) {
  bulk_seen->error = ETIMEDOUT;
  {
    LineGuard guard = LineGuard::start(folder_).value();
    ASSERT_TRUE(watch(guard, port_));
    ASSERT_TRUE(wait_until([] { return bulk_seen->count > 3; }));
    EXPECT_EQ(guard.page().holds_line, 1u);
    bulk_seen->error = 0;
    ASSERT_TRUE(wait_until([&] { return guard.page().zeros > 3; }));
    bulk_seen->count = 0;
  }
  EXPECT_GE(bulk_seen->count, 5u);
}

TEST_F(UsbGuard, gives_up_a_device_that_was_unplugged) {
  LineGuard guard = LineGuard::start(folder_).value();
  bulk_seen->error = ENODEV;
  ASSERT_TRUE(watch(guard, port_));
  ASSERT_TRUE(wait_until([&] { return bulk_seen->count > 0 && guard.page().holds_line == 0; }));
}

TEST_F(UsbGuard, keeps_the_device_at_zero_when_its_process_was_killed) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    Result<LineGuard> guard = LineGuard::start(folder_);
    if (guard && watch(*guard, port_)) ::kill(::getpid(), SIGKILL);
    ::_exit(1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  ASSERT_TRUE(wait_until([] { return bulk_seen->count > 50; }));
  // The next process's guard ends it, before the device is opened anew.
  LineGuard next = LineGuard::start(folder_).value();
  const std::uint64_t ended_with = bulk_seen->count;
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  EXPECT_EQ(bulk_seen->count, ended_with);
}

}  // namespace
}  // namespace prismesh::deviced::pen
