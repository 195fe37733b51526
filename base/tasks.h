// Runs tasks of very different length on a few threads, while the thread that started them reports their progress. For loops over many
// equal entries there is base/parallel_for.h.
#pragma once

#include <cstddef>
#include <functional>

namespace prismesh {

/// Calls `task(i, wake)` once for each i in [0, count) on at most `max_threads` threads (0: as many as the processor has), begun in
/// ascending order. `wake` may be called by a task at any time: the calling thread then calls `watch`, perhaps once for several wakes. So
/// `watch` needs no lock. With one thread everything runs on the calling one. Returns when all tasks have ended; then throws the exception
/// of the first task that threw one.
void run_tasks(std::size_t count, std::size_t max_threads,
               const std::function<void(std::size_t task, const std::function<void()>& wake)>& task, const std::function<void()>& watch);

}  // namespace prismesh
