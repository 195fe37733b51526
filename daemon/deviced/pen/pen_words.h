// The safety's phases and faults in words.
#pragma once

#include <string>
#include <string_view>

#include "drivers/haptics/safety.h"

namespace prismesh::deviced::pen {

// For files: these never change.
std::string_view phase_name(drivers::haptics::SafetyPhase phase);
std::string_view fault_name(drivers::haptics::SafetyFault fault);

/// What happened, and what to do.
std::string fault_sentence(drivers::haptics::SafetyFault fault);

}  // namespace prismesh::deviced::pen
