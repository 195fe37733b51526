// Messages as lines of JSON, one message a line: {"request": "open", "number": 5, "path": "car.k"}, {"answer": "done", "to": 5},
// {"event": "document_closed"}. docs/protocol.md lists them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/error.h"
#include "ipc/model/messages.h"
#include "ipc/wire/envelope.h"

namespace prismesh::ipc {

/// Without the line's end. Errors: text in the request isn't UTF-8.
Result<std::string> encode_request(std::uint64_t number, const Request& request);
/// `descriptors`: how many are sent with the line. Text that isn't UTF-8 (names in decks) gets replacement characters.
std::string encode_answer(std::uint64_t to, const Answer& answer, std::size_t descriptors = 0);
std::string encode_event(const Event& event);
/// An answer's fields alone, as an object in one line, for programs that print answers.
std::string answer_fields(const Answer& answer);

using NumberedRequest = Numbered<Request>;
/// Errors name the field and, for an unknown one, the nearest known.
tl::expected<NumberedRequest, BadRequest> decode_request(std::string_view line);

using FromDaemon = Said<Answer, Event>;
Result<FromDaemon> decode_from_daemon(std::string_view line);

}  // namespace prismesh::ipc
