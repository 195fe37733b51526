#include "kiosk/tools/exhibition/show_clock.h"

#include <algorithm>

namespace prismesh::kiosk::tools::exhibition {

namespace {
constexpr std::int64_t kSecond = 1'000'000'000;
}  // namespace

void ShowClock::become(Stage stage, std::int64_t now_ns) {
  stage_ = stage;
  since_ns_ = now_ns;
}

bool ShowClock::touched(std::int64_t now_ns) {
  switch (stage_) {
    case Stage::show:
    case Stage::warning: become(Stage::visit, now_ns); return true;
    case Stage::visit:
    case Stage::unlocked: since_ns_ = now_ns; return false;
    case Stage::over: break;
  }
  return true;
}

void ShowClock::face(bool there, std::int64_t now_ns) {
  if (!there) {
    face_since_ns_ = -1;
    if (gone_since_ns_ < 0) gone_since_ns_ = now_ns;
    if (now_ns - gone_since_ns_ >= kGoneNs) face_counted_ = false;
    return;
  }
  gone_since_ns_ = -1;
  if (face_since_ns_ < 0) face_since_ns_ = now_ns;
  if (face_counted_ || now_ns - face_since_ns_ < kFaceNs) return;
  face_counted_ = true;
  if (stage_ == Stage::show) become(Stage::visit, now_ns);
}

void ShowClock::turn(std::int64_t now_ns) {
  if (stage_ == Stage::visit && now_ns - since_ns_ >= times_.idle_ns) become(Stage::warning, now_ns);
  if (stage_ == Stage::warning && now_ns - since_ns_ >= times_.warning_ns) end();
  if (stage_ == Stage::unlocked && now_ns - since_ns_ >= times_.unlocked_ns) end();
}

void ShowClock::unlock(std::int64_t now_ns) { become(Stage::unlocked, now_ns); }

void ShowClock::end() { stage_ = Stage::over; }

int ShowClock::seconds_left(std::int64_t now_ns) const {
  const std::int64_t left = std::max<std::int64_t>(0, since_ns_ + times_.warning_ns - now_ns);
  return static_cast<int>((left + kSecond - 1) / kSecond);
}

std::int64_t ShowClock::next_ns(std::int64_t now_ns) const {
  switch (stage_) {
    case Stage::visit: return since_ns_ + times_.idle_ns;
    case Stage::warning: return std::min(since_ns_ + times_.warning_ns, now_ns + kSecond / 4);  // the seconds that are shown
    case Stage::unlocked: return since_ns_ + times_.unlocked_ns;
    case Stage::show:
    case Stage::over: break;
  }
  return now_ns;
}

}  // namespace prismesh::kiosk::tools::exhibition
