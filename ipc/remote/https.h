// A connection to a station: TLS 1.3 with the certificate that the pairing code or the pairing named, and requests on it, one after the
// other. The only source with Beast and OpenSSL's connections is https.cpp.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "ipc/remote/station_address.h"
#include "ipc/store/sha256.h"
#include "ipc/wire/line_fault.h"

namespace prismesh::ipc::remote {

/// The beginning of the SHA-256 of the station's certificate: 10 bytes of a pairing code, 32 of a paired station.
using Pin = std::vector<std::uint8_t>;

struct LinePatience {
  std::chrono::milliseconds connect{10'000};
  std::chrono::milliseconds silence{60'000};  ///< without a byte in either direction
};

struct HttpsRequest {
  std::string method;
  std::string target;
  std::vector<std::pair<std::string, std::string>> headers;
  std::string_view body;  ///< sent where `has_body`
  bool has_body = false;
  bool asks_before_body = false;  ///< the body is sent only when the station wants it (Expect: 100-continue)
};

struct HttpsAnswer {
  unsigned status = 0;
  std::map<std::string, std::string> headers;  ///< names in small letters
  std::string body;                            ///< what no sink took

  std::string_view header(const std::string& name) const;
};

/// Takes the body of an answer with status 200 or 206 piece by piece. `head`: the answer without its body. An error ends the request.
using BodySink = std::function<Result<void>(const HttpsAnswer& head, std::string_view bytes)>;

class HttpsLine {
 public:
  /// Nothing is sent to a station whose certificate has another beginning than `pin`. Errors: that (doesn't pass), and nobody answers.
  static LineResult<HttpsLine> connect(const StationAddress& station, const Pin& pin, const LinePatience& patience, Stop stop);
  HttpsLine(HttpsLine&&) noexcept;
  HttpsLine& operator=(HttpsLine&&) noexcept;
  ~HttpsLine();

  /// SHA-256 of the station's certificate.
  const store::ContentHash& fingerprint() const;
  /// `sent`: called with the bytes of the body that went out so far. Errors: the line (then this object is of no use any more), the sink, a
  /// body of more than 16 MB without a sink.
  LineResult<HttpsAnswer> ask(const HttpsRequest& request, const BodySink& sink = {}, const std::function<void(std::uint64_t)>& sent = {});
  /// Whether another request may follow on this line.
  bool is_open() const;

 private:
  struct Impl;
  explicit HttpsLine(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace prismesh::ipc::remote
