// How long work reports its progress and is told to stop.
#pragma once

#include <functional>
#include <string>
#include <type_traits>
#include <utility>

#include "base/error.h"

namespace prismesh {

/// What long work is doing, in words ("round 3, 41 of 1109 bad elements left"). Called only by a listener that shows them.
using Doing = std::function<std::string()>;

/// Is called repeatedly with the fraction done (0..1), and with words where the work has some, on the thread that started the work. Returns
/// false to stop: the work then fails with the error `cancelled()`, or keeps what it has reached if it can and `keeps()`. An empty one is
/// never called.
class Progress {
 public:
  Progress() = default;
  /// `listener`: bool(double fraction), or bool(double fraction, const Doing& doing); `doing` may be empty. `keeps`: whether whoever stops
  /// the work wants what it has reached by then.
  template <class Listener>
  requires(!std::is_same_v<std::remove_cvref_t<Listener>, Progress>)
      Progress(Listener listener, std::function<bool()> keeps = {})  // NOLINT(google-explicit-constructor): a lambda is one
      : keeps_(std::move(keeps)) {
    if constexpr (std::is_invocable_r_v<bool, Listener&, double, const Doing&>)
      listener_ = std::move(listener);
    else
      listener_ = [heard = std::move(listener)](double fraction, const Doing&) mutable -> bool { return heard(fraction); };
  }

  explicit operator bool() const { return static_cast<bool>(listener_); }
  bool operator()(double fraction, const Doing& doing = {}) const { return listener_(fraction, doing); }
  /// Asked after a stop.
  bool keeps() const { return keeps_ && keeps_(); }

 private:
  std::function<bool(double, const Doing&)> listener_;
  std::function<bool()> keeps_;
};

/// The error of work that was told to stop.
inline Error cancelled() { return {{}, 0, "cancelled", ErrorKind::cancelled}; }
/// Whether an error is that of work that was told to stop, whatever file it names.
inline bool is_cancelled(const Error& error) { return error.kind == ErrorKind::cancelled; }

}  // namespace prismesh
