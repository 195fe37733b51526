// Makes the running machine follow what prismesh-setup has written.
#pragma once

#include <cstdint>

#include "base/error.h"
#include "ipc/setup/messages.h"

namespace prismesh::setup {

/// What a request changes besides files. Errors: the kernel's; a tool that fails (names it).
Result<void> follow(const ipc::SetupRequest& request);

/// Seconds since 1970 of a day and time in the zone that $TZ names, which must have passed ipc::check_clock.
std::int64_t seconds_of(const ipc::SetClock& clock);

}  // namespace prismesh::setup
