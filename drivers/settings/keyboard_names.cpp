#include "drivers/settings/keyboard_names.h"

#include <algorithm>
#include <optional>

namespace prismesh::drivers::settings {
namespace {

/// The value of `NAME="value"`; nothing: another line.
std::optional<std::string> value_in(std::string_view line, std::string_view name) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  if (!line.starts_with(name) || line.size() <= name.size() || line[name.size()] != '=') return std::nullopt;
  line.remove_prefix(name.size() + 1);
  if (!line.empty() && (line.front() == '"' || line.front() == '\'')) {
    const std::size_t end = line.find(line.front(), 1);
    return std::string(line.substr(1, end == std::string_view::npos ? end : end - 1));
  }
  return std::string(line.substr(0, line.find_first_of(" \t#\r")));
}

}  // namespace

KeyboardNames read_keyboard_names(std::string_view text) {
  KeyboardNames names;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (auto model = value_in(line, "XKBMODEL")) names.model = *model;
    if (auto layout = value_in(line, "XKBLAYOUT")) names.layout = *layout;
    if (auto variant = value_in(line, "XKBVARIANT")) names.variant = *variant;
    if (auto options = value_in(line, "XKBOPTIONS")) names.options = *options;
  }
  return names;
}

}  // namespace prismesh::drivers::settings
