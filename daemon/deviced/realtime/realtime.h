// What a loop in real time needs of the system: a thread with SCHED_FIFO where it is granted, sleep until an absolute time, locked memory.
#pragma once

#include <pthread.h>

#include <cstdint>
#include <string>

#include "base/error.h"

namespace prismesh::deviced {

/// Locks the process's memory, present and future, unless a limit applies: then a later allocation would fail. Returns an empty text, or
/// why it wasn't locked and what would help.
std::string lock_memory();

void sleep_until(std::int64_t ns);
/// Of the calling thread.
std::int64_t thread_cpu_ns();

struct StartedThread {
  pthread_t thread{};
  bool realtime = false;
  std::string refused;  ///< why SCHED_FIFO was refused and what would help; empty if it was granted
};
/// Starts a thread with a small stack. `realtime` is set before the thread runs. Errors: no thread can be created.
Result<void> start_realtime_thread(const char* what, void* (*enter)(void*), void* argument, StartedThread& started);

}  // namespace prismesh::deviced
