// A daemon's log: lines on standard error, with time and level. spdlog's headers, which are heavy, stay in log.cpp.
#pragma once

#include <cstdint>
#include <string_view>

#include <fmt/core.h>

namespace prismesh::logging {

enum class Level : std::uint8_t { info, warning, error, critical };

/// Writes `program` into every line. Lines logged before this go to standard output.
void start(std::string_view program);
void write(Level level, std::string_view text);
/// Returns when everything written has left the process.
void flush();

template <class... Args>
void info(fmt::format_string<Args...> text, Args&&... args) {
  write(Level::info, fmt::vformat(text, fmt::make_format_args(args...)));
}
template <class... Args>
void warn(fmt::format_string<Args...> text, Args&&... args) {
  write(Level::warning, fmt::vformat(text, fmt::make_format_args(args...)));
}
template <class... Args>
void error(fmt::format_string<Args...> text, Args&&... args) {
  write(Level::error, fmt::vformat(text, fmt::make_format_args(args...)));
}
template <class... Args>
void critical(fmt::format_string<Args...> text, Args&&... args) {
  write(Level::critical, fmt::vformat(text, fmt::make_format_args(args...)));
}

}  // namespace prismesh::logging
