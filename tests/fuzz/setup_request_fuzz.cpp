// Lines from a hostile kiosk or a false prismesh-setup, in both directions: a typed error, or a message that is written and read again; and
// text of a station's files.
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "ipc/setup/checks.h"
#include "ipc/setup/messages_json.h"
#include "tests/fuzz/require.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prismesh::ipc;
  const std::string_view line(reinterpret_cast<const char*>(data), size);
  if (const auto request = decode_setup_request(line)) {
    // Text that came in as JSON is UTF-8, so it can go out.
    const auto again = encode_setup_request(*request);
    require(again.has_value());
    const auto back = decode_setup_request(*again);
    require(back.has_value() && encode_setup_request(*back) == *again);
    // Nothing that is written into a file as it came has a second line, or leads out of a folder. A calibration is written anew.
    for (const char c : *again) require(static_cast<unsigned char>(c) >= ' ');
    const bool calibration = std::holds_alternative<SetCalibration>(*request);
    require(calibration || (again->find("\\n") == std::string::npos && again->find("\\u0000") == std::string::npos &&
                            again->find("..") == std::string::npos));
  } else {
    require(!request.error().message.empty());
  }
  if (const auto answer = decode_setup_answer(line)) {
    const std::string again = encode_setup_answer(*answer);
    const auto back = decode_setup_answer(again);
    require(back.has_value() && encode_setup_answer(*back) == again);
  } else {
    require(!answer.error().message.empty());
  }
  return 0;
}
