#include "drivers/settings/choose_profile.h"

#include <array>
#include <optional>
#include <vector>

#include "base/file.h"
#include "base/toml_text.h"
#include "drivers/settings/settings.h"

namespace prismesh::drivers::settings {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Returns the end of the string, in single or double quotes, at the start of `text`; nothing for any other value.
std::optional<std::size_t> end_of_string(std::string_view text) {
  if (text.empty() || (text[0] != '"' && text[0] != '\'') || text.substr(0, 3) == std::string(3, text[0])) return std::nullopt;
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (text[i] == text[0]) return i + 1;
    if (text[i] == '\\' && text[0] == '"') ++i;
  }
  return std::nullopt;
}

bool is_section(std::string_view line) { return line.starts_with('['); }

bool is_display_section(std::string_view line) {
  if (!line.starts_with('[')) return false;
  const std::size_t end = line.find(']');
  return end != std::string_view::npos && trimmed(line.substr(1, end - 1)) == "display";
}

/// Returns where the value of `profile = ..` begins in a line; nothing for every other line.
std::optional<std::size_t> profile_value(std::string_view line) {
  const std::size_t equals = line.find('=');
  if (equals == std::string_view::npos || trimmed(line.substr(0, equals)) != "profile") return std::nullopt;
  const std::size_t value = line.find_first_not_of(" \t", equals + 1);
  return value == std::string_view::npos ? line.size() : value;
}

struct ProfileKeyPosition {
  std::optional<std::size_t> section_end;  ///< just behind the line [display]
  std::optional<std::size_t> value;        ///< start of the value of the key `profile`
};

ProfileKeyPosition find(std::string_view text) {
  ProfileKeyPosition found;
  bool inside = false;
  for (std::size_t start = 0; start < text.size();) {
    std::size_t end = text.find('\n', start);
    end = end == std::string_view::npos ? text.size() : end + 1;
    const std::string_view line = text.substr(start, end - start);
    if (const std::string_view words = trimmed(line.substr(0, line.find('\n'))); is_section(words)) {
      inside = is_display_section(words);
      if (inside && !found.section_end) found.section_end = end;
    } else if (inside && !found.value) {
      if (const auto value = profile_value(line)) found.value = start + *value;
    }
    start = end;
  }
  return found;
}

}  // namespace

Result<std::string> with_profile(std::string_view text, const std::string& file, const std::filesystem::path& profile) {
  const std::string value = toml_quoted(profile.string());
  const std::string line_end = text.find("\r\n") != std::string_view::npos ? "\r\n" : "\n";
  const ProfileKeyPosition found = find(text);
  std::string changed(text);
  if (found.value) {
    const std::optional<std::size_t> length = end_of_string(text.substr(*found.value));
    if (!length) return fail(file, "its display profile isn't written in one line: set profile = " + value + " under [display] yourself");
    changed.replace(*found.value, *length, value);
  } else if (found.section_end) {
    const bool line_open = !text.substr(0, *found.section_end).ends_with('\n');
    changed.insert(*found.section_end, (line_open ? line_end : "") + "profile = " + value + line_end);
  } else {
    if (!changed.empty() && !changed.ends_with('\n')) changed += line_end;
    changed += (changed.empty() ? "" : line_end) + "[display]" + line_end + "profile = " + value + line_end;
  }
  // Verify the result before writing, because TOML has other ways to write a section.
  const Result<StationSettings> read = parse_settings_part(changed, file);
  if (!read) return fail(read.error());
  const std::string beside = (std::filesystem::path(file).parent_path() / profile).lexically_normal().string();
  if (read->display.profile != beside && read->display.profile != profile.string())
    return fail(file, "set profile = " + value + " under [display] yourself: the file is written in a way that can't be changed safely");
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
