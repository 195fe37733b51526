// The record of a stored model as text.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/error.h"
#include "ipc/store/record.h"

namespace prismesh::ipc::store {

/// Text with a checksum before it, so that damage is found.
std::string with_checksum(std::string_view text);
/// The text. Nothing: it is damaged.
std::optional<std::string_view> without_checksum(std::string_view checked);

std::string encode_record(const ModelRecord& record);
/// Errors: it is damaged. `file` is for errors.
Result<ModelRecord> decode_record(std::string_view text, const std::string& file);

/// One JSON object, as clients get it.
std::string record_json(const ModelRecord& record);

}  // namespace prismesh::ipc::store
