#include "ipc/reconnecting_client.h"

#include <algorithm>
#include <thread>

#include "ipc/connection.h"

namespace prismesh::ipc {

namespace {

using Time = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kFirstPause{50};
constexpr std::chrono::milliseconds kMaxPause{1000};
/// How long `wait` sleeps between two checks for the welcome.
constexpr std::chrono::milliseconds kLook{5};

}  // namespace

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

template class Reconnecting<Client>;
template class Reconnecting<DeviceClient>;

}  // namespace prismesh::ipc
