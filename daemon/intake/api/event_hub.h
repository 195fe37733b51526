// Events for clients that follow the catalogue. Each has a queue; who doesn't read loses the connection, not the station its memory.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/intake/access/token.h"

namespace prismesh::intake {

/// What a follower gets next.
struct PendingEvents {
  std::string text;
  bool ends = false;  ///< it was too slow, or isn't known
};

/// Safe to use from any thread.
class EventHub {
 public:
  /// Adds a follower. Nothing: there are too many.
  std::optional<std::uint64_t> follow(const Caller& caller);
  void leave(std::uint64_t follower);
  /// Called, from any thread, when there is something for it.
  void wake_by(std::uint64_t follower, std::function<void()> wake);
  PendingEvents take(std::uint64_t follower);
  std::optional<Caller> caller_of(std::uint64_t follower);

  /// Something happened to a model. `name` is a word, `data` one line.
  void tell(std::string_view name, const ipc::store::ContentHash& model, std::string_view data);
  /// Called with each model's hash that is told of, from any thread. Before the first `tell`.
  void listen(std::function<void(const std::string& model)> told) { told_ = std::move(told); }
  std::size_t count();

 private:
  struct Follower {
    Caller caller;
    std::string text;
    bool overflowed = false;
    std::function<void()> wake;
  };
  std::mutex mutex_;
  std::map<std::uint64_t, Follower> followers_;
  std::uint64_t last_ = 0;
  std::function<void(const std::string&)> told_;
};

}  // namespace prismesh::intake
