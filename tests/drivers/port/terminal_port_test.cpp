#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <iterator>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/port/open_error.h"
#include "drivers/port/open_port.h"
#include "drivers/port/pty_pair.h"
#include "tests/drivers/port/allocations.h"
#include "tests/drivers/port/bytes.h"

namespace prismesh::drivers::port {
namespace {

using testing::HasSubstr;

constexpr char kEveryByte[] =
    "\x03\x04\x11\x13\x1a\x1c\x7f\r\n\xff\xff plain";  // includes the bytes that a terminal in cooked mode interprets

PtyPair pair() {
  Result<PtyPair> opened = open_pty_pair();
  EXPECT_TRUE(opened) << opened.error().text();
  return std::move(*opened);
}

TEST(TerminalPort, transfers_every_byte_both_ways_without_echo) {
  const PtyPair pty = pair();
  ASSERT_TRUE(is_pseudo_terminal(pty.slave_path));
  const auto port = open_port(pty.slave_path, 19200);
  ASSERT_TRUE(port) << port.error().text();
  const std::string text(kEveryByte, sizeof kEveryByte);  // with its NUL
  (*port)->write(bytes_of(text));
  EXPECT_EQ(read_soon(*pty.master, text.size()), text);
  pty.master->write(bytes_of(text));
  EXPECT_EQ(read_soon(**port, text.size()), text);
  EXPECT_EQ(read_text(*pty.master), "") << "an echo";
  EXPECT_TRUE((*port)->set_baud(1'000'000));
}

TEST(TerminalPort, reads_nothing_without_input) {
  const PtyPair pty = pair();
  const auto port = *open_terminal_port(pty.slave_path);
  std::array<std::byte, 8> buffer{};
  const PortCount got = port->read(buffer);
  EXPECT_EQ(got.bytes, 0u);
  EXPECT_EQ(got.status, PortStatus::ok);
}

/// The driver's end of a pseudo-terminal, in addition to other openers.
class DriversEnd {
 public:
  explicit DriversEnd(const std::string& path) : descriptor_(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {}
  ~DriversEnd() { ::close(descriptor_); }
  DriversEnd(const DriversEnd&) = delete;
  DriversEnd& operator=(const DriversEnd&) = delete;

  /// Number of bytes that the kernel has delivered and nobody has read.
  int waiting() const {
    int bytes = 0;
    return ::ioctl(descriptor_, FIONREAD, &bytes) == 0 ? bytes : -1;
  }
  void send(std::string_view text) const { EXPECT_EQ(::write(descriptor_, text.data(), text.size()), std::ssize(text)); }

 private:
  int descriptor_;
};

TEST(TerminalPort, discards_queued_input_on_opening_and_on_request) {
  const PtyPair pty = pair();
  pty.master->write(bytes_of("said before anyone listened"));
  const auto port = *open_terminal_port(pty.slave_path);
  pty.master->write(bytes_of("new"));
  EXPECT_EQ(read_soon(*port, 3), "new");
  pty.master->write(bytes_of("old"));
  const DriversEnd line(pty.slave_path);
  ASSERT_TRUE(eventually([&] { return line.waiting() == 3; }));
  port->discard_input();
  pty.master->write(bytes_of("newer"));
  EXPECT_EQ(read_soon(*port, 5), "newer");
}

TEST(TerminalPort, does_not_echo_the_simulators_earlier_output) {
  const PtyPair pty = pair();
  pty.master->write(bytes_of("records\r\n"));
  const DriversEnd line(pty.slave_path);
  ASSERT_TRUE(eventually([&] { return line.waiting() == 9; }));
  line.send(".");
  EXPECT_EQ(read_soon(*pty.master, 1), ".") << "the first byte that it receives";
}

TEST(TerminalPort, a_vanished_device_is_gone_for_reads_and_writes) {
  for (const bool by_reading : {true, false}) {
    PtyPair pty = pair();
    const auto port = *open_terminal_port(pty.slave_path);
    pty.master.reset();
    std::array<std::byte, 8> buffer{};
    const PortCount count = by_reading ? port->read(buffer) : port->write(buffer);
    EXPECT_EQ(count.status, PortStatus::gone);
    EXPECT_EQ(count.bytes, 0u);
    EXPECT_EQ(port->last_error(), by_reading ? 0 : EIO) << "a read sees the end, a write the error";
    EXPECT_EQ(port->read(buffer).status, PortStatus::gone) << "and stays so";
  }
}

TEST(TerminalPort, the_master_survives_its_slaves) {
  const PtyPair pty = pair();
  std::array<std::byte, 8> buffer{};
  for (int i = 0; i < 3; ++i) {
    const auto port = open_terminal_port(pty.slave_path);
    ASSERT_TRUE(port) << port.error().text();
    (*port)->write(bytes_of("hello"));
    EXPECT_EQ(read_soon(*pty.master, 5), "hello");
    pty.master->write(bytes_of("left unread"));
  }
  EXPECT_EQ(pty.master->read(buffer).status, PortStatus::ok);
}

TEST(TerminalPort, a_full_line_accepts_a_part_and_reports_full) {
  const PtyPair pty = pair();
  const auto port = *open_terminal_port(pty.slave_path);
  const std::string much(1 << 20, 'x');
  const PortCount put = port->write(bytes_of(much));
  EXPECT_EQ(put.status, PortStatus::full);
  EXPECT_GT(put.bytes, 0u);
  EXPECT_LT(put.bytes, much.size());
}

TEST(TerminalPort, refuses_a_second_opener_and_names_the_first) {
  const PtyPair pty = pair();
  auto first = open_terminal_port(pty.slave_path);
  const auto second = open_port(pty.slave_path, 9600);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().file, pty.slave_path);
  EXPECT_THAT(second.error().message, HasSubstr("another program has it open: "));
  EXPECT_THAT(second.error().message, HasSubstr("(process " + std::to_string(::getpid()) + ")"));
  first->reset();
  EXPECT_TRUE(open_port(pty.slave_path, 9600)) << "closing sets it free";
}

TEST(TerminalPort, reading_and_writing_allocate_nothing) {
  const PtyPair pty = pair();
  const auto port = *open_terminal_port(pty.slave_path);
  std::array<std::byte, 64> buffer{};
  const std::uint64_t before = allocations_of_this_thread();
  for (int i = 0; i < 100; ++i) {
    port->write(buffer);
    pty.master->read(buffer);
    pty.master->write(buffer);
    port->read(buffer);
  }
  EXPECT_EQ(allocations_of_this_thread(), before);
}

TEST(OpenPort, a_missing_device_is_reported) {
  const auto port = open_port("/dev/serial/by-id/usb-Nobody-if00-port0", 9600);
  ASSERT_FALSE(port);
  EXPECT_EQ(port.error().file, "/dev/serial/by-id/usb-Nobody-if00-port0");
  EXPECT_THAT(port.error().message, HasSubstr("is it plugged in and switched on? "));
  EXPECT_THAT(port.error().message,
              testing::AnyOf(HasSubstr("plugged in now: /dev/serial/by-id/"), HasSubstr("no serial device is plugged in")));
}

TEST(OpenPort, reports_what_is_no_serial_line) {
  for (const char* path : {"/dev/null", "/etc/passwd", "/tmp"}) {
    const auto port = open_port(path, 9600);
    ASSERT_FALSE(port) << path;
    EXPECT_THAT(port.error().message, HasSubstr("is no serial line; give the device's own file")) << path;
  }
  EXPECT_FALSE(is_pseudo_terminal("/dev/null"));
  EXPECT_FALSE(is_pseudo_terminal("/dev/pts"));
}

TEST(OpenPort, tells_a_units_limits_from_a_files_rights) {
  EXPECT_THAT(open_error("/dev/ttyUSB0", EPERM).text(), HasSubstr("/dev/ttyUSB0: systemd keeps this device from the program's unit"));
  EXPECT_THAT(open_error("/dev/ttyUSB0", EACCES).text(), HasSubstr("/dev/ttyUSB0: this user may not open it"));
}

TEST(OpenPort, without_permission_says_how_to_get_it) {
  const PtyPair pty = pair();
  std::filesystem::permissions(pty.slave_path, std::filesystem::perms::none);
  if (::getuid() == 0) {
    // The superuser has all permissions, so a child process tries as nobody.
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      if (::setgid(65534) != 0 || ::setuid(65534) != 0) ::_exit(2);
      const auto refused = open_port(pty.slave_path, 9600);
      const bool refused_correctly =
          !refused && refused.error().message.find("this user may not open it: install systemd/udev/60-prismesh.rules") == 0 &&
          refused.error().message.find("(sudo usermod -aG ") != std::string::npos;
      ::_exit(refused_correctly ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
  } else {
    const auto refused = open_port(pty.slave_path, 9600);
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, HasSubstr("this user may not open it: install systemd/udev/60-prismesh.rules"));
  }
}

}  // namespace
}  // namespace prismesh::drivers::port
