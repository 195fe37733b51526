#include "ipc/pen/client.h"

#include "ipc/pen/messages_json.h"
#include "ipc/wire/connection.h"

namespace prismesh::ipc {

namespace {

struct PenProtocol {
  static constexpr const char* kDaemon = "the pen daemon";
  using Request = PenRequest;
  using Answer = PenAnswer;
  using Event = PenEvent;
  using Reply = PenClient::Reply;
  static Result<std::string> encode(std::uint64_t number, const Request& request) { return encode_pen_request(number, request); }
  static Result<Said<Answer, Event>> decode(std::string_view line) { return decode_from_pen(line); }
};

/// The state page with its descriptor, which is handed on.
struct KeptPage {
  Descriptor descriptor;
  PenPageReader reader;

  static Result<KeptPage> map(const Descriptor& descriptor) {
    Result<PenPageReader> reader = PenPageReader::map(descriptor);
    if (!reader) return fail(std::move(reader.error()));
    Result<Descriptor> kept = descriptor.duplicate();
    if (!kept) return fail(std::move(kept.error()));
    return KeptPage{std::move(*kept), std::move(*reader)};
  }
};

}  // namespace

std::filesystem::path pen_socket_path(const std::optional<std::filesystem::path>& override) {
  return runtime_directory(override) / "pen.sock";
}

struct PenClient::Impl final : Connection<PenProtocol> {
  using Connection::Connection;

  std::uint64_t hello = 0;
  PenWelcome welcome;
  std::optional<KeptPage> page;
};

PenClient::PenClient(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
PenClient::PenClient(PenClient&&) noexcept = default;
PenClient& PenClient::operator=(PenClient&&) noexcept = default;
PenClient::~PenClient() = default;

Result<PenClient> PenClient::begin(const std::filesystem::path& socket, const std::string& program) {
  Result<Descriptor> connected = connect_to(socket, "start it with `prismesh-deviced --only pen`");
  if (!connected) return fail(std::move(connected.error()));
  PenClient client(std::make_unique<Impl>(std::move(*connected), socket));
  const Result<std::uint64_t> hello = client.send(PenHello{kPenProtocolVersion, program});
  if (!hello) return fail(hello.error());
  client.impl_->hello = *hello;
  return client;
}

Result<bool> PenClient::greeted(std::chrono::milliseconds patience) {
  if (impl_->page) return true;
  return impl_->take_welcome(impl_->hello, patience, impl_->welcome, impl_->page);
}

Result<PenClient> PenClient::connect(const std::filesystem::path& socket, const std::string& program) {
  return welcomed(begin(socket, program), socket);
}

Result<std::uint64_t> PenClient::send(const PenRequest& request) { return impl_->send(request); }

Result<PenAnswer> PenClient::call(const PenRequest& request, std::chrono::milliseconds patience) { return impl_->call(request, patience); }

Result<void> PenClient::poll(std::chrono::milliseconds patience) {
  const Result<bool> turned = impl_->turn(std::chrono::steady_clock::now() + patience);
  if (!turned) return fail(turned.error());
  return {};
}

Result<std::uint64_t> PenClient::send_field(const Descriptor& page) {
  Result<Descriptor> theirs = page.duplicate();
  if (!theirs) return fail(std::move(theirs.error()));
  std::vector<Descriptor> descriptors;
  descriptors.push_back(std::move(*theirs));
  return impl_->send(AttachField{}, std::move(descriptors));
}

Result<PenAnswer> PenClient::attach_field(const Descriptor& page, std::chrono::milliseconds patience) {
  const Result<std::uint64_t> number = send_field(page);
  if (!number) return fail(number.error());
  return impl_->wait(*number, patience);
}

std::optional<PenEvent> PenClient::next_event() { return impl_->next_event(); }
std::optional<PenClient::Reply> PenClient::next_reply() { return impl_->next_reply(); }
const PenWelcome& PenClient::welcome() const { return impl_->welcome; }
const PenPageReader& PenClient::page() const { return impl_->page->reader; }
const Descriptor& PenClient::page_descriptor() const { return impl_->page->descriptor; }
int PenClient::descriptor() const { return impl_->descriptor(); }

}  // namespace prismesh::ipc
