// Lines from a hostile client or a false intake daemon, in both directions: a typed error or a message, and a message can be written
// and read again, field for field.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "ipc/intake/messages_json.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prismesh::ipc;
  const std::string_view line(reinterpret_cast<const char*>(data), size);
  if (const auto request = decode_intake_request(line)) {
    // Text that came in as JSON is UTF-8, so it can go out.
    const auto again = encode_intake_request(request->number, request->request);
    if (!again) std::abort();
    const auto back = decode_intake_request(*again);
    if (!back || back->number != request->number) std::abort();
    const auto once_more = encode_intake_request(back->number, back->request);
    if (!once_more || *once_more != *again) std::abort();
  } else if (request.error().message.empty()) {
    std::abort();
  }
  if (const auto message = decode_from_intake(line)) {
    if (const auto* answer = std::get_if<IntakeAnswer>(&message->message)) {
      const std::string again = encode_intake_answer(message->to, *answer, message->descriptors);
      const auto back = decode_from_intake(again);
      if (!back || encode_intake_answer(back->to, std::get<IntakeAnswer>(back->message), back->descriptors) != again) std::abort();
    } else {
      const std::string again = encode_intake_event(std::get<IntakeEvent>(message->message));
      const auto back = decode_from_intake(again);
      if (!back || encode_intake_event(std::get<IntakeEvent>(back->message)) != again) std::abort();
    }
  } else if (message.error().message.empty()) {
    std::abort();
  }
  return 0;
}
