#include "ipc/wire/line_socket.h"

#include <array>
#include <cerrno>
#include <cstring>

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "ipc/wire/roles.h"

namespace prismesh::ipc {

namespace {

constexpr std::size_t kReadBytes = 64 * 1024;
constexpr std::size_t kMaxDescriptorsPerMessage = 253;  // the kernel's limit

tl::unexpected<Error> gone(const char* why) { return fail("", std::string("the connection was closed: ") + why); }

struct ControlBuffer {
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int) * kMaxDescriptorsPerMessage)> bytes;
};

}  // namespace

LineSocket::LineSocket(Descriptor socket, LineLimits limits) : socket_(std::move(socket)), limits_(limits) {}

Result<bool> LineSocket::receive() {
  incoming_.erase(0, taken_);
  scanned_ -= taken_;
  taken_ = 0;
  bool received = false;
  for (int round = 0; round < 4; ++round) {
    std::array<char, kReadBytes> buffer;
    ControlBuffer control;
    iovec part{buffer.data(), buffer.size()};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    if (limits_.descriptors > 0) {
      message.msg_control = control.bytes.data();
      message.msg_controllen = control.bytes.size();
    }
    const ssize_t count = ::recvmsg(socket_.get(), &message, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return received;
    if (count < 0) return gone(std::strerror(errno));
    if (Result<void> kept = keep_descriptors(&message); !kept) return fail(std::move(kept.error()));
    if (count == 0) return received ? Result<bool>(true) : gone("the other side ended");
    incoming_.append(buffer.data(), static_cast<std::size_t>(count));
    received = true;
    if (incoming_.size() > limits_.line_bytes && incoming_.find('\n', scanned_) == std::string::npos)
      return fail("", "a line is longer than " + std::to_string(limits_.line_bytes) + " bytes");
  }
  return received;
}

Result<void> LineSocket::keep_descriptors(const void* received) {
  // CMSG_NXTHDR takes a non-const pointer, but changes nothing.
  auto* message = const_cast<msghdr*>(static_cast<const msghdr*>(received));
  for (cmsghdr* header = CMSG_FIRSTHDR(message); header != nullptr; header = CMSG_NXTHDR(message, header)) {
    if (header->cmsg_level != SOL_SOCKET || header->cmsg_type != SCM_RIGHTS) continue;
    const std::size_t count = (header->cmsg_len - CMSG_LEN(0)) / sizeof(int);
    for (std::size_t i = 0; i < count; ++i) {
      int number = -1;
      std::memcpy(&number, CMSG_DATA(header) + i * sizeof(int), sizeof(int));
      descriptors_.emplace_back(number);
    }
  }
  if ((message->msg_flags & MSG_CTRUNC) != 0)
    return fail("", limits_.descriptors == 0 ? "descriptors came that nobody asked for" : "descriptors were lost");
  if (descriptors_.size() > limits_.descriptors) return fail("", "too many descriptors came");
  return {};
}

std::optional<std::string_view> LineSocket::next_line() {
  const std::size_t end = incoming_.find('\n', std::max(taken_, scanned_));
  if (end == std::string::npos) {
    scanned_ = incoming_.size();
    return std::nullopt;
  }
  const std::string_view line = std::string_view(incoming_).substr(taken_, end - taken_);
  taken_ = end + 1;
  scanned_ = taken_;
  return line;
}

Result<std::vector<Descriptor>> LineSocket::take_descriptors(std::size_t count) {
  if (count > descriptors_.size()) return fail("", "a message names more descriptors than came with it");
  std::vector<Descriptor> taken;
  for (std::size_t i = 0; i < count; ++i) {
    taken.push_back(std::move(descriptors_.front()));
    descriptors_.pop_front();
  }
  return taken;
}

void LineSocket::queue(std::string line, std::vector<Descriptor> descriptors) {
  line += '\n';
  queued_bytes_ += line.size();
  outgoing_.push_back({std::move(line), 0, std::move(descriptors)});
}

long LineSocket::send_some(Outgoing& out) {
  ControlBuffer control{};
  iovec part{out.bytes.data() + out.sent, out.bytes.size() - out.sent};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  if (!out.descriptors.empty()) {
    const std::size_t bytes = sizeof(int) * out.descriptors.size();
    message.msg_control = control.bytes.data();
    message.msg_controllen = CMSG_SPACE(bytes);
    cmsghdr* header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(bytes);
    for (std::size_t i = 0; i < out.descriptors.size(); ++i) {
      const int number = out.descriptors[i].get();
      std::memcpy(CMSG_DATA(header) + i * sizeof(int), &number, sizeof(int));
    }
  }
  return ::sendmsg(socket_.get(), &message, MSG_DONTWAIT | MSG_NOSIGNAL);
}

Result<bool> LineSocket::flush() {
  while (!outgoing_.empty()) {
    Outgoing& out = outgoing_.front();
    if (out.descriptors.size() > kMaxDescriptorsPerMessage) return fail("", "a message has too many descriptors");
    const long count = send_some(out);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return false;
    if (count < 0) return gone(std::strerror(errno));
    // They were sent with the first byte.
    out.descriptors.clear();
    out.sent += static_cast<std::size_t>(count);
    queued_bytes_ -= static_cast<std::size_t>(count);
    if (out.sent == out.bytes.size()) outgoing_.pop_front();
  }
  return true;
}

namespace {

/// A user who may write to the folder could put a socket there and answer in the daemon's place.
Result<void> check_folder(const std::filesystem::path& folder) {
  struct stat status {};
  if (::stat(folder.c_str(), &status) != 0) return {};  // then connecting tells what is wrong
  if (status.st_uid != ::geteuid() && status.st_uid != 0)
    return fail(folder.string(),
                "belongs to another user (" + std::to_string(status.st_uid) + "), so whoever answers there is not to be trusted");
  if ((status.st_mode & 0022) != 0)
    return fail(folder.string(), "others may write to it, so whoever answers there is not to be trusted; make it private (chmod 700)");
  return {};
}

Result<void> check_server(int socket, const std::filesystem::path& path) {
  ucred peer{};
  socklen_t size = sizeof peer;
  if (::getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0)
    return fail(path.string(), std::string("can't tell who listens there: ") + std::strerror(errno));
  if (peer.uid == ::geteuid() || peer.uid == 0) return {};
  const Result<RoleTable> roles = read_roles();
  if (!roles) return fail(roles.error());
  if (roles->of(peer.uid).has(Role::serve)) return {};
  return fail(path.string(), "another user (" + std::to_string(peer.uid) + ", process " + std::to_string(peer.pid) +
                                 ") listens there, not a daemon of yours");
}

}  // namespace

Result<Descriptor> connect_to(const std::filesystem::path& path, std::string_view remedy) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.native().size() >= sizeof address.sun_path)
    return fail(path.string(), "the path is too long for a socket (" + std::to_string(sizeof address.sun_path - 1) + " bytes at most)");
  std::memcpy(address.sun_path, path.c_str(), path.native().size());
  if (Result<void> trusted = check_folder(path.parent_path()); !trusted) return fail(std::move(trusted.error()));
  Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (!socket) return fail(path.string(), std::string("no socket: ") + std::strerror(errno));
  int status = 0;
  do status = ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
  while (status != 0 && errno == EINTR);
  if (status == 0) {
    if (Result<void> trusted = check_server(socket.get(), path); !trusted) return fail(std::move(trusted.error()));
    return socket;
  }
  if (errno == ENOENT || errno == ECONNREFUSED) return fail(path.string(), "nobody listens there: " + std::string(remedy));
  return fail(path.string(), std::string("can't connect: ") + std::strerror(errno));
}

}  // namespace prismesh::ipc
