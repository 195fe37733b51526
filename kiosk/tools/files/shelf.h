// The models of the station's store, as rows of the box in which a deck is chosen.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "ipc/store/record.h"
#include "kiosk/tools/files/browse.h"

namespace prismesh::kiosk::tools::files {

/// A row for each record: its name and sender, how old it is, and what it was edited from. `now_s`: since 1970.
std::vector<BrowseRow> shelf_of(std::span<const ipc::store::ModelRecord> records, std::int64_t now_s);

/// The newest models of the store that the intake at this socket has; empty: there is no intake, or none may be read.
std::vector<BrowseRow> read_shelf(const std::filesystem::path& intake_socket);

}  // namespace prismesh::kiosk::tools::files
