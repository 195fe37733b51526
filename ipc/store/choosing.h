// Finds the model that a user means by its name or hash.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "ipc/store/record.h"

namespace prismesh::ipc::store {

/// Whether a text may be meant as a hash or its beginning: six or more hexadecimal digits and nothing else. A vault takes no such name.
bool may_be_hash(std::string_view text);

/// The place of the model that is meant. `wanted`: its hash, at least six digits of the beginning of its hash, or its whole name; a whole
/// hash is never compared with names, which anybody may choose. `where`: who has the models; `lists`: the command that lists them. Errors:
/// there is none, or there are several.
Result<std::size_t> choose_model(const std::vector<ModelRecord>& models, const std::string& wanted, const std::string& where,
                                 const std::string& lists);

}  // namespace prismesh::ipc::store
