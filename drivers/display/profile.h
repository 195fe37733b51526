// Display profiles: how a kind of display combines two eyes' pictures into one, and the calibration of one display. Plain data, stored as
// TOML files (docs/display.md lists the keys).
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include "base/error.h"
#include "drivers/display/eyes.h"
#include "drivers/display/optics.h"

namespace prismesh::drivers::display {

enum class Weave : unsigned char {
  mask,     ///< each (sub)pixel shows the eye that the mask sends it to, for any eye positions: prisms, lenses, slits; the mask may lean
  columns,  ///< half-width images in alternate columns that never change; only the mask moves
  stencil,  ///< full-size images; each eye keeps every second column of its own: for comparison, thin lines break up
  rows,     ///< half-height images in alternate rows, for monitors with polarised glasses
  side_by_side,  ///< half-width images next to each other
  top_bottom,    ///< half-height images, the left eye's on top
  anaglyph,      ///< red from the left eye, green and blue from the right one
  one_eye,       ///< the picture of one eye, full size
  centre,        ///< the picture from the point between the eyes, full size, for an ordinary screen
};

/// Order of a pixel's colours from left to right, for a mask that is fine enough to separate them.
enum class Subpixels : unsigned char { none, rgb, bgr };

/// The monitor that a profile was calibrated for; empty texts and zeros match any monitor.
struct Monitor {
  std::string name;                 ///< as in the monitor's EDID
  std::string serial;               ///< as in the monitor's EDID
  std::array<int, 2> pixels{0, 0};  ///< columns and rows of the panel
  bool operator==(const Monitor&) const = default;
};

struct Profile {
  std::string name;
  Weave weave = Weave::mask;
  Eye eye = Eye::left;  ///< the eye that one_eye shows; for other weaves, the eye that the pointer aims with
  /// Exchanges the eyes' parts of the panel: the right eye gets even columns or rows (0, 2, ..), the left or upper half, red.
  bool swap_eyes = false;
  Subpixels subpixels = Subpixels::none;  ///< for weave mask only
  bool mask_moves = false;                ///< a servo shifts the mask; false: the mask stays at its zero
  double gamma = 2.2;                     ///< of the panel: light = value ^ gamma
  /// Share of the other eye's light that the left and the right eye see; for weaves in which both eyes share the panel.
  std::array<double, 2> crosstalk{0, 0};
  std::optional<double> eye_separation_mm{};  ///< measured for this viewer; overrides the tracker's value
  Monitor monitor{};
  MaskOptics optics{};  ///< all weaves use pixel_pitch_mm; the other values are for masks

  bool operator==(const Profile&) const = default;
  bool stereo() const { return weave != Weave::one_eye && weave != Weave::centre; }
  /// Returns whether neighbouring pixels belong to different eyes, so that the picture must be shown pixel by pixel, without scaling.
  bool interlaced() const { return has_mask() || weave == Weave::rows; }
  bool has_mask() const { return weave == Weave::mask || weave == Weave::columns || weave == Weave::stencil; }
};

/// Returns prism-mask, prism-mask-columns, prism-mask-stencil, lenticular, row-interlaced, side-by-side, top-bottom, anaglyph, mono,
/// mono-left and mono-right.
std::span<const Profile> built_in_profiles();
/// Returns a built-in profile by name, or else reads a profile file. Errors: neither exists (lists the built-in names); the file can't be
/// read; see parse_profile.
Result<Profile> find_profile(const std::string& name_or_path);

/// Parses a profile from TOML text. Missing keys keep their defaults; a missing name becomes the file's. `file` is named in errors. Errors,
/// each with its line: text that isn't TOML, an unknown key (with the nearest known one), a value of the wrong type or out of range.
Result<Profile> parse_profile(std::string_view text, const std::string& file);
/// Returns TOML text with all keys, which parse_profile turns into the same profile.
std::string profile_text(const Profile& profile);
/// Writes a profile file atomically. Errors: a value that parse_profile would refuse (says which one); the disk's errors.
Result<void> write_profile(const std::filesystem::path& path, const Profile& profile);

/// Returns the size in mm of a screen of `width` x `height` pixels.
Eigen::Vector2d screen_size_mm(const Profile& profile, int width, int height);

}  // namespace prismesh::drivers::display
