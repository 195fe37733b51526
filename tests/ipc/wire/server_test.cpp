#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include "ipc/wire/line_socket.h"
#include "ipc/wire/runtime_directory.h"
#include "ipc/wire/server.h"
#include "tests/support/few_descriptors.h"

namespace prismesh::ipc {
namespace {

namespace fs = std::filesystem;

class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "prismesh-ipc-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~Folder() {
    std::error_code problem;
    fs::remove_all(path_, problem);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Sets an environment variable until the end of the scope; null: unsets it.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    set(value);
  }
  ~Variable() { set(before_ ? before_->c_str() : nullptr); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  void set(const char* value) { value != nullptr ? ::setenv(name_, value, 1) : ::unsetenv(name_); }

  const char* name_;
  std::optional<std::string> before_;
};

/// Answers "big N" with N bytes, "hello" with a welcome or a refusal, everything else with itself, and remembers who left and why.
class Echo final : public ServerHandler {
 public:
  void connected(ClientId) override {}
  void line(ClientId client, std::string_view line) override {
    if (line.starts_with("big "))
      server->send(client, std::string(std::stoul(std::string(line.substr(4))), 'x'));
    else if (line == "hello")
      greet(client);
    else if (line == "memory")
      server->send(client, "memory", one_descriptor());
    else
      server->send(client, std::string(line));
  }
  void disconnected(ClientId client, const std::string& why) override {
    const std::lock_guard lock(mutex_);
    left_.push_back(why);
    who_left_.push_back(client);
    changed_.notify_all();
  }
  std::string wait_for_leaving() {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::seconds(20), [&] { return !left_.empty(); });
    return left_.empty() ? "nobody left" : left_.front();
  }
  /// Once so many have left: the clients, by the order in which they left.
  std::vector<ClientId> wait_for_all_to_leave(std::size_t count) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::seconds(20), [&] { return who_left_.size() >= count; });
    return who_left_;
  }
  Server* server = nullptr;

 private:
  void greet(ClientId client) {
    const std::optional<std::string> refusal = server->refusal(client);
    if (!refusal) server->welcome(client);
    server->send(client, refusal.value_or("welcome"));
    if (refusal) server->cut(client, "refused");
  }
  static std::vector<Descriptor> one_descriptor() {
    std::vector<Descriptor> descriptors;
    descriptors.push_back(make_sealed_memory("test", std::as_bytes(std::span("hello"))).value());
    return descriptors;
  }
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> left_;
  std::vector<ClientId> who_left_;
};

class Running {
 public:
  explicit Running(const fs::path& socket, const ServerLimits& limits = {}) : server_(Server::listen(socket, echo_, limits).value()) {
    echo_.server = &server_;
    thread_ = std::thread([this] { server_.run(); });
  }
  ~Running() {
    server_.stop();
    thread_.join();
  }
  Echo& echo() { return echo_; }

 private:
  Echo echo_;
  Server server_;
  std::thread thread_;
};

