#include "drivers/settings/string_setting.h"

#include <optional>

#include "base/toml_text.h"

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

bool is_section_named(std::string_view line, std::string_view section) {
  if (!line.starts_with('[')) return false;
  const std::size_t end = line.find(']');
  return end != std::string_view::npos && trimmed(line.substr(1, end - 1)) == section;
}

/// Returns where the value of `key = ..` begins in a line; nothing for every other line.
std::optional<std::size_t> value_of(std::string_view line, std::string_view key) {
  const std::size_t equals = line.find('=');
  if (equals == std::string_view::npos || trimmed(line.substr(0, equals)) != key) return std::nullopt;
  const std::size_t value = line.find_first_not_of(" \t", equals + 1);
  return value == std::string_view::npos ? line.size() : value;
}

struct KeyPosition {
  std::optional<std::size_t> section_end;  ///< just behind the line of the section
  std::optional<std::size_t> value;        ///< start of the key's value
};

KeyPosition find(std::string_view text, std::string_view section, std::string_view key) {
  KeyPosition found;
  bool inside = false;
  for (std::size_t start = 0; start < text.size();) {
    std::size_t end = text.find('\n', start);
    end = end == std::string_view::npos ? text.size() : end + 1;
    const std::string_view line = text.substr(start, end - start);
    if (const std::string_view words = trimmed(line.substr(0, line.find('\n'))); is_section(words)) {
      inside = is_section_named(words, section);
      if (inside && !found.section_end) found.section_end = end;
    } else if (inside && !found.value) {
      if (const auto value = value_of(line, key)) found.value = start + *value;
    }
    start = end;
  }
  return found;
}

}  // namespace

Result<std::string> with_string(std::string_view text, const std::string& file, const StringSetting& setting) {
  const std::string value = toml_quoted(setting.value);
  const std::string line = std::string(setting.key) + " = " + value, section = "[" + std::string(setting.section) + "]";
  const std::string line_end = text.find("\r\n") != std::string_view::npos ? "\r\n" : "\n";
  const KeyPosition found = find(text, setting.section, setting.key);
  std::string changed(text);
  if (found.value) {
    const std::optional<std::size_t> length = end_of_string(text.substr(*found.value));
    if (!length)
      return fail(file, std::string(setting.what) + " isn't written in one line: set " + line + " under " + section + " yourself");
    changed.replace(*found.value, *length, value);
  } else if (found.section_end) {
    const bool line_open = !text.substr(0, *found.section_end).ends_with('\n');
    changed.insert(*found.section_end, (line_open ? line_end : "") + line + line_end);
  } else {
    if (!changed.empty() && !changed.ends_with('\n')) changed += line_end;
    changed += (changed.empty() ? "" : line_end) + section + line_end + line + line_end;
  }
  return changed;
}

tl::unexpected<Error> not_changed_safely(const std::string& file, const StringSetting& setting) {
  return fail(file, "set " + std::string(setting.key) + " = " + toml_quoted(setting.value) + " under [" + std::string(setting.section) +
                        "] yourself: the file is written in a way that can't be changed safely");
}

}  // namespace prismesh::drivers::settings
