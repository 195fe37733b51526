#include "daemon/deviced/pen/pen_daemon.h"

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

#include "base/file.h"
#include "base/log.h"
#include "daemon/common/service.h"
#include "daemon/deviced/pen/pen_station.h"
#include "drivers/haptics/safety_words.h"
#include "ipc/pen/client.h"
#include "ipc/pen/messages_json.h"
#include "ipc/pen/roles.h"

namespace prismesh::deviced::pen {

namespace {

using Time = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kPollPeriod{5};
constexpr std::chrono::milliseconds kReportPause{500};
constexpr std::chrono::milliseconds kArmPatience{1000};

ipc::ServerLimits limits() {
  ipc::ServerLimits limits;
  limits.line_bytes = std::size_t{64} * 1024;
  limits.queue_bytes = std::size_t{1024} * 1024;
  limits.descriptors = 1;
  return limits;
}

struct PenProtocol {
  using Request = ipc::PenRequest;
  using Answer = ipc::PenAnswer;
  using Event = ipc::PenEvent;
  using Hello = ipc::PenHello;
  static constexpr int kVersion = ipc::kPenProtocolVersion;
  static auto decode(std::string_view line) { return ipc::decode_pen_request(line); }
  static std::string encode_answer(std::uint64_t to, const Answer& answer, std::size_t descriptors) {
    return ipc::encode_pen_answer(to, answer, descriptors);
  }
  static std::string encode_event(const Event& event) { return ipc::encode_pen_event(event); }
  static bool must_be_told(const Answer&) { return false; }
};

}  // namespace

/// Members stand in the order of their construction; they end in reverse: loop, fields, guard.
struct PenDaemon::Impl final : daemon::Service<PenProtocol> {
  Impl(drivers::settings::HapticPenSettings wanted, ipc::PenPage made, RecordStore store)
      : settings(std::move(wanted)), page(std::move(made)), records(std::move(store)) {
    feel.stiffness_newton_m = settings.stiffness_newton_m;
    feel.friction = settings.friction;
    feel.damping_newton_s_m = settings.damping_newton_s_m;
  }

  struct Arming {
    ipc::ClientId client = 0;
    std::uint64_t number = 0;
    std::uint64_t answered_before = 0;
    Time::time_point until;
  };

  drivers::settings::HapticPenSettings settings;
  ipc::Descriptor lock;  ///< of the state's folder
  ipc::PenPage page;
  RecordStore records;
  drivers::haptics::Feel feel;
  bool memory_locked = false;
  int status = 0;
  std::optional<Arming> arming;
  ipc::PenInfo reported;
  Time::time_point reported_at{};
  std::optional<LineGuard> guard;
  std::optional<FieldReader> fields;
  std::unique_ptr<PenStation> station;
  const daemon::Heartbeat* watched = nullptr;
  std::optional<daemon::HeartbeatMonitor> ticking;

  bool has_pen() const { return settings.driver != drivers::settings::PenDriver::none; }

  Result<void> start_pen() {
    fields.emplace();
    Result<std::unique_ptr<PenStation>> started = PenStation::start(settings, *guard, *fields, page, records, memory_locked);
    if (!started) return fail(std::move(started.error()));
    station = std::move(*started);
    return {};
  }

  /// A tick was in time since the last report. A loop without a line has none.
  bool is_well() override {
    const daemon::Heartbeat* beats = station ? station->heartbeat() : nullptr;
    if (std::exchange(watched, beats) != beats) {
      ticking.reset();
      if (beats != nullptr) ticking.emplace("no tick came in time", *beats, 1);
    }
    return !ticking || !ticking->is_hung();
  }

