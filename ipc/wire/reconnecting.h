// A connection that is restored when a daemon restarts.
#pragma once

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "base/error.h"
#include "ipc/wire/greeting_patience.h"

namespace prismesh::ipc {

/// For programs with a loop of their own: get the client in each turn, and report when a call of it fails.
/// `AnyClient` has `begin` and `greeted`, as ipc::Client.
template <class AnyClient>
class Reconnecting {
 public:
  Reconnecting(std::filesystem::path socket, std::string program) : socket_(std::move(socket)), program_(std::move(program)) {}

  /// The connected client, or null; never waits. Tries to connect at once after a loss, then after 50 ms, 100 ms and so on, up to a second.
  /// A new client (`connections` has changed) knows no snapshots, drags or pages of the old one.
  AnyClient* client();
  /// As `client`, trying again for up to `patience`. Errors: why the last try failed.
  Result<AnyClient*> wait(std::chrono::milliseconds patience);
  /// Closes the connection, after a call failed because the daemon is gone.
  void lost(const Error& why);

  std::size_t connections() const { return connections_; }
  /// Why there is no client.
  const Error& trouble() const { return trouble_; }

 private:
  using Time = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kFirstPause{50}, kMaxPause{1000};
  static constexpr std::chrono::milliseconds kLook{5};  ///< how long `wait` sleeps between two checks for the welcome

  void try_again_later(Error why);

  std::filesystem::path socket_;
  std::string program_;
  std::optional<AnyClient> client_;
  bool greeted_ = false;
  std::chrono::steady_clock::time_point begun_{};
  std::size_t connections_ = 0;
  Error trouble_{"", 0, "not connected yet"};
  std::chrono::steady_clock::time_point next_try_{};
  std::chrono::milliseconds pause_{0};
};

template <class AnyClient>
AnyClient* Reconnecting<AnyClient>::client() {
  if (client_ && greeted_) return &*client_;
  if (!client_) {
    if (Time::now() < next_try_) return nullptr;
    Result<AnyClient> begun = AnyClient::begin(socket_, program_);
    if (!begun) {
      try_again_later(std::move(begun.error()));
      return nullptr;
    }
    client_ = std::move(*begun);
    begun_ = Time::now();
  }
  const Result<bool> greeted = client_->greeted();
  if (!greeted) {
    try_again_later(greeted.error());
  } else if (*greeted) {
    greeted_ = true;
    ++connections_;
    pause_ = std::chrono::milliseconds(0);
    return &*client_;
  } else {
    trouble_ = {socket_.string(), 0, "the daemon listens, but hasn't answered the greeting yet"};
    if (Time::now() - begun_ > kGreetingPatience) try_again_later(trouble_);
  }
  return nullptr;
}

template <class AnyClient>
void Reconnecting<AnyClient>::try_again_later(Error why) {
  client_.reset();
  trouble_ = std::move(why);
  pause_ = std::clamp(pause_ * 2, kFirstPause, kMaxPause);
  next_try_ = Time::now() + pause_;
}

template <class AnyClient>
Result<AnyClient*> Reconnecting<AnyClient>::wait(std::chrono::milliseconds patience) {
  const Time::time_point until = Time::now() + patience;
  for (;;) {
    if (AnyClient* connected = client()) return connected;
    // The first attempt is always made, and the daemon may take a moment to greet.
    if (Time::now() >= until && !client_) return fail(trouble_);
    if (Time::now() >= until + kGreetingPatience) return fail(trouble_);
    std::this_thread::sleep_until(client_ ? Time::now() + kLook : std::min(next_try_, until));
  }
}

template <class AnyClient>
void Reconnecting<AnyClient>::lost(const Error& why) {
  client_.reset();
  greeted_ = false;
  trouble_ = why;
  next_try_ = Time::now();
}

}  // namespace prismesh::ipc
