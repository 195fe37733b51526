// A daemon of its own protocol, as small as one can be: who may ask it for what.
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/common/service.h"
#include "ipc/wire/json_message.h"
#include "ipc/wire/line_socket.h"

namespace prismesh::daemon {

struct Greeting {
  int protocol = 1;
  std::string program;
};
struct Ask {};
struct Turn {
  int by = 0;
};
struct Reply {
  int value = 0;
};
struct Turned {
  int value = 0;
};

ipc::Role role_for(const std::variant<Greeting, Ask, Turn>& request) {
  return std::holds_alternative<Turn>(request) ? ipc::Role::edit : ipc::Role::watch;
}

struct DialProtocol {
  using Hello = Greeting;
  using Request = std::variant<Greeting, Ask, Turn>;
  using Answer = std::variant<ipc::Failed, ipc::Done, Reply>;
  using Event = std::variant<Turned>;
  static constexpr int kVersion = 1;
  static tl::expected<ipc::Numbered<Request>, ipc::BadRequest> decode(std::string_view line);
  static std::string encode_answer(std::uint64_t to, const Answer& answer, std::size_t descriptors);
  static std::string encode_event(const Event& event);
  static bool must_be_told(const Answer&) { return false; }
};

}  // namespace prismesh::daemon

namespace prismesh::json {
PRISMESH_MESSAGE(daemon::Greeting, "hello", f("protocol", m.protocol), f("program", m.program));
PRISMESH_MESSAGE(daemon::Ask, "ask", );
PRISMESH_MESSAGE(daemon::Turn, "turn", f("by", m.by));
PRISMESH_MESSAGE(daemon::Reply, "reply", f("value", m.value));
PRISMESH_MESSAGE(daemon::Turned, "turned", f("value", m.value));
}  // namespace prismesh::json

namespace prismesh::daemon {

tl::expected<ipc::Numbered<DialProtocol::Request>, ipc::BadRequest> DialProtocol::decode(std::string_view line) {
  return ipc::json_message::decode_request<Request>(line);
}
std::string DialProtocol::encode_answer(std::uint64_t to, const Answer& answer, std::size_t descriptors) {
  return ipc::json_message::encode_answer(to, answer, descriptors);
}
std::string DialProtocol::encode_event(const Event& event) { return ipc::json_message::encode_event(event); }

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A daemon that keeps a number.
class Dial final : public Service<DialProtocol> {
 public:
  int value = 0;
  std::atomic<int> gone = 0;

