// Who may include whom: the layers, and the modules inside mesh/. The picture is in docs/architecture.md.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace prismesh::architecture {

/// A file's module: "base", "mesh/deck", "drivers", "ipc", "daemon/modeld", "kiosk", "cli", "tests"; empty for none of ours.
std::string module_of(std::string_view path);

/// Whether a file in module `from` may include one of module `to`.
bool may_include(std::string_view from, std::string_view to);

/// Every include in a source text that breaks a rule, as "path:line: sentence".
std::vector<std::string> include_violations(std::string_view path, std::string_view text);

}  // namespace prismesh::architecture
