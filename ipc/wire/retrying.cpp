#include "ipc/wire/retrying.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "base/progress.h"

namespace prismesh::ipc {

namespace {

constexpr std::chrono::milliseconds kPauseMax{5000};
constexpr std::chrono::milliseconds kPauseTurn{50};

/// Waits, unless it is stopped meanwhile.
bool paused(std::chrono::milliseconds pause, const Stop& stop) {
  const auto end = std::chrono::steady_clock::now() + pause;
  while (std::chrono::steady_clock::now() < end) {
    if (stop && stop()) return false;
    std::this_thread::sleep_for(std::min(kPauseTurn, pause));
  }
  return true;
}

}  // namespace

Retrying::Retrying(RetryPatience patience, Stop stop) : patience_(patience), stop_(std::move(stop)), pause_(patience.first_pause) {}

void Retrying::line_is_good() {
  cut_since_.reset();
  pause_ = patience_.first_pause;
}

Result<void> Retrying::wait_after(const LineFault& fault, std::optional<std::chrono::steady_clock::time_point> silent_since) {
  if (!fault.may_pass) return fail(fault.error);
  const auto now = std::chrono::steady_clock::now();
  if (!cut_since_) cut_since_ = silent_since.value_or(now);
  if (now - *cut_since_ + pause_ > patience_.whole) return fail(fault.error);
  if (!paused(std::exchange(pause_, std::min(2 * pause_, kPauseMax)), stop_)) return fail(cancelled());
  return {};
}

}  // namespace prismesh::ipc
