#include "ipc/setup/client.h"

#include <poll.h>

#include <string>
#include <utility>
#include <variant>

#include "ipc/setup/messages_json.h"
#include "ipc/wire/connection.h"
#include "ipc/wire/failure.h"
#include "ipc/wire/line_socket.h"
#include "ipc/wire/runtime_directory.h"

namespace prismesh::ipc {
namespace {

constexpr LineLimits kAnswerLimits{std::size_t{1} << 20, 0};

}  // namespace

std::filesystem::path setup_socket_path(const std::optional<std::filesystem::path>& override) {
  return runtime_directory(override) / "setup.sock";
}

Result<SetupAnswer> ask_setup(const std::filesystem::path& socket, const SetupRequest& request, std::chrono::milliseconds patience) {
  const auto until = std::chrono::steady_clock::now() + patience;
  Result<std::string> line = encode_setup_request(request);
  if (!line) return fail(line.error());
  Result<Descriptor> connected = connect_to(socket, "this station isn't set up from the kiosk");
  if (!connected) return fail(connected.error());
  LineSocket stream(std::move(*connected), kAnswerLimits);
  stream.queue(std::move(*line));
  for (;;) {
    const Result<bool> sent = stream.flush();
    if (!sent) return fail(sent.error());
    if (const std::optional<std::string_view> answered = stream.next_line()) {
      Result<SetupAnswer> answer = decode_setup_answer(*answered);
      if (!answer) return answer;
      if (const auto* failed = std::get_if<Failed>(&*answer)) return fail(error_from(*failed));
      return answer;
    }
    const Result<bool> ready = wait_for_socket(stream.descriptor(), static_cast<short>(*sent ? POLLIN : POLLIN | POLLOUT), until);
    if (!ready) return fail(ready.error());
    if (!*ready) return fail(socket.string(), "the station's set-up doesn't answer");
    if (const Result<bool> received = stream.receive(); !received) return fail(received.error());
  }
}

}  // namespace prismesh::ipc
