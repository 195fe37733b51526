// The one JSON form of edits.
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "base/error.h"
#include "mesh/document/edit.h"

namespace prismesh::mesh::document {

/// Errors name the field that is wrong or unknown and the nearest known one.
Result<Edit> edit_from_json(const nlohmann::json& json);
nlohmann::json edit_to_json(const Edit& edit);

/// Parses text, then edit_from_json. `syntax_error` (optional) is set when the text isn't JSON at all.
Result<Edit> parse_edit(std::string_view text, bool* syntax_error = nullptr);

}  // namespace prismesh::mesh::document
