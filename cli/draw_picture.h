// Draws a document by the headless kiosk. Inner to cli.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/context.h"
#include "mesh/document/document.h"

namespace prismesh::cli {

/// Seals a snapshot and starts the kiosk beside this program, with more of its arguments. `field`: a descriptor that it inherits besides;
/// -1: none. Returns the kiosk's exit status, which has said what was wrong. Errors: there is no kiosk, no memory, it was stopped or
/// killed.
Result<int> draw_picture(const mesh::document::Document& document, const std::filesystem::path& output,
                         const std::vector<std::string>& more, int field, const Context& context);

}  // namespace prismesh::cli
