// Display profiles: how two eyes' pictures become one picture for a kind of display, and what was calibrated of one display. Plain data,
// kept as TOML files (docs/display.md lists the keys).
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
  mask,          ///< each (sub)pixel shows the eye that the mask sends it to, wherever the eyes are: prisms, lenses, slits; may lean
  columns,       ///< half-width images dealt out to alternate columns that never change: the mask's shift alone
  stencil,       ///< full-size images of which each eye gets every other column, the rest dropped: for comparison, it tears thin lines
  rows,          ///< half-height images dealt out to alternate rows: monitors for polarised glasses
  side_by_side,  ///< half-width images beside each other
  top_bottom,    ///< half-height images, the left one on top
  anaglyph,      ///< red from the left, green and blue from the right
  one_eye,       ///< the picture of one eye, full size
  centre,        ///< the picture from between the eyes, full size: an ordinary screen
};

/// Order of a pixel's colours from left to right, where a mask is fine enough to tell them apart.
enum class Subpixels : unsigned char { none, rgb, bgr };

/// The monitor that a profile was calibrated for; empty texts and zeros: any.
struct Monitor {
  std::string name;                ///< as the monitor says it itself (EDID)
  std::string serial;              ///< likewise
  std::array<int, 2> pixels{0, 0}; /**< columns and rows of the panel */
  bool operator==(const Monitor&) const = default;
};

struct Profile {
  std::string name;
  Weave weave = Weave::mask;
  Eye eye = Eye::left;  ///< for one_eye: which; else the eye that the pointer aims with
  bool swap_eyes =
      false;  ///< exchanges the eyes' places on the panel: even columns or rows (0, 2, ..), left or upper half, red are the right's
  Subpixels subpixels = Subpixels::none;  ///< weave mask only
  bool mask_moves = false;                ///< a servo shifts the mask; false: it stands at its zero
  double gamma = 2.2;                     ///< of the panel: light = value ^ gamma
  std::array<double, 2> crosstalk{0, 0};  ///< share of the other eye's light that the left, the right eye sees; weaves that share the panel
  std::optional<double> eye_separation_mm{};  ///< measured with this viewer; goes before the tracker's
  Monitor monitor{};
  MaskOptics optics{};  ///< pixel_pitch_mm counts for every weave, the rest for masks

  bool operator==(const Profile&) const = default;
  bool stereo() const { return weave != Weave::one_eye && weave != Weave::centre; }
  /// Neighbouring pixels belong to different eyes: such a picture is right only pixel by pixel.
  bool interlaced() const { return has_mask() || weave == Weave::rows; }
  bool has_mask() const { return weave == Weave::mask || weave == Weave::columns || weave == Weave::stencil; }
};

/// prism-mask, prism-mask-columns, prism-mask-stencil, lenticular, row-interlaced, side-by-side, top-bottom, anaglyph, mono, mono-left,
/// mono-right.
std::span<const Profile> built_in_profiles();
/// A built-in profile by name, or else a profile file. Errors: neither (lists the names), not readable, see parse_profile.
Result<Profile> find_profile(const std::string& name_or_path);

/// A profile from TOML text; keys that lack keep their defaults, the name is then the file's. `file` stands in errors: text that isn't
/// TOML, an unknown key (names the nearest known one), a value of the wrong kind or out of its range: each with its line.
Result<Profile> parse_profile(std::string_view text, const std::string& file);
/// TOML text that parse_profile turns into the same profile, with all keys.
std::string profile_text(const Profile& profile);
/// Writes a profile file, whole or not at all. Errors: a value that reading would refuse (says which), the disk's.
Result<void> write_profile(const std::filesystem::path& path, const Profile& profile);

/// The screen's size in mm for a display of so many pixels.
Eigen::Vector2d screen_size_mm(const Profile& profile, int width, int height);

}  // namespace prismesh::drivers::display
