#include "daemon/deviced/pen/weigh.h"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/file.h"
#include "daemon/deviced/pen/line_guard.h"
#include "daemon/deviced/pen/open_pen.h"
#include "daemon/deviced/pen/pen_thread.h"
#include "daemon/deviced/pen/weighing_line.h"
#include "daemon/deviced/realtime/realtime.h"
#include "drivers/haptic_pen/weighing.h"
#include "drivers/settings/settings.h"
#include "ipc/wire/runtime_directory.h"
#include "ipc/wire/server.h"

namespace prismesh::deviced::pen {
namespace {

using drivers::haptic_pen::HapticPen;
using drivers::haptic_pen::Weighing;
using drivers::haptic_pen::WeighingOptions;
using drivers::haptic_pen::WeighingStep;

constexpr int kZerosAtEnd = 20;

/// Ticks the weighing in real time; the other side only reads its step.
class WeighingThread {
 public:
  WeighingThread(Weighing& weighing, HapticPen& pen, GuardPage& guard) : weighing_(weighing), pen_(pen), line_(pen, guard) {}
  ~WeighingThread() { end(); }
  WeighingThread(const WeighingThread&) = delete;
  WeighingThread& operator=(const WeighingThread&) = delete;

  Result<void> start() {
    if (Result<void> started = start_realtime_thread("pen weighing", enter, this, thread_); !started) return started;
    running_ = true;
    return {};
  }
  /// Sends zeros and ends the thread.
  void end() {
    stop_ = true;
    if (std::exchange(running_, false)) ::pthread_join(thread_.thread, nullptr);
  }
  void go_on() { go_on_ = true; }
  WeighingStep step() const { return step_; }
  bool tripped() const { return tripped_; }

 private:
  static void* enter(void* self) {
    static_cast<WeighingThread*>(self)->run();
    return nullptr;
  }
  void run() {
    std::int64_t due_ns = clock_.now_ns();
    while (!stop_) {
      sleep_until(due_ns);
      const std::int64_t now_ns = clock_.now_ns();
      if (go_on_.exchange(false)) weighing_.go_on(now_ns);
      if (line_.send(now_ns, weighing_.tick(pen_.read(now_ns), now_ns))) tripped_ = true;
      step_ = weighing_.step();
      due_ns = next_pen_tick_ns(due_ns, clock_.now_ns());
    }
    for (int i = 0; i < kZerosAtEnd; ++i) {
      line_.send(clock_.now_ns(), Eigen::Vector3d::Zero());
      sleep_until(clock_.now_ns() + kPenPeriodNs);
    }
  }
  Weighing& weighing_;
  HapticPen& pen_;
  WeighingLine line_;
  MonotonicClock clock_;
  std::atomic<WeighingStep> step_ = WeighingStep::wait_for_pen;
  std::atomic<bool> go_on_ = false, stop_ = false, tripped_ = false;
  bool running_ = false;
  StartedThread thread_;
};

void tell(const std::string& sentence) {
  std::printf("%s\n", sentence.c_str());
  std::fflush(stdout);
}

/// True: a line has come; false: not yet. Error: there will be none.
Result<bool> line_came(int input, int patience_ms) {
  pollfd waiting{input, POLLIN, 0};
  if (::poll(&waiting, 1, patience_ms) <= 0) return false;
  char each = 0;
  for (;;) {
    if (::read(input, &each, 1) != 1) return fail("--weigh", "the input ended: it needs a terminal, where Enter is pressed");
    if (each == '\n') return true;
    if (::poll(&waiting, 1, 0) <= 0) return false;
  }
}

std::string asked_in(WeighingStep step, double grams) {
  switch (step) {
    case WeighingStep::ask_empty:
      return "1. Take everything off the grip and let go of it. The pen will carry it up and down by itself, slowly.\n"
             "   Keep your hands away, then press Enter.";
    case WeighingStep::empty: return "   It moves without the weight ..";
    case WeighingStep::ask_weight:
      return fmt::format(
          "2. Hang {:g} g on the grip, on a short thread, so that the weight hangs free and doesn't swing, and let go.\n"
          "   Press Enter.",
          grams);
    case WeighingStep::loaded: return "   It moves with the weight ..";
    case WeighingStep::wait_for_pen:
    case WeighingStep::done:
    case WeighingStep::failed: break;
  }
  return {};
}

Result<void> guide(WeighingThread& thread, HapticPen& pen, LineGuard& guard, const WeighPenOptions& options) {
  WeighingStep told = WeighingStep::wait_for_pen;
  std::string advised;
  for (;;) {
    const WeighingStep step = thread.step();
    if (step == WeighingStep::done || step == WeighingStep::failed) return {};
    if (thread.tripped()) return fail("--weigh", "the pen's guard had to end the force: this machine was too busy; begin again");
    if (!guard.is_alive()) return fail("--weigh", "nobody guards the pen's line any more");
    if (pen.gone()) return fail("--weigh", "the line was lost: is the pen plugged in?");
    if (step == WeighingStep::wait_for_pen)
      if (std::string advice = pen.advice(); !advice.empty() && advice != advised) tell(advised = std::move(advice));
    if (std::exchange(told, step) != step) tell(asked_in(step, options.grams));
    const Result<bool> line = line_came(options.input, 50);
    if (!line) return fail(line.error());
    // Enter pressed early isn't for the next question.
    if (*line && thread.step() == told) thread.go_on();
  }
}

}  // namespace

Result<double> grams_of(const std::string& text) {
  double grams = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), grams);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(grams))
    return fail("--weigh", "must be a weight in grams, not " + text);
  return grams;
}

