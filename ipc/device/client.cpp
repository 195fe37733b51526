#include "ipc/device/client.h"

#include "ipc/device/messages_json.h"
#include "ipc/wire/connection.h"

namespace prismesh::ipc {

namespace {

struct DeviceProtocol {
  static constexpr const char* kDaemon = "the device daemon";
  using Request = DeviceRequest;
  using Answer = DeviceAnswer;
  using Event = DeviceEvent;
  using Reply = DeviceClient::Reply;
  static Result<std::string> encode(std::uint64_t number, const Request& request) { return encode_device_request(number, request); }
  static Result<Said<Answer, Event>> decode(std::string_view line) { return decode_from_deviced(line); }
};

}  // namespace

std::filesystem::path device_socket_path(const std::optional<std::filesystem::path>& override) {
  return runtime_directory(override) / "deviced.sock";
}

struct DeviceClient::Impl final : Connection<DeviceProtocol> {
  using Connection::Connection;

  std::uint64_t hello = 0;
  DeviceWelcome welcome;
  std::optional<DevicePageReader> page;
};

DeviceClient::DeviceClient(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
DeviceClient::DeviceClient(DeviceClient&&) noexcept = default;
DeviceClient& DeviceClient::operator=(DeviceClient&&) noexcept = default;
DeviceClient::~DeviceClient() = default;

Result<DeviceClient> DeviceClient::begin(const std::filesystem::path& socket, const std::string& program) {
  Result<Descriptor> connected = connect_to(socket, "start the device daemon with `./station run` or `prismesh-deviced`");
  if (!connected) return fail(std::move(connected.error()));
  DeviceClient client(std::make_unique<Impl>(std::move(*connected), socket));
  const Result<std::uint64_t> hello = client.send(DeviceHello{kDeviceProtocolVersion, program});
  if (!hello) return fail(hello.error());
  client.impl_->hello = *hello;
  return client;
}

Result<bool> DeviceClient::greeted(std::chrono::milliseconds patience) {
  if (impl_->page) return true;
  return impl_->take_welcome(impl_->hello, patience, impl_->welcome, impl_->page);
}

Result<DeviceClient> DeviceClient::connect(const std::filesystem::path& socket, const std::string& program) {
  return welcomed(begin(socket, program), socket);
}

Result<std::uint64_t> DeviceClient::send(const DeviceRequest& request) { return impl_->send(request); }

Result<DeviceAnswer> DeviceClient::call(const DeviceRequest& request, std::chrono::milliseconds patience) {
  return impl_->call(request, patience);
}

Result<void> DeviceClient::poll(std::chrono::milliseconds patience) {
  const Result<bool> turned = impl_->turn(std::chrono::steady_clock::now() + patience);
  if (!turned) return fail(turned.error());
  return {};
}

std::optional<DeviceEvent> DeviceClient::next_event() { return impl_->next_event(); }
std::optional<DeviceClient::Reply> DeviceClient::next_reply() { return impl_->next_reply(); }
const DeviceWelcome& DeviceClient::welcome() const { return impl_->welcome; }
const DevicePageReader& DeviceClient::page() const { return *impl_->page; }
int DeviceClient::descriptor() const { return impl_->descriptor(); }

}  // namespace prismesh::ipc
