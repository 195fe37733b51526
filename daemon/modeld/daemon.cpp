#include "daemon/modeld/daemon.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>

#include <unistd.h>

#include "base/clock.h"
#include "base/log.h"
#include "daemon/common/service.h"
#include "daemon/common/watchdog.h"
#include "daemon/modeld/pen_field.h"
#include "daemon/modeld/request_handler.h"
#include "daemon/modeld/request_scheduler.h"
#include "daemon/modeld/worker.h"
#include "ipc/model/client.h"
#include "ipc/model/messages_json.h"
#include "ipc/model/roles.h"
#include "ipc/model/state_page.h"
#include "ipc/wire/failure.h"

namespace prismesh::modeld {

namespace {

/// The loop gives a heartbeat every half second.
constexpr std::chrono::milliseconds kWatchPeriod{500};
static_assert(kWatchPeriod.count() * 1'000'000 >= ipc::kHeartbeatPeriodNs);
constexpr std::chrono::seconds kMaxUnserved{20};
constexpr int kMaxPeriodsOfAppend = 10;  ///< that an append may take, in periods of the supervisor

ipc::ServerLimits limits() {
  ipc::ServerLimits limits;
  limits.descriptors = 1;  // of follow_pen
  return limits;
}

struct ModelProtocol {
  using Request = ipc::Request;
  using Answer = ipc::Answer;
  using Event = ipc::Event;
  using Hello = ipc::Hello;
  static constexpr int kVersion = ipc::kProtocolVersion;
  static auto decode(std::string_view line) { return ipc::decode_request(line); }
  static std::string encode_answer(std::uint64_t to, const Answer& answer, std::size_t descriptors) {
    return ipc::encode_answer(to, answer, descriptors);
  }
  static std::string encode_event(const Event& event) { return ipc::encode_event(event); }
  static bool must_be_told(const Answer& answer) {
    return std::holds_alternative<ipc::Edited>(answer) || std::holds_alternative<ipc::Saved>(answer) ||
           std::holds_alternative<ipc::DocumentState>(answer) || std::holds_alternative<ipc::DragBegun>(answer);
  }
};

/// Aborts, so that a core file shows the stacks of all threads. Acknowledged edits are on disk.
void end_hung_process(const std::string& what) {
  ::alarm(5);  // in case the log hangs too
  logging::critical("{}: the daemon hangs and ends itself, to be started anew; what was acknowledged is on disk", what);
  logging::flush();
  std::abort();
}

}  // namespace

struct Daemon::Impl final : daemon::Service<ModelProtocol>, ClientChannel {
  using Service = daemon::Service<ModelProtocol>;

  Impl(const DaemonOptions& options, ipc::Descriptor state_lock, ipc::StatePage state_page)
      : lock(std::move(state_lock)),
        page(std::move(state_page)),
        publisher(StateFolder(options.state_directory).first_number()),
        handler(StateFolder(options.state_directory), publisher, options.history_bytes, clock, DeckSource(options.importer),
                StoredModels(options.intake)),
        scheduler(*this, worker, handler, publisher) {}

  ipc::Descriptor lock;
  ipc::StatePage page;
  ipc::SnapshotPublisher publisher;
  MonotonicClock clock;
  RequestHandler handler;
  PenField pen_field;
  std::optional<ipc::ClientId> pen_owner;  ///< the client that asked for it
  RequestScheduler scheduler;
  daemon::Heartbeat loop_heartbeat;
  daemon::HeartbeatMonitor append_monitor{"the journal can't be written", handler.appending(), kMaxPeriodsOfAppend};
  std::optional<daemon::Watchdog> watchdog;  // outlives the worker, whose end it watches
  Worker worker;                             // last: it ends before the objects that it works on

  // --- from the socket ---

