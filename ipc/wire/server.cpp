#include "ipc/wire/server.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <map>
#include <new>
#include <utility>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/system/system_error.hpp>

#include "ipc/wire/line_socket.h"

namespace prismesh::ipc {

namespace {

namespace asio = boost::asio;
using asio::posix::stream_descriptor;
using boost::system::error_code;
using Time = std::chrono::steady_clock;

Result<Descriptor> bind_socket(const std::filesystem::path& path, bool for_others) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.native().size() >= sizeof address.sun_path)
    return fail(path.string(), "the path is too long for a socket (" + std::to_string(sizeof address.sun_path - 1) + " bytes at most)");
  std::memcpy(address.sun_path, path.c_str(), path.native().size());
  Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!socket) return fail(path.string(), std::string("no socket: ") + std::strerror(errno));
  // The folder's lock is ours, so a socket that lies there has no listener.
  ::unlink(path.c_str());
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::chmod(path.c_str(), for_others ? 0666 : 0600) != 0 || ::listen(socket.get(), 16) != 0)
    return fail(path.string(), std::string("can't listen there: ") + std::strerror(errno));
  return socket;
}

Roles roles_of(int socket, const RoleTable& table) {
  ucred peer{};
  socklen_t size = sizeof peer;
  if (::getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) return {};
  return table.of(peer.uid);
}

/// Asio waits on a descriptor that somebody else owns.
class Watched {
 public:
  Watched(asio::io_context& loop, int descriptor) : stream_(loop, descriptor) {}
  ~Watched() { stream_.release(); }
  Watched(const Watched&) = delete;
  Watched& operator=(const Watched&) = delete;
  stream_descriptor& operator*() { return stream_; }
  stream_descriptor* operator->() { return &stream_; }

 private:
  stream_descriptor stream_;
};

struct ServedClient {
  ServedClient(asio::io_context& loop, Descriptor socket, const ServerLimits& limits, const Roles& of_user)
      : lines(std::move(socket), {limits.line_bytes, limits.descriptors}), watched(loop, lines.descriptor()), roles(of_user) {}

  LineSocket lines;
  Watched watched;
  Roles roles;
  bool closed = false;
  bool writing = false;
  bool welcomed = false;
  bool surplus = false;  ///< one too many: it is only refused
  Time::time_point since = Time::now();
  Time::time_point last_progress = Time::now();  ///< when it last accepted queued bytes
};

}  // namespace

struct Server::Impl {
  Impl(std::filesystem::path where, ServerHandler& to, const ServerLimits& bounds, RoleTable who, Descriptor folder_lock, Descriptor socket)
      : path(std::move(where)),
        handler(to),
        limits(bounds),
        roles(std::move(who)),
        lock(std::move(folder_lock)),
        listening(std::move(socket)),
        watched(loop, listening.get()),
        signals(loop, SIGTERM, SIGINT),
        retry(loop),
        stalls(loop) {}

  std::filesystem::path path;
  ServerHandler& handler;
  ServerLimits limits;
  RoleTable roles;
  Descriptor lock;  ///< none: another process made the socket
  Descriptor listening;
  asio::io_context loop{1};
  Watched watched;
  asio::signal_set signals;
  asio::steady_timer retry;
  asio::steady_timer stalls;
  std::vector<std::unique_ptr<asio::steady_timer>> timers;
  std::map<ClientId, std::shared_ptr<ServedClient>> connections;
  ClientId next_client = 1;

  void start() {
    accept_next();
    watch_stalls();
    // A closing terminal ends the daemon, unless it was started to ignore that (nohup).
    struct sigaction hang_up {};
    if (::sigaction(SIGHUP, nullptr, &hang_up) == 0 && hang_up.sa_handler != SIG_IGN) signals.add(SIGHUP);
    signals.async_wait([this](const error_code& problem, int) {
      if (!problem) loop.stop();
    });
  }

  void accept_next() {
    watched->async_wait(stream_descriptor::wait_read, [this](const error_code& problem) {
      if (problem) return;
      if (accept_all()) return accept_next();
      // Out of descriptors: the waiting client stays ready, so try again only after a while.
      retry.expires_after(std::chrono::milliseconds(200));
      retry.async_wait([this](const error_code& stopped) {
        if (!stopped) accept_next();
      });
    });
  }

