// Changes the ids of SET commands of case control, which are lists without fields. Private to the writer.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck::nastran {

/// The text of a command, which begins with "SET", without some of its single ids. Errors: the reason.
Result<std::string> without_in_case_set(std::string text, std::span<const std::int64_t> leaving);

/// Appends ids to the command at `set`, on lines of their own. Errors: the reason.
Result<std::vector<Replacement>> join_case_set(std::string_view text, const Referrer& set, std::span<const std::int64_t> ids);

}  // namespace prismesh::mesh::deck::nastran
