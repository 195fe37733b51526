// What an exhibition asks of the model server: nothing that reads or writes another file than its deck.
#pragma once

#include <filesystem>

#include "ipc/model/messages.h"

namespace prismesh::kiosk::tools::exhibition {

/// `deck`: the exhibition's, an absolute path.
bool is_allowed(const ipc::Request& request, const std::filesystem::path& deck);

}  // namespace prismesh::kiosk::tools::exhibition
