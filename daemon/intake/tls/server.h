// The HTTPS server: takes connections, reads requests with limits, and sends answers. TLS 1.3 only.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "base/error.h"
#include "daemon/intake/api/api.h"
#include "daemon/intake/tls/identity.h"
#include "daemon/intake/tls/server_settings.h"

namespace prismesh::intake {

class HttpsServer {
 public:
  /// Errors: the address can't be listened at, the identity isn't taken.
  static Result<std::unique_ptr<HttpsServer>> listen(const ServerSettings& settings, const Identity& identity, Api& api, Access& access,
                                                     EventHub& events, Figures& figures, std::shared_ptr<StoreThread> store);
  ~HttpsServer();

  std::uint16_t port() const;
  /// Calls `work` on the serving thread every `period`. Before `run`.
  void every(std::chrono::milliseconds period, std::function<void()> work);
  /// Serves until `stop`, on the calling thread.
  void run();
  /// May be called from any thread.
  void stop();

 private:
  struct Impl;
  explicit HttpsServer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace prismesh::intake
