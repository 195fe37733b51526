// Sets the station's display profile in a settings file: changes that one line and leaves the rest as the user wrote it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/error.h"

namespace prismesh::drivers::settings {

/// Returns the text of a settings file with `profile` set under [display]: replaces the value, or else adds the key to the section, or else
/// appends the section. `profile`: a built-in profile's name or a file, relative to the settings file. Keeps comments, order and line ends.
/// Errors: the text can't be changed safely, so the user has to change it (says how).
Result<std::string> with_profile(std::string_view text, const std::string& file, const std::filesystem::path& profile);

/// Changes the file atomically; creates it and its folders if missing. Errors: those of with_profile; the disk's errors; an existing file
/// that isn't a settings file (then nothing is written).
Result<void> choose_profile(const std::filesystem::path& file, const std::filesystem::path& profile);

}  // namespace prismesh::drivers::settings
