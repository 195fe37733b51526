#include "kiosk/stereo/profile.h"

#include <array>

#include <toml++/toml.h>

#include "base/file.h"

namespace prismesh::kiosk::stereo {

namespace {

constexpr std::array<std::pair<std::string_view, Weave>, 5> kWeaves{{{"columns", Weave::columns},
                                                                     {"one-eye", Weave::one_eye},
                                                                     {"centre", Weave::centre},
                                                                     {"anaglyph", Weave::anaglyph},
                                                                     {"side-by-side", Weave::side_by_side}}};

std::string known_profiles() {
  std::string names;
  for (const Profile& profile : built_in_profiles()) names += (names.empty() ? "" : ", ") + profile.name;
  return names;
}

tl::unexpected<Error> wrong(const std::string& file, const toml::node& node, const std::string& message) {
  return fail(file, static_cast<long>(node.source().begin.line), message);
}

/// Sets what one key says. `key` is known to the caller only as text.
Result<void> read_key(const std::string& file, std::string_view key, const toml::node& value, Profile& profile) {
  if (key == "name") {
    if (!value.is_string()) return wrong(file, value, "name must be a text");
    profile.name = value.ref<std::string>();
  } else if (key == "weave") {
    for (const auto& [name, weave] : kWeaves)
      if (value.value<std::string>() == name) return profile.weave = weave, Result<void>();
    return wrong(file, value, "weave must be one of \"columns\", \"one-eye\", \"centre\", \"anaglyph\", \"side-by-side\"");
  } else if (key == "eye") {
    const auto eye = value.value<std::string>();
    if (eye != "left" && eye != "right") return wrong(file, value, "eye must be \"left\" or \"right\"");
    profile.eye = eye == "left" ? Eye::left : Eye::right;
  } else if (key == "pixel_pitch_mm") {
    const auto pitch = value.value<double>();
    if (!pitch || !(*pitch >= 0.01 && *pitch <= 10)) return wrong(file, value, "pixel_pitch_mm must be a number from 0.01 to 10");
    profile.pixel_pitch_mm = *pitch;
  } else if (key == "swap_eyes") {
    if (!value.is_boolean()) return wrong(file, value, "swap_eyes must be true or false");
    profile.swap_eyes = *value.value<bool>();
  } else {
    return wrong(file, value,
                 "unknown key \"" + std::string(key) + "\"; a display profile has name, weave, eye, pixel_pitch_mm and swap_eyes");
  }
  return {};
}

Result<Profile> read_profile(const std::filesystem::path& path) {
  const Result<FileBytes> bytes = read_file(path);
  if (!bytes) return fail(bytes.error());
  Profile profile;
  profile.name = path.stem().string();
  try {
    const toml::table table = toml::parse(bytes->text(), path.string());
    for (const auto& [key, value] : table)
      if (const auto read = read_key(path.string(), key.str(), value, profile); !read) return fail(read.error());
  } catch (const toml::parse_error& error) {
    return fail(path.string(), static_cast<long>(error.source().begin.line), std::string(error.description()));
  }
  return profile;
}

}  // namespace

std::span<const Profile> built_in_profiles() {
  static const std::array<Profile, 6> profiles{{{.name = "prism-mask", .weave = Weave::columns},
                                                {.name = "mono-left", .weave = Weave::one_eye, .eye = Eye::left},
                                                {.name = "mono-right", .weave = Weave::one_eye, .eye = Eye::right},
                                                {.name = "mono", .weave = Weave::centre},
                                                {.name = "anaglyph", .weave = Weave::anaglyph},
                                                {.name = "side-by-side", .weave = Weave::side_by_side}}};
  return profiles;
}

Result<Profile> find_profile(const std::string& name_or_path) {
  for (const Profile& profile : built_in_profiles())
    if (profile.name == name_or_path) return profile;
  std::error_code ignored;
  if (!std::filesystem::exists(name_or_path, ignored))
    return fail(name_or_path, "there is no display profile of this name and no such file; profiles are " + known_profiles());
  return read_profile(name_or_path);
}

Eigen::Vector2d screen_size_mm(const Profile& profile, int width, int height) {
  return Eigen::Vector2d(width, height) * profile.pixel_pitch_mm;
}

}  // namespace prismesh::kiosk::stereo
