#include "drivers/port/port_keeper.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "drivers/port/udp_port.h"

namespace prismesh::drivers::port {

template <class Port>
BasicKeeper<Port>::BasicKeeper(Clock& clock, Maker maker, std::string path, BackOff back_off)
    : clock_(clock), maker_(std::move(maker)), path_(std::move(path)), back_off_(back_off), next_try_ns_(clock.now_ns()) {}

template <class Port>
BasicKeeper<Port>::~BasicKeeper() {
  delete offered_.load();
  delete returned_.load();
  delete held_;
}

template <class Port>
Port* BasicKeeper<Port>::port() {
  // Loads before exchanging: an exchange in each tick would take the cache line from the other side.
  if (held_ == nullptr && offered_.load(std::memory_order_relaxed) != nullptr)
    held_ = offered_.exchange(nullptr, std::memory_order_acquire);
  return held_;
}

template <class Port>
void BasicKeeper<Port>::give_back() {
  if (held_ == nullptr) return;
  // No other port is offered until this one has been collected, so the slot is free.
  returned_.store(held_, std::memory_order_release);
  held_ = nullptr;
  if (notify_ != nullptr) notify_(notify_with_);
}

template <class Port>
std::int64_t BasicKeeper<Port>::work() {
  const std::int64_t now = clock_.now_ns();
  close_returned(now);
  if (!handed_out_ && now >= next_try_ns_) try_to_open(now);
  return handed_out_ ? std::numeric_limits<std::int64_t>::max() : next_try_ns_;
}

template <class Port>
void BasicKeeper<Port>::close_returned(std::int64_t now) {
  std::unique_ptr<Port> dead(returned_.exchange(nullptr, std::memory_order_acquire));
  if (!dead) return;
  handed_out_ = false;
  // Without the back-off, a port that fails right after opening would be reopened without pause.
  if (now - opened_ns_ >= back_off_.proven_after_ns) wait_ns_ = 0;
  next_try_ns_ = now + wait_ns_;
  const std::scoped_lock lock(report_mutex_);
  report_.open = false;
  report_.reason = Error{path_, 0, "went away" + (dead->last_error() != 0 ? std::string(": ") + std::strerror(dead->last_error()) : "")};
}

template <class Port>
void BasicKeeper<Port>::try_to_open(std::int64_t now) {
  Result<std::unique_ptr<Port>> opened = maker_();
  wait_ns_ = wait_ns_ == 0 ? back_off_.first_wait_ns : std::min(2 * wait_ns_, back_off_.max_wait_ns);
  next_try_ns_ = now + wait_ns_;
  opened_ns_ = now;
  handed_out_ = opened.has_value();
  {
    const std::scoped_lock lock(report_mutex_);
    ++report_.attempts;
    report_.open = handed_out_;
    if (handed_out_) {
      ++report_.openings;
      report_.reason.reset();
    } else {
      report_.reason = opened.error();
    }
  }
  if (handed_out_) offered_.store(opened->release(), std::memory_order_release);
}

template <class Port>
void BasicKeeper<Port>::retry_now() {
  wait_ns_ = 0;
  next_try_ns_ = clock_.now_ns();
}

template <class Port>
KeeperReport BasicKeeper<Port>::report() const {
  const std::scoped_lock lock(report_mutex_);
  return report_;
}

template <class Port>
void BasicKeeper<Port>::on_give_back(void (*call)(void*), void* with) {
  notify_ = call;
  notify_with_ = with;
}

template class BasicKeeper<BytePort>;
template class BasicKeeper<DatagramPort>;

}  // namespace prismesh::drivers::port
