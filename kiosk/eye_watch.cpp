#include "kiosk/eye_watch.h"

#include <algorithm>

#include <fmt/format.h>

namespace prismesh::kiosk {
namespace {

using drivers::prism_servo::MaskPhase;
using ipc::EyesPhase;
using toolkit::EyesFacts;

/// The tracker in a few words, and what the user can do about it.
void word_eyes(EyesPhase phase, const ipc::DeviceInfo* tracker, EyesFacts& facts) {
  facts.condition = phase == EyesPhase::tracking ? EyesFacts::Condition::good : EyesFacts::Condition::trouble;
  switch (phase) {
    case EyesPhase::tracking: facts.eyes = "following you"; return;
    case EyesPhase::searching:
      facts.condition = EyesFacts::Condition::waiting;
      facts.eyes = "nobody seen";
      facts.advice = "Sit in front of the screen, an arm's length away.";
      return;
    case EyesPhase::silent:
      facts.eyes = "tracker is silent";
      facts.advice = "Is the eye tracker switched on, and its baud rate right?";
      break;
    case EyesPhase::absent:
      facts.eyes = "tracker unplugged";
      facts.advice = "Plug the eye tracker in.";
      break;
    case EyesPhase::none:
      facts.eyes = "no tracker";
      facts.advice = "Name the eye tracker in prismesh.toml.";
      break;
  }
  if (tracker != nullptr && !tracker->trouble.empty()) facts.advice = tracker->trouble;
}

/// Only what keeps the picture mono though the eyes are seen.
void word_mask(MaskPhase phase, const ipc::DeviceInfo* servo, EyesFacts& facts) {
  const auto say = [&](EyesFacts::Condition state, const char* mask, const char* advice) {
    facts.mask = mask;
    if (facts.condition != EyesFacts::Condition::good) return;
    facts.condition = state;
    facts.advice = servo != nullptr && !servo->trouble.empty() ? servo->trouble : advice;
  };
  switch (phase) {
    case MaskPhase::following:
    case MaskPhase::flying_back: facts.mask = "following"; return;
    case MaskPhase::homing: return say(EyesFacts::Condition::waiting, "finding its zero", "");
    case MaskPhase::frozen:
    case MaskPhase::parking:
    case MaskPhase::parked: return say(EyesFacts::Condition::waiting, "at rest", "");
    case MaskPhase::held: return say(EyesFacts::Condition::waiting, "held for calibration", "");
    case MaskPhase::absent: return say(EyesFacts::Condition::trouble, "motor doesn't answer", "Check the prism motor's power and cable.");
    case MaskPhase::stuck: return say(EyesFacts::Condition::trouble, "stuck", "Free the mask, then press Ctrl+R.");
    case MaskPhase::alarm:
      return say(EyesFacts::Condition::trouble, "motor alarm", "Switch the prism motor off and on, then press Ctrl+R.");
  }
}

}  // namespace

EyeWatch::EyeWatch(const stereo::FollowOptions& options, DeviceLink& link, Clock& clock, notices::Trace trace)
    : link_(link), clock_(clock), trace_(trace), eyes_(options) {}

void EyeWatch::set_options(const stereo::FollowOptions& options) {
  if (options == eyes_.options()) return;
  eyes_.set_options(options);
  traced_phase_.reset();
}

bool EyeWatch::look() {
  const std::int64_t now = clock_.now_ns();
  timing_.begun(now);
  const stereo::DeviceReading reading = link_.read();
  lit_ = timing_.lit(now);
  seen_ = eyes_.look(reading, now, lit_);
  if (!refused_.empty()) seen_ = eyes_.flatten();
  // The mask must not go anywhere by itself from the moment that depth may be seen.
  if (follows() && seen_.depth_share > 0) {
    link_.tell_picture(false);
    mono_lit_ns_.reset();
  }
  tell(now);
  trace_phase(reading, now);
  std::optional<EyesFacts> facts = word(reading);
  const bool reworded = facts != facts_;
  facts_ = std::move(facts);
  return reworded || seen_ != shown_;
}

void EyeWatch::drawn(std::optional<std::int64_t> refresh_ns) {
  const std::int64_t now = clock_.now_ns();
  timing_.drawn(now);
  if (refresh_ns) timing_.refreshed(*refresh_ns, now);
  note_shown(timing_.lit(now - timing_.draw_ns()).from_ns);
}

void EyeWatch::taken() { note_shown(lit_.from_ns); }

void EyeWatch::note_shown(std::int64_t lit_ns) {
  shown_ = seen_;
  // A display that follows no eyes needs no mask that does.
  const bool mono = !follows() || seen_.depth_share <= 0;
  if (mono && !mono_lit_ns_) mono_lit_ns_ = lit_ns;
  if (!follows() || traced_mono_ == mono) return;
  traced_mono_ = mono;
  trace_.line(fmt::format("shows {} lit {} measured {}", mono ? "mono" : "depth", lit_ns, eyes_.measured_ns()));
}

void EyeWatch::tell(std::int64_t now_ns) {
  if (mono_lit_ns_ && now_ns >= *mono_lit_ns_) link_.tell_picture(true);
}

void EyeWatch::trace_phase(const stereo::DeviceReading& reading, std::int64_t now_ns) {
  if (!follows()) return;
  const EyesPhase phase = reading.eyes ? reading.eyes->phase : EyesPhase::none;
  if (traced_phase_ == phase) return;
  traced_phase_ = phase;
  trace_.line(fmt::format("eyes {} {}", reading.eyes ? name(phase) : "unknown", now_ns));
}

std::optional<EyesFacts> EyeWatch::word(const stereo::DeviceReading& reading) const {
  EyesFacts facts;
  if (!refused_.empty()) {
    facts.condition = EyesFacts::Condition::trouble;
    facts.eyes = "no depth on this screen";
    facts.advice = refused_;
    return facts;
  }
  if (!follows()) return std::nullopt;
  facts.in_depth = seen_.depth_share > 0;
  if (!link_.connected()) {
    facts.condition = EyesFacts::Condition::trouble;
    facts.eyes = "no device daemon";
    facts.advice = "Start prismesh-deviced; it is tried again every second.";
    return facts;
  }
  if (!reading.eyes) return facts;
  const ipc::DeviceInfo* tracker = link_.device("eye tracker");
  const ipc::DeviceInfo* servo = link_.device("prism servo");
  facts.simulated = (tracker != nullptr && tracker->simulated) || (servo != nullptr && servo->simulated);
  word_eyes(reading.eyes->phase, tracker, facts);
  if (eyes_.options().movable_mask) word_mask(reading.prism ? reading.prism->phase : MaskPhase::absent, servo, facts);
  return facts;
}

}  // namespace prismesh::kiosk
