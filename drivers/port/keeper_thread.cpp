#include "drivers/port/keeper_thread.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace prismesh::drivers::port {

namespace {

// Polling period if inotify or the eventfd isn't available.
constexpr std::int64_t kMaxSleepNs = 1'000'000'000;

std::vector<std::string> paths_of(const std::vector<KeeperWork>& keepers) {
  std::vector<std::string> paths;
  paths.reserve(keepers.size());
  for (const KeeperWork& keeper : keepers) paths.push_back(keeper.path);
  return paths;
}

}  // namespace

KeeperThread::KeeperThread(Clock& clock, std::vector<KeeperWork> keepers)
    : clock_(clock), keepers_(std::move(keepers)), watch_(paths_of(keepers_)), event_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  for (const KeeperWork& keeper : keepers_) keeper.on_give_back([](void* self) { static_cast<const KeeperThread*>(self)->wake(); }, this);
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

KeeperThread::~KeeperThread() {
  thread_.request_stop();
  wake();
  thread_.join();
  for (const KeeperWork& keeper : keepers_) keeper.on_give_back(nullptr, nullptr);
  if (event_ >= 0) ::close(event_);
}

void KeeperThread::wake() const {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t ignored = ::write(event_, &one, sizeof one);  // a full counter means that the thread is awake already
}

void KeeperThread::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    std::int64_t due = std::numeric_limits<std::int64_t>::max();
    for (const KeeperWork& keeper : keepers_) due = std::min(due, keeper.work());
    wait_until(due);
    for (const std::size_t touched : watch_.changed_paths()) keepers_[touched].retry_now();
  }
}

void KeeperThread::wait_until(std::int64_t due_ns) {
  std::array<pollfd, 2> watched{pollfd{event_, POLLIN, 0}, pollfd{watch_.descriptor(), POLLIN, 0}};
  const std::int64_t wait = std::clamp<std::int64_t>(due_ns - clock_.now_ns(), 0, kMaxSleepNs);
  ::poll(watched.data(), watched.size(), static_cast<int>((wait + 999'999) / 1'000'000));
  std::uint64_t taken = 0;
  [[maybe_unused]] const ssize_t ignored = ::read(event_, &taken, sizeof taken);
}

}  // namespace prismesh::drivers::port
