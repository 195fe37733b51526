#include "ipc/setup/own_addresses.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <memory>

namespace prismesh::ipc {
namespace {

int prefix_of(const sockaddr& mask) {
  int prefix = 0;
  const auto count = [&](const unsigned char* bytes, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) prefix += std::popcount(bytes[i]);
  };
  if (mask.sa_family == AF_INET)
    count(reinterpret_cast<const unsigned char*>(&reinterpret_cast<const sockaddr_in&>(mask).sin_addr), 4);
  else
    count(reinterpret_cast<const unsigned char*>(&reinterpret_cast<const sockaddr_in6&>(mask).sin6_addr), 16);
  return prefix;
}

}  // namespace

std::vector<std::string> own_addresses() {
  std::vector<std::string> addresses;
  ifaddrs* found = nullptr;
  if (::getifaddrs(&found) != 0) return addresses;
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> all(found, &::freeifaddrs);
  for (const ifaddrs* each = found; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr || each->ifa_netmask == nullptr || (each->ifa_flags & IFF_LOOPBACK) != 0) continue;
    std::array<char, INET6_ADDRSTRLEN> text{};
    const void* bytes = nullptr;
    if (each->ifa_addr->sa_family == AF_INET) bytes = &reinterpret_cast<const sockaddr_in*>(each->ifa_addr)->sin_addr;
    if (each->ifa_addr->sa_family == AF_INET6) {
      const in6_addr& six = reinterpret_cast<const sockaddr_in6*>(each->ifa_addr)->sin6_addr;
      if (!IN6_IS_ADDR_LINKLOCAL(&six)) bytes = &six;
    }
    if (bytes == nullptr || ::inet_ntop(each->ifa_addr->sa_family, bytes, text.data(), text.size()) == nullptr) continue;
    addresses.push_back(std::string(text.data()) + "/" + std::to_string(prefix_of(*each->ifa_netmask)));
  }
  std::ranges::sort(addresses);
  return addresses;
}

}  // namespace prismesh::ipc
