#include "ipc/remote/station_address.h"

#include <algorithm>
#include <charconv>

namespace prismesh::ipc::remote {

namespace {

constexpr std::size_t kMaxHostBytes = 253;

bool is_host_sign(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '_';
}
bool is_address_sign(char c) { return is_host_sign(c) || c == ':'; }

tl::unexpected<Error> no_address(std::string_view text) {
  return fail(std::string(text), "is no station; write its name or address, like station.example.com or 192.168.0.7:7443");
}

}  // namespace

std::string StationAddress::text() const {
  const bool needs_brackets = host.find(':') != std::string::npos;
  return (needs_brackets ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

Result<StationAddress> parse_station_address(std::string_view text) {
  StationAddress address;
  std::string_view port;
  bool has_port = false;
  if (text.starts_with('[')) {
    const std::size_t end = text.find(']');
    if (end == std::string_view::npos) return no_address(text);
    address.host = text.substr(1, end - 1);
    const std::string_view rest = text.substr(end + 1);
    if (!rest.empty() && rest.front() != ':') return no_address(text);
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
  if (!sound) return no_address(text);
  if (!has_port) return address;
  const auto [end, failed] = std::from_chars(port.data(), port.data() + port.size(), address.port);
  if (port.empty() || failed != std::errc{} || end != port.data() + port.size() || address.port == 0) return no_address(text);
  return address;
}

}  // namespace prismesh::ipc::remote
