#include "daemon/modeld/daemon.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <new>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <unistd.h>

#include "base/clock.h"
#include "base/log.h"
#include "daemon/modeld/request_handler.h"
#include "daemon/modeld/request_scheduler.h"
#include "daemon/modeld/watchdog.h"
#include "daemon/modeld/worker.h"
#include "ipc/model/client.h"
#include "ipc/model/messages_json.h"
#include "ipc/model/state_page.h"
#include "ipc/wire/failure.h"
#include "ipc/wire/server.h"

namespace prismesh::modeld {

namespace {

/// The loop gives a heartbeat every half second.
constexpr std::chrono::milliseconds kWatchPeriod{500};
static_assert(kWatchPeriod.count() * 1'000'000 >= ipc::kHeartbeatPeriodNs);
constexpr std::chrono::seconds kMaxUnserved{20};

constexpr const char* kNoMemoryToAnswer = "there isn't enough memory for the answer";

bool says_what_was_done(const ipc::Answer& answer) {
  return std::holds_alternative<ipc::Edited>(answer) || std::holds_alternative<ipc::Saved>(answer) ||
         std::holds_alternative<ipc::DocumentState>(answer) || std::holds_alternative<ipc::DragBegun>(answer);
}

/// Aborts, so that a core file shows the stacks of all threads. Acknowledged edits are on disk.
void end_hung_process(const std::string& what) {
  ::alarm(5);  // in case the log hangs too
  logging::critical("{}: the daemon hangs and ends itself, to be started anew; what was acknowledged is on disk", what);
  logging::flush();
  std::abort();
}

}  // namespace

struct Daemon::Impl final : ipc::ServerHandler, ClientChannel {
  Impl(const DaemonOptions& options, ipc::Descriptor state_lock, ipc::StatePage state_page)
      : lock(std::move(state_lock)),
        page(std::move(state_page)),
        publisher(StateFolder(options.state_directory).first_number()),
        handler(StateFolder(options.state_directory), publisher, options.history_bytes, clock),
        scheduler(*this, worker, handler, publisher) {}

  ipc::Descriptor lock;
  ipc::StatePage page;
  std::optional<ipc::Server> server;
  std::set<ipc::ClientId> greeted;
  ipc::SnapshotPublisher publisher;
  MonotonicClock clock;
  RequestHandler handler;
  RequestScheduler scheduler;
  Heartbeat loop_heartbeat;
  std::optional<Watchdog> watchdog;  // outlives the worker, whose end it watches
  Worker worker;                     // last: it ends before the objects that it works on

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
    scheduler.request(client, request->number, std::move(request->request), line.size());
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
    if (greeted.insert(client).second) scheduler.arrived(client);
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
    scheduler.left(client);
    beat();
  }

  // --- to the socket ---

  void answer(ipc::ClientId client, std::uint64_t number, const ipc::Answer& answer, std::vector<ipc::Descriptor> descriptors) override {
    if (const auto* failed = std::get_if<ipc::Failed>(&answer))
      logging::info("client {}: refused: {}", client, ipc::error_from(*failed).text());
    const std::size_t count = descriptors.size();
    try {
      server->send(client, ipc::encode_answer(number, answer, count), std::move(descriptors));
    } catch (const std::bad_alloc&) {
      // A completed request must not be reported as failed. The client reconnects and asks for the state.
      if (says_what_was_done(answer)) return server->cut(client, kNoMemoryToAnswer);
      server->send(client, ipc::encode_answer(number, ipc::Failed{"", 0, kNoMemoryToAnswer}, 0));
    }
  }

  void tell(ipc::ClientId client, const ipc::Event& event) override {
    if (!greeted.contains(client)) return;
    try {
      server->send(client, ipc::encode_event(event));
    } catch (const std::bad_alloc&) {
      server->cut(client, kNoMemoryToAnswer);
    }
  }

  void tell_all(const ipc::Event& event) override {
    // A copy: a send that cuts its client off changes the set.
    const std::set<ipc::ClientId> all = greeted;
    for (const ipc::ClientId client : all) tell(client, event);
    beat();
  }

  void post(std::function<void()> work) override { server->post(std::move(work)); }

  void beat() {
    loop_heartbeat.beat();
    ipc::Health health = scheduler.health();
    health.heartbeat_ns = clock.now_ns();
    health.pid = ::getpid();
    page.set_health(health);
  }

  void watch(std::chrono::seconds limit) {
    if (limit.count() == 0) return;
    const auto periods = [](std::chrono::seconds silence) { return static_cast<int>(silence / kWatchPeriod); };
    std::vector<HeartbeatMonitor> watched;
    watched.emplace_back("clients aren't served", loop_heartbeat, periods(std::min(limit, kMaxUnserved)));
    watched.emplace_back("the work under way makes no progress", worker.heartbeat(), periods(limit));
    watchdog.emplace(std::move(watched), kWatchPeriod, end_hung_process);
  }

  void begin() {
    server->every(std::chrono::nanoseconds(ipc::kHeartbeatPeriodNs), [this] { beat(); });
    beat();
    scheduler.start([](const ipc::Answer& answer) {
      if (const auto* failed = std::get_if<ipc::Failed>(&answer))
        logging::error("what was open last time could not be opened: {}", ipc::error_from(*failed).text());
      if (const auto* state = std::get_if<ipc::DocumentState>(&answer))
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
  auto state = std::make_unique<Impl>(options, std::move(*lock), std::move(*page));
  Result<ipc::Server> server = ipc::Server::listen(ipc::model_socket_path(options.runtime_directory), *state);
  if (!server) return fail(std::move(server.error()));
  state->server = std::move(*server);
  state->watch(options.hang_limit);
  state->begin();
  return Daemon(std::move(state));
}

Daemon::Daemon(std::unique_ptr<Impl> state) : impl_(std::move(state)) {}
Daemon::Daemon(Daemon&&) noexcept = default;
Daemon::~Daemon() = default;

void Daemon::run() {
  impl_->loop_heartbeat.begin();
  impl_->server->run();
  impl_->loop_heartbeat.end();
}
void Daemon::stop() { impl_->server->stop(); }

}  // namespace prismesh::modeld
