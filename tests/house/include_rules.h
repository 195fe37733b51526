// Who may include whom: the floors of the house, and the rooms inside mesh/. The picture is in docs/architecture.md.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace prismesh::house {

/// A file's room: "base", "mesh/deck", "drivers", "ipc", "daemon/modeld", "kiosk", "cli", "tests"; empty for none of ours.
std::string room_of(std::string_view path);

/// Whether a file in room `from` may include one of room `to`.
bool may_include(std::string_view from, std::string_view to);

/// Every include in a source text that breaks a rule, as "path:line: sentence".
std::vector<std::string> include_violations(std::string_view path, std::string_view text);

}  // namespace prismesh::house
