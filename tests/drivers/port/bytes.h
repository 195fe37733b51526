// Text as bytes and back, for tests of ports.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <thread>

#include "drivers/port/byte_port.h"

namespace prismesh::drivers::port {

inline std::span<const std::byte> bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }

/// What is there to read now, at most `most` bytes.
inline std::string read_text(BytePort& port, std::size_t most = 4096) {
  std::string text(most, '\0');
  const PortCount got = port.read(std::as_writable_bytes(std::span(text)));
  text.resize(got.bytes);
  return text;
}

/// The kernel passes a terminal's bytes on from a worker of its own, so what was written isn't there at once. False after ten seconds.
inline bool soon(const std::function<bool()>& is_so) {
  for (int i = 0; i < 10'000; ++i) {
    if (is_so()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

inline std::string read_soon(BytePort& port, std::size_t length) {
  std::string text;
  soon([&] {
    text += read_text(port, length - text.size());
    return text.size() >= length;
  });
  return text;
}

}  // namespace prismesh::drivers::port