Result<void> weigh_pen(const WeighPenOptions& options) {
  const Result<drivers::settings::StationSettings> read = drivers::settings::read_settings(options.config);
  if (!read) return fail(read.error());
  const drivers::settings::HapticPenSettings& settings = read->haptic_pen;
  if (settings.driver == drivers::settings::PenDriver::none ||
      (settings.driver == drivers::settings::PenDriver::simulated && settings.port.empty()))
    return fail("--weigh", "no device is configured that could be weighed: set haptic_pen.driver in prismesh.toml");
  const WeighingOptions weight{options.grams, settings.max_newton, settings.force_scale};
  if (Result<void> fits = check(weight); !fits) return fits;
  if (Result<void> made = make_folders(options.state_directory); !made) return made;
  const Result<ipc::Descriptor> lock = ipc::lock_folder(options.state_directory, "pen.lock", "a pen daemon");
  if (!lock) return fail(lock.error());
  Result<LineGuard> guard = LineGuard::start(options.state_directory);
  if (!guard) return fail(std::move(guard.error()));
  (void)lock_memory();
  Result<std::unique_ptr<OpenPen>> opened = open_pen(settings, pen_place(settings), guard->page());
  if (!opened) return fail(std::move(opened.error()));
  Weighing weighing(weight);
  {
    WeighingThread thread(weighing, (*opened)->pen(), guard->page());
    if (Result<void> started = thread.start(); !started) return started;
    if (Result<void> watched = (*opened)->hand_to(*guard); !watched) return watched;
    if (Result<void> guided = guide(thread, (*opened)->pen(), *guard, options); !guided) return guided;
  }
  guard->release();
  if (weighing.step() == WeighingStep::failed) return fail("--weigh", words_of(weighing.fault()));
  tell(
      fmt::format("Asked for {:.3f} N, it carried {:.3f} N ({:g} g). Up and down differ by {:.3f} N each way: friction.\n"
                  "So that its newtons are true, set in prismesh.toml:\n\n[haptic_pen]\nforce_scale = {:.3f}",
                  weighing.asked_newton(), weight.newton(), options.grams, weighing.friction_newton(), weighing.force_scale()));
  return {};
}

}  // namespace prismesh::deviced::pen
