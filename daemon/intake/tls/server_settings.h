// Where the HTTPS server listens, and how long it waits.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace prismesh::intake {

struct ServerSettings {
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;  ///< 0: any that is free
  std::int64_t max_connections = 1200;
  std::chrono::milliseconds greeting{10'000};   ///< of TLS, and for a request's header
  std::chrono::milliseconds idle{60'000};       ///< between requests
  std::chrono::milliseconds piece{30'000};      ///< for 32 KB of a body, either way
  std::chrono::milliseconds heartbeat{15'000};  ///< between lines to those who follow events
};

}  // namespace prismesh::intake
