#include "daemon/deviced/loop.h"

#include <array>
#include <utility>

namespace prismesh::deviced {

namespace {

using drivers::port::PortStatus;
using drivers::prism_servo::MaskControl;
using drivers::prism_servo::MaskPhase;
using drivers::prism_servo::PrismServo;
using drivers::prism_servo::ServoPhase;
using ipc::EyesPhase;

template <class... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <class... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

void store(std::array<double, 3>& to, const Eigen::Vector3d& from) { to = {from.x(), from.y(), from.z()}; }

/// Compares all fields but the measurements.
bool same_servo(const ServoChanged& a, const ServoChanged& b) {
  return a.open == b.open && a.tick.phase == b.tick.phase && a.tick.trouble == b.tick.trouble &&
         a.tick.trouble_number == b.tick.trouble_number && a.tick.alarm_bits == b.tick.alarm_bits;
}

}  // namespace

DeviceLoop::DeviceLoop(const LoopSettings& settings, const LoopPorts& ports, ipc::DevicePage& page)
    : settings_(settings),
      ports_(ports),
      page_(page),
      tracker_(settings.tracker),
      filter_({settings.tracker.noise_mm}),
      control_(settings.optics, settings.limits) {
  eyes_.lost_after_ns = settings.limits.eyes_lost_ns;
  eyes_.eye_separation_mm = settings.eye_separation_mm;
}

void DeviceLoop::tick(std::int64_t now_ns) {
  take_commands();
  poll_tracker(now_ns);
  publish_eyes(now_ns);
  tick_servo(now_ns, mask_.goal_mm, mask_.powered);
  MaskControl::Input input;
  input.now_ns = now_ns;
  input.head = filter_.state();
  input.head_seen = eyes_.phase == EyesPhase::tracking;
  input.servo = servo_tick_;
  // Decisions made here are sent with the next tick.
  input.servo_lag_ns = (servo_ ? servo_->lag_ns() : 0) + kTickPeriodNs;
  input.picture_mono = picture_mono_;
  input.hold_mm = hold_mm_ ? &*hold_mm_ : nullptr;
  input.rearm = std::exchange(rearm_, false);
  mask_ = control_.step(input);
  page_.set_prism(mask_.state);
  report_changes(now_ns);
}

void DeviceLoop::wind_down(std::int64_t now_ns) {
  release_tracker();
  publish_eyes(now_ns);
  tick_servo(now_ns, servo_tick_.reading.position_mm, false);
  mask_.state.time_ns = now_ns;
  mask_.state.phase = MaskPhase::absent;
  mask_.state.stereo_allowed = false;
  mask_.state.velocity_mm_s = 0;
  page_.set_prism(mask_.state);
}

void DeviceLoop::take_commands() {
  while (const std::optional<LoopCommand> command = commands_.pop()) execute(*command);
}

void DeviceLoop::execute(const LoopCommand& command) {
  std::visit(Overloaded{
                 [&](const SetPictureMono& shown) { picture_mono_ = shown.mono; },
                 [&](const SetHold& hold) { hold_mm_ = hold.position_mm; },
                 [&](const EndHold&) { hold_mm_.reset(); },
                 [&](const RequestRearm&) { rearm_ = true; },
                 [&](const SetDisplay& display) {
                   control_.set_optics(display.optics);
                   eyes_.eye_separation_mm = display.eye_separation_mm;
                 },
             },
             command);
}

DeviceLoop::Tracker* DeviceLoop::attached_tracker() {
  if (Tracker* attached = tracker_.tracker()) return attached;
  if (ports_.tracker_line != nullptr)
    if (drivers::port::BytePort* port = ports_.tracker_line->port()) return &tracker_.attach(*port);
  if (ports_.tracker_datagrams != nullptr)
    if (drivers::port::DatagramPort* port = ports_.tracker_datagrams->port()) return &tracker_.attach(*port);
  return nullptr;
}

void DeviceLoop::release_tracker() {
  tracker_.detach();
  if (ports_.tracker_line != nullptr) ports_.tracker_line->give_back();
  if (ports_.tracker_datagrams != nullptr) ports_.tracker_datagrams->give_back();
}

void DeviceLoop::poll_tracker(std::int64_t now_ns) {
  Tracker* tracker = attached_tracker();
  if (tracker == nullptr) return;
  Tracker::Polled polled = tracker->poll(now_ns);
  // The sample arrived at an unknown moment since the last tick: half a period ago on average.
  polled.sample.measured_ns -= kTickPeriodNs / 2;
  if (polled.fresh) filter_.take(polled.sample);
  const drivers::eye_tracker::LineCounts& counts = tracker->counts();
  eyes_.records = counts.records;
  eyes_.bytes_skipped = counts.bytes_skipped;
  eyes_.resyncs = counts.resyncs;
  if (polled.status == PortStatus::gone) release_tracker();
}

EyesPhase DeviceLoop::eyes_phase(std::int64_t now_ns) {
  if (ports_.tracker_line == nullptr && ports_.tracker_datagrams == nullptr) return EyesPhase::none;
  const Tracker* tracker = tracker_.tracker();
  if (tracker == nullptr) return EyesPhase::absent;
  if (!tracker->synchronised()) return EyesPhase::silent;
  const std::int64_t measured_ns = filter_.state().time_ns;
  const bool fresh = measured_ns != 0 && now_ns - measured_ns <= settings_.limits.eyes_lost_ns;
  return fresh ? EyesPhase::tracking : EyesPhase::searching;
}

void DeviceLoop::publish_eyes(std::int64_t now_ns) {
  const EyesPhase phase = eyes_phase(now_ns);
  if (eyes_.phase == EyesPhase::tracking && phase != EyesPhase::tracking) ++eyes_.times_lost;
  const drivers::eye_tracker::HeadState& head = filter_.state();
  eyes_.time_ns = now_ns;
  eyes_.measured_ns = head.time_ns;
  store(eyes_.between_eyes_mm, head.between_eyes_mm);
  store(eyes_.velocity_mm_s, head.velocity_mm_s);
  store(eyes_.toward_right, head.toward_right);
  eyes_.phase = phase;
  page_.set_eyes(eyes_);
}

void DeviceLoop::tick_servo(std::int64_t now_ns, double goal_mm, bool powered) {
  if (!servo_ && ports_.servo_line != nullptr)
    if (drivers::port::BytePort* port = ports_.servo_line->port()) servo_.emplace(*port, settings_.servo);
  if (!servo_) {
    servo_tick_ = PrismServo::Tick{};
    return;
  }
  servo_tick_ = servo_->tick(now_ns, goal_mm, powered);
  if (servo_tick_.status != PortStatus::gone) return;
  servo_.reset();
  ports_.servo_line->give_back();
  servo_tick_ = PrismServo::Tick{};
}

void DeviceLoop::report_changes(std::int64_t now_ns) {
  // An event that doesn't fit into the ring is sent by a later tick, because the state still differs from the reported one.
  if (eyes_.phase != reported_eyes_ && events_.push(EyesChanged{now_ns, eyes_.phase})) reported_eyes_ = eyes_.phase;
  const MaskPhase mask = mask_.state.phase;
  if (mask != reported_mask_ && events_.push(MaskChanged{now_ns, mask})) reported_mask_ = mask;
  const ServoChanged servo{now_ns, servo_.has_value(), servo_tick_};
  if (!same_servo(servo, reported_servo_) && events_.push(servo)) reported_servo_ = servo;
}

}  // namespace prismesh::deviced
