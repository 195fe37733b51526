#include "drivers/display/profile.h"

#include "base/file.h"

namespace prismesh::drivers::display {

namespace {

std::string known_profiles() {
  std::string names;
  for (const Profile& profile : built_in_profiles()) names += (names.empty() ? "" : ", ") + profile.name;
  return names;
}

}  // namespace

std::span<const Profile> built_in_profiles() {
  // The lenticular's elements lean by one pixel in six, as usual: this spreads the black grid between the pixels over both eyes.
  static const std::array<Profile, 11> kProfiles{
      {{.name = "prism-mask", .weave = Weave::mask, .subpixels = Subpixels::rgb, .mask_moves = true},
       {.name = "prism-mask-columns", .weave = Weave::columns, .mask_moves = true},
       {.name = "prism-mask-stencil", .weave = Weave::stencil, .mask_moves = true},
       {.name = "lenticular", .weave = Weave::mask, .subpixels = Subpixels::rgb, .optics = {.lean = 1.0 / 6}},
       {.name = "row-interlaced", .weave = Weave::rows},
       {.name = "side-by-side", .weave = Weave::side_by_side},
       {.name = "top-bottom", .weave = Weave::top_bottom},
       {.name = "anaglyph", .weave = Weave::anaglyph},
       {.name = "mono", .weave = Weave::centre},
       {.name = "mono-left", .weave = Weave::one_eye, .eye = Eye::left},
       {.name = "mono-right", .weave = Weave::one_eye, .eye = Eye::right}}};
  return kProfiles;
}

Result<Profile> find_profile(const std::string& name_or_path) {
  for (const Profile& profile : built_in_profiles())
    if (profile.name == name_or_path) return profile;
  std::error_code ignored;
  if (!std::filesystem::exists(name_or_path, ignored))
    return fail(name_or_path, "there is no display profile of this name and no such file; profiles are " + known_profiles());
  const Result<FileBytes> bytes = read_file(name_or_path);
  if (!bytes) return fail(bytes.error());
  return parse_profile(bytes->text(), name_or_path);
}

Result<void> write_profile(const std::filesystem::path& path, const Profile& profile) {
  const std::string text = profile_text(profile);
  // A profile that can't be read again must not be written.
  const Result<Profile> again = parse_profile(text, path.string());
  if (!again) return fail(again.error());
  const PendingFile file{path, {text}};
  return replace_files({&file, 1});
}

Eigen::Vector2d screen_size_mm(const Profile& profile, int width, int height) {
  return Eigen::Vector2d(width, height) * profile.optics.pixel_pitch_mm;
}

}  // namespace prismesh::drivers::display
