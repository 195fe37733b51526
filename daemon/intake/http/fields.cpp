#include "daemon/intake/http/fields.h"

#include <arpa/inet.h>

#include <algorithm>
#include <charconv>
#include <vector>

#include "base/base64.h"

namespace prismesh::intake {

namespace {

constexpr std::size_t kMaxMetadataKeys = 32;
constexpr std::size_t kMaxQueryKeys = 16;
constexpr std::string_view kSessionCookie = "__Host-prismesh";

/// Cuts the text off at the separator; the whole text if there is none.
std::string_view take_part(std::string_view& text, char separator) {
  const std::size_t end = std::min(text.find(separator), text.size());
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return part;
}

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

std::optional<std::string_view> token_text(std::string_view token) {
  constexpr std::size_t kMaxToken = 200;
  const bool plain = std::all_of(token.begin(), token.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
  });
  if (token.empty() || token.size() > kMaxToken || !plain) return std::nullopt;
  return token;
}

bool is_metadata_key(std::string_view key) {
  return !key.empty() && std::all_of(key.begin(), key.end(), [](char c) { return c > ' ' && c < '\x7f' && c != ','; });
}

std::optional<int> hex_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return std::nullopt;
}

std::optional<std::string> unescaped(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      plain += text[i] == '+' ? ' ' : text[i];
      continue;
    }
    if (i + 2 >= text.size()) return std::nullopt;
    const std::optional<int> high = hex_value(text[i + 1]), low = hex_value(text[i + 2]);
    if (!high || !low) return std::nullopt;
    plain += static_cast<char>(*high * 16 + *low);
    i += 2;
  }
  return plain;
}

}  // namespace

std::optional<std::uint64_t> parse_size(std::string_view text) {
  std::int64_t value = 0;
  if (text.empty() || text.front() < '0' || text.front() > '9') return std::nullopt;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return static_cast<std::uint64_t>(value);
}

Result<std::map<std::string, std::string>> parse_upload_metadata(std::string_view header) {
  const auto wrong = [](std::string message) { return fail("Upload-Metadata", std::move(message)); };
  std::map<std::string, std::string> metadata;
  while (!header.empty()) {
    const bool is_last = header.find(',') == std::string_view::npos;
    std::string_view pair = without_blanks(take_part(header, ','));
    if (!is_last && header.empty()) return wrong("ends with a comma");
    const std::string_view key = take_part(pair, ' ');
    if (!is_metadata_key(key)) return wrong("must be keys with values in base64, and commas between");
    const std::optional<std::vector<std::byte>> value = base64_decode(pair);
    if (!value) return wrong("the value of '" + std::string(key) + "' must be base64");
    const std::string text(reinterpret_cast<const char*>(value->data()), value->size());
    if (!metadata.emplace(key, text).second) return wrong("'" + std::string(key) + "' comes twice");
    if (metadata.size() > kMaxMetadataKeys) return wrong("has more than " + std::to_string(kMaxMetadataKeys) + " keys");
  }
  return metadata;
}

tl::expected<ByteRange, RangeFault> parse_range(std::string_view header, std::uint64_t file_bytes) {
  constexpr std::string_view kUnit = "bytes=";
  const auto ignored = [] { return tl::unexpected(RangeFault::none_asked); };
  const auto unsatisfiable = [] { return tl::unexpected(RangeFault::unsatisfiable); };
  if (!header.starts_with(kUnit)) return ignored();
  std::string_view range = without_blanks(header.substr(kUnit.size()));
  const std::size_t hyphen = range.find('-');
  if (hyphen == std::string_view::npos) return ignored();
  const std::string_view first = range.substr(0, hyphen), last = range.substr(hyphen + 1);
  if (first.empty()) {
    const std::optional<std::uint64_t> bytes = parse_size(last);
    if (!bytes) return ignored();
    if (*bytes == 0 || file_bytes == 0) return unsatisfiable();
    const std::uint64_t count = std::min(*bytes, file_bytes);
    return ByteRange{file_bytes - count, count};
  }
  const std::optional<std::uint64_t> begin = parse_size(first);
  const std::optional<std::uint64_t> end = last.empty() ? std::optional(file_bytes) : parse_size(last);
  if (!begin || !end || (!last.empty() && *end < *begin)) return ignored();
  if (*begin >= file_bytes) return unsatisfiable();
  const std::uint64_t behind = last.empty() ? file_bytes : std::min(*end + 1, file_bytes);
  return ByteRange{*begin, behind - *begin};
}

