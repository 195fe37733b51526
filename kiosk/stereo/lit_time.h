// Predicts when a picture that is begun now will be seen, the time that head and mask are predicted to. All times are arguments.
//
//   begun ----- drawn and handed over ----- refresh ----- scan-out reaches the middle ----- its pixels turn
//        draw time (measured)        wait          half a period               panel latency
//
// The display may report its last refresh (EGL_CHROMIUM_sync_control). Otherwise the wait is assumed to be its mean, half a period.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace prismesh::kiosk::stereo {

/// CLOCK_MONOTONIC, at the middle of the panel.
struct LitTime {
  std::int64_t from_ns = 0;   ///< the picture is seen from here ...
  std::int64_t until_ns = 0;  ///< ... until the next one can take its place
  /// The time that head and mask are predicted to. The picture is then ahead of them at first by as much as it is behind at the end.
  std::int64_t middle_ns() const { return from_ns + (until_ns - from_ns) / 2; }
};

struct DisplayTiming {
  std::int64_t period_ns = 16'666'667;         ///< of the display's refresh
  std::int64_t panel_latency_ns = 10'000'000;  ///< from a row's scan-out to its light
};

class PictureTiming {
 public:
  explicit PictureTiming(const DisplayTiming& timing) : timing_(timing) {}

  void set_timing(const DisplayTiming& timing) { timing_ = timing; }
  const DisplayTiming& timing() const { return timing_; }

  void begun(std::int64_t now_ns) { begun_ns_ = now_ns; }
  /// The picture is drawn to the last pixel and about to be handed to the display.
  void drawn(std::int64_t now_ns);
  /// A refresh began at refresh_ns. A time in the future or older than a second is ignored.
  void refreshed(std::int64_t refresh_ns, std::int64_t now_ns);

  /// When a picture that is begun now is seen.
  LitTime lit(std::int64_t now_ns) const;
  /// The earliest time to begin the next picture: an earlier one would only wait for the one before.
  std::int64_t next_begin_ns() const { return begun_ns_ + timing_.period_ns; }
  /// Median and max draw time of the last pictures; one period before the first.
  std::int64_t draw_ns() const;
  std::int64_t max_draw_ns() const;

 private:
  static constexpr std::size_t kRemembered = 5;

  DisplayTiming timing_;
  std::array<std::int64_t, kRemembered> draws_{};
  std::size_t drawn_ = 0;
  std::int64_t begun_ns_ = 0;
  std::optional<std::int64_t> refresh_ns_;
};

}  // namespace prismesh::kiosk::stereo
