// Rules of includes: a module includes only modules that it uses; no header–source pair includes itself through others.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tests/architecture/tree.h"

namespace prismesh::architecture {

/// The module of a file: its folder for the product ("mesh/deck/lsdyna"), "tests/viewer", or "tests"; empty for files of others.
std::string module_of(std::string_view path);

/// Whether a file of module `from` may include one of module `to`.
bool may_include(std::string_view from, std::string_view to);

/// Every include in a source text that breaks a rule, as "path:line: sentence".
std::vector<std::string> include_violations(std::string_view path, std::string_view text);

/// Header–source pairs that include each other, directly or through others. A pair is a header and the source of the same name in one
/// folder.
std::vector<std::string> pair_cycles(const std::vector<SourceText>& sources);

}  // namespace prismesh::architecture