bool lists_tag(std::string_view header, std::string_view tag) {
  if (without_blanks(header) == "*") return true;
  while (!header.empty()) {
    std::string_view each = without_blanks(take_part(header, ','));
    if (each.starts_with("W/")) each.remove_prefix(2);
    if (each == tag) return true;
  }
  return false;
}

std::optional<std::string_view> parse_bearer(std::string_view header) {
  constexpr std::string_view kScheme = "Bearer ";
  if (!header.starts_with(kScheme)) return std::nullopt;
  return token_text(header.substr(kScheme.size()));
}

std::optional<std::string_view> parse_session_cookie(std::string_view header) {
  std::optional<std::string_view> found;
  while (!header.empty()) {
    std::string_view value = without_blanks(take_part(header, ';'));
    if (take_part(value, '=') != kSessionCookie) continue;
    // A second one was set by somebody else; which one is meant nobody can tell.
    if (found) return std::nullopt;
    found = value;
  }
  return found ? token_text(*found) : std::nullopt;
}

std::string session_cookie(std::string_view token, std::int64_t lifetime_s) {
  return std::string(kSessionCookie) + "=" + std::string(token) + "; Path=/; Max-Age=" + std::to_string(token.empty() ? 0 : lifetime_s) +
         "; Secure; HttpOnly; SameSite=Strict";
}

Result<Target> parse_target(std::string_view target) {
  const auto wrong = [](std::string message) { return fail("request", std::move(message)); };
  if (!target.starts_with('/') || target.starts_with("//")) return wrong("the target must be a path");
  if (!std::all_of(target.begin(), target.end(), [](char c) { return c > ' ' && c < '\x7f' && c != '#' && c != '\\'; }))
    return wrong("the target has signs that no path has");
  Target parsed;
  parsed.path = take_part(target, '?');
  while (!target.empty()) {
    std::string_view pair = take_part(target, '&');
    const std::optional<std::string> key = unescaped(take_part(pair, '='));
    const std::optional<std::string> value = unescaped(pair);
    if (!key || !value) return wrong("the query can't be read");
    if (!parsed.query.emplace(*key, *value).second) return wrong("the query has a key twice");
    if (parsed.query.size() > kMaxQueryKeys) return wrong("the query has too many keys");
  }
  return parsed;
}

std::optional<std::string> parse_host(std::string_view header) {
  std::string_view host = header, port;
  if (header.starts_with('[')) {
    const std::size_t end = header.find(']');
    if (end == std::string_view::npos) return std::nullopt;
    host = header.substr(1, end - 1);
    port = header.substr(end + 1);
    if (!is_address_literal(host)) return std::nullopt;
  } else if (const std::size_t colon = header.find(':'); colon != std::string_view::npos) {
    host = header.substr(0, colon);
    port = header.substr(colon);
  }
  if (!port.empty()) {
    const std::optional<std::uint64_t> number = port.front() == ':' ? parse_size(port.substr(1)) : std::nullopt;
    if (!number || *number > 65535) return std::nullopt;
  }
  std::string name(host);
  for (char& c : name) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '.' || c == ':';
    if (!plain) return std::nullopt;
  }
  if (name.empty() || name.size() > 253) return std::nullopt;
  return name;
}

bool is_address_literal(std::string_view host) {
  in6_addr address{};
  const std::string text(host);
  return ::inet_pton(AF_INET, text.c_str(), &address) == 1 || ::inet_pton(AF_INET6, text.c_str(), &address) == 1;
}

}  // namespace prismesh::intake
