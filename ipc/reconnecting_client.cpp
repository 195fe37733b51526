#include "ipc/reconnecting_client.h"

#include <algorithm>
#include <thread>
#include <utility>

namespace prismesh::ipc {

namespace {

using Time = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kFirstPause{50};
constexpr std::chrono::milliseconds kLongestPause{1000};

}  // namespace

Client* ReconnectingClient::client() {
  if (client_) return &*client_;
  if (Time::now() < next_try_) return nullptr;
  Result<Client> connected = Client::connect(socket_, program_);
  if (connected) {
    client_ = std::move(*connected);
    ++connections_;
    pause_ = std::chrono::milliseconds(0);
    return &*client_;
  }
  trouble_ = std::move(connected.error());
  pause_ = std::clamp(pause_ * 2, kFirstPause, kLongestPause);
  next_try_ = Time::now() + pause_;
  return nullptr;
}

Result<Client*> ReconnectingClient::wait(std::chrono::milliseconds patience) {
  const Time::time_point until = Time::now() + patience;
  for (;;) {
    if (Client* connected = client()) return connected;
    if (Time::now() >= until) return fail(trouble_);
    std::this_thread::sleep_until(std::min(next_try_, until));
  }
}

void ReconnectingClient::lost(const Error& why) {
  client_.reset();
  trouble_ = why;
  next_try_ = Time::now();
}

}  // namespace prismesh::ipc
