#include "daemon/deviced/loop_thread.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>

#include <linux/capability.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace prismesh::deviced {

namespace {

/// Above ordinary work and the kernel's threads at 1, below the interrupt threads at 50 that deliver the ports' bytes.
constexpr int kPriority = 40;
constexpr std::size_t kStackBytes = std::size_t{256} * 1024;
/// How long the servo may take to receive the torque-off command.
constexpr int kWindDownTicks = 25;

timespec as_timespec(std::int64_t ns) { return {static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)}; }

void sleep_until(std::int64_t ns) {
  const timespec until = as_timespec(ns);
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

std::int64_t thread_cpu_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return now.tv_sec * 1'000'000'000 + now.tv_nsec;
}

bool has_capability(int capability) {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct data[_LINUX_CAPABILITY_U32S_3]{};
  if (::syscall(SYS_capget, &header, data) != 0) return false;
  return (data[CAP_TO_INDEX(capability)].effective & CAP_TO_MASK(capability)) != 0;
}

}  // namespace

std::string lock_memory() {
  rlimit limit{};
  const bool boundless = ::getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
  if (!boundless && !has_capability(CAP_IPC_LOCK))
    return "memory isn't locked (only " + std::to_string(limit.rlim_cur / 1024) +
           " KiB may be): a tick may wait for the disk while memory is short; allow it with LimitMEMLOCK=infinity in the unit";
  if (::mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return {};
  return std::string("memory isn't locked (") + std::strerror(errno) + "): a tick may wait for the disk while memory is short";
}

std::int64_t next_due_ns(std::int64_t due_ns, std::int64_t ended_ns) {
  return due_ns + kTickPeriodNs * std::max<std::int64_t>(1, (ended_ns - due_ns) / kTickPeriodNs);
}

Result<std::unique_ptr<LoopThread>> LoopThread::start(DeviceLoop& loop, ipc::DevicePage& page, bool memory_locked, bool simulated) {
  std::unique_ptr<LoopThread> made(new LoopThread(loop, page));
  made->health_.pid = ::getpid();
  made->health_.memory_locked = memory_locked;
  made->health_.simulated = simulated;
  made->heartbeat_.begin();  // before the thread runs: one that never begins is missed too
  int status = made->create(true);
  if (status == EPERM) {
    made->refused_ =
        "real-time priority was refused: ticks may come late while the machine is busy; allow it with LimitRTPRIO=40 in the unit, or with "
        "rtprio in /etc/security/limits.conf";
    status = made->create(false);
  }
  if (status != 0) return fail("device loop", std::string("no thread can be created: ") + std::strerror(status));
  return made;
}

/// Returns pthread_create's status.
int LoopThread::create(bool realtime) {
  health_.realtime = realtime;
  pthread_attr_t attributes;
  ::pthread_attr_init(&attributes);
  // A locked stack is fully resident, so the default of 8 MiB would be wasted.
  ::pthread_attr_setstacksize(&attributes, kStackBytes);
  if (realtime) {
    sched_param priority{};
    priority.sched_priority = kPriority;
    ::pthread_attr_setinheritsched(&attributes, PTHREAD_EXPLICIT_SCHED);
    ::pthread_attr_setschedpolicy(&attributes, SCHED_FIFO);
    ::pthread_attr_setschedparam(&attributes, &priority);
  }
  const int status = ::pthread_create(&thread_, &attributes, enter, this);
  ::pthread_attr_destroy(&attributes);
  running_ = status == 0;
  return status;
}

LoopThread::~LoopThread() {
  if (!running_) return;
  stop_ = true;
  ::pthread_join(thread_, nullptr);
}

void* LoopThread::enter(void* self) {
  ::pthread_setname_np(::pthread_self(), "device loop");  // the name that top and chrt show
  static_cast<LoopThread*>(self)->run();
  return nullptr;
}

void LoopThread::run() {
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
