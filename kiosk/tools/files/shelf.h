// The models of the station's store, as rows of the box in which a deck is chosen.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/intake/messages.h"
#include "ipc/store/record.h"
#include "kiosk/tools/files/browse.h"

namespace prismesh::kiosk::tools::files {

/// A row for each record: its name and sender, how old it is, and what it was edited from. `now_s`: since 1970.
std::vector<BrowseRow> shelf_of(std::span<const ipc::store::ModelRecord> records, std::int64_t now_s);

/// The newest models of the store that the intake at this socket has; empty: there is no intake, or none may be read.
std::vector<BrowseRow> read_shelf(const std::filesystem::path& intake_socket);

/// The path of the row that asks for a pairing code; no deck's.
inline constexpr std::string_view kPairName = "pair:";

/// How another computer, or a browser, comes to the models: the code, and what must be compared. A browser can't compare by itself.
std::vector<std::string> pairing_words(const ipc::MadePairingCode& made, const ipc::IntakeInfo& info);

/// Asks the intake for a code, by which one computer may list, fetch and send models. Where there is none: why.
std::vector<std::string> ask_for_pairing(const std::filesystem::path& intake_socket);

}  // namespace prismesh::kiosk::tools::files
