// Display profiles: how two eyes' pictures become one picture for a kind of display. Plain data.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include "base/error.h"
#include "kiosk/stereo/frustum.h"

namespace prismesh::kiosk::stereo {

enum class Weave : unsigned char {
  columns,       ///< half-width images dealt out to alternate columns (prism mask, parallax barrier)
  one_eye,       ///< the picture of one eye, full size
  centre,        ///< the picture from between the eyes, full size: an ordinary screen
  anaglyph,      ///< red from the left, green and blue from the right
  side_by_side,  ///< half-width images beside each other
};

struct Profile {
  std::string name;
  Weave weave = Weave::columns;
  Eye eye = Eye::left;             ///< for one_eye: which; else the eye that the pointer aims with
  double pixel_pitch_mm = 0.2805;  ///< of the display
  bool swap_eyes = false;          ///< columns: the right eye has the even columns (0, 2, ..); side_by_side: the right image is left

  bool operator==(const Profile&) const = default;
  bool stereo() const { return weave == Weave::columns || weave == Weave::anaglyph || weave == Weave::side_by_side; }
  bool half_width() const { return weave == Weave::columns || weave == Weave::side_by_side; }
};

/// prism-mask, mono-left, mono-right, mono, anaglyph, side-by-side.
std::span<const Profile> built_in_profiles();
/// A built-in profile by name, or else a profile file (TOML: name, weave, eye, pixel_pitch_mm, swap_eyes). Errors: neither (lists the
/// names), not readable, a wrong or unknown key (file and line).
Result<Profile> find_profile(const std::string& name_or_path);

/// The screen's size in mm for a display of so many pixels.
Eigen::Vector2d screen_size_mm(const Profile& profile, int width, int height);

}  // namespace prismesh::kiosk::stereo
