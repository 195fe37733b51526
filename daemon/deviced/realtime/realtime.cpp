#include "daemon/deviced/realtime/realtime.h"

#include <linux/capability.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>

namespace prismesh::deviced {

namespace {

/// Above ordinary work and the kernel's threads at 1, below the interrupt threads at 50 that deliver the ports' bytes.
constexpr int kPriority = 40;
constexpr std::size_t kStackBytes = std::size_t{256} * 1024;

timespec as_timespec(std::int64_t ns) { return {static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)}; }

bool has_capability(int capability) {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct data[_LINUX_CAPABILITY_U32S_3]{};
  if (::syscall(SYS_capget, &header, data) != 0) return false;
  return (data[CAP_TO_INDEX(capability)].effective & CAP_TO_MASK(capability)) != 0;
}

int create_thread(bool realtime, void* (*enter)(void*), void* argument, pthread_t& thread) {
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
  const int status = ::pthread_create(&thread, &attributes, enter, argument);
  ::pthread_attr_destroy(&attributes);
  return status;
}

}  // namespace

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

std::string lock_memory() {
  rlimit limit{};
  const bool boundless = ::getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
  if (!boundless && !has_capability(CAP_IPC_LOCK))
    return "memory isn't locked (only " + std::to_string(limit.rlim_cur / 1024) +
           " KiB may be): a tick may wait for the disk while memory is short; allow it with LimitMEMLOCK=infinity in the unit";
  if (::mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return {};
  return std::string("memory isn't locked (") + std::strerror(errno) + "): a tick may wait for the disk while memory is short";
}

Result<void> start_realtime_thread(const char* what, void* (*enter)(void*), void* argument, StartedThread& started) {
  started.realtime = true;
  int status = create_thread(true, enter, argument, started.thread);
  if (status == EPERM) {
    started.realtime = false;
    started.refused =
        "real-time priority was refused: ticks may come late while the machine is busy; allow it with LimitRTPRIO=40 in the unit, or with "
        "rtprio in /etc/security/limits.conf";
    status = create_thread(false, enter, argument, started.thread);
  }
  if (status != 0) return fail(what, std::string("no thread can be created: ") + std::strerror(status));
  return {};
}

}  // namespace prismesh::deviced
