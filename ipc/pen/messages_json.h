// The pen's messages as lines of JSON, in the same form as modeld's (ipc/model/messages_json.h). docs/protocol.md lists them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/error.h"
#include "ipc/pen/messages.h"
#include "ipc/wire/envelope.h"

namespace prismesh::ipc {

/// Without the line's end. Errors: text in the request isn't UTF-8.
Result<std::string> encode_pen_request(std::uint64_t number, const PenRequest& request);
/// `descriptors`: how many are sent with the line.
std::string encode_pen_answer(std::uint64_t to, const PenAnswer& answer, std::size_t descriptors = 0);
std::string encode_pen_event(const PenEvent& event);

/// Errors name the field and, for an unknown one, the nearest known.
tl::expected<Numbered<PenRequest>, BadRequest> decode_pen_request(std::string_view line);
Result<Said<PenAnswer, PenEvent>> decode_from_pen(std::string_view line);

}  // namespace prismesh::ipc
