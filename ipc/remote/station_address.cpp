#include "ipc/remote/station_address.h"

#include "ipc/wire/host_port.h"

namespace prismesh::ipc::remote {

std::string StationAddress::text() const { return bracketed(host) + ":" + std::to_string(port); }

Result<StationAddress> parse_station_address(std::string_view text) {
  std::optional<HostPort> address = parse_host_port(text);
  if (!address) return fail(std::string(text), "is no station; write its name or address, like station.example.com or 192.168.0.7:7443");
  return StationAddress{std::move(address->host), address->port.value_or(kStationPort)};
}

}  // namespace prismesh::ipc::remote
