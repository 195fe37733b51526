// Runs a kiosk without a display: writes pictures of what it would show into a folder.
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "kiosk/app_options.h"
#include "kiosk/picture_watch.h"
#include "kiosk/render/offscreen.h"
#include "kiosk/station.h"

namespace prismesh::kiosk {

class HeadlessKiosk {
 public:
  HeadlessKiosk(const AppOptions& options, Station& station, const render::Offscreen& target);

  /// Runs until the pictures are written. Errors: a model too large for the GPU; a picture can't be written.
  Result<void> run();

 private:
  /// A picture that was taken and whose measured eyes haven't been told yet.
  struct Shot {
    std::filesystem::path file;
    std::int64_t lit_ns = 0;
  };
  /// The eyes and the mask as they were measured, not predicted.
  struct Measured {
    std::int64_t eyes_ns = 0;
    mesh::Vec3 eyes_mm = mesh::Vec3::Zero();
    std::int64_t mask_ns = 0;
    double mask_mm = 0;
  };

  bool settled() const;
  Result<void> shoot();
  void remember();
  /// Tells for the oldest pictures where eyes and mask were when these would have lit up, as soon as that was measured.
  void tell_seen();

  const AppOptions& options_;
  Station& station_;
  const render::Offscreen& target_;
  int taken_ = 0;
  std::deque<Shot> shots_;
  std::deque<Measured> measured_;
  PictureWatch watch_{reports_to_supervisor()};
};

}  // namespace prismesh::kiosk
