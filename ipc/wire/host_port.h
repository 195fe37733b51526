// A host and its port, as people write them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace prismesh::ipc {

struct HostPort {
  std::string host;  ///< a name or an address, without brackets
  std::optional<std::uint16_t> port;
};

/// HOST, HOST:PORT, [ADDRESS], [ADDRESS]:PORT; ADDRESS of version 6 without a port needs no brackets. Nothing: none of these.
std::optional<HostPort> parse_host_port(std::string_view text);

/// "host", with brackets where it is an address of version 6.
std::string bracketed(const std::string& host);

}  // namespace prismesh::ipc