/// Waits for a line; "closed: ..." when there is none any more.
std::string next_line(LineSocket& socket) {
  for (;;) {
    if (const auto line = socket.next_line()) return std::string(*line);
    pollfd ready{socket.descriptor(), POLLIN, 0};
    if (::poll(&ready, 1, 20'000) <= 0) return "nothing came";
    if (const Result<bool> received = socket.receive(); !received) return "closed: " + received.error().message;
  }
}

void say(LineSocket& socket, std::string line) {
  socket.queue(std::move(line));
  while (true) {
    const Result<bool> flushed = socket.flush();
    if (!flushed || *flushed) return;
    pollfd ready{socket.descriptor(), POLLOUT, 0};
    if (::poll(&ready, 1, 20'000) <= 0) return;
  }
}

TEST(Server, carries_lines_and_descriptors) {
  const Folder folder;
  Running running(folder.path() / "s");
  LineSocket socket(connect_to(folder.path() / "s").value(), {});
  say(socket, "one\nmemory\nthree");
  EXPECT_EQ(next_line(socket), "one");
  EXPECT_EQ(next_line(socket), "memory");
  const auto descriptors = socket.take_descriptors(1);
  ASSERT_TRUE(descriptors);
  EXPECT_EQ(std::memcmp(Mapping::map(descriptors->front(), false)->bytes().data(), "hello", 5), 0);
  EXPECT_EQ(next_line(socket), "three");
  EXPECT_FALSE(socket.take_descriptors(1)) << "there was one only";
}

TEST(Server, long_lines_go_through_whole) {
  const Folder folder;
  Running running(folder.path() / "s");
  LineSocket socket(connect_to(folder.path() / "s").value(), {});
  const std::string line(5'000'000, 'y');
  say(socket, line);
  EXPECT_EQ(next_line(socket), line);
}

TEST(Server, an_oversized_line_is_cut_off) {
  const Folder folder;
  ServerLimits limits;
  limits.line_bytes = 100'000;
  Running running(folder.path() / "s", limits);
  LineSocket fine(connect_to(folder.path() / "s").value(), {});
  LineSocket socket(connect_to(folder.path() / "s").value(), {});
  say(socket, std::string(300'000, 'y'));
  EXPECT_EQ(next_line(socket).substr(0, 6), "closed");
  EXPECT_EQ(running.echo().wait_for_leaving(), "a line is longer than 100000 bytes");
  say(fine, "others go on");
  EXPECT_EQ(next_line(fine), "others go on");
}

TEST(Server, a_client_that_takes_nothing_is_cut_off) {
  const Folder folder;
  ServerLimits limits;
  limits.stall = std::chrono::milliseconds(200);
  Running running(folder.path() / "s", limits);
  LineSocket socket(connect_to(folder.path() / "s").value(), {});
  say(socket, "big 4000000");
  EXPECT_EQ(running.echo().wait_for_leaving(), "it took nothing for 200 ms");
}

/// How many lines of so many bytes a socket holds that nobody reads.
std::size_t lines_held(std::size_t line_bytes) {
  int ends[2];
  EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends), 0);
  const Descriptor from(ends[0]), to(ends[1]);
  const std::string line(line_bytes, 'x');
  std::size_t count = 0;
  while (::send(from.get(), line.data(), line.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(line.size())) ++count;
  return count;
}

/// Until so many bytes have come that nobody has read.
bool wait_for_bytes(const LineSocket& socket, std::size_t bytes) {
  for (int tries = 0; tries < 20'000; ++tries, std::this_thread::sleep_for(std::chrono::milliseconds(1))) {
    int there = 0;
    if (::ioctl(socket.descriptor(), FIONREAD, &there) == 0 && static_cast<std::size_t>(there) >= bytes) return true;
  }
  return false;
}

TEST(Server, a_client_that_was_idle_has_its_whole_time_to_take_what_comes_next) {
  const Folder folder;
  ServerLimits limits;
  limits.stall = std::chrono::milliseconds(400);
  Running running(folder.path() / "s", limits);
  LineSocket first(connect_to(folder.path() / "s").value(), {}), second(connect_to(folder.path() / "s").value(), {});
  LineSocket idle(connect_to(folder.path() / "s").value(), {});
  // The data fills its socket completely, and no more data waits to be sent.
  const std::size_t held = lines_held(1001);
  for (std::size_t i = 0; i < held; ++i) say(idle, "big 1000");
  ASSERT_TRUE(wait_for_bytes(idle, held * 1001));
  // So long that a client that takes nothing is cut off.
  say(first, "big 4000000");
  EXPECT_EQ(running.echo().wait_for_leaving(), "it took nothing for 400 ms");
  say(second, "big 4000000");
  ASSERT_TRUE(wait_for_bytes(second, 1));
  say(idle, "big 1000");
  EXPECT_THAT(running.echo().wait_for_all_to_leave(3), testing::ElementsAre(1, 2, 3)) << "the idle one began to wait last";
}

TEST(Server, a_client_that_asks_for_more_than_it_takes_is_cut_off) {
  const Folder folder;
  ServerLimits limits;
  limits.queue_bytes = 10'000'000;
  Running running(folder.path() / "s", limits);
  LineSocket socket(connect_to(folder.path() / "s").value(), {});
  for (int i = 0; i < 5; ++i) say(socket, "big 4000000");
  EXPECT_EQ(running.echo().wait_for_leaving(), "it reads too slowly");
}

TEST(Server, descriptors_that_nobody_asked_for_cut_the_sender_off) {
  const Folder folder;
  Running running(folder.path() / "s");
  LineSocket socket(connect_to(folder.path() / "s").value(), {});
  std::vector<Descriptor> descriptors;
  descriptors.push_back(make_shared_memory("test", 1).value());
  socket.queue("take this", std::move(descriptors));
  ASSERT_TRUE(socket.flush());
  EXPECT_EQ(running.echo().wait_for_leaving(), "descriptors came that nobody asked for");
}

TEST(LineSocketTest, takes_no_more_descriptors_than_its_limit) {
  int ends[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), 0);
  LineSocket sender(Descriptor{ends[0]}, {});
  LineLimits limits;
  limits.descriptors = 3;
  LineSocket receiver(Descriptor{ends[1]}, limits);
  const auto send = [&](std::size_t count) {
    std::vector<Descriptor> descriptors;
    for (std::size_t i = 0; i < count; ++i) descriptors.push_back(make_shared_memory("test", 1).value());
    sender.queue("some", std::move(descriptors));
    ASSERT_TRUE(sender.flush());
  };
  send(3);
  ASSERT_TRUE(receiver.receive());
  ASSERT_TRUE(receiver.next_line());
  ASSERT_TRUE(receiver.take_descriptors(2));
  send(2);
  ASSERT_TRUE(receiver.receive()) << "those that were taken make room";
  send(1);
  const Result<bool> received = receiver.receive();
  ASSERT_FALSE(received);
  EXPECT_EQ(received.error().message, "too many descriptors came");
}

TEST(LineSocketTest, descriptors_go_once_with_a_line_of_many_parts) {
  int ends[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), 0);
  LineSocket sender(Descriptor{ends[0]}, {}), receiver(Descriptor{ends[1]}, {});
  std::vector<Descriptor> descriptors;
  descriptors.push_back(make_shared_memory("test", 1).value());
  descriptors.push_back(make_shared_memory("test", 1).value());
  sender.queue(std::string(2'000'000, 'y'), std::move(descriptors));
  int parts = 0;
  for (Result<bool> whole = false; !*whole; ++parts) {
    whole = sender.flush();
    ASSERT_TRUE(whole);
    const Result<bool> received = receiver.receive();
    ASSERT_TRUE(received) << received.error().message;
  }
  EXPECT_GT(parts, 2) << "the line went at once";
  while (receiver.receive().value()) {
  }
  const auto line = receiver.next_line();
  ASSERT_TRUE(line);
  EXPECT_EQ(line->size(), 2'000'000u);
  EXPECT_TRUE(receiver.take_descriptors(2));
  EXPECT_FALSE(receiver.take_descriptors(1)) << "there were two only";
}

TEST(Server, a_live_one_is_named_and_a_stale_socket_replaced) {
  const Folder folder;
  Echo echo;
  {
    Running running(folder.path() / "s");
    const Result<Server> second = Server::listen(folder.path() / "s", echo);
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().message.find("already runs here (process " + std::to_string(::getpid())), std::string::npos)
        << second.error().message;
    Running beside(folder.path() / "other/s");
    LineSocket socket(connect_to(folder.path() / "other/s").value(), {});
    say(socket, "two stations");
    EXPECT_EQ(next_line(socket), "two stations");
  }
  std::ofstream(folder.path() / "s") << "left by a daemon that was killed";
  Running again(folder.path() / "s");
  EXPECT_TRUE(connect_to(folder.path() / "s"));
}

TEST(Server, the_folder_must_be_private) {
  const Folder folder;
  Echo echo;
  for (const mode_t mode : {0777U, 0770U, 0720U, 0702U}) {
    ASSERT_EQ(::chmod(folder.path().c_str(), mode), 0);
    const Result<Server> server = Server::listen(folder.path() / "s", echo);
    ASSERT_FALSE(server) << std::oct << mode;
    EXPECT_NE(server.error().message.find("others may write to it"), std::string::npos);
  }
  ASSERT_EQ(::chmod(folder.path().c_str(), 0700), 0);
  fs::create_directory(folder.path() / "mine");
  ::chmod((folder.path() / "mine").c_str(), 0700);
  const Running running(folder.path() / "mine/run/s");
  struct stat status {};
  ASSERT_EQ(::stat((folder.path() / "mine/run").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0700u);
}

TEST(Server, a_folder_that_others_may_look_into_is_made_private) {
  const Folder folder;
  const fs::path run = folder.path() / "run";
  fs::create_directory(run);
  ASSERT_EQ(::chmod(run.c_str(), 0755), 0);
  ASSERT_TRUE(make_private_folder(run));
  struct stat status {};
  ASSERT_EQ(::stat(run.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0700u);
}

TEST(Server, another_users_folder_is_not_private) {
  if (::geteuid() != 0) GTEST_SKIP() << "SKIPPED ALOUD: a folder of another user needs root";
  const Folder folder;
  const fs::path theirs = folder.path() / "theirs";
  fs::create_directory(theirs);
  ASSERT_EQ(::chmod(theirs.c_str(), 0700), 0);
  ASSERT_EQ(::chown(theirs.c_str(), 65534, 65534), 0);
  const Result<void> made = make_private_folder(theirs);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message.find("another user"), std::string::npos) << made.error().message;
}

TEST(Server, a_link_is_no_private_folder_whatever_its_slashes) {
  const Folder folder;
  fs::create_directory(folder.path() / "real");
  ::chmod((folder.path() / "real").c_str(), 0700);
  fs::create_directory_symlink(folder.path() / "real", folder.path() / "link");
  for (const char* name : {"link", "link/", "link//"}) {
    const Result<void> made = make_private_folder(folder.path() / name);
    ASSERT_FALSE(made) << name;
    EXPECT_EQ(made.error().message, "is no folder");
  }
}

TEST(Server, the_holders_number_is_not_needed_for_the_lock) {
  const Folder folder;
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit none{0, before.rlim_max};  // as on a full disk
  const auto old = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &none), 0);
  const Result<Descriptor> lock = lock_folder(folder.path(), "lock", "a daemon");
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, old);
  EXPECT_TRUE(lock) << lock.error().text();
}

