// Moves the view smoothly to a point of the model: to the middle of the screen, into its plane, at a scale that shows elements well. Pure;
// times are passed in.
#pragma once

#include <cstdint>
#include <optional>

#include "kiosk/stereo/view.h"

namespace prismesh::kiosk::toolkit {

class ViewGlide {
 public:
  static constexpr std::int64_t kGlideNs = 190'000'000;

  /// `mm_per_unit`: the scale to end with.
  void begin(const stereo::Vec3& point, double mm_per_unit, std::int64_t now_ns) { way_ = Way{point, mm_per_unit, now_ns, now_ns}; }
  bool moving() const { return way_.has_value(); }
  /// The view for now. The remaining distance shrinks by the same share even if the user has moved the view meanwhile.
  stereo::View along(const stereo::View& view, std::int64_t now_ns);

 private:
  struct Way {
    stereo::Vec3 point;
    double mm_per_unit = 1;
    std::int64_t begun_ns = 0;
    std::int64_t last_ns = 0;
  };
  std::optional<Way> way_;
};

/// The scale that shows a length with the wanted number of pixels; the present scale if that shows it between half and four times as
/// large.
double scale_to_look_at(double length, double now_mm_per_unit, double mm_per_pixel, double wanted_pixels = 48);

}  // namespace prismesh::kiosk::toolkit