 private:
  Result<Welcomed> welcome(ipc::ClientId) override { return Welcomed{ipc::Done{}, {}}; }
  void request(ipc::ClientId client, std::uint64_t number, Request request, std::size_t) override {
    if (const auto* turn = std::get_if<Turn>(&request)) {
      value += turn->by;
      tell_all(Turned{value});
    }
    answer(client, number, Reply{value});
  }
  void left(ipc::ClientId) override { ++gone; }
};

constexpr uid_t kNobody = 65534;

class ServiceTest : public ::testing::Test {
 protected:
  ServiceTest() {
    std::string name = (fs::temp_directory_path() / "prismesh-service-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    ::chmod(folder_.c_str(), 0755);
  }
  ~ServiceTest() override {
    if (thread_.joinable()) {
      dial_.stop();
      thread_.join();
    }
    ::unsetenv("PRISMESH_ROLES");
    std::error_code problem;
    fs::remove_all(folder_, problem);
  }

  void give(const std::string& table) {
    std::ofstream(folder_ / "roles.toml") << table;
    ::chmod((folder_ / "roles.toml").c_str(), 0644);
    ::setenv("PRISMESH_ROLES", (folder_ / "roles.toml").c_str(), 1);
  }
  void start() {
    const Result<void> listening = dial_.listen(socket());
    ASSERT_TRUE(listening) << listening.error().text();
    thread_ = std::thread([this] { dial_.run("turns"); });
  }
  fs::path socket() const { return folder_ / "run" / "dial.sock"; }

  /// Says the lines as the user, and returns all that is answered until nothing comes for a while.
  std::string said_to(uid_t user, const std::string& lines, int patience_ms = 150) {
    int ends[2];
    EXPECT_EQ(::pipe(ends), 0);
    const pid_t child = ::fork();
    if (child == 0) {
      if (user != ::geteuid() && ::setresuid(user, user, user) != 0) ::_exit(2);
      const int connection = ::socket(AF_UNIX, SOCK_STREAM, 0);
      sockaddr_un address{};
      address.sun_family = AF_UNIX;
      std::strcpy(address.sun_path, socket().c_str());
      if (::connect(connection, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
        (void)!::write(ends[1], "can't connect", 13);
        ::_exit(1);
      }
      (void)!::write(connection, lines.data(), lines.size());
      pollfd ready{connection, POLLIN, 0};
      char bytes[4096];
      while (::poll(&ready, 1, patience_ms) > 0) {
        const ssize_t count = ::read(connection, bytes, sizeof bytes);
        if (count <= 0) break;
        (void)!::write(ends[1], bytes, static_cast<std::size_t>(count));
      }
      ::_exit(0);
    }
    ::close(ends[1]);
    std::string all;
    char bytes[4096];
    for (ssize_t count = 0; (count = ::read(ends[0], bytes, sizeof bytes)) > 0;) all.append(bytes, static_cast<std::size_t>(count));
    ::close(ends[0]);
    ::waitpid(child, nullptr, 0);
    return all;
  }

  static constexpr const char* kHello = "{\"request\":\"hello\",\"number\":1,\"protocol\":1,\"program\":\"test\"}\n";
  static constexpr const char* kAsk = "{\"request\":\"ask\",\"number\":2}\n";
  static constexpr const char* kTurn = "{\"request\":\"turn\",\"number\":3,\"by\":5}\n";

  fs::path folder_;
  Dial dial_;
  std::thread thread_;
};

TEST_F(ServiceTest, does_what_its_own_user_asks_for_and_tells_everybody) {
  start();
  const std::string said = said_to(::geteuid(), std::string(kHello) + kAsk + kTurn);
  EXPECT_THAT(said, HasSubstr(R"({"answer":"done","to":1})"));
  EXPECT_THAT(said, HasSubstr(R"("value":0)"));
  EXPECT_THAT(said, HasSubstr(R"({"event":"turned","value":5})"));
  for (int i = 0; i < 500 && dial_.gone == 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  dial_.stop();
  thread_.join();
  EXPECT_EQ(dial_.value, 5);
  EXPECT_EQ(dial_.gone, 1);
}

TEST_F(ServiceTest, demands_a_hello_of_its_version_first) {
  start();
  EXPECT_THAT(said_to(::geteuid(), kAsk), HasSubstr("the first message must be a hello"));
  EXPECT_THAT(said_to(::geteuid(), "{\"request\":\"hello\",\"number\":1,\"protocol\":9,\"program\":\"test\"}\n"), HasSubstr("protocol"));
  EXPECT_THAT(said_to(::geteuid(), std::string(kHello) + "{\"request\":\"tun\",\"number\":4}\n"), HasSubstr(R"(the nearest is \"turn\")"));
}

TEST_F(ServiceTest, lets_nobody_else_connect_without_a_role) {
  if (::geteuid() != 0) GTEST_SKIP() << "SKIPPED ALOUD: playing another user needs root";
  start();
  EXPECT_EQ(said_to(kNobody, kHello), "can't connect");
}

TEST_F(ServiceTest, lets_a_watcher_look_and_refuses_it_the_rest) {
  if (::geteuid() != 0) GTEST_SKIP() << "SKIPPED ALOUD: playing another user needs root";
  give("[users]\n65534 = [\"watch\"]\n1 = [\"edit\"]\n2 = [\"offer\"]\n");
  start();
  const std::string said = said_to(kNobody, std::string(kHello) + kAsk + kTurn);
  EXPECT_THAT(said, HasSubstr(R"({"answer":"reply","to":2,"value":0})"));
  EXPECT_THAT(said, HasSubstr("this needs the role edit; your user has: watch"));
  EXPECT_THAT(said_to(1, std::string(kHello) + kTurn), HasSubstr(R"("value":5)"));
  EXPECT_THAT(said_to(2, kHello), HasSubstr("needs the role watch"));
  EXPECT_EQ(said_to(3, kHello), "") << "a user without a role is cut off before it has said anything";
}

TEST_F(ServiceTest, does_not_start_with_a_table_that_cannot_be_trusted) {
  give("[users]\n65534 = [\"wach\"]\n");
  Result<void> listening = dial_.listen(socket());
  ASSERT_FALSE(listening);
  EXPECT_THAT(listening.error().text(), HasSubstr("roles.toml:2"));
  EXPECT_THAT(listening.error().text(), HasSubstr(R"(the nearest is "watch")"));
  give("[users]\n");
  ::chmod((folder_ / "roles.toml").c_str(), 0666);
  listening = dial_.listen(socket());
  ASSERT_FALSE(listening);
  EXPECT_THAT(listening.error().text(), HasSubstr("others may write to it"));
}

/// Reads the datagrams that come to a socket as systemd's would.
class Notified {
 public:
  explicit Notified(const fs::path& path) : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strcpy(address.sun_path, path.c_str());
    EXPECT_EQ(::bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
  }
  ~Notified() {
    ::close(socket_);
    ::unsetenv("NOTIFY_SOCKET");
  }
  std::string next() const {
    pollfd ready{socket_, POLLIN, 0};
    char bytes[1024];
    if (::poll(&ready, 1, 5000) <= 0) return "nothing";
    const ssize_t count = ::read(socket_, bytes, sizeof bytes);
    return std::string(bytes, static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  }

 private:
  int socket_;
};

TEST_F(ServiceTest, tells_systemd_that_it_is_ready_alive_and_ending) {
  const Notified notified(folder_ / "notify");
  ::setenv("WATCHDOG_USEC", "20000", 1);
  ::setenv("WATCHDOG_PID", std::to_string(::getpid()).c_str(), 1);
  start();
  EXPECT_EQ(notified.next(), "READY=1\nSTATUS=turns");
  EXPECT_EQ(notified.next(), "WATCHDOG=1");
  EXPECT_EQ(notified.next(), "WATCHDOG=1");
  dial_.stop();
  thread_.join();
  std::string last;
  while ((last = notified.next()) == "WATCHDOG=1") {
  }
  EXPECT_EQ(last, "STOPPING=1");
  ::unsetenv("WATCHDOG_USEC");
  ::unsetenv("WATCHDOG_PID");
}

TEST_F(ServiceTest, serves_the_socket_that_systemd_made_and_leaves_it_there) {
  // systemd puts the socket at descriptor 3, which a test program may use otherwise: so a child plays the daemon.
  fs::create_directories(folder_ / "run");
  const int listening = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strcpy(address.sun_path, socket().c_str());
  ASSERT_EQ(::bind(listening, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(::listen(listening, 4), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(listening, 3);
    ::setenv("LISTEN_FDS", "1", 1);
    ::setenv("LISTEN_PID", std::to_string(::getpid()).c_str(), 1);
    Dial dial;
    if (!dial.listen(socket())) ::_exit(1);
    dial.run("turns");
    ::_exit(0);
  }
  EXPECT_THAT(said_to(::geteuid(), std::string(kHello) + kTurn, 2000), HasSubstr(R"("value":5)"));
  ::kill(child, SIGTERM);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_TRUE(fs::exists(socket())) << "the next daemon finds it";
  EXPECT_FALSE(fs::exists(folder_ / "run" / "dial.sock.lock")) << "systemd starts one daemon only";
  ::close(listening);
}

}  // namespace
}  // namespace prismesh::daemon
