// What every daemon does at its socket: greets clients, checks their roles, answers, and tells all of them what has happened. A daemon
// derives from Service<Protocol> and says what its requests do.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "base/supervisor.h"
#include "daemon/common/inherited_socket.h"
#include "ipc/wire/envelope.h"
#include "ipc/wire/failure.h"
#include "ipc/wire/server.h"

namespace prismesh::daemon {

/// `Protocol` names the messages (Hello, Request, Answer, Event), their lines (decode, encode_answer, encode_event) and kVersion. Each
/// Hello has `protocol` and `program`; Failed is an Answer. `role_for(request)` is found by its argument. `must_be_told(answer)`: the
/// answer says that something was done, so that it can't be replaced by a failure. All but `post` and `stop` is called from the loop's
/// thread.
template <class Protocol>
class Service : public ipc::ServerHandler {
 public:
  using Request = typename Protocol::Request;
  using Answer = typename Protocol::Answer;
  using Event = typename Protocol::Event;
  using Hello = typename Protocol::Hello;

  /// Listens at the socket, or serves the one that systemd made there. Errors: as ipc::Server::listen and ipc::read_roles.
  Result<void> listen(const std::filesystem::path& socket, const ipc::ServerLimits& limits = {}) {
    const Result<ipc::RoleTable> roles = ipc::read_roles();
    if (!roles) return fail(roles.error());
    std::optional<ipc::Descriptor> inherited = inherited_socket(socket);
    Result<ipc::Server> server = inherited ? ipc::Server::serve(std::move(*inherited), socket, *this, limits, *roles)
                                           : ipc::Server::listen(socket, *this, limits, *roles);
    if (!server) return fail(std::move(server.error()));
    server_ = std::move(*server);
    return {};
  }

  /// Serves until SIGTERM, SIGINT, a terminal's SIGHUP or `stop`. Tells systemd that the daemon is ready, ending, and while `is_well` that
  /// it is alive.
  void run(const std::string& status) {
    if (const auto period = supervisor::period())
      server_->every(*period, [this] {
        if (is_well()) supervisor::tell_alive();
      });
    supervisor::tell_ready(status);
    server_->run();
    supervisor::tell_ending();
  }
  void stop() { server_->stop(); }
  void post(std::function<void()> work) { server_->post(std::move(work)); }
  void every(std::chrono::nanoseconds period, std::function<void()> work) { server_->every(period, std::move(work)); }

  void answer(ipc::ClientId client, std::uint64_t number, const Answer& answer, std::vector<ipc::Descriptor> descriptors = {}) {
    if (const auto* failed = std::get_if<ipc::Failed>(&answer))
      logging::info("client {}: refused: {}", client, ipc::error_from(*failed).text());
    const std::size_t count = descriptors.size();
    try {
      server_->send(client, Protocol::encode_answer(number, answer, count), std::move(descriptors));
    } catch (const std::bad_alloc&) {
      // A completed request must not be reported as failed. The client reconnects and asks for the state.
      if (Protocol::must_be_told(answer)) return server_->cut(client, kNoMemory);
      server_->send(client, Protocol::encode_answer(number, ipc::Failed{"", 0, kNoMemory, {}}, 0));
    }
  }

  void tell(ipc::ClientId client, const Event& event) {
    if (!greeted_.contains(client)) return;
    try {
      server_->send(client, Protocol::encode_event(event));
    } catch (const std::bad_alloc&) {
      server_->cut(client, kNoMemory);
    }
  }

  void tell_all(const Event& event) {
    // A copy: a send that cuts its client off changes the map.
    const std::map<ipc::ClientId, std::string> all = greeted_;
    for (const auto& [client, program] : all) tell(client, event);
  }

  /// The next descriptors that the client has sent. Errors: fewer have arrived.
  Result<std::vector<ipc::Descriptor>> take_descriptors(ipc::ClientId client, std::size_t count) {
    return server_->take_descriptors(client, count);
  }

  /// The programs of the clients that were welcomed.
  const std::map<ipc::ClientId, std::string>& greeted() const { return greeted_; }

 protected:
  struct Welcomed {
    Answer answer;
    std::vector<ipc::Descriptor> descriptors;
  };
  /// Errors: the client is cut off.
  virtual Result<Welcomed> welcome(ipc::ClientId client) = 0;
  /// Called once a client that greeted anew has its welcome.
  virtual void arrived(ipc::ClientId) {}
  /// Of a client that was welcomed and whose user may ask for this. `bytes`: length of its line.
  virtual void request(ipc::ClientId client, std::uint64_t number, Request request, std::size_t bytes) = 0;
  /// Called for clients that were welcomed.
  virtual void left(ipc::ClientId) {}
  /// Whether the daemon does its work; systemd restarts it when it doesn't.
  virtual bool is_well() { return true; }

 private:
  static constexpr const char* kNoMemory = "there isn't enough memory for the answer";

  void connected(ipc::ClientId) final {}

  void line(ipc::ClientId client, std::string_view line) final {
    auto decoded = Protocol::decode(line);
    if (!decoded) return answer(client, decoded.error().number, ipc::Failed{"request", 0, decoded.error().message, {}});
    if (const auto* hello = std::get_if<Hello>(&decoded->request)) return greet(client, decoded->number, *hello);
    if (!greeted_.contains(client)) {
      answer(client, decoded->number, ipc::Failed{"request", 0, "the first message must be a hello", {}});
      return server_->cut(client, "it didn't greet");
    }
    const ipc::Role needed = role_for(decoded->request);
    if (const ipc::Roles has = server_->roles(client); !has.has(needed))
      return answer(client, decoded->number,
                    ipc::Failed{"",
                                0,
                                "this needs the role " + std::string(name(needed)) + "; your user has: " + has.names() +
                                    " (/etc/prismesh/roles.toml gives roles)",
                                {}});
    request(client, decoded->number, std::move(decoded->request), line.size());
  }

  void greet(ipc::ClientId client, std::uint64_t number, const Hello& hello) {
    std::optional<std::string> refusal = server_->refusal(client);
    if (!refusal) refusal = ipc::protocol_refusal(Protocol::kVersion, hello.protocol, hello.program);
    if (!refusal && !server_->roles(client).has(role_for(Request(hello))))
      refusal = "your user may not look on: it needs the role " + std::string(name(role_for(Request(hello))));
    if (refusal) {
      answer(client, number, ipc::Failed{"", 0, *refusal, {}});
      return server_->cut(client, "it was refused");
    }
    Result<Welcomed> welcomed = welcome(client);
    if (!welcomed) return server_->cut(client, welcomed.error().text());
    const bool is_new = greeted_.insert_or_assign(client, hello.program).second;
    server_->welcome(client);
    logging::info("client {} is {}", client, hello.program);
    answer(client, number, welcomed->answer, std::move(welcomed->descriptors));
    if (is_new) arrived(client);
  }

  void disconnected(ipc::ClientId client, const std::string& why) final {
    if (greeted_.erase(client) == 0) return;
    logging::info("client {} left: {}", client, why);
    left(client);
  }

  std::optional<ipc::Server> server_;
  std::map<ipc::ClientId, std::string> greeted_;
};

}  // namespace prismesh::daemon