TEST(Server, clients_that_never_greet_shut_nobody_out) {
  const Folder folder;
  ServerLimits limits;
  limits.clients = 3;
  Running running(folder.path() / "s", limits);
  LineSocket welcomed(connect_to(folder.path() / "s").value(), {});
  say(welcomed, "hello");
  EXPECT_EQ(next_line(welcomed), "welcome");
  LineSocket first(connect_to(folder.path() / "s").value(), {}), second(connect_to(folder.path() / "s").value(), {});
  LineSocket third(connect_to(folder.path() / "s").value(), {});
  say(third, "hello");
  EXPECT_EQ(next_line(third), "welcome");
  EXPECT_EQ(next_line(first).substr(0, 6), "closed") << "the oldest that hasn't greeted goes";
  say(second, "hello");
  EXPECT_EQ(next_line(second), "welcome");
}

TEST(Server, who_comes_when_all_places_are_taken_is_told_so) {
  const Folder folder;
  ServerLimits limits;
  limits.clients = 1;
  Running running(folder.path() / "s", limits);
  LineSocket welcomed(connect_to(folder.path() / "s").value(), {});
  say(welcomed, "hello");
  EXPECT_EQ(next_line(welcomed), "welcome");
  LineSocket late(connect_to(folder.path() / "s").value(), {});
  say(late, "hello");
  EXPECT_EQ(next_line(late), "1 program is connected already, as many as this daemon serves; close one of them");
  EXPECT_EQ(next_line(late).substr(0, 6), "closed");
  say(welcomed, "still here");
  EXPECT_EQ(next_line(welcomed), "still here");
}