  ipc::PenInfo info() {
    ipc::PenInfo info;
    info.max_newton = settings.max_newton;
    info.stiffness_newton_m = feel.stiffness_newton_m;
    info.friction = feel.friction;
    info.damping_newton_s_m = feel.damping_newton_s_m;
    info.workspace_scale = settings.workspace_scale;
    info.left_handed = settings.left_handed;
    const ipc::PenState state = page.state();
    info.state = name(state.stage);
    if (!has_pen()) return info;
    info.simulated = settings.driver == drivers::settings::PenDriver::simulated;
    info.kind = info.simulated ? "simulated" : settings.driver == drivers::settings::PenDriver::inverse3 ? "inverse3" : "falcon";
    info.where = station->where();
    info.trouble = station->trouble();
    if (info.trouble.empty() && state.stage == ipc::PenStage::latched) info.trouble = fault_sentence(state.fault);
    return info;
  }

  void poll() {
    if (!station) return;
    if (!guard->is_alive()) {
      logging::critical("the process that guards the pen's line has ended, so this one ends to be started again");
      status = kUnguardedStatus;
      return stop();
    }
    station->poll();
    answer_arming();
    const ipc::PenInfo now = info();
    if (now == reported || Time::now() - reported_at < kReportPause) return;
    reported = now;
    reported_at = Time::now();
    const std::string what = "haptic pen (" + now.kind + ", " + now.where + "): " + now.state;
    if (now.trouble.empty())
      logging::info("{}", what);
    else
      logging::warn("{}: {}", what, now.trouble);
    tell_all(ipc::PenChanged{now});
  }

  void answer_arming() {
    if (!arming) return;
    const ipc::PenState state = page.state();
    if (state.arms_answered == arming->answered_before) {
      if (Time::now() < arming->until) return;
      answer(arming->client, arming->number, ipc::Failed{"", 0, "the loop didn't answer", {}});
    } else if (state.arm_refused) {
      answer(arming->client, arming->number,
             ipc::Failed{"",
                         0,
                         "the pen can't be armed now (" + std::string(name(state.stage)) +
                             "): it must be ready, send poses, and touch nothing; move it away from the shells and try again",
                         {}});
    } else {
      answer(arming->client, arming->number, ipc::Done{});
    }
    arming.reset();
  }

  // --- from the socket ---

  Result<Welcomed> welcome(ipc::ClientId) override {
    Result<ipc::Descriptor> shared = page.descriptor().duplicate();
    if (!shared) return fail(std::move(shared.error()));
    Welcomed welcomed{ipc::PenWelcome{ipc::kPenProtocolVersion, PRISMESH_VERSION}, {}};
    welcomed.descriptors.push_back(std::move(*shared));
    return welcomed;
  }

  void request(ipc::ClientId client, std::uint64_t number, ipc::PenRequest request, std::size_t) override {
    if (std::holds_alternative<ipc::ArmPen>(request)) return arm(client, number);
    answer(client, number, std::visit([&](const auto& wanted) { return done(client, wanted); }, request));
  }

  void arm(ipc::ClientId client, std::uint64_t number) {
    if (const auto failed = no_pen()) return answer(client, number, *failed);
    if (arming) return answer(client, number, ipc::Failed{"", 0, "the pen is being armed already", {}});
    const std::uint64_t before = page.state().arms_answered;
    if (Result<void> asked = station->arm(); !asked) return answer(client, number, ipc::failed_from(asked.error()));
    logging::info("{} (client {}) arms the pen", greeted().at(client), client);
    arming = Arming{client, number, before, Time::now() + kArmPatience};
  }

  template <class Other>
  ipc::PenAnswer done(ipc::ClientId, const Other&) {
    return ipc::Done{};  // hello and arm are handled elsewhere
  }

  std::optional<ipc::Failed> no_pen() const {
    if (station) return std::nullopt;
    return ipc::Failed{"", 0, "no haptic pen is configured: set haptic_pen.driver in prismesh.toml", {}};
  }

  ipc::PenAnswer done(ipc::ClientId, const ipc::GetPen&) { return ipc::Pen{info()}; }

  ipc::PenAnswer done(ipc::ClientId, const ipc::DisarmPen&) {
    if (const auto failed = no_pen()) return *failed;
    if (Result<void> asked = station->disarm(); !asked) return ipc::failed_from(asked.error());
    return ipc::Done{};
  }