  /// False if the process can't accept more connections now.
  bool accept_all() {
    for (;;) {
      Descriptor socket(::accept4(listening.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
      if (!socket) return errno != EMFILE && errno != ENFILE && errno != ENOMEM && errno != ENOBUFS;
      const Roles roles_of_client = roles_of(socket.get(), roles);
      if (roles_of_client.none()) continue;
      if (connections.size() >= limits.clients) close_oldest_silent();
      const ClientId client = next_client++;
      const auto served = std::make_shared<ServedClient>(loop, std::move(socket), limits, roles_of_client);
      served->surplus = connections.size() >= limits.clients;
      connections.emplace(client, served);
      handler.connected(client);
      read_next(client);
    }
  }

  /// Makes room: clients are numbered in the order they came.
  void close_oldest_silent() {
    const auto silent = std::find_if(connections.begin(), connections.end(), [](const auto& each) { return !each.second->welcomed; });
    if (silent != connections.end()) close(silent->first, "it hadn't greeted, and its place was needed");
  }

  std::shared_ptr<ServedClient> find(ClientId client) const {
    const auto found = connections.find(client);
    return found == connections.end() ? nullptr : found->second;
  }

  void read_next(ClientId client) {
    const std::shared_ptr<ServedClient> connection = find(client);
    if (!connection) return;
    connection->watched->async_wait(stream_descriptor::wait_read, [this, client, connection](const error_code& problem) {
      if (problem || connection->closed) return;
      try {
        const Result<bool> received = connection->lines.receive();
        deliver(client);
        if (connection->closed) return;
        if (!received) return close(client, received.error().message);
      } catch (const std::bad_alloc&) {
        return close(client, "there wasn't enough memory for what it sent");
      }
      read_next(client);
    });
  }

  void deliver(ClientId client) {
    const std::shared_ptr<ServedClient> connection = find(client);
    while (connection && !connection->closed) {
      const std::optional<std::string_view> line = connection->lines.next_line();
      if (!line) return;
      if (line->size() > limits.line_bytes) return close(client, "a line is longer than " + std::to_string(limits.line_bytes) + " bytes");
      handler.line(client, *line);
    }
  }

  void write_next(ClientId client) {
    const std::shared_ptr<ServedClient> connection = find(client);
    if (!connection || connection->writing) return;
    const std::size_t before = connection->lines.queued_bytes();
    const Result<bool> flushed = connection->lines.flush();
    if (!flushed) return close(client, flushed.error().message);
    if (connection->lines.queued_bytes() != before) connection->last_progress = Time::now();
    if (*flushed) return;
    connection->writing = true;
    connection->watched->async_wait(stream_descriptor::wait_write, [this, client, connection](const error_code& problem) {
      connection->writing = false;
      if (!problem && !connection->closed) write_next(client);
    });
  }

  void close(ClientId client, const std::string& why) {
    const std::shared_ptr<ServedClient> connection = find(client);
    if (!connection) return;
    connection->closed = true;
    connections.erase(client);
    (void)connection->lines.flush();
    connection->watched->cancel();
    // The descriptor closes with the last handler that holds it; the other side is told now.
    ::shutdown(connection->lines.descriptor(), SHUT_RDWR);
    // Called from the loop: the daemon may be in the middle of sending to this client.
    asio::post(loop, [this, client, why] { handler.disconnected(client, why); });
  }

  void watch_stalls() {
    stalls.expires_after(std::min(limits.stall, limits.greeting) / 4);
    stalls.async_wait([this](const error_code& stopped) {
      if (stopped) return;
      std::vector<ClientId> stalled;
      for (const auto& [client, connection] : connections)
        if (connection->lines.queued_bytes() > 0 && Time::now() - connection->last_progress > limits.stall) stalled.push_back(client);
      for (const ClientId client : stalled) close(client, "it took nothing for " + std::to_string(limits.stall.count()) + " ms");
      std::vector<ClientId> silent;
      for (const auto& [client, connection] : connections)
        if (!connection->welcomed && Time::now() - connection->since > limits.greeting) silent.push_back(client);
      for (const ClientId client : silent) close(client, "it didn't greet for " + std::to_string(limits.greeting.count()) + " ms");
      watch_stalls();
    });
  }

  void repeat(asio::steady_timer& timer, std::chrono::nanoseconds period, std::function<void()> work) {
    timer.expires_after(std::chrono::duration_cast<asio::steady_timer::duration>(period));
    timer.async_wait([this, &timer, period, work = std::move(work)](const error_code& stopped) mutable {
      if (stopped) return;
      try {
        work();
      } catch (const std::bad_alloc&) {
        // It is tried again next time.
      }
      repeat(timer, period, std::move(work));
    });
  }
};

Result<Server> Server::listen(const std::filesystem::path& socket, ServerHandler& handler, const ServerLimits& limits,
                              const RoleTable& roles) {
  const bool for_others = roles.has_others();
  if (Result<void> made = make_private_folder(socket.parent_path(), for_others); !made) return fail(std::move(made.error()));
  Result<Descriptor> lock = lock_folder(socket.parent_path(), socket.filename().string() + ".lock", "a daemon");
  if (!lock) return fail(std::move(lock.error()));
  Result<Descriptor> listening = bind_socket(socket, for_others);
  if (!listening) return fail(std::move(listening.error()));
  return start(std::move(*listening), std::move(*lock), socket, handler, limits, roles);
}

Result<Server> Server::serve(Descriptor listening, const std::filesystem::path& socket, ServerHandler& handler, const ServerLimits& limits,
                             const RoleTable& roles) {
  if (::fcntl(listening.get(), F_SETFL, O_NONBLOCK) != 0 || ::fcntl(listening.get(), F_SETFD, FD_CLOEXEC) != 0)
    return fail(socket.string(), std::string("can't be served: ") + std::strerror(errno));
  return start(std::move(listening), Descriptor(), socket, handler, limits, roles);
}

Result<Server> Server::start(Descriptor listening, Descriptor lock, const std::filesystem::path& socket, ServerHandler& handler,
                             const ServerLimits& limits, const RoleTable& roles) {
  try {
    auto impl = std::make_unique<Impl>(socket, handler, limits, roles, std::move(lock), std::move(listening));
    impl->start();
    return Server(std::move(impl));
  } catch (const boost::system::system_error& problem) {
    // The library throws when descriptors have run out.
    return fail(socket.string(), "can't be served: " + problem.code().message());
  }
}

Server::Server(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Server::Server(Server&&) noexcept = default;
Server& Server::operator=(Server&&) noexcept = default;

Server::~Server() {
  if (!impl_) return;
  for (const auto& [client, connection] : impl_->connections) (void)connection->lines.flush();
  if (impl_->lock) ::unlink(impl_->path.c_str());
}

Result<std::vector<Descriptor>> Server::take_descriptors(ClientId client, std::size_t count) {
  const std::shared_ptr<ServedClient> connection = impl_->find(client);
  if (!connection) return fail("", "the client is gone");
  return connection->lines.take_descriptors(count);
}

Roles Server::roles(ClientId client) const {
  const std::shared_ptr<ServedClient> connection = impl_->find(client);
  return connection ? connection->roles : Roles();
}

void Server::run() {
  for (;;) {
    try {
      impl_->loop.run();
      return;
    } catch (const std::bad_alloc&) {
      // This work is skipped; the others continue.
    }
  }
}
void Server::stop() { impl_->loop.stop(); }
void Server::post(std::function<void()> work) { asio::post(impl_->loop, std::move(work)); }

void Server::every(std::chrono::nanoseconds period, std::function<void()> work) {
  impl_->timers.push_back(std::make_unique<asio::steady_timer>(impl_->loop));
  impl_->repeat(*impl_->timers.back(), period, std::move(work));
}

void Server::send(ClientId client, std::string line, std::vector<Descriptor> descriptors) {
  const std::shared_ptr<ServedClient> connection = impl_->find(client);
  if (!connection) return;
  if (connection->lines.queued_bytes() == 0) connection->last_progress = Time::now();
  connection->lines.queue(std::move(line), std::move(descriptors));
  if (connection->lines.queued_bytes() > impl_->limits.queue_bytes) return cut(client, "it reads too slowly");
  impl_->write_next(client);
}

void Server::welcome(ClientId client) {
  if (const std::shared_ptr<ServedClient> connection = impl_->find(client)) connection->welcomed = true;
}

std::optional<std::string> Server::refusal(ClientId client) const {
  const std::shared_ptr<ServedClient> connection = impl_->find(client);
  if (!connection || !connection->surplus) return std::nullopt;
  return std::to_string(impl_->limits.clients) + (impl_->limits.clients == 1 ? " program is" : " programs are") +
         " connected already, as many as this daemon serves; close one of them";
}

void Server::cut(ClientId client, const std::string& why) { impl_->close(client, why); }

std::optional<std::string> protocol_refusal(int ours, int theirs, const std::string& program) {
  if (ours == theirs) return std::nullopt;
  return "the daemon speaks protocol " + std::to_string(ours) + ", " + (program.empty() ? "the client" : program) + " protocol " +
         std::to_string(theirs) + ": use programs of one version, and restart the daemon after an update";
}

}  // namespace prismesh::ipc
