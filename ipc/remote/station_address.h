// Where a station is, as people write it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/error.h"

namespace prismesh::ipc::remote {

inline constexpr std::uint16_t kStationPort = 7443;

struct StationAddress {
  std::string host;  ///< a name or an address, without brackets
  std::uint16_t port = kStationPort;
  bool operator==(const StationAddress&) const = default;

  /// "host:7443", "[::1]:7443": also what the header Host says.
  std::string text() const;
};

/// HOST, HOST:PORT, [ADDRESS], [ADDRESS]:PORT; ADDRESS of version 6 without a port needs no brackets. Errors: none of these.
Result<StationAddress> parse_station_address(std::string_view text);

}  // namespace prismesh::ipc::remote
