// deviced's messages as lines of JSON, in the same form as modeld's (ipc/model/messages_json.h). docs/protocol.md lists them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/error.h"
#include "ipc/device/messages.h"
#include "ipc/wire/envelope.h"

namespace prismesh::ipc {

/// Without the line's end. Errors: text in the request isn't UTF-8.
Result<std::string> encode_device_request(std::uint64_t number, const DeviceRequest& request);
/// `descriptors`: how many are sent with the line.
std::string encode_device_answer(std::uint64_t to, const DeviceAnswer& answer, std::size_t descriptors = 0);
std::string encode_device_event(const DeviceEvent& event);
/// An answer's fields alone, as an object in one line, for programs that print answers.
std::string device_answer_fields(const DeviceAnswer& answer);

/// Errors name the field and, for an unknown one, the nearest known.
tl::expected<Numbered<DeviceRequest>, BadRequest> decode_device_request(std::string_view line);
Result<Said<DeviceAnswer, DeviceEvent>> decode_from_deviced(std::string_view line);

}  // namespace prismesh::ipc
