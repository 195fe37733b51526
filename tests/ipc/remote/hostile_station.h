// A station with a sound key that answers what a test wants, right or wrong.
#pragma once

#include <openssl/ssl.h>
#include <pthread.h>
#include <signal.h>

#include <functional>
#include <string>
#include <utility>

#include "daemon/intake/tls/identity.h"
#include "ipc/remote/station_book.h"
#include "tests/ipc/remote/cutting_line.h"

namespace prismesh::ipc::remote {

class HostileStation {
 public:
  /// `answer`: the whole answer to a request, whose first line and headers it gets.
  HostileStation(const std::filesystem::path& folder, std::function<std::string(const std::string& head)> answer)
      : answer_(std::move(answer)) {
    const Result<store::Folder> opened = store::Folder::open(folder);
    EXPECT_TRUE(opened);
    const Result<intake::Identity> identity = intake::open_identity(*opened);
    EXPECT_TRUE(identity) << identity.error().text();
    fingerprint_ = identity->fingerprint;
    context_ = SSL_CTX_new(TLS_server_method());
    const std::string pem = (folder / "identity.pem").string();
    EXPECT_EQ(SSL_CTX_use_PrivateKey_file(context_, pem.c_str(), SSL_FILETYPE_PEM), 1);
    EXPECT_EQ(SSL_CTX_use_certificate_chain_file(context_, pem.c_str()), 1);
    listening_ = listen_on_loopback(port_);
    serving_ = std::thread([this] { serve(); });
  }
  ~HostileStation() {
    ends_ = true;
    serving_.join();
    ::close(listening_);
    SSL_CTX_free(context_);
  }
  HostileStation(const HostileStation&) = delete;
  HostileStation& operator=(const HostileStation&) = delete;

  PairedStation paired() const {
    PairedStation station;
    station.address = {"127.0.0.1", port_};
    station.name = station.address.text();
    station.fingerprint = fingerprint_;
    station.token = "pm_0";
    station.token_name = "test";
    return station;
  }

  static std::string ok(const std::string& body) {
    return "HTTP/1.1 200 OK\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
  }

 private:
  void serve() {
    // OpenSSL writes to clients that have gone.
    sigset_t pipe;
    sigemptyset(&pipe);
    sigaddset(&pipe, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &pipe, nullptr);
    while (!ends_) {
      pollfd waiting{listening_, POLLIN, 0};
      if (::poll(&waiting, 1, 20) != 1) continue;
      const int client = ::accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
      const timeval patience{5, 0};
      ::setsockopt(client, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
      SSL* tls = SSL_new(context_);
      SSL_set_fd(tls, client);
      if (SSL_accept(tls) == 1) answer_all(tls);
      SSL_free(tls);
      ::close(client);
    }
  }
  void answer_all(SSL* tls) {
    std::string head;
    char sign = 0;
    while (!ends_ && SSL_read(tls, &sign, 1) == 1) {
      head += sign;
      if (!head.ends_with("\r\n\r\n")) continue;
      const std::string said = answer_(std::exchange(head, {}));
      if (said.empty() || SSL_write(tls, said.data(), static_cast<int>(said.size())) <= 0) return;
      // What follows is a body, which is no request.
      if (said.find("Connection: close") != std::string::npos) return;
    }
  }

  std::function<std::string(const std::string&)> answer_;
  store::ContentHash fingerprint_;
  SSL_CTX* context_ = nullptr;
  int listening_ = -1;
  std::uint16_t port_ = 0;
  std::atomic<bool> ends_{false};
  std::thread serving_;
};

}  // namespace prismesh::ipc::remote
