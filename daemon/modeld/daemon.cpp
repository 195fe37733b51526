#include "daemon/modeld/daemon.h"

#include <chrono>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <unistd.h>

#include "base/clock.h"
#include "base/log.h"
#include "daemon/modeld/bench.h"
#include "daemon/modeld/desk.h"
#include "daemon/modeld/worker.h"
#include "ipc/client.h"
#include "ipc/messages_json.h"
#include "ipc/server.h"
#include "ipc/state_page.h"

namespace prismesh::modeld {

struct Daemon::State final : ipc::ServerHandler, Outlet {
  State(const DaemonOptions& options, ipc::Descriptor state_lock, ipc::StatePage state_page)
      : lock(std::move(state_lock)),
        page(std::move(state_page)),
        publisher(StateFolder(options.state_directory).first_number()),
        bench(StateFolder(options.state_directory), publisher, options.history_bytes),
        desk(*this, worker, bench, publisher) {}

  ipc::Descriptor lock;
  ipc::StatePage page;
  std::optional<ipc::Server> server;
  std::set<ipc::ClientId> greeted;
  ipc::SnapshotPublisher publisher;
  Bench bench;
  Desk desk;
  Worker worker;  // last: it ends before what it works on

  // --- from the socket ---

  void connected(ipc::ClientId) override {}

  void line(ipc::ClientId client, std::string_view line) override {
    auto request = ipc::decode_request(line);
    if (!request) return answer(client, request.error().number, ipc::Failed{"request", 0, request.error().message}, {});
    if (const auto* hello = std::get_if<ipc::Hello>(&request->request)) return greet(client, request->number, *hello);
    if (!greeted.contains(client)) {
      answer(client, request->number, ipc::Failed{"request", 0, "the first message must be a hello"}, {});
      return server->cut(client, "it didn't greet");
    }
    desk.request(client, request->number, std::move(request->request), line.size());
  }

  void greet(ipc::ClientId client, std::uint64_t number, const ipc::Hello& hello) {
    std::optional<std::string> refusal = server->refusal(client);
    if (!refusal) refusal = ipc::protocol_refusal(ipc::kProtocolVersion, hello.protocol, hello.program);
    if (refusal) {
      answer(client, number, ipc::Failed{"", 0, *refusal}, {});
      return server->cut(client, "it was refused");
    }
    Result<ipc::Descriptor> state_page = page.descriptor().duplicate();
    if (!state_page) return server->cut(client, state_page.error().text());
    if (greeted.insert(client).second) desk.arrived(client);
    server->welcome(client);
    logging::info("client {} is {}", client, hello.program);
    std::vector<ipc::Descriptor> descriptors;
    descriptors.push_back(std::move(*state_page));
    answer(client, number, ipc::Welcome{ipc::kProtocolVersion, PRISMESH_VERSION, client}, std::move(descriptors));
    beat();
  }

  void disconnected(ipc::ClientId client, const std::string& why) override {
    if (greeted.erase(client) == 0) return;
    logging::info("client {} left: {}", client, why);
    desk.left(client);
    beat();
  }

  // --- to the socket ---

  void answer(ipc::ClientId client, std::uint64_t number, const ipc::Answer& answer, std::vector<ipc::Descriptor> descriptors) override {
    if (const auto* failed = std::get_if<ipc::Failed>(&answer))
      logging::info("client {}: refused: {}", client, Error{failed->file, failed->line, failed->message}.text());
    const std::size_t count = descriptors.size();
    server->send(client, ipc::encode_answer(number, answer, count), std::move(descriptors));
  }

  void tell(ipc::ClientId client, const ipc::Event& event) override {
    if (greeted.contains(client)) server->send(client, ipc::encode_event(event));
  }

  void tell_all(const ipc::Event& event) override {
    const std::string line = ipc::encode_event(event);
    // A copy: sending to a client that is cut off for it changes the set.
    const std::set<ipc::ClientId> all = greeted;
    for (const ipc::ClientId client : all) server->send(client, line);
    beat();
  }

  void post(std::function<void()> work) override { server->post(std::move(work)); }

  void beat() {
    MonotonicClock clock;
    ipc::Health health = desk.health();
    health.heartbeat_ns = clock.now_ns();
    health.pid = ::getpid();
    page.set_health(health);
  }

  void begin() {
    server->every(std::chrono::nanoseconds(ipc::kHeartbeatPeriodNs), [this] { beat(); });
    beat();
    desk.start([](const ipc::Answer& answer) {
      if (const auto* failed = std::get_if<ipc::Failed>(&answer))
        logging::error("what was open last time could not be opened: {}", Error{failed->file, failed->line, failed->message}.text());
      if (const auto* state = std::get_if<ipc::State>(&answer))
        logging::info("opened {} again with {} edits from the journal", state->path, state->recovered_edits);
    });
  }
};

Result<Daemon> Daemon::start(const DaemonOptions& options) {
  if (Result<void> made = ipc::make_private_folder(options.state_directory); !made) return fail(std::move(made.error()));
  Result<ipc::Descriptor> lock = ipc::lock_folder(options.state_directory, "modeld.lock", "a daemon with this state folder");
  if (!lock) return fail(std::move(lock.error()));
  Result<ipc::StatePage> page = ipc::StatePage::create();
  if (!page) return fail(std::move(page.error()));
  auto state = std::make_unique<State>(options, std::move(*lock), std::move(*page));
  Result<ipc::Server> server = ipc::Server::listen(ipc::model_socket_path(options.runtime_directory), *state);
  if (!server) return fail(std::move(server.error()));
  state->server = std::move(*server);
  state->begin();
  return Daemon(std::move(state));
}

Daemon::Daemon(std::unique_ptr<State> state) : state_(std::move(state)) {}
Daemon::Daemon(Daemon&&) noexcept = default;
Daemon::~Daemon() = default;

void Daemon::run() { state_->server->run(); }
void Daemon::stop() { state_->server->stop(); }

}  // namespace prismesh::modeld
