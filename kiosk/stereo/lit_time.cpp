#include "kiosk/stereo/lit_time.h"

#include <algorithm>

namespace prismesh::kiosk::stereo {

namespace {
constexpr std::int64_t kMaxRefreshAgeNs = 1'000'000'000;  ///< the phase of an older refresh may have drifted
}

void PictureTiming::drawn(std::int64_t now_ns) {
  draws_[drawn_ % kRemembered] = std::max<std::int64_t>(0, now_ns - begun_ns_);
  ++drawn_;
}

void PictureTiming::refreshed(std::int64_t refresh_ns, std::int64_t now_ns) {
  if (refresh_ns > 0 && refresh_ns <= now_ns && now_ns - refresh_ns < kMaxRefreshAgeNs) refresh_ns_ = refresh_ns;
}

std::int64_t PictureTiming::draw_ns() const {
  const std::size_t count = std::min(drawn_, kRemembered);
  if (count == 0) return timing_.period_ns;
  std::array<std::int64_t, kRemembered> sorted = draws_;
  std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(count));
  return sorted[count / 2];
}

std::int64_t PictureTiming::max_draw_ns() const {
  const std::size_t count = std::min(drawn_, kRemembered);
  return count == 0 ? timing_.period_ns : *std::max_element(draws_.begin(), draws_.begin() + static_cast<std::ptrdiff_t>(count));
}

LitTime PictureTiming::lit(std::int64_t now_ns) const {
  const std::int64_t handed_ns = now_ns + draw_ns(), period = std::max<std::int64_t>(1, timing_.period_ns);
  std::int64_t shown_ns = handed_ns + period / 2;
  if (refresh_ns_ && now_ns - *refresh_ns_ < kMaxRefreshAgeNs)
    shown_ns = *refresh_ns_ + (handed_ns - *refresh_ns_ + period - 1) / period * period;
  const std::int64_t from_ns = shown_ns + period / 2 + timing_.panel_latency_ns;
  return {from_ns, from_ns + std::max(period, max_draw_ns())};
}

}  // namespace prismesh::kiosk::stereo
