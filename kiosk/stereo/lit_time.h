// When a picture that is begun now will be seen: what a head and a mask are predicted to. Pure, on times that are passed in.
//
//   begun ----- drawn and handed over ----- refresh ----- scan-out reaches the middle ----- its pixels turn
//        draw time (measured)        wait          half a period               panel latency
//
// The display may say when it refreshed last (EGL_CHROMIUM_sync_control); else the wait is taken to be half a period, its mean.
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
  /// What head and mask are predicted to: then a picture that stands still is as much ahead of them at first as it is behind at last.
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
  /// Drawn to the last pixel and about to be handed to the display.
  void drawn(std::int64_t now_ns);
  /// A refresh began then; a time in the future or older than a second is no use and is ignored.
  void refreshed(std::int64_t refresh_ns, std::int64_t now_ns);

  /// Of a picture that is begun now.
  LitTime lit(std::int64_t now_ns) const;
  /// Pictures begun earlier would only queue up behind the one before.
  std::int64_t next_begin_ns() const { return begun_ns_ + timing_.period_ns; }
  /// Median of the last pictures.
  std::int64_t draw_ns() const;
  std::int64_t longest_draw_ns() const;

 private:
  static constexpr std::size_t kRemembered = 5;

  DisplayTiming timing_;
  std::array<std::int64_t, kRemembered> draws_{};
  std::size_t drawn_ = 0;
  std::int64_t begun_ns_ = 0;
  std::optional<std::int64_t> refresh_ns_;
};

}  // namespace prismesh::kiosk::stereo
