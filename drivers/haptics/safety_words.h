// The safety's phases and faults in words.
#pragma once

#include <string>
#include <string_view>

#include "drivers/haptics/safety.h"

namespace prismesh::drivers::haptics {

// For files: these never change.
std::string_view phase_name(SafetyPhase phase);
std::string_view fault_name(SafetyFault fault);

/// "two poses were too far apart".
std::string_view fault_words(SafetyFault fault);
/// The same, and what follows from it.
std::string fault_sentence(SafetyFault fault);

}  // namespace prismesh::drivers::haptics