TEST(Server, who_does_not_greet_in_time_is_cut_off) {
  const Folder folder;
  ServerLimits limits;
  limits.greeting = std::chrono::milliseconds(200);
  Running running(folder.path() / "s", limits);
  LineSocket silent(connect_to(folder.path() / "s").value(), {});
  EXPECT_EQ(next_line(silent).substr(0, 6), "closed");
  EXPECT_EQ(running.echo().wait_for_leaving(), "it didn't greet for 200 ms");
}

TEST(Server, another_users_program_is_not_served) {
  if (::geteuid() != 0) GTEST_SKIP() << "SKIPPED ALOUD: playing another user needs root";
  constexpr uid_t kNobody = 65534;
  const Folder folder;
  Running running(folder.path() / "s");
  // As where somebody has opened the folder by hand afterwards.
  ASSERT_EQ(::chmod(folder.path().c_str(), 0755), 0);
  ASSERT_EQ(::chmod((folder.path() / "s").c_str(), 0666), 0);
  // The peer is who it was when it connected, whoever has its socket then. A process of its own changes who it is: the user of this one is
  // also the server's.
  Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strcpy(address.sun_path, (folder.path() / "s").c_str());
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const bool connected =
        ::seteuid(kNobody) == 0 && ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    ::_exit(connected ? 0 : 1);
  }
  int ended = 0;
  ASSERT_EQ(::waitpid(child, &ended, 0), child);
  ASSERT_EQ(ended, 0) << "the file's mode alone lets it in";
  LineSocket theirs(std::move(socket), {});
  say(theirs, "hello");
  EXPECT_EQ(next_line(theirs).substr(0, 6), "closed");
  LineSocket ours(connect_to(folder.path() / "s").value(), {});
  say(ours, "hello");
  EXPECT_EQ(next_line(ours), "welcome");
}

