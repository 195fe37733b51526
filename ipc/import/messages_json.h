// The messages of prismesh-import as lines of JSON, in the same form as modeld's (ipc/model/messages_json.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/error.h"
#include "ipc/import/messages.h"
#include "ipc/wire/envelope.h"

namespace prismesh::ipc {

/// Without the line's end. Errors: text in the request isn't UTF-8.
Result<std::string> encode_import_request(const ImportRequest& request);
/// `descriptors`: how many are sent with the line.
std::string encode_import_answer(const ImportAnswer& answer, std::size_t descriptors = 0);
std::string encode_import_event(const ImportEvent& event);

/// Errors name the field and, for an unknown one, the nearest known.
Result<ImportRequest> decode_import_request(std::string_view line);

Result<Said<ImportAnswer, ImportEvent>> decode_from_import(std::string_view line);

}  // namespace prismesh::ipc
