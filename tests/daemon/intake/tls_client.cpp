#include "tests/daemon/intake/tls_client.h"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>

namespace prismesh::intake {

struct TlsClient::Impl {
  int socket = -1;
  SSL_CTX* context = nullptr;
  SSL* tls = nullptr;
  bool connected = false;
  std::string buffer;

  ~Impl() {
    SSL_free(tls);
    SSL_CTX_free(context);
    if (socket >= 0) ::close(socket);
  }
  bool read_more() {
    char bytes[16384];
    const int got = connected ? SSL_read(tls, bytes, sizeof bytes) : 0;
    if (got <= 0) return false;
    buffer.append(bytes, static_cast<std::size_t>(got));
    return true;
  }
};

TlsClient::TlsClient(std::uint16_t port, int newest) : impl_(std::make_unique<Impl>()) {
  impl_->socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const timeval patience{20, 0};
  ::setsockopt(impl_->socket, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  ::setsockopt(impl_->socket, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  const int at_once = 1;
  ::setsockopt(impl_->socket, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(impl_->socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return;
  impl_->context = SSL_CTX_new(TLS_client_method());
  SSL_CTX_set_max_proto_version(impl_->context, newest);
  impl_->tls = SSL_new(impl_->context);
  SSL_set_fd(impl_->tls, impl_->socket);
  impl_->connected = SSL_connect(impl_->tls) == 1;
}

TlsClient::TlsClient(TlsClient&&) noexcept = default;
TlsClient::~TlsClient() = default;

bool TlsClient::connected() const { return impl_->connected; }
std::string TlsClient::version() const { return SSL_get_version(impl_->tls); }

ipc::store::ContentHash TlsClient::fingerprint() const {
  ipc::store::ContentHash hash;
  X509* certificate = SSL_get1_peer_certificate(impl_->tls);
  unsigned size = 0;
  if (certificate != nullptr) X509_digest(certificate, EVP_sha256(), hash.bytes.data(), &size);
  X509_free(certificate);
  return hash;
}

bool TlsClient::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const int wrote =
        impl_->connected ? SSL_write(impl_->tls, bytes.data(), static_cast<int>(std::min<std::size_t>(bytes.size(), 1 << 20))) : 0;
    if (wrote <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(wrote));
  }
  return true;
}

std::string TlsClient::receive_until(std::string_view text) {
  std::size_t at = impl_->buffer.find(text);
  while (at == std::string::npos && impl_->read_more()) at = impl_->buffer.find(text);
  const std::size_t end = at == std::string::npos ? impl_->buffer.size() : at + text.size();
  std::string got = impl_->buffer.substr(0, end);
  impl_->buffer.erase(0, end);
  return got;
}

TestResponse TlsClient::receive(bool to_head) {
  TestResponse response;
  const std::string head = receive_until("\r\n\r\n");
  if (!head.starts_with("HTTP/1.1 ") || head.size() < 14) return response;
  response.status = static_cast<unsigned>(std::stoi(head.substr(9, 3)));
  for (std::size_t at = head.find("\r\n") + 2; at < head.size() && head.compare(at, 2, "\r\n") != 0; at = head.find("\r\n", at) + 2) {
    const std::size_t colon = head.find(": ", at), end = head.find("\r\n", at);
    std::string name = head.substr(at, colon - at);
    std::transform(name.begin(), name.end(), name.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    response.headers[name] = head.substr(colon + 2, end - colon - 2);
  }
  if (response.status == 100) return receive(to_head);
  if (to_head || response.header("content-length").empty()) return response;
  const auto bytes = static_cast<std::size_t>(std::stoull(response.header("content-length")));
  while (impl_->buffer.size() < bytes && impl_->read_more()) {
  }
  response.body = impl_->buffer.substr(0, bytes);
  impl_->buffer.erase(0, bytes);
  if (response.body.size() < bytes) response.status = 0;
  return response;
}

void TlsClient::cut() {
  // No goodbye: as a cable that is pulled.
  const linger at_once{1, 0};
  ::setsockopt(impl_->socket, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  ::close(impl_->socket);
  impl_->socket = -1;
  impl_->connected = false;
}

}  // namespace prismesh::intake
