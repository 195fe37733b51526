#include "ipc/intake/client.h"

#include "ipc/intake/messages_json.h"
#include "ipc/wire/connection.h"
#include "ipc/wire/runtime_directory.h"

namespace prismesh::ipc {

namespace {

struct IntakeReply {
  std::uint64_t request = 0;
  IntakeAnswer answer;
};

struct IntakeProtocol {
  static constexpr const char* kDaemon = "the intake daemon";
  using Request = IntakeRequest;
  using Answer = IntakeAnswer;
  using Event = IntakeEvent;
  using Reply = IntakeReply;
  static Result<std::string> encode(std::uint64_t number, const Request& request) { return encode_intake_request(number, request); }
  static Result<Said<Answer, Event>> decode(std::string_view line) { return decode_from_intake(line); }
};

}  // namespace

std::filesystem::path intake_socket_path(const std::optional<std::filesystem::path>& override) {
  return runtime_directory(override) / "intake.sock";
}

struct IntakeClient::Impl final : Connection<IntakeProtocol> {
  using Connection::Connection;
};

IntakeClient::IntakeClient(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
IntakeClient::IntakeClient(IntakeClient&&) noexcept = default;
IntakeClient& IntakeClient::operator=(IntakeClient&&) noexcept = default;
IntakeClient::~IntakeClient() = default;

Result<IntakeClient> IntakeClient::connect(const std::filesystem::path& socket, const std::string& program,
                                           std::chrono::milliseconds patience) {
  Result<Descriptor> connected = connect_to(socket, "start it with `prismesh-intake`");
  if (!connected) return fail(std::move(connected.error()));
  IntakeClient client(std::make_unique<Impl>(std::move(*connected), socket));
  const Result<IntakeAnswer> welcome = client.call(IntakeHello{kIntakeProtocolVersion, program}, patience);
  if (!welcome) return fail(welcome.error());
  if (!std::holds_alternative<IntakeWelcome>(*welcome)) return fail(socket.string(), "what listens there isn't the intake daemon");
  return client;
}

Result<IntakeAnswer> IntakeClient::call(const IntakeRequest& request, std::chrono::milliseconds patience) {
  return impl_->call(request, patience);
}

Result<void> IntakeClient::poll(std::chrono::milliseconds patience) {
  const Result<bool> turned = impl_->turn(std::chrono::steady_clock::now() + patience);
  if (!turned) return fail(turned.error());
  return {};
}

std::optional<IntakeEvent> IntakeClient::next_event() { return impl_->next_event(); }
int IntakeClient::descriptor() const { return impl_->descriptor(); }

}  // namespace prismesh::ipc
