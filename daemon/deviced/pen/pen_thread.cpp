#include "daemon/deviced/pen/pen_thread.h"

#include <algorithm>
#include <cmath>

namespace prismesh::deviced::pen {

namespace {

constexpr std::uint32_t kTicksOfTable = 1000;
constexpr int kWindDownFrames = 5;

}  // namespace

std::int64_t next_pen_tick_ns(std::int64_t due_ns, std::int64_t ended_ns) {
  return due_ns + kPenPeriodNs * std::max<std::int64_t>(1, (ended_ns - due_ns) / kPenPeriodNs);
}

void TimeTable::add(std::int64_t ns) {
  const std::int64_t us = std::clamp<std::int64_t>((ns + 999) / 1000, 0, kPlaces - 1);
  ++places_[static_cast<std::size_t>(us)];
  ++count_;
}

std::int64_t TimeTable::share_ns(double share) const {
  const auto wanted = static_cast<std::uint32_t>(std::ceil(share * count_));
  std::uint32_t passed = 0;
  for (std::size_t us = 0; us < kPlaces; ++us) {
    passed += places_[us];
    if (passed >= wanted && passed > 0) return static_cast<std::int64_t>(us) * 1000;
  }
  return 0;
}

void TimeTable::clear() {
  places_.fill(0);
  count_ = 0;
}

Result<std::unique_ptr<PenThread>> PenThread::start(PenLoop& loop, GuardPage& guard, ipc::PenPage& page, const ipc::PenHealth& health) {
  std::unique_ptr<PenThread> made(new PenThread(loop, guard, page));
  made->health_ = health;
  made->heartbeat_.begin();  // before the thread runs: one that never begins is missed too
  if (Result<void> started = start_realtime_thread("pen loop", enter, made.get(), made->thread_); !started)
    return fail(std::move(started.error()));
  made->running_ = true;
  return made;
}

PenThread::~PenThread() {
  if (!running_) return;
  stop_ = true;
  ::pthread_join(thread_.thread, nullptr);
}

void* PenThread::enter(void* self) {
  ::pthread_setname_np(::pthread_self(), "pen loop");  // the name that top and chrt show
  static_cast<PenThread*>(self)->run();
  return nullptr;
}

void PenThread::run() {
  health_.realtime = thread_.realtime;
  std::int64_t due_ns = clock_.now_ns();
  while (!stop_.load(std::memory_order_relaxed)) {
    sleep_until(due_ns);
    const std::int64_t began_ns = clock_.now_ns();
    const std::int64_t cpu_ns = thread_cpu_ns();
    loop_.tick(began_ns);
    record_timing(due_ns, began_ns, thread_cpu_ns() - cpu_ns);
    heartbeat_.beat();
    due_ns = next_pen_tick_ns(due_ns, clock_.now_ns());
  }
  heartbeat_.end();
  for (int tick = 0; tick < kWindDownFrames; ++tick) {
    loop_.wind_down(clock_.now_ns());
    sleep_until(clock_.now_ns() + kPenPeriodNs);
  }
}

void PenThread::record_timing(std::int64_t due_ns, std::int64_t began_ns, std::int64_t cpu_ns) {
  const std::int64_t late_ns = began_ns - due_ns;
  if (late_ns > kPenPeriodNs) ++health_.ticks_late;
  health_.worst_late_ns = std::max(health_.worst_late_ns, late_ns);
  cpu_.add(cpu_ns);
  late_.add(late_ns);
  ++health_.ticks;
  if (cpu_.count() >= kTicksOfTable) {
    health_.cpu_p50_ns = cpu_.share_ns(0.5);
    health_.cpu_p99_ns = cpu_.share_ns(0.99);
    health_.late_p99_ns = late_.share_ns(0.99);
    cpu_.clear();
    late_.clear();
  }
  health_.heartbeat_ns = began_ns;
  health_.guard_trips = guard_.trips.load();
  health_.guard_silence_ns = guard_.silence_ns.load();
  page_.set_health(health_);
}

}  // namespace prismesh::deviced::pen
