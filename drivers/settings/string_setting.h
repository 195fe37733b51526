// Sets one text in the text of a settings file and leaves the rest as the user wrote it.
#pragma once

#include <string>
#include <string_view>

#include "base/error.h"

namespace prismesh::drivers::settings {

struct StringSetting {
  std::string_view section, key;
  std::string value;
  std::string_view what;  ///< the setting in words, for errors: "its display profile"
};

/// Replaces the value, or else adds the key to the section, or else appends the section. Keeps comments, order and line ends. TOML has
/// other ways to write a section: whoever calls reads the result before it is written. Errors: the value isn't written in one line.
Result<std::string> with_string(std::string_view text, const std::string& file, const StringSetting& setting);

/// The error where what was read of the result isn't what was set: says what the user has to write.
tl::unexpected<Error> not_changed_safely(const std::string& file, const StringSetting& setting);

}  // namespace prismesh::drivers::settings
