// Converts text to bytes and back, for tests of ports.
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

/// Reads what is available now, max. `max_bytes` bytes.
inline std::string read_text(BytePort& port, std::size_t max_bytes = 4096) {
  std::string text(max_bytes, '\0');
  const PortCount got = port.read(std::as_writable_bytes(std::span(text)));
  text.resize(got.bytes);
  return text;
}

/// Waits until the condition holds, because a kernel worker delivers a terminal's bytes with a delay. Returns false after ten seconds.
inline bool eventually(const std::function<bool()>& is_so) {
  for (int i = 0; i < 10'000; ++i) {
    if (is_so()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

inline std::string read_soon(BytePort& port, std::size_t length) {
  std::string text;
  eventually([&] {
    text += read_text(port, length - text.size());
    return text.size() >= length;
  });
  return text;
}

}  // namespace prismesh::drivers::port