  ipc::PenAnswer done(ipc::ClientId, const ipc::SetFeel& wanted) {
    if (const auto failed = no_pen()) return *failed;
    const auto refusal = [](const char* field, const std::optional<double>& value, double max) -> std::optional<ipc::Failed> {
      if (!value || (*value >= 0 && *value <= max)) return std::nullopt;
      return ipc::Failed{"", 0, fmt::format("{} must be from 0 to {}, not {}", field, max, *value), {}};
    };
    if (const auto wrong = refusal("stiffness_newton_m", wanted.stiffness_newton_m, 5000)) return *wrong;
    if (const auto wrong = refusal("friction", wanted.friction, 1)) return *wrong;
    if (const auto wrong = refusal("damping_newton_s_m", wanted.damping_newton_s_m, 5)) return *wrong;
    feel.stiffness_newton_m = wanted.stiffness_newton_m.value_or(feel.stiffness_newton_m);
    feel.friction = wanted.friction.value_or(feel.friction);
    feel.damping_newton_s_m = wanted.damping_newton_s_m.value_or(feel.damping_newton_s_m);
    station->use(feel);
    return ipc::Done{};
  }

  ipc::PenAnswer done(ipc::ClientId client, const ipc::AttachField&) {
    Result<std::vector<ipc::Descriptor>> given = take_descriptors(client, 1);
    if (!given) return ipc::failed_from(given.error());
    if (const auto failed = no_pen()) return *failed;
    Result<ipc::HapticFieldPageReader> reader = ipc::HapticFieldPageReader::map(given->front());
    if (!reader) return ipc::failed_from(reader.error());
    fields->attach(std::move(*reader));
    logging::info("{} (client {}) gives the haptic field", greeted().at(client), client);
    return ipc::Done{};
  }
};

Result<PenDaemon> PenDaemon::start(const PenDaemonOptions& options) {
  Result<drivers::settings::StationSettings> settings = drivers::settings::read_settings(options.config);
  if (!settings) return fail(std::move(settings.error()));
  if (Result<void> made = make_folders(options.state_directory); !made) return fail(std::move(made.error()));
  Result<ipc::Descriptor> lock = ipc::lock_folder(options.state_directory, "pen.lock", "a pen daemon");
  if (!lock) return fail(std::move(lock.error()));
  Result<ipc::PenPage> page = ipc::PenPage::create();
  if (!page) return fail(std::move(page.error()));
  page->set_state({});
  auto state = std::make_unique<Impl>(settings->haptic_pen, std::move(*page), RecordStore(options.state_directory));
  state->lock = std::move(*lock);
  const std::filesystem::path socket = ipc::pen_socket_path(options.runtime_directory);
  if (Result<void> listening = state->listen(socket, limits()); !listening) return fail(std::move(listening.error()));
  if (!state->has_pen()) return PenDaemon(std::move(state));
  Result<LineGuard> guard = LineGuard::start(options.state_directory);
  if (!guard) return fail(std::move(guard.error()));
  state->guard.emplace(std::move(*guard));
  if (const std::string refused = lock_memory(); refused.empty())
    state->memory_locked = true;
  else
    logging::warn("{}", refused);
  if (Result<void> started = state->start_pen(); !started) return fail(std::move(started.error()));
  state->every(kPollPeriod, [state = state.get()] { state->poll(); });
  return PenDaemon(std::move(state));
}

PenDaemon::PenDaemon(std::unique_ptr<Impl> state) : impl_(std::move(state)) {}
PenDaemon::PenDaemon(PenDaemon&&) noexcept = default;
PenDaemon::~PenDaemon() = default;

int PenDaemon::run() {
  impl_->run(impl_->has_pen() ? "drives the haptic pen" : "no haptic pen is configured");
  return impl_->status;
}
void PenDaemon::stop() { impl_->stop(); }

}  // namespace prismesh::deviced::pen
