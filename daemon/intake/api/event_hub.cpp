#include "daemon/intake/api/event_hub.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace prismesh::intake {

namespace {

constexpr std::size_t kMaxFollowers = 200;
constexpr std::size_t kMaxFollowersOfAToken = 8;
constexpr std::size_t kMaxQueuedBytes = std::size_t{64} << 10;

}  // namespace

std::optional<std::uint64_t> EventHub::follow(const Caller& caller) {
  const std::lock_guard lock(mutex_);
  const auto same =
      std::count_if(followers_.begin(), followers_.end(), [&](const auto& each) { return each.second.caller.name == caller.name; });
  if (followers_.size() >= kMaxFollowers || static_cast<std::size_t>(same) >= kMaxFollowersOfAToken) return std::nullopt;
  followers_[++last_].caller = caller;
  return last_;
}

void EventHub::leave(std::uint64_t follower) {
  const std::lock_guard lock(mutex_);
  followers_.erase(follower);
}

void EventHub::wake_by(std::uint64_t follower, std::function<void()> wake) {
  const std::lock_guard lock(mutex_);
  if (const auto found = followers_.find(follower); found != followers_.end()) found->second.wake = std::move(wake);
}

PendingEvents EventHub::take(std::uint64_t follower) {
  const std::lock_guard lock(mutex_);
  const auto found = followers_.find(follower);
  if (found == followers_.end() || found->second.overflowed) return {"", true};
  return {std::exchange(found->second.text, {}), false};
}

std::optional<Caller> EventHub::caller_of(std::uint64_t follower) {
  const std::lock_guard lock(mutex_);
  const auto found = followers_.find(follower);
  return found == followers_.end() ? std::nullopt : std::optional(found->second.caller);
}

void EventHub::tell(std::string_view name, const ipc::store::ContentHash& model, std::string_view data) {
  const std::string event = "event: " + std::string(name) + "\ndata: " + std::string(data) + "\n\n";
  std::vector<std::function<void()>> wakes;
  {
    const std::lock_guard lock(mutex_);
    for (auto& [id, follower] : followers_) {
      if (follower.text.size() + event.size() > kMaxQueuedBytes)
        follower.overflowed = true;
      else
        follower.text += event;
      if (follower.wake) wakes.push_back(follower.wake);
    }
  }
  for (const std::function<void()>& wake : wakes) wake();
  if (told_) told_(model.hex());
}

std::size_t EventHub::count() {
  const std::lock_guard lock(mutex_);
  return followers_.size();
}

}  // namespace prismesh::intake
