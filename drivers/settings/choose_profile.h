// Makes a display profile the station's own: changes that one line of a settings file and leaves everything else as the user wrote it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/error.h"

namespace prismesh::drivers::settings {

/// The text of a settings file with `profile` (a built-in one's name, or a file; one that isn't absolute is beside the settings) under
/// [display]: replaced where it stands, else added to the section, else the section is
/// added at the end. Comments, order and line ends stay. Errors: the text can't be changed safely, so that somebody has to (says how).
Result<std::string> with_profile(std::string_view text, const std::string& file, const std::filesystem::path& profile);

/// Changes the file, whole or not at all; a file that isn't there is made, and its folders. Errors: those of with_profile, the disk's, and
/// text that is no settings file (nothing is written then).
Result<void> choose_profile(const std::filesystem::path& file, const std::filesystem::path& profile);

}  // namespace prismesh::drivers::settings
