// Lines from a hostile peer, in both directions: a typed error or a message, and a message can be written and read again.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "ipc/import/messages_json.h"
#include "ipc/model/messages_json.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prismesh::ipc;
  const std::string_view line(reinterpret_cast<const char*>(data), size);
  if (const auto request = decode_request(line)) {
    const auto again = encode_request(request->number, request->request);
    // Text that came in as JSON is UTF-8, so it can go out.
    if (!again || !decode_request(*again)) std::abort();
  } else if (request.error().message.empty()) {
    std::abort();
  }
  if (const auto message = decode_from_daemon(line)) {
    if (const auto* answer = std::get_if<Answer>(&message->message)) {
      if (!decode_from_daemon(encode_answer(message->to, *answer, message->descriptors))) std::abort();
    } else if (!decode_from_daemon(encode_event(std::get<Event>(message->message)))) {
      std::abort();
    }
  } else if (message.error().message.empty()) {
    std::abort();
  }
  // What a hostile prismesh-import may say, and a request to it.
  if (const auto message = decode_from_import(line)) {
    if (const auto* answer = std::get_if<ImportAnswer>(&message->message))
      if (!decode_from_import(encode_import_answer(*answer, message->descriptors))) std::abort();
  } else if (message.error().message.empty()) {
    std::abort();
  }
  if (const auto request = decode_import_request(line)) {
    const auto again = encode_import_request(*request);
    if (!again || !decode_import_request(*again)) std::abort();
  }
  return 0;
}
