// A request and a response, without the library that brings them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "ipc/store/sha256.h"
#include "ipc/wire/descriptor.h"

namespace prismesh::intake {

struct Header {
  std::string name;  ///< small letters
  std::string value;
};

struct HttpRequest {
  std::string method;  ///< "GET"
  std::string target;  ///< as it stands in the first line
  std::vector<Header> headers;
  std::optional<std::uint64_t> body_bytes;  ///< announced; nothing: no body
  bool is_chunked = false;

  /// Nothing: there is none. The first, if there are several; check_request refuses those.
  std::optional<std::string_view> header(std::string_view name) const {
    for (const Header& each : headers)
      if (each.name == name) return each.value;
    return std::nullopt;
  }
};

/// Bytes of a stored file that go to the client.
struct FileBody {
  ipc::Descriptor file;
  std::uint64_t begin = 0;
  std::uint64_t bytes = 0;
  std::uint64_t all_bytes = 0;
  ipc::store::ContentHash hash;
  /// All of it is sent: then its hash is compared, and the last piece is held back if it differs.
  bool is_whole() const { return bytes == all_bytes; }
};

/// Events that go on until one side ends.
struct EventBody {
  std::uint64_t subscription = 0;
};

struct HttpResponse {
  unsigned status = 200;
  std::vector<std::pair<std::string, std::string>> headers;
  std::variant<std::string, FileBody, EventBody> body;
  std::optional<std::uint64_t> announced_bytes;  ///< of a body that isn't sent: the answer to HEAD
  std::shared_ptr<void> permit;                  ///< held until the answer is sent
};

/// A refusal, as {"error": sentence}.
HttpResponse error_response(unsigned status, std::string_view sentence);
HttpResponse json_response(std::string text, unsigned status = 200);

}  // namespace prismesh::intake