  Result<Welcomed> welcome(ipc::ClientId client) override {
    Result<ipc::Descriptor> shared = page.descriptor().duplicate();
    if (!shared) return fail(std::move(shared.error()));
    Welcomed welcomed{ipc::Welcome{ipc::kProtocolVersion, PRISMESH_VERSION, client}, {}};
    welcomed.descriptors.push_back(std::move(*shared));
    return welcomed;
  }
  void arrived(ipc::ClientId client) override {
    scheduler.arrived(client);
    beat();
  }
  void request(ipc::ClientId client, std::uint64_t number, ipc::Request request, std::size_t bytes) override {
    if (const auto* follow = std::get_if<ipc::FollowPen>(&request)) return follow_pen(client, number, *follow);
    if (std::holds_alternative<ipc::LeavePen>(request)) return leave_pen(client, number);
    scheduler.request(client, number, std::move(request), bytes);
  }
  void left(ipc::ClientId client) override {
    if (pen_owner == client) end_pen();
    scheduler.left(client);
    beat();
  }

  void follow_pen(ipc::ClientId client, std::uint64_t number, const ipc::FollowPen& request) {
    Result<ipc::Descriptor> field = followed(client, request);
    if (!field) return answer(client, number, ipc::failed_from(field.error()), {});
    pen_owner = client;
    std::vector<ipc::Descriptor> descriptors;
    descriptors.push_back(std::move(*field));
    answer(client, number, ipc::PenFollowed{}, std::move(descriptors));
  }
  Result<ipc::Descriptor> followed(ipc::ClientId client, const ipc::FollowPen& request) {
    const Result<std::vector<ipc::Descriptor>> given = take_descriptors(client, 1);
    if (!given) return fail(given.error());
    const Result<mesh::field::Placement> placement = placement_of(request);
    if (!placement) return fail(placement.error());
    Result<ipc::PenPageReader> pen = ipc::PenPageReader::map(given->front());
    if (!pen) return fail(std::move(pen.error()));
    return pen_field.follow(std::move(*pen), *placement, request.placement);
  }
  void leave_pen(ipc::ClientId client, std::uint64_t number) {
    if (pen_owner != client) return answer(client, number, ipc::Failed{"", 0, "you follow no pen"}, {});
    end_pen();
    answer(client, number, ipc::Done{}, {});
  }
  void end_pen() {
    pen_field.leave();
    pen_owner.reset();
  }

  // --- to the socket ---

  void answer(ipc::ClientId client, std::uint64_t number, const ipc::Answer& answer, std::vector<ipc::Descriptor> descriptors) override {
    Service::answer(client, number, answer, std::move(descriptors));
  }
  void tell(ipc::ClientId client, const ipc::Event& event) override { Service::tell(client, event); }
  void tell_all(const ipc::Event& event) override {
    Service::tell_all(event);
    beat();
  }
  void shown(const PublishedState& published) override { pen_field.show(published.document); }
  bool follows_pen() const override { return pen_owner.has_value(); }
  void felt(const std::optional<DragFeel>& feel) override { pen_field.show_drag(feel); }
  void post(std::function<void()> work) override { Service::post(std::move(work)); }

  /// The disk takes the journal. An append that fails is said to the client; one that hangs can only be cut off.
  bool is_well() override { return !append_monitor.is_hung(); }

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
    std::vector<daemon::HeartbeatMonitor> watched;
    watched.emplace_back("clients aren't served", loop_heartbeat, periods(std::min(limit, kMaxUnserved)));
    watched.emplace_back("the work under way makes no progress", worker.heartbeat(), periods(limit));
    watchdog.emplace(std::move(watched), kWatchPeriod, end_hung_process);
  }

  void begin() {
    every(std::chrono::nanoseconds(ipc::kHeartbeatPeriodNs), [this] { beat(); });
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
  if (Result<void> listening = state->listen(ipc::model_socket_path(options.runtime_directory), limits()); !listening)
    return fail(std::move(listening.error()));
  state->watch(options.hang_limit);
  state->begin();
  return Daemon(std::move(state));
}

Daemon::Daemon(std::unique_ptr<Impl> state) : impl_(std::move(state)) {}
Daemon::Daemon(Daemon&&) noexcept = default;
Daemon::~Daemon() = default;

void Daemon::run() {
  impl_->loop_heartbeat.begin();
  impl_->run("serves the document");
  impl_->loop_heartbeat.end();
}
void Daemon::stop() { impl_->stop(); }

}  // namespace prismesh::modeld
