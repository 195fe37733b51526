#include "daemon/deviced/loop_thread.h"

#include <algorithm>

#include <unistd.h>

namespace prismesh::deviced {

namespace {

/// How long the servo may take to receive the torque-off command.
constexpr int kWindDownTicks = 25;

}  // namespace

std::int64_t next_due_ns(std::int64_t due_ns, std::int64_t ended_ns) {
  return due_ns + kTickPeriodNs * std::max<std::int64_t>(1, (ended_ns - due_ns) / kTickPeriodNs);
}

Result<std::unique_ptr<LoopThread>> LoopThread::start(DeviceLoop& loop, ipc::DevicePage& page, bool memory_locked, bool simulated) {
  std::unique_ptr<LoopThread> made(new LoopThread(loop, page));
  made->health_.pid = ::getpid();
  made->health_.memory_locked = memory_locked;
  made->health_.simulated = simulated;
  made->heartbeat_.begin();  // before the thread runs: one that never begins is missed too
  if (Result<void> started = start_realtime_thread("device loop", enter, made.get(), made->thread_); !started)
    return fail(std::move(started.error()));
  made->running_ = true;
  return made;
}

LoopThread::~LoopThread() {
  if (!running_) return;
  stop_ = true;
  ::pthread_join(thread_.thread, nullptr);
}

void* LoopThread::enter(void* self) {
  ::pthread_setname_np(::pthread_self(), "device loop");  // the name that top and chrt show
  static_cast<LoopThread*>(self)->run();
  return nullptr;
}

void LoopThread::run() {
  health_.realtime = thread_.realtime;
  std::int64_t due_ns = clock_.now_ns();
  while (!stop_.load(std::memory_order_relaxed)) {
    sleep_until(due_ns);
    const std::int64_t began_ns = clock_.now_ns();
    const std::int64_t cpu_ns = thread_cpu_ns();
    loop_.tick(began_ns);
    record_timing(due_ns, began_ns, thread_cpu_ns() - cpu_ns);
    heartbeat_.beat();
    due_ns = next_due_ns(due_ns, clock_.now_ns());
  }
  heartbeat_.end();
  for (int tick = 0; tick < kWindDownTicks; ++tick) {
    loop_.wind_down(clock_.now_ns());
    sleep_until(clock_.now_ns() + kTickPeriodNs);
  }
}

void LoopThread::record_timing(std::int64_t due_ns, std::int64_t began_ns, std::int64_t cpu_ns) {
  const std::int64_t late_ns = began_ns - due_ns;
  if (late_ns > kTickPeriodNs) ++health_.ticks_late;
  health_.worst_late_ns = std::max(health_.worst_late_ns, late_ns);
  costs_[health_.ticks % costs_.size()] = cpu_ns;
  ++health_.ticks;
  if (health_.ticks % costs_.size() == 0) {
    // nth_element may reorder the costs: they are overwritten next.
    std::nth_element(costs_.begin(), costs_.begin() + costs_.size() / 2, costs_.end());
    health_.tick_cpu_ns = costs_[costs_.size() / 2];
  }
  health_.heartbeat_ns = began_ns;
  page_.set_health(health_);
}

}  // namespace prismesh::deviced
