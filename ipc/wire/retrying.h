// How long a cut line is tried again, and how long to wait between two tries.
#pragma once

#include <chrono>
#include <optional>

#include "base/error.h"
#include "ipc/wire/line_fault.h"

namespace prismesh::ipc {

struct RetryPatience {
  /// How long the line may stay cut, without a request that is answered.
  std::chrono::milliseconds whole{60'000};
  std::chrono::milliseconds first_pause{200};  ///< before another try; each is twice as long as the last, up to 5 s
};

class Retrying {
 public:
  Retrying(RetryPatience patience, Stop stop);

  /// Waits before another try. `silent_since`: nothing came or went since then; nothing: since now. Errors: `fault` doesn't pass, the
  /// patience is over, the user stopped it.
  Result<void> wait_after(const LineFault& fault, std::optional<std::chrono::steady_clock::time_point> silent_since = std::nullopt);
  /// Something came or went: what follows is another cut.
  void line_is_good();
  bool is_stopped() const { return stop_ && stop_(); }

 private:
  RetryPatience patience_;
  Stop stop_;
  std::optional<std::chrono::steady_clock::time_point> cut_since_;
  std::chrono::milliseconds pause_;
};

}  // namespace prismesh::ipc
