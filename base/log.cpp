#include "base/log.h"

#include <string>

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

namespace prismesh::logging {
namespace {

spdlog::level::level_enum level_of(Level level) {
  switch (level) {
    case Level::info: break;
    case Level::warning: return spdlog::level::warn;
    case Level::error: return spdlog::level::err;
    case Level::critical: return spdlog::level::critical;
  }
  return spdlog::level::info;
}

}  // namespace

void start(std::string_view program) {
  const std::string name(program);
  spdlog::set_default_logger(spdlog::stderr_logger_mt(name));
  spdlog::set_pattern("%Y-%m-%dT%H:%M:%S.%e " + name + " %l: %v");
}

void write(Level level, std::string_view text) { spdlog::log(level_of(level), text); }

void flush() { spdlog::default_logger()->flush(); }

}  // namespace prismesh::logging
