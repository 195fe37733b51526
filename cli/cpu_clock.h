// Processor time as a clock. Inner to cli.
#pragma once

#include "base/clock.h"

namespace prismesh::cli {

/// Processor time that all threads of this process have used.
class ProcessCpuClock final : public Clock {
 public:
  std::int64_t now_ns() override;
};

}  // namespace prismesh::cli
