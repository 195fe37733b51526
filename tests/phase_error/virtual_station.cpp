#include "tests/phase_error/virtual_station.h"

#include <algorithm>
#include <array>
#include <deque>
#include <memory>
#include <optional>

#include "base/clock.h"
#include "daemon/deviced/loop.h"
#include "drivers/eye_tracker/configured/tracker.h"
#include "drivers/eye_tracker/dynasight/simulator.h"
#include "drivers/port/memory_line.h"
#include "drivers/prism_servo/dynamixel/simulated_servo.h"
#include "ipc/device/page.h"
#include "kiosk/stereo/lit_time.h"

namespace prismesh::phase_error {
namespace {

using drivers::eye_tracker::HeadState;
using drivers::port::MemoryLine;
using drivers::port::PortKeeper;
using drivers::prism_servo::MaskControl;
namespace dynamixel = drivers::prism_servo::dynamixel;
namespace dynasight = drivers::eye_tracker::dynasight;

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kStartNs = 1'000 * kMs;  // not 0, as with a real machine's clock
constexpr std::int64_t kSettleNs = 2'000 * kMs;
constexpr std::int64_t kDeviceStepNs = kMs / 2;

deviced::LoopSettings loop_settings(const VirtualStationSettings& settings) {
  deviced::LoopSettings loop;
  loop.tracker.driver = drivers::settings::TrackerDriver::dynasight;
  loop.tracker.latency_ms = settings.tracker_latency_s * 1e3;
  loop.tracker.noise_mm = settings.noise_mm;
  loop.optics = settings.profile.optics;
  return loop;
}

/// Replaces deviced's loop for runs without prediction: takes the newest measurement as the head's present position.
class PlainLoop {
 public:
  PlainLoop(const deviced::LoopSettings& settings, drivers::port::BytePort& tracker, drivers::port::BytePort& servo, ipc::DevicePage& page)
      : tracker_(settings.tracker), servo_(servo, settings.servo), control_(settings.optics, settings.limits), page_(page) {
    tracker_.attach(tracker);
  }
  void tick(std::int64_t now_ns) {
    const auto polled = tracker_.tracker()->poll(now_ns);
    if (polled.fresh) head_ = {polled.sample.measured_ns, polled.sample.between_eyes_mm, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX()};
    ipc::EyesState eyes;
    eyes.time_ns = now_ns;
    eyes.measured_ns = head_.time_ns;
    eyes.between_eyes_mm = {head_.between_eyes_mm.x(), head_.between_eyes_mm.y(), head_.between_eyes_mm.z()};
    eyes.phase = head_.time_ns != 0 ? ipc::EyesPhase::tracking : ipc::EyesPhase::searching;
    page_.set_eyes(eyes);
    MaskControl::Input input;
    input.now_ns = now_ns;
    input.head = head_;
    input.head_seen = head_.time_ns != 0;
    input.servo = servo_.tick(now_ns, mask_.goal_mm, mask_.powered);
    input.servo_lag_ns = servo_.lag_ns();
    mask_ = control_.step(input);
    mask_.state.velocity_mm_s = mask_.state.goal_velocity_mm_s = 0;
    page_.set_prism(mask_.state);
  }

 private:
  drivers::eye_tracker::configured::ConfiguredTracker tracker_;
  dynamixel::Servo servo_;
  MaskControl control_;
  MaskControl::Output mask_;
  HeadState head_;
  ipc::DevicePage& page_;
};

/// The kiosk's part: reads the page at each refresh, draws, and passes the picture on; the display shows it from the next refresh on.
class Display {
 public:
  Display(const ipc::DevicePageReader& page, std::int64_t draw_ns) : page_(page), eyes_({}), timing_(kTiming), draw_ns_(draw_ns) {}

  std::int64_t next_ns() const { return drawing_ ? *drawing_ + draw_ns_ : refresh_ns_ + kTiming.period_ns; }
  void work(std::int64_t now_ns) {
    if (drawing_) {
      timing_.drawn(now_ns);
      timing_.refreshed(refresh_ns_, now_ns);
      const std::int64_t shown_ns = refresh_ns_ + kTiming.period_ns;
      waiting_.push_back({shown_ns + kTiming.period_ns / 2 + kTiming.panel_latency_ns, drawn_for_});
      drawing_.reset();
      return;
    }
    refresh_ns_ = now_ns;
    timing_.begun(now_ns);
    drawn_for_ = eyes_.look({page_.eyes(), page_.prism()}, now_ns, timing_.lit(now_ns));
    drawing_ = now_ns;
  }
  struct Lit {
    std::int64_t from_ns = 0;
    kiosk::stereo::SeenFrom drawn;
  };
  /// The picture that is lit, if any.
  const Lit* lit(std::int64_t now_ns) {
    while (waiting_.size() > 1 && waiting_[1].from_ns <= now_ns) waiting_.pop_front();
    return !waiting_.empty() && waiting_.front().from_ns <= now_ns ? &waiting_.front() : nullptr;
  }
  static constexpr kiosk::stereo::DisplayTiming kTiming{};

