// What prismesh-intake counts, for /metrics.
#pragma once

#include <atomic>
#include <cstdint>

namespace prismesh::intake {

struct Figures {
  std::atomic<std::uint64_t> requests{0};
  std::atomic<std::uint64_t> refused{0};  ///< answered with a status of 400 or more
  std::atomic<std::uint64_t> received_bytes{0};
  std::atomic<std::uint64_t> sent_bytes{0};
  std::atomic<std::uint64_t> published{0};
  std::atomic<std::uint64_t> rot{0};
  std::atomic<std::int64_t> connections{0};
};

}  // namespace prismesh::intake
