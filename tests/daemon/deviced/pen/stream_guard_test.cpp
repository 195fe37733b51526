// The guard of a connection to a service: it sends the service's own zero, and ends the connection some time after the pen's process.
#include <poll.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <gtest/gtest.h>

#include "daemon/deviced/pen/line_guard.h"

namespace prismesh::deviced::pen {
namespace {

namespace fs = std::filesystem;

class StreamGuard : public ::testing::Test {
 protected:
  StreamGuard() {
    std::string name = (fs::temp_directory_path() / "prismesh-stream-guard-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends_.data()), 0);
  }
  ~StreamGuard() override {
    for (const int end : ends_)
      if (end >= 0) ::close(end);
    fs::remove_all(folder_);
  }
  /// What has come by then; "" at the connection's end, and after a long time.
  std::string heard() {
    pollfd waits{ends_[1], POLLIN, 0};
    std::array<char, 4096> bytes{};
    if (::poll(&waits, 1, 20'000) != 1) return "nothing";
    const ssize_t got = ::recv(ends_[1], bytes.data(), bytes.size(), 0);
    return got > 0 ? std::string(bytes.data(), static_cast<std::size_t>(got)) : std::string();
  }
  Result<void> watch(LineGuard& guard) const { return guard.watch(ends_[0], std::as_bytes(std::span(kZero))); }

  static constexpr std::string_view kZero = "{\"zero\"}";
  fs::path folder_;
  std::array<int, 2> ends_{-1, -1};
};

TEST_F(StreamGuard, sends_the_services_own_zero_when_the_loop_is_silent) {
  LineGuard guard = LineGuard::start(folder_).value();
  ASSERT_TRUE(watch(guard));
  // Nobody beats.
  const std::string text = heard();
  EXPECT_EQ(text.substr(0, kZero.size()), kZero);
  EXPECT_TRUE(guard.page().is_tripped());
  EXPECT_EQ(guard.page().trips.load(), 1u);
}

TEST_F(StreamGuard, takes_no_zero_that_is_too_long) {
  LineGuard guard = LineGuard::start(folder_).value();
  const std::array<std::byte, 161> longer{};
  EXPECT_FALSE(guard.watch(ends_[0], longer));
  EXPECT_FALSE(guard.watch(-1, std::as_bytes(std::span(kZero))));
}

TEST_F(StreamGuard, ends_the_connection_after_a_process_that_was_killed) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(ends_[1]);
    Result<LineGuard> guard = LineGuard::start(folder_);
    if (guard && watch(*guard)) ::kill(::getpid(), SIGKILL);
    ::_exit(1);
  }
  ::close(std::exchange(ends_[0], -1));
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  std::string all;
  for (std::string text = heard(); !text.empty(); text = heard()) {
    ASSERT_NE(text, "nothing");
    all += text;
  }
  ASSERT_GE(all.size(), kZero.size());
  EXPECT_EQ(all.substr(all.size() - kZero.size()), kZero);
}

}  // namespace
}  // namespace prismesh::deviced::pen
