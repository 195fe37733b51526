// The small files beside an upload, as text.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/error.h"
#include "daemon/intake/store/new_upload.h"

namespace prismesh::intake {

std::string encode_upload(const NewUpload& upload);
/// Errors: it is damaged. `file` is for errors.
Result<NewUpload> decode_upload(std::string_view text, const std::string& file);

std::string encode_offset(std::uint64_t offset);
/// Nothing: it is damaged.
std::optional<std::uint64_t> decode_offset(std::string_view text);

}  // namespace prismesh::intake
