#include "daemon/setup/setup.h"

#include <poll.h>
#include <pwd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <utility>
#include <variant>

#include "base/log.h"
#include "daemon/setup/machine.h"
#include "ipc/setup/messages_json.h"
#include "ipc/wire/failure.h"
#include "ipc/wire/line_socket.h"

namespace prismesh::setup {
namespace {

/// Whoever connects asks at once.
constexpr std::chrono::seconds kPatience{10};

using Time = std::chrono::steady_clock;

Result<void> wait_until(const ipc::LineSocket& socket, short what, Time::time_point until) {
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Time::now()).count();
    pollfd watched{socket.descriptor(), what, 0};
    const int ready = left <= 0 ? 0 : ::poll(&watched, 1, static_cast<int>(left));
    if (ready > 0) return {};
    if (ready == 0) return fail("request", "nothing came in ten seconds");
    if (errno != EINTR) return fail("request", std::strerror(errno));
  }
}

Result<void> check_peer(int socket, const std::string& kiosk) {
  ucred peer{};
  socklen_t size = sizeof peer;
  if (::getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) return fail("request", std::strerror(errno));
  if (peer.uid == 0 || peer.uid == ::geteuid()) return {};
  const passwd* user = kiosk.empty() ? nullptr : ::getpwnam(kiosk.c_str());  // NOLINT(concurrency-mt-unsafe): one thread
  if (user != nullptr && user->pw_uid == peer.uid) return {};
  return fail("request", "the user " + std::to_string(peer.uid) + " may not set this station up");
}

Result<std::string> receive_line(ipc::LineSocket& socket, Time::time_point until) {
  for (;;) {
    if (const std::optional<std::string_view> line = socket.next_line()) return std::string(*line);
    if (Result<void> waited = wait_until(socket, POLLIN, until); !waited) return fail(waited.error());
    if (Result<bool> received = socket.receive(); !received) return fail(received.error());
  }
}

Result<void> send_line(ipc::LineSocket& socket, std::string line, Time::time_point until) {
  socket.queue(std::move(line));
  for (;;) {
    const Result<bool> sent = socket.flush();
    if (!sent) return fail(sent.error());
    if (*sent) return {};
    if (Result<void> waited = wait_until(socket, POLLOUT, until); !waited) return waited;
  }
}

/// What somebody sent may be quoted, and the log has a line for each entry.
std::string in_one_line(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  return text;
}

Result<void> write(const ipc::SetupRequest& request, const StationFiles& files) {
  struct Write {
    const StationFiles& files;
    Result<void> operator()(const ipc::GetSetup&) const { return {}; }
    Result<void> operator()(const ipc::SetName& m) const { return files.set_name(m.name); }
    Result<void> operator()(const ipc::SetNetwork& m) const { return files.set_network(m); }
    Result<void> operator()(const ipc::SetProfile& m) const { return files.set_profile(m.profile); }
    Result<void> operator()(const ipc::SetCalibration& m) const { return files.set_calibration(m.profile); }
    Result<void> operator()(const ipc::SetPairing& m) const { return files.set_pairing(m.on); }
    Result<void> operator()(const ipc::SetZone& m) const { return files.set_zone(m.zone); }
    Result<void> operator()(const ipc::SetClock&) const { return {}; }
    Result<void> operator()(const ipc::KeepPage& m) const { return files.keep_page(m.page); }
    Result<void> operator()(const ipc::FinishSetup&) const { return files.finish(); }
  };
  return std::visit(Write{files}, request);
}

}  // namespace

ipc::SetupAnswer carry_out(const ipc::SetupRequest& request, const StationFiles& files) {
  if (std::holds_alternative<ipc::GetSetup>(request)) return files.read();
  Result<void> done = write(request, files);
  if (done && files.is_machine()) {
    ::setenv("TZ", ":/etc/localtime", 1);  // NOLINT(concurrency-mt-unsafe): the program has one thread
    ::tzset();
    done = follow(request);
  }
  if (!done) return ipc::failed_from(done.error());
  return ipc::Done{};
}

Result<void> serve(ipc::Descriptor connection, const StationFiles& files, const std::string& kiosk) {
  const Time::time_point until = Time::now() + kPatience;
  const Result<void> allowed = check_peer(connection.get(), kiosk);
  ipc::LineSocket socket(std::move(connection), {ipc::kMaxSetupRequestBytes, 0});
  Result<ipc::SetupRequest> request = fail("request", "");
  if (!allowed) {
    request = fail(allowed.error());
  } else if (const Result<std::string> line = receive_line(socket, until); !line) {
    request = fail(line.error());
  } else {
    request = ipc::decode_setup_request(*line);
  }
  const ipc::SetupAnswer answer = request ? carry_out(*request, files) : ipc::SetupAnswer(ipc::failed_from(request.error()));
  if (const auto* failed = std::get_if<ipc::Failed>(&answer))
    logging::warn("refused: {}", in_one_line(failed->file + ": " + failed->message));
  if (Result<void> sent = send_line(socket, ipc::encode_setup_answer(answer), Time::now() + kPatience); !sent) return sent;
  return request ? Result<void>() : fail(request.error());
}

}  // namespace prismesh::setup
