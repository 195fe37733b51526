// The view's way to a point of the model: it comes to the middle of the screen, into its plane, at a scale at which an element can be
// looked at. Pure, on times that are passed in.
#pragma once

#include <cstdint>
#include <optional>

#include "kiosk/stereo/view.h"

namespace prismesh::kiosk::tools {

class ViewGlide {
 public:
  static constexpr std::int64_t kGlideNs = 190'000'000;

  /// `mm_per_unit`: the scale to end with.
  void begin(const stereo::Vec3& point, double mm_per_unit, std::int64_t now_ns) { way_ = Way{point, mm_per_unit, now_ns, now_ns}; }
  bool moving() const { return way_.has_value(); }
  /// The view as it should be now. What is left of the way shrinks by the same share whatever the hand did to the view meanwhile.
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

/// The scale at which a length is so many pixels, unless the present one shows it between half and four times as large: then that.
double scale_to_look_at(double length, double now_mm_per_unit, double mm_per_pixel, double wanted_pixels = 48);

}  // namespace prismesh::kiosk::tools
