#include "daemon/deviced/pen/line_guard.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <new>
#include <string>
#include <utility>

#include "daemon/deviced/pen/guard_process.h"

namespace prismesh::deviced::pen {
namespace {

using ipc::Descriptor;

constexpr int kEndPatienceMs = 2000;

tl::unexpected<Error> failed(const std::string& what) { return fail("the pen's guard", what + ": " + std::strerror(errno)); }

/// The process that holds the lock; 0: none.
pid_t holder(int lock) {
  struct flock asked {};
  asked.l_type = F_WRLCK;
  if (::fcntl(lock, F_GETLK, &asked) != 0 || asked.l_type == F_UNLCK) return 0;
  return asked.l_pid;
}

Result<void> end_earlier(int lock) {
  for (const int signal : {SIGTERM, SIGKILL}) {
    const pid_t earlier = holder(lock);
    if (earlier <= 0) return {};
    const Descriptor process(static_cast<int>(::syscall(SYS_pidfd_open, earlier, 0)));
    // The lock says that the number still means this process.
    if (!process || holder(lock) != earlier) continue;
    ::syscall(SYS_pidfd_send_signal, process.get(), signal, nullptr, 0);
    pollfd ended{process.get(), POLLIN, 0};
    if (::poll(&ended, 1, kEndPatienceMs) > 0) return {};
  }
  if (holder(lock) <= 0) return {};
  return fail("the pen's guard", "that of an earlier process (" + std::to_string(holder(lock)) + ") holds the line and doesn't end");
}

bool say(int socket, GuardMessage told, int line = -1) {
  iovec part{&told, sizeof told};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
  if (line >= 0) {
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    cmsghdr* header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(sizeof(int));
    std::memcpy(CMSG_DATA(header), &line, sizeof line);
  }
  return ::sendmsg(socket, &message, MSG_NOSIGNAL | MSG_DONTWAIT) == sizeof told;
}

}  // namespace

Result<LineGuard> LineGuard::start(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "pen-guard.lock";
  const Descriptor lock(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (!lock) return fail(path.string(), std::string("can't be opened: ") + std::strerror(errno));
  if (Result<void> ended = end_earlier(lock.get()); !ended) return fail(std::move(ended.error()));
  LineGuard guard;
  const Result<Descriptor> memory = ipc::make_shared_memory("prismesh-pen-guard", sizeof(GuardPage));
  if (!memory) return fail(memory.error());
  if (Result<void> reserved = ipc::reserve(*memory, 0, sizeof(GuardPage)); !reserved) return fail(std::move(reserved.error()));
  Result<ipc::Mapping> mapping = ipc::Mapping::map(*memory, true);
  if (!mapping) return fail(std::move(mapping.error()));
  guard.mapping_ = std::move(*mapping);
  guard.page_ = new (guard.mapping_.writable_bytes().data()) GuardPage;
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) return failed("no socket");
  guard.socket_ = Descriptor(ends[0]);
  const Descriptor theirs(ends[1]);
  const pid_t parent = ::getpid();
  guard.process_ = ::fork();
  if (guard.process_ < 0) return failed("no process");
  if (guard.process_ == 0) run_guard(*guard.page_, theirs.get(), lock.get(), parent);
  return guard;
}

LineGuard::LineGuard(LineGuard&& other) noexcept
    : page_(std::exchange(other.page_, nullptr)),
      mapping_(std::move(other.mapping_)),
      socket_(std::move(other.socket_)),
      process_(std::exchange(other.process_, -1)) {}

LineGuard::~LineGuard() {
  if (process_ <= 0) return;
  say(socket_.get(), {.word = GuardWord::end});
  ::waitpid(process_, nullptr, 0);
}

Result<void> LineGuard::watch(const drivers::port::BytePort& line) {
  if (line.descriptor() < 0) return fail("the pen's guard", "this line has no descriptor that could be duplicated");
  if (!say(socket_.get(), {.word = GuardWord::line}, line.descriptor())) return failed("it can't be told");
  return {};
}

Result<void> LineGuard::watch(const drivers::port::UsbPort& line, std::uint8_t endpoint, std::span<const std::byte> zero) {
  if (line.descriptor() < 0) return fail("the pen's guard", "this device has no descriptor that could be duplicated");
  GuardMessage told{.word = GuardWord::usb, .endpoint = endpoint, .zero_bytes = static_cast<std::uint8_t>(zero.size()), .zero = {}};
  std::copy(zero.begin(), zero.end(), told.zero.begin());
  if (!say(socket_.get(), told, line.descriptor())) return failed("it can't be told");
  return {};
}

Result<void> LineGuard::watch(int connection, std::span<const std::byte> zero) {
  GuardMessage told{.word = GuardWord::stream, .endpoint = 0, .zero_bytes = static_cast<std::uint8_t>(zero.size()), .zero = {}};
  if (connection < 0 || zero.size() > told.zero.size()) return fail("the pen's guard", "this connection can't be guarded");
  std::copy(zero.begin(), zero.end(), told.zero.begin());
  if (!say(socket_.get(), told, connection)) return failed("it can't be told");
  return {};
}

void LineGuard::release() { say(socket_.get(), {.word = GuardWord::release}); }

bool LineGuard::is_alive() {
  if (process_ > 0 && ::waitpid(process_, nullptr, WNOHANG) == process_) process_ = -1;
  return process_ > 0;
}

drivers::port::UsbGate usb_gate(GuardPage& page) {
  return {[&page] { return page.begin_writing(); }, [&page] { page.end_writing(); }};
}

drivers::port::PortCount GuardedPort::write(std::span<const std::byte> from) {
  if (!page_.begin_writing()) return {0, drivers::port::PortStatus::full};
  const drivers::port::PortCount put = line_.write(from);
  page_.end_writing();
  return put;
}

}  // namespace prismesh::deviced::pen
