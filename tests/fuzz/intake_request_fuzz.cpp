// What strangers write into a request: lines of a header "name: value", the target in the first line, and the body of a pairing. Each is
// refused, or what was read of it keeps its promises.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "daemon/intake/api/pair_request.h"
#include "daemon/intake/api/thumbnail.h"
#include "daemon/intake/http/checks.h"
#include "daemon/intake/http/fields.h"
#include "daemon/intake/http/routes.h"
#include "daemon/intake/store/checksum.h"
#include "ipc/intake/pairing_code.h"
#include "tests/fuzz/require.h"

using namespace prismesh;  // NOLINT: a fuzz target is a program of its own

namespace {

void read_value(std::string_view value) {
  if (const auto range = intake::parse_range(value, 1000))
    require(range->bytes > 0 && range->begin < 1000 && range->bytes <= 1000 - range->begin);
  if (const auto checksum = intake::parse_checksum(value))
    require(checksum->digest.size() == (checksum->algorithm == intake::ChecksumAlgorithm::sha1 ? 20u : 32u));
  if (const auto metadata = intake::parse_upload_metadata(value)) require(metadata->size() <= 32);
  if (const auto token = intake::parse_bearer(value)) require(!token->empty() && token->find(' ') == std::string_view::npos);
  if (const auto token = intake::parse_session_cookie(value)) require(!token->empty() && token->find(';') == std::string_view::npos);
  if (const auto host = intake::parse_host(value)) require(!host->empty() && host->find('/') == std::string::npos);
  if (const auto size = intake::parse_size(value)) require(*size <= 9223372036854775807u);
  if (intake::is_thumbnail(value)) require(value.size() >= 57);
  intake::lists_tag(value, "\"a\"");
  if (const auto code = ipc::decode_pairing_code(value)) require(ipc::decode_pairing_code(ipc::encode_pairing_code(*code)) == *code);
  if (const auto pair = intake::parse_pair_request(value); !pair) require(!pair.error().message.empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(data), size);
  intake::HttpRequest request;
  request.method = "GET";
  request.target = text.substr(0, text.find('\n'));
  if (const auto target = intake::parse_target(request.target)) {
    const intake::FoundRoute found = intake::find_route("GET", target->path);
    for (const std::string_view part : found.parts) require(!part.empty() && part.find('/') == std::string_view::npos);
    require(found.route == nullptr || !found.allowed.empty());
  }
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(line.size() < text.size() ? line.size() + 1 : text.size());
    const std::size_t colon = line.find(": ");
    if (colon != std::string_view::npos)
      request.headers.push_back({std::string(line.substr(0, colon)), std::string(line.substr(colon + 2))});
    read_value(colon == std::string_view::npos ? line : line.substr(colon + 2));
  }
  if (const auto refused = intake::check_request(request, {"station"})) require(refused->status >= 400);
  return 0;
}
