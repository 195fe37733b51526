// Checks of the machine that a station runs on: what is good, and what to do about the rest. They read files below a root folder, so that
// tests can make a machine up.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "drivers/settings/settings.h"

namespace prismesh::cli {

enum class Grade : std::uint8_t {
  good,
  note,  ///< the station works without it
  bad,
};

struct Finding {
  std::string what;  ///< "graphics card", "clock", ...
  Grade grade = Grade::good;
  std::string says;
  std::string to_do{};  ///< empty where nothing is to be done
};

/// What the checks look at.
struct Machine {
  std::filesystem::path root = "/";
  std::filesystem::path state_directory;       ///< of journals
  std::uint64_t max_realtime_priority = 0;     ///< RLIMIT_RTPRIO
  std::optional<std::uint64_t> max_locked_kb;  ///< RLIMIT_MEMLOCK; nothing: no limit
  std::int64_t now_s = 0;                      ///< since 1970
  bool clock_synchronized = false;
  bool in_x11 = false;  ///< DISPLAY is set
};
/// This machine, as this process sees it.
Machine this_machine(const std::filesystem::path& state_directory);

std::vector<Finding> check_displays(const Machine& machine);
std::vector<Finding> check_graphics(const Machine& machine);
/// Who gives the bare screen to the kiosk.
std::vector<Finding> check_seat(const Machine& machine);
/// Ports of real devices, and what is simulated.
std::vector<Finding> check_ports(const Machine& machine, const drivers::settings::StationSettings& settings);
std::vector<Finding> check_realtime(const Machine& machine);
std::vector<Finding> check_disk(const Machine& machine);
std::vector<Finding> check_clock(const Machine& machine);
std::vector<Finding> check_units(const Machine& machine);

}  // namespace prismesh::cli
