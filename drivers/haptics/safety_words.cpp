#include "drivers/haptics/safety_words.h"

namespace prismesh::drivers::haptics {

std::string_view phase_name(SafetyPhase phase) {
  switch (phase) {
    case SafetyPhase::disarmed: return "disarmed";
    case SafetyPhase::armed: return "armed";
    case SafetyPhase::latched: return "latched";
  }
  return "unknown";
}

std::string_view fault_name(SafetyFault fault) {
  switch (fault) {
    case SafetyFault::none: return "none";
    case SafetyFault::not_finite: return "not_finite";
    case SafetyFault::jump: return "jump";
    case SafetyFault::too_fast: return "too_fast";
    case SafetyFault::io_error: return "io_error";
    case SafetyFault::lost_reply: return "lost_reply";
    case SafetyFault::no_pose: return "no_pose";
    case SafetyFault::pose_time: return "pose_time";
    case SafetyFault::late_tick: return "late_tick";
    case SafetyFault::clock: return "clock";
    case SafetyFault::died_armed: return "died_armed";
  }
  return "unknown";
}

std::string_view fault_words(SafetyFault fault) {
  switch (fault) {
    case SafetyFault::none: return "the force was switched off";
    case SafetyFault::not_finite: return "a pose or a force was no number";
    case SafetyFault::jump: return "two poses were too far apart";
    case SafetyFault::too_fast: return "the pen moved faster than 1.5 m/s";
    case SafetyFault::io_error: return "the line to the pen failed";
    case SafetyFault::lost_reply: return "the pen left a request unanswered";
    case SafetyFault::no_pose: return "no pose came for more than 10 ms";
    case SafetyFault::pose_time: return "a pose came with a wrong time";
    case SafetyFault::late_tick: return "the loop stood still for more than 10 ms";
    case SafetyFault::clock: return "the clock went back";
    case SafetyFault::died_armed: return "the program ended while the pen was armed";
  }
  return "an unknown fault";
}

std::string fault_sentence(SafetyFault fault) { return std::string(fault_words(fault)) + ", so its force is zero until it is armed again"; }

}  // namespace prismesh::drivers::haptics
