// Reads what stands in headers and targets. All of it comes from strangers.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "base/error.h"

namespace prismesh::intake {

/// Digits only, up to 2^63 - 1.
std::optional<std::uint64_t> parse_size(std::string_view text);

/// Upload-Metadata of tus 1.0.0: "name BASE64,other BASE64,flag". Keys are ASCII without blanks and commas; at most 32 of them, none twice.
Result<std::map<std::string, std::string>> parse_upload_metadata(std::string_view header);

/// Part of a file.
struct ByteRange {
  std::uint64_t begin = 0;
  std::uint64_t bytes = 0;
  bool operator==(const ByteRange&) const = default;
};
enum class RangeFault : std::uint8_t {
  none_asked,     ///< no range that is understood: all of the file is the answer (RFC 9110, 14.2)
  unsatisfiable,  ///< it begins behind the end
};
/// A single range of bytes: "bytes=0-9", "bytes=10-", "bytes=-5".
tl::expected<ByteRange, RangeFault> parse_range(std::string_view header, std::uint64_t file_bytes);

/// Whether a list like `"a", W/"b"` or `*` has the tag (compared weakly: RFC 9110, 8.8.3.2). `tag` with its quotes.
bool lists_tag(std::string_view header, std::string_view tag);

/// The token of "Bearer TOKEN".
std::optional<std::string_view> parse_bearer(std::string_view header);
/// The token in a header Cookie. Nothing: there is none, or two, or what no token is.
std::optional<std::string_view> parse_session_cookie(std::string_view header);
/// The header Set-Cookie that gives a browser its token: no script reads it, no other site's page sends it, no page of another name or
/// without TLS sets it. An empty token takes it away.
std::string session_cookie(std::string_view token, std::int64_t lifetime_s);

/// Path and query of a target in origin form. The path isn't unescaped: no route needs that, and an escaped sign fits none.
struct Target {
  std::string_view path;
  std::map<std::string, std::string, std::less<>> query;
};
/// Errors: another form, a query that can't be read, a key twice.
Result<Target> parse_target(std::string_view target);

/// A host of the header Host, without its port, in small letters. Nothing: it is none.
std::optional<std::string> parse_host(std::string_view header);
bool is_address_literal(std::string_view host);

}  // namespace prismesh::intake
