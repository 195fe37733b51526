// The messages of prismesh-intake as lines of JSON, in the same form as modeld's (ipc/model/messages_json.h). docs/protocol.md lists them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/error.h"
#include "ipc/intake/messages.h"
#include "ipc/wire/envelope.h"

namespace prismesh::ipc {

/// Without the line's end. Errors: text in the request isn't UTF-8.
Result<std::string> encode_intake_request(std::uint64_t number, const IntakeRequest& request);
std::string encode_intake_answer(std::uint64_t to, const IntakeAnswer& answer, std::size_t descriptors = 0);
std::string encode_intake_event(const IntakeEvent& event);

/// Errors name the field and, for an unknown one, the nearest known.
tl::expected<Numbered<IntakeRequest>, BadRequest> decode_intake_request(std::string_view line);
Result<Said<IntakeAnswer, IntakeEvent>> decode_from_intake(std::string_view line);

}  // namespace prismesh::ipc
