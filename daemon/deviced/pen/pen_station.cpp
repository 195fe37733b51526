#include "daemon/deviced/pen/pen_station.h"

#include <unistd.h>

#include <algorithm>
#include <utility>

#include "base/file.h"
#include "base/log.h"
#include "drivers/haptic_pen/falcon/falcon_pen.h"
#include "drivers/haptic_pen/hand_script.h"
#include "drivers/port/pty_pair.h"

namespace prismesh::deviced::pen {

namespace {

namespace framed = drivers::haptic_pen::framed;
using drivers::haptics::HapticLimits;
using drivers::haptics::SafetyPhase;
using drivers::haptics::SafetyRecord;

constexpr std::int64_t kTryAgainNs = 250'000'000;
/// Looking through all USB devices takes five milliseconds, where plugs are seen at once; a service that hangs is given a third of a
/// second.
constexpr std::int64_t kLookAgainNs = 1'000'000'000;
/// Far longer than what latches: the line is then opened anew.
constexpr std::int64_t kMaxSilenceOfPenNs = 1'000'000'000;

Result<drivers::haptic_pen::HandSource> simulated_hand(const std::string& script) {
  if (script.empty()) return drivers::haptic_pen::HandSource(framed::wandering_hand);
  const Result<FileBytes> bytes = read_file(script);
  if (!bytes) return fail(bytes.error());
  Result<drivers::haptic_pen::HandScript> parsed = drivers::haptic_pen::HandScript::parse(bytes->text(), script);
  if (!parsed) return fail(std::move(parsed.error()));
  return drivers::haptic_pen::HandSource([parsed = std::move(*parsed)](double seconds) { return parsed.at(seconds); });
}

}  // namespace

PenStation::PenStation(const drivers::settings::HapticPenSettings& settings, LineGuard& guard, FieldReader& fields, ipc::PenPage& page,
                       RecordStore& records)
    : settings_(settings), guard_(guard), fields_(fields), page_(page), records_(records), port_(pen_place(settings)) {}

Result<std::unique_ptr<PenStation>> PenStation::start(const drivers::settings::HapticPenSettings& settings, LineGuard& guard,
                                                      FieldReader& fields, ipc::PenPage& page, RecordStore& records, bool memory_locked) {
  std::unique_ptr<PenStation> station(new PenStation(settings, guard, fields, page, records));
  station->health_.pid = ::getpid();
  station->health_.guard_pid = guard.process();
  station->health_.memory_locked = memory_locked;
  station->feel_.stiffness_newton_m = settings.stiffness_newton_m;
  station->feel_.friction = settings.friction;
  station->feel_.damping_newton_s_m = settings.damping_newton_s_m;
  if (settings.driver == drivers::settings::PenDriver::falcon) {
    if (auto watch = drivers::port::watch_usb(drivers::haptic_pen::falcon::falcon_wanted())) station->plugs_ = std::move(*watch);
  } else if (settings.driver == drivers::settings::PenDriver::simulated && settings.port.empty()) {
    Result<drivers::port::PtyPair> terminal = drivers::port::open_pty_pair();
    if (!terminal) return fail(std::move(terminal.error()));
    station->port_ = terminal->slave_path;
    Result<drivers::haptic_pen::HandSource> hand = simulated_hand(settings.hand_script);
    if (!hand) return fail(std::move(hand.error()));
    station->device_ = std::make_unique<framed::SimulatedDeviceThread>(std::move(terminal->master),
                                                                       drivers::haptic_pen::SimulatedPenOptions{}, std::move(*hand));
  }
  // What the last process has left: it may have died armed.
  const SafetyRecord stored = records.stored();
  if (stored.phase == SafetyPhase::armed)
    if (Result<void> latched = records.store({SafetyPhase::latched, drivers::haptics::SafetyFault::died_armed, 0}); !latched)
      return fail(std::move(latched.error()));
  station->show_absent();
  station->poll();
  return station;
}

PenStation::~PenStation() {
  const bool armed = loop_ && loop_->record().phase == SafetyPhase::armed;
  close_line();
  // It ends in order and the force is zero: nothing has to be found out before the pen is armed again.
  if (armed || arming_) (void)records_.store({});
}

void PenStation::poll() {
  const bool gone = pen_ && pen_->pen().gone();
  const bool sets_up = pen_ && !pen_->pen().advice().empty();
  if (sets_up) heard_ns_ = clock_.now_ns();
  // Where a line has come back under its old name while the old one was held, nothing tells but its silence.
  const bool silent =
      pen_ && !sets_up && clock_.now_ns() - std::max({opened_ns_, heard_ns_, page_.state().measured_ns}) > kMaxSilenceOfPenNs;
  if (gone || silent) {
    store_record();
    close_line();
    trouble_ = gone ? "the line was lost: is the pen plugged in?" : "the line is open, but no poses come from it: is a pen there?";
    logging::warn("{}: {}", port_, trouble_);
    show_absent();
  }
  const bool plugged = plugs_ && std::exchange(plugs_seen_, plugs_->arrived()) != plugs_seen_;
  if (!pen_ && (plugged || clock_.now_ns() >= next_try_ns_)) open_line();
  if (pen_ && (sets_up || page_.state().measured_ns > opened_ns_)) trouble_.clear();
  store_record();
}

void PenStation::open_line() {
  next_try_ns_ = clock_.now_ns() + (settings_.driver == drivers::settings::PenDriver::simulated ? kTryAgainNs : kLookAgainNs);
  Result<std::unique_ptr<OpenPen>> opened = open_pen(settings_, port_, guard_.page());
  if (!opened) {
    if (std::exchange(trouble_, opened.error().text()) != trouble_) logging::warn("{}", trouble_);
    return;
  }
  pen_ = std::move(*opened);
  HapticLimits limits;
  limits.max_newton = settings_.max_newton;
  loop_.emplace(limits, pen_->pen(), fields_, guard_.page(), page_, records_.stored(), feel_, page_.state().arms_answered);
  Result<std::unique_ptr<PenThread>> started = PenThread::start(*loop_, guard_.page(), page_, health_);
  Result<void> watched = started ? pen_->hand_to(guard_) : Result<void>(fail(started.error()));
  if (started) thread_ = std::move(*started);
  if (!watched) {
    trouble_ = watched.error().text();
    logging::error("{}", trouble_);
    return close_line();
  }
  if (!thread_->refused().empty() && refused_.empty()) logging::warn("{}", refused_ = thread_->refused());
  opened_ns_ = clock_.now_ns();
  // A line that is opened anew for its silence keeps its trouble until a pose comes.
  if (!trouble_.empty()) logging::info("{}: open again", port_);
}

void PenStation::close_line() {
  thread_.reset();
  guard_.release();
  loop_.reset();
  pen_.reset();
}

void PenStation::show_absent() {
  ipc::PenState state = page_.state();
  state.time_ns = clock_.now_ns();
  const SafetyRecord& record = records_.stored();
  state.stage = record.phase == SafetyPhase::latched ? ipc::PenStage::latched : ipc::PenStage::absent;
  state.fault = record.fault;
  state.newton = {};
  state.touching = false;
  page_.set_state(state);
}

void PenStation::store_record() {
  if (!loop_) return;
  // The loop's record follows once it has answered; until then the disk says armed.
  if (arming_ && page_.state().arms_answered == arms_before_) return;
  arming_ = false;
  if (Result<void> stored = records_.store(loop_->record()); !stored) {
    logging::error("the pen's state can't be stored, so it is disarmed: {}", stored.error().text());
    loop_->send(RequestDisarm{});
  }
}

Result<void> PenStation::arm() {
  if (!loop_) return fail("", "the pen isn't there" + (trouble().empty() ? std::string() : ": " + trouble()));
  if (!guard_.is_alive()) return fail("", "nobody guards the pen's line");
  if (arming_) return fail("", "the pen is being armed already");
  arms_before_ = page_.state().arms_answered;
  if (Result<void> stored = records_.store({SafetyPhase::armed, {}, 0}); !stored) return stored;
  arming_ = true;
  if (!loop_->send(RequestArm{})) return fail("", "the loop takes no requests");
  return {};
}

Result<void> PenStation::disarm() {
  if (loop_ && !loop_->send(RequestDisarm{})) return fail("", "the loop takes no requests");
  return {};
}

void PenStation::use(const drivers::haptics::Feel& feel) {
  feel_ = feel;
  if (loop_) loop_->send(UseFeel{feel});
}

}  // namespace prismesh::deviced::pen