TEST(Client, another_users_daemon_is_not_trusted) {
  if (::geteuid() != 0) GTEST_SKIP() << "SKIPPED ALOUD: playing another user needs root";
  constexpr uid_t kNobody = 65534;
  const Folder folder;
  ::chmod(folder.path().c_str(), 0755);
  const fs::path theirs = folder.path() / "theirs", ours = folder.path() / "ours";
  fs::create_directory(theirs);
  ASSERT_EQ(::chown(theirs.c_str(), kNobody, kNobody), 0);
  ASSERT_EQ(::chmod(theirs.c_str(), 0755), 0);
  fs::create_directory(ours);
  ::chmod(ours.c_str(), 0700);
  // A socket that another user listens at, in a folder of that user and in one of ours.
  for (const fs::path& socket : {theirs / "s", ours / "s"}) {
    int ready[2];
    ASSERT_EQ(::pipe(ready), 0);
    const pid_t child = ::fork();
    if (child == 0) {
      const int listening = ::socket(AF_UNIX, SOCK_STREAM, 0);
      sockaddr_un address{};
      address.sun_family = AF_UNIX;
      std::strcpy(address.sun_path, socket.c_str());
      if (::bind(listening, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 || ::seteuid(kNobody) != 0 ||
          ::listen(listening, 1) != 0 || ::write(ready[1], "r", 1) != 1)
        ::_exit(1);
      ::pause();
    }
    char said = 0;
    ::close(ready[1]);
    ASSERT_EQ(::read(ready[0], &said, 1), 1);
    const Result<Descriptor> connected = connect_to(socket);
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    ::close(ready[0]);
    ASSERT_FALSE(connected) << socket;
    EXPECT_NE(connected.error().message.find("user (65534"), std::string::npos) << connected.error().text();
  }
}

TEST(Client, a_folder_that_others_may_write_to_is_not_trusted) {
  const Folder folder;
  const Running running(folder.path() / "s");
  struct Case {
    mode_t mode;
    bool trusted;
  };
  for (const Case& each :
       {Case{0777, false}, Case{0770, false}, Case{0720, false}, Case{0702, false}, Case{0755, true}, Case{0700, true}}) {
    ASSERT_EQ(::chmod(folder.path().c_str(), each.mode), 0);
    const Result<Descriptor> connected = connect_to(folder.path() / "s");
    EXPECT_EQ(connected.has_value(), each.trusted) << std::oct << each.mode;
    if (connected) continue;
    EXPECT_THAT(connected.error().message, testing::HasSubstr("others may write to it"));
  }
}

TEST(Client, looks_for_the_daemon_in_the_folder_that_its_surroundings_name) {
  struct Case {
    const char* runtime_directory;
    const char* xdg_runtime_dir;
    fs::path folder;
  };
  const fs::path own = "/tmp/prismesh-" + std::to_string(::geteuid());
  for (const Case& each : {Case{"/run/prismesh", "/run/user/1", "/run/prismesh"}, Case{"/run/prismesh:/run/second", "", "/run/prismesh"},
                           Case{"", "/run/user/1", "/run/user/1/prismesh"}, Case{nullptr, "/run/user/1", "/run/user/1/prismesh"},
                           Case{"", "", own}, Case{nullptr, nullptr, own}}) {
    const Variable first("RUNTIME_DIRECTORY", each.runtime_directory), second("XDG_RUNTIME_DIR", each.xdg_runtime_dir);
    EXPECT_EQ(runtime_directory(std::nullopt), each.folder);
    EXPECT_EQ(runtime_directory("/named"), "/named") << "what was named goes before";
  }
}

TEST(Server, a_socket_path_that_is_too_long_is_said) {
  const Folder folder;
  Echo echo;
  const Result<Server> server = Server::listen(folder.path() / std::string(120, 'd') / "s", echo);
  ASSERT_FALSE(server);
  EXPECT_NE(server.error().message.find("too long for a socket"), std::string::npos);
  EXPECT_FALSE(connect_to(folder.path() / std::string(120, 'd') / "s"));
}

TEST(Server, with_too_few_descriptors_it_does_not_start_and_says_so) {
#ifdef PRISMESH_ADDRESS_SANITIZER
  GTEST_SKIP() << "UndefinedBehaviorSanitizer needs descriptors of its own to look at an object's type";
#endif
  const Folder folder;
  Echo echo;
  int refused = 0;
  for (int free = 0; free < 12; ++free) {
    const Result<Server> server = [&] {
      const prismesh::test::FewDescriptors few(free);
      return Server::listen(folder.path() / "s", echo);
    }();
    if (server) continue;
    ++refused;
    EXPECT_THAT(server.error().text(), testing::HasSubstr("Too many open files")) << free;
  }
  EXPECT_GE(refused, 4) << "two for the folder and the socket, two and more for the loop";
  EXPECT_TRUE(Server::listen(folder.path() / "s", echo)) << "later it starts";
}

}  // namespace
}  // namespace prismesh::ipc
