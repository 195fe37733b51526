// A client that says over TLS exactly what a test wants, right or wrong.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "ipc/store/sha256.h"

namespace prismesh::intake {

struct TestResponse {
  unsigned status = 0;                         ///< 0: the connection ended
  std::map<std::string, std::string> headers;  ///< names in small letters
  std::string body;

  std::string header(const std::string& name) const {
    const auto found = headers.find(name);
    return found == headers.end() ? "" : found->second;
  }
};

class TlsClient {
 public:
  /// `newest`: the newest version of TLS that it speaks (0x0304 is 1.3).
  explicit TlsClient(std::uint16_t port, int newest = 0x0304);
  TlsClient(TlsClient&&) noexcept;
  ~TlsClient();

  bool connected() const;
  std::string version() const;
  ipc::store::ContentHash fingerprint() const;

  /// False: the line is cut.
  bool send(std::string_view bytes);
  /// Reads one answer. `to_head`: it has no body.
  TestResponse receive(bool to_head = false);
  /// Reads until the text has come, or the line is cut; what came.
  std::string receive_until(std::string_view text);
  /// Cuts the line in the middle of whatever it is.
  void cut();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prismesh::intake
