// Takes journals out of use. One whose content wasn't read to its end becomes "damaged", which is never removed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "base/error.h"
#include "daemon/modeld/state_folder.h"
#include "mesh/document/journal.h"

namespace prismesh::modeld {

/// Number of records in a journal that nobody has open; nothing, if it can't be read to its end.
std::optional<std::uint64_t> records_in(const std::filesystem::path& journal);

/// Retires the file of an open journal under `ending`; as damaged, where it holds anything that wasn't read. Does nothing if the file is
/// gone. Errors: it can't be renamed.
Result<void> retire_open(const StateFolder& folder, const mesh::document::Journal& journal, const char* ending);

/// Retires a journal that nobody has open under `ending`; as damaged, where it can't be read to its end. Returns the new path. Errors: it
/// can't be renamed.
Result<std::filesystem::path> retire_unopened(const StateFolder& folder, const std::filesystem::path& journal, const char* ending);

}  // namespace prismesh::modeld
