// The messages of prismesh-setup as lines of JSON, in the same form as modeld's (ipc/model/messages_json.h).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "base/error.h"
#include "ipc/setup/messages.h"

namespace prismesh::ipc {

/// A request is no longer than that, its line's end included.
inline constexpr std::size_t kMaxSetupRequestBytes = 8192;

/// Without the line's end. Errors: text in the request isn't UTF-8.
Result<std::string> encode_setup_request(const SetupRequest& request);
std::string encode_setup_answer(const SetupAnswer& answer);

/// Reads and checks a request (ipc/setup/checks.h). Errors name the field and, for an unknown one, the nearest known.
Result<SetupRequest> decode_setup_request(std::string_view line);
Result<SetupAnswer> decode_setup_answer(std::string_view line);

}  // namespace prismesh::ipc
