#include "daemon/intake/tls/server.h"

#include <openssl/ssl.h>

#include <list>
#include <utility>

#include <boost/asio/io_context.hpp>

#include "base/log.h"
#include "daemon/intake/tls/connection.h"

namespace prismesh::intake {

namespace asio = boost::asio;
using tcp = asio::ip::tcp;

struct HttpsServer::Impl {
  Impl(const ServerSettings& given, ConnectionContext context_given)
      : settings(given), context{settings,
                                 context_given.api,
                                 context_given.access,
                                 context_given.events,
                                 context_given.figures,
                                 std::move(context_given.store)} {}

  ServerSettings settings;
  ConnectionContext context;
  asio::io_context io{1};
  asio::ssl::context tls{asio::ssl::context::tls_server};
  tcp::acceptor acceptor{io};
  asio::steady_timer pause{io};
  struct Repeated {
    asio::steady_timer timer;
    std::chrono::milliseconds period;
    std::function<void()> work;
  };
  std::list<Repeated> repeated;

  void repeat(Repeated& each) {
    each.timer.expires_after(each.period);
    each.timer.async_wait([this, &each](const boost::system::error_code& error) {
      if (error) return;
      each.work();
      repeat(each);
    });
  }

  Result<void> use(const Identity& identity) {
    boost::system::error_code error;
    tls.use_private_key(asio::buffer(identity.pem), asio::ssl::context::pem, error);
    if (!error) tls.use_certificate(asio::buffer(identity.pem), asio::ssl::context::pem, error);
    SSL_CTX* context_of_tls = tls.native_handle();
    if (error || SSL_CTX_set_min_proto_version(context_of_tls, TLS1_3_VERSION) != 1 || SSL_CTX_set_num_tickets(context_of_tls, 0) != 1)
      return fail("prismesh-intake", "the station's key isn't taken: " + error.message());
    // A connection that waits needs no buffers.
    SSL_CTX_set_mode(context_of_tls, SSL_MODE_RELEASE_BUFFERS);
    return {};
  }

  Result<void> open() {
    boost::system::error_code error;
    const asio::ip::address address = asio::ip::make_address(settings.address, error);
    if (error) return fail("remote.listen", "'" + settings.address + "' is no address");
    const tcp::endpoint endpoint(address, settings.port);
    acceptor.open(endpoint.protocol(), error);
    if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
    if (error) return fail(settings.address + ":" + std::to_string(settings.port), "can't be listened at: " + error.message());
    return {};
  }

  void accept() {
    acceptor.async_accept([this](const boost::system::error_code& error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (error) return wait_and_accept();
      boost::system::error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      // The socket closes at once where there are too many.
      if (context.figures.connections < settings.max_connections) std::make_shared<Connection>(std::move(socket), tls, context)->start();
      accept();
    });
  }

  /// There are no descriptors: others must end first.
  void wait_and_accept() {
    pause.expires_after(std::chrono::milliseconds(100));
    pause.async_wait([this](const boost::system::error_code& error) {
      if (!error) accept();
    });
  }
};

HttpsServer::HttpsServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
HttpsServer::~HttpsServer() = default;

Result<std::unique_ptr<HttpsServer>> HttpsServer::listen(const ServerSettings& settings, const Identity& identity, Api& api, Access& access,
                                                         EventHub& events, Figures& figures, std::shared_ptr<StoreThread> store) {
  auto impl = std::make_unique<Impl>(settings, ConnectionContext{settings, api, access, events, figures, std::move(store)});
  if (const Result<void> used = impl->use(identity); !used) return fail(used.error());
  if (const Result<void> opened = impl->open(); !opened) return fail(opened.error());
  impl->accept();
  return std::unique_ptr<HttpsServer>(new HttpsServer(std::move(impl)));
}

std::uint16_t HttpsServer::port() const { return impl_->acceptor.local_endpoint().port(); }
void HttpsServer::every(std::chrono::milliseconds period, std::function<void()> work) {
  impl_->repeated.push_back({asio::steady_timer(impl_->io), period, std::move(work)});
  impl_->repeat(impl_->repeated.back());
}
void HttpsServer::run() { impl_->io.run(); }
void HttpsServer::stop() { impl_->io.stop(); }

}  // namespace prismesh::intake