 private:
  const ipc::DevicePageReader& page_;
  kiosk::stereo::TrackedEyes eyes_;
  kiosk::stereo::PictureTiming timing_;
  std::int64_t draw_ns_;
  std::int64_t refresh_ns_ = kStartNs;
  std::optional<std::int64_t> drawing_;
  kiosk::stereo::SeenFrom drawn_for_;
  std::deque<Lit> waiting_;
};

/// Both devices on their lines.
struct Devices {
  Devices(Clock& clock, const VirtualStationSettings& settings)
      : tracker_line(clock, {.host_baud = 19200, .device_baud = 19200, .latency_ns = settings.line_latency_ns}),
        servo_line(clock, {.host_baud = 57'600, .device_baud = 57'600, .latency_ns = settings.line_latency_ns}),
        tracker(tracker_line.device(), settings.head,
                {.noise_mm = settings.noise_mm,
                 .latency_ns = static_cast<std::int64_t>(settings.tracker_latency_s * 1e9),
                 .seed = settings.seed}),
        servo(servo_line.device(), {}) {}
  MemoryLine tracker_line, servo_line;
  dynasight::DynasightSimulator tracker;
  dynamixel::SimulatedServo servo;
};

}  // namespace

drivers::display::Profile on_panel(const std::string& profile) {
  drivers::display::Profile found = drivers::display::find_profile(profile).value();
  found.optics.panel_columns = 1280;
  return found;
}

void run(const VirtualStationSettings& settings, double seconds, const std::function<void(const Moment&)>& see) {
  ManualClock clock;
  clock.advance_ns(kStartNs);
  Devices devices(clock, settings);
  ipc::DevicePage page = ipc::DevicePage::create().value();
  const ipc::DevicePageReader reader = ipc::DevicePageReader::map(page.descriptor()).value();
  const deviced::LoopSettings loop_set = loop_settings(settings);
  PortKeeper tracker_port(clock, [&] { return devices.tracker_line.open_host(); });
  PortKeeper servo_port(clock, [&] { return devices.servo_line.open_host(); });
  tracker_port.work();
  servo_port.work();
  std::optional<deviced::DeviceLoop> loop;
  std::optional<PlainLoop> plain;
  if (settings.predicts)
    loop.emplace(loop_set, deviced::LoopPorts{&tracker_port, nullptr, &servo_port}, page);
  else
    plain.emplace(loop_set, *tracker_port.port(), *servo_port.port(), page);
  Display display(reader, settings.draw_ns);
  devices.tracker.run_until(kStartNs);

  const std::int64_t end_ns = kStartNs + static_cast<std::int64_t>(seconds * 1e9);
  std::int64_t next_tick = kStartNs + kMs / 3, next_step = kStartNs + kDeviceStepNs;
  // A quarter and three quarters of a refresh period after the picture lights up.
  const std::int64_t look_period = Display::kTiming.period_ns / 2;
  std::int64_t next_look = kStartNs + kSettleNs;
  bool aligned = false;
  while (clock.now_ns() < end_ns) {
    const std::int64_t next = std::min({next_tick, next_step, display.next_ns(), next_look});
    clock.advance_ns(next - clock.now_ns());
    if (next == next_step) {
      devices.tracker.run_until(next);
      devices.servo.step(next);
      next_step += kDeviceStepNs;
    }
    if (next == next_tick) {
      if (loop)
        loop->tick(next);
      else
        plain->tick(next);
      next_tick += deviced::kTickPeriodNs;
    }
    if (next == display.next_ns()) display.work(next);
    if (next != next_look) continue;
    const Display::Lit* lit = display.lit(next);
    if (!aligned && lit != nullptr) {
      next_look = lit->from_ns + 2 * Display::kTiming.period_ns + look_period / 2;
      aligned = true;
      continue;
    }
    next_look += look_period;
    if (lit == nullptr) continue;
    see({next - kStartNs, settings.head(static_cast<double>(next - kStartNs) * 1e-9).between_eyes_mm, devices.servo.mask_mm(), lit->drawn});
  }
}

}  // namespace prismesh::phase_error
