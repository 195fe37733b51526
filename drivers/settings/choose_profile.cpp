#include "drivers/settings/choose_profile.h"

#include <array>

#include "base/file.h"
#include "drivers/settings/settings.h"
#include "drivers/settings/string_setting.h"

namespace prismesh::drivers::settings {

Result<std::string> with_profile(std::string_view text, const std::string& file, const std::filesystem::path& profile) {
  const StringSetting setting{"display", "profile", profile.string(), "its display profile"};
  Result<std::string> changed = with_string(text, file, setting);
  if (!changed) return changed;
  // Verify the result before writing, because TOML has other ways to write a section.
  const Result<StationSettings> read = parse_settings_part(*changed, file);
  if (!read) return fail(read.error());
  const std::string beside = (std::filesystem::path(file).parent_path() / profile).lexically_normal().string();
  if (read->display.profile != beside && read->display.profile != profile.string()) return not_changed_safely(file, setting);
  return changed;
}

Result<void> choose_profile(const std::filesystem::path& file, const std::filesystem::path& profile) {
  std::error_code error;
  FileBytes bytes;
  if (std::filesystem::exists(file, error)) {
    Result<FileBytes> read = read_file(file);
    if (!read) return fail(read.error());
    bytes = std::move(*read);
    if (Result<StationSettings> valid = parse_settings_part(bytes.text(), file); !valid) return fail(valid.error());
  }
  const Result<std::string> changed = with_profile(bytes.text(), file.string(), profile);
  if (!changed) return fail(changed.error());
  const std::array<PendingFile, 1> files{{{file, {*changed}}}};
  return replace_files(files);
}

}  // namespace prismesh::drivers::settings
