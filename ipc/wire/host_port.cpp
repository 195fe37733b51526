#include "ipc/wire/host_port.h"

#include <algorithm>
#include <charconv>

namespace prismesh::ipc {

namespace {

constexpr std::size_t kMaxHostBytes = 253;

bool is_address_sign(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '_' || c == ':';
}

}  // namespace

std::string bracketed(const std::string& host) { return host.find(':') != std::string::npos ? "[" + host + "]" : host; }

std::optional<HostPort> parse_host_port(std::string_view text) {
  HostPort address;
  std::string_view port;
  bool has_port = false;
  if (text.starts_with('[')) {
    const std::size_t end = text.find(']');
    if (end == std::string_view::npos) return std::nullopt;
    address.host = text.substr(1, end - 1);
    const std::string_view rest = text.substr(end + 1);
    if (!rest.empty() && rest.front() != ':') return std::nullopt;
    has_port = !rest.empty();
    port = has_port ? rest.substr(1) : rest;
  } else if (std::count(text.begin(), text.end(), ':') == 1) {
    address.host = text.substr(0, text.find(':'));
    port = text.substr(text.find(':') + 1);
    has_port = true;
  } else {
    address.host = text;
  }
  const bool sound = !address.host.empty() && address.host.size() <= kMaxHostBytes && address.host.front() != '-' &&
                     std::all_of(address.host.begin(), address.host.end(), is_address_sign);
  if (!sound) return std::nullopt;
  if (!has_port) return address;
  std::uint16_t number = 0;
  const auto [end, failed] = std::from_chars(port.data(), port.data() + port.size(), number);
  if (port.empty() || failed != std::errc{} || end != port.data() + port.size() || number == 0) return std::nullopt;
  address.port = number;
  return address;
}

}  // namespace prismesh::ipc
