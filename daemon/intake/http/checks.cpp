#include "daemon/intake/http/checks.h"

#include <algorithm>
#include <array>

#include "daemon/intake/http/fields.h"

namespace prismesh::intake {

namespace {

// What would be read twice with two meanings, if it came twice.
constexpr std::array<std::string_view, 19> kOnce{
    "host",          "origin",          "authorization",         "content-length", "content-type",  "transfer-encoding", "upload-offset",
    "upload-length", "upload-metadata", "upload-checksum",       "tus-resumable",  "range",         "if-range",          "content-encoding",
    "expect",        "prismesh-name",   "prismesh-derived-from", "cookie",         "sec-fetch-site"};

constexpr std::string_view kOtherSite = "pages of other sites have no access";

std::optional<std::string_view> twice(const HttpRequest& request) {
  for (const std::string_view name : kOnce)
    if (std::count_if(request.headers.begin(), request.headers.end(), [&](const Header& header) { return header.name == name; }) > 1)
      return name;
  return std::nullopt;
}

bool is_own_host(const std::string& host, const std::vector<std::string>& hosts) {
  return host == "localhost" || is_address_literal(host) || std::find(hosts.begin(), hosts.end(), host) != hosts.end();
}

}  // namespace

std::optional<HttpResponse> check_request(const HttpRequest& request, const std::vector<std::string>& hosts) {
  if (const auto name = twice(request)) return error_response(400, "the header " + std::string(*name) + " comes twice");
  if (request.is_chunked || request.header("transfer-encoding"))
    return error_response(411, "a body must come with its length (Content-Length), not in chunks");
  if (request.header("content-encoding")) return error_response(415, "a body must come as it is, without Content-Encoding");
  if (request.header("x-http-method-override")) return error_response(400, "X-HTTP-Method-Override isn't taken");
  const std::optional<std::string_view> host_header = request.header("host");
  const std::optional<std::string> host = host_header ? parse_host(*host_header) : std::nullopt;
  if (!host) return error_response(400, "the header Host must name the station");
  if (!is_own_host(*host, hosts))
    return error_response(421, "this station isn't called that; say its name in the settings (remote.hosts), or use its address");
  if (const auto origin = request.header("origin"); origin && *origin != "https://" + std::string(*host_header))
    return error_response(403, kOtherSite);
  return std::nullopt;
}

std::optional<HttpResponse> check_browser(const HttpRequest& request) {
  const bool changes = request.method != "GET" && request.method != "HEAD";
  if (changes && !request.header("origin")) return error_response(403, kOtherSite);
  const std::optional<std::string_view> from = request.header("sec-fetch-site");
  // "none": somebody typed the address.
  if (from && *from != "same-origin" && (changes || *from != "none")) return error_response(403, kOtherSite);
  return std::nullopt;
}

}  // namespace prismesh::intake
