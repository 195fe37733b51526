#include "cli/machine_checks.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <span>
#include <system_error>

#include <sys/resource.h>
#include <sys/statvfs.h>
#include <sys/timex.h>
#include <unistd.h>

#include "base/counted.h"
#include "base/file.h"
#include "drivers/display/edid.h"

namespace prismesh::cli {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kPriority = 40;                          // of the device loop
constexpr std::uint64_t kMinFreeBytes = std::uint64_t{1} << 30;  // of journals and decks
constexpr std::uint64_t kFewFreeBytes = std::uint64_t{10} << 30;
constexpr std::int64_t kOldestNowS = 1'767'225'600;  // 2026-01-01: the programs are newer

fs::path below(const Machine& machine, std::string_view path) { return machine.root / fs::path(path).relative_path(); }

std::string first_line(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

/// The entries of a folder whose names begin so, ascending.
std::vector<fs::path> entries(const fs::path& folder, std::string_view begin) {
  std::vector<fs::path> found;
  std::error_code missing;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, missing))
    if (entry.path().filename().string().starts_with(begin)) found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

std::string gigabytes(std::uint64_t bytes) { return std::to_string(bytes >> 30) + " GiB"; }

std::vector<std::byte> bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::vector<std::byte> bytes;
  for (char each = 0; in.get(each);) bytes.push_back(static_cast<std::byte>(each));
  return bytes;
}

Finding port_finding(const Machine& machine, const std::string& role, const std::string& port, bool simulated) {
  if (simulated) return {role, Grade::note, "simulated", {}};
  const fs::path path = below(machine, port);
  std::error_code problem;
  if (!fs::exists(path, problem))
    return {role, Grade::bad, port + " isn't there", "plug its adapter in, or name another port in prismesh.toml (docs/settings.md)"};
  if (::access(path.c_str(), R_OK | W_OK) != 0)
    return {role, Grade::bad, port + " may not be used by this user",
            "add the user to the group that owns it (dialout or prismesh), and log in anew"};
  return {role, Grade::good, port, {}};
}

}  // namespace

Machine this_machine(const fs::path& state_directory) {
  Machine machine;
  machine.state_directory = state_directory;
  rlimit limit{};
  if (::getrlimit(RLIMIT_RTPRIO, &limit) == 0) machine.max_realtime_priority = limit.rlim_cur;
  if (::getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) machine.max_locked_kb = limit.rlim_cur / 1024;
  if (::geteuid() == 0) {  // root isn't held to either
    machine.max_realtime_priority = 99;
    machine.max_locked_kb.reset();
  }
  machine.now_s = std::time(nullptr);
  timex clock{};
  machine.clock_synchronized = ::adjtimex(&clock) >= 0 && (clock.status & STA_UNSYNC) == 0;
  const char* display = std::getenv("DISPLAY");
  machine.in_x11 = display != nullptr && *display != 0;
  return machine;
}

std::vector<Finding> check_displays(const Machine& machine) {
  std::vector<Finding> findings;
  for (const fs::path& connector : entries(below(machine, "/sys/class/drm"), "card")) {
    if (first_line(connector / "status") != "connected") continue;
    const std::string name = "display " + connector.filename().string();
    const std::string mode = first_line(connector / "modes");
    const Result<drivers::display::Edid> edid = drivers::display::decode_edid(bytes_of(connector / "edid"));
    if (!edid) {
      findings.push_back({name, Grade::note, "its description can't be read (" + edid.error().message + "); first mode " + mode,
                          "a calibration can't be bound to this monitor; try another cable"});
      continue;
    }
    const std::string native = std::to_string(edid->native_width) + "x" + std::to_string(edid->native_height);
    const std::string who = edid->identity.text();
    if (!mode.empty() && mode != native)
      findings.push_back({name, Grade::bad, who + ": the first mode is " + mode + ", the panel has " + native,
                          "an interlaced picture must never be scaled: choose the native mode"});
    else
      findings.push_back({name, Grade::good, who + ", " + native, {}});
  }
  if (findings.empty())
    findings.push_back({"display", machine.in_x11 ? Grade::note : Grade::bad, "no monitor is seen by the kernel",
                        machine.in_x11 ? "" : "connect one, or start the kiosk headless"});
  return findings;
}

std::vector<Finding> check_graphics(const Machine& machine) {
  std::vector<Finding> findings;
  for (const fs::path& node : entries(below(machine, "/dev/dri"), "renderD")) {
    std::error_code problem;
    const fs::path driver = fs::read_symlink(below(machine, "/sys/class/drm") / node.filename() / "device/driver", problem);
    const std::string name = problem ? node.filename().string() : driver.filename().string();
    if (::access(node.c_str(), R_OK | W_OK) != 0)
      findings.push_back({"graphics card", Grade::bad, name + " may not be used by this user", "add the user to the group render"});
    else
      findings.push_back({"graphics card", Grade::good, name, {}});
  }
  if (findings.empty())
    findings.push_back({"graphics card", Grade::bad, "none: the processor draws, which is too slow for large models in depth",
                        "install a graphics card with a Mesa driver"});
  return findings;
}

std::vector<Finding> check_seat(const Machine& machine) {
  std::error_code error;
  if (fs::exists(below(machine, "/run/seatd.sock"), error)) return {{"screen", Grade::good, "seatd gives it to the kiosk"}};
  if (machine.in_x11) return {{"screen", Grade::note, "this X11 session has it; without one the kiosk needs seatd", "apt install seatd"}};
  return {{"screen", Grade::bad, "nothing gives the bare screen to the kiosk: seatd doesn't run",
           "apt install seatd; systemctl enable --now seatd"}};
}

std::vector<Finding> check_ports(const Machine& machine, const drivers::settings::StationSettings& settings) {
  std::vector<Finding> findings;
  const auto& tracker = settings.eye_tracker;
  if (tracker.driver == drivers::settings::TrackerDriver::none)
    findings.push_back({"eye tracker", Grade::note, "none is configured: depth is shown for a fixed place", "docs/display.md"});
  else if (tracker.driver == drivers::settings::TrackerDriver::opentrack && !tracker.simulated)
    findings.push_back({"eye tracker", Grade::good, "opentrack, by UDP port " + std::to_string(tracker.udp_port), {}});
  else
    findings.push_back(port_finding(machine, "eye tracker", tracker.port, tracker.simulated));
  const auto& servo = settings.prism_servo;
  if (servo.driver == drivers::settings::ServoDriver::none)
    findings.push_back({"prism servo", Grade::note, "none is configured: the mask doesn't follow the eyes", "docs/display.md"});
  else
    findings.push_back(port_finding(machine, "prism servo", servo.port, servo.simulated));
  return findings;
}

std::vector<Finding> check_realtime(const Machine& machine) {
  std::vector<Finding> findings;
  const std::string priority = std::to_string(machine.max_realtime_priority);
  if (machine.max_realtime_priority >= kPriority)
    findings.push_back({"real-time priority", Grade::good, "up to " + priority, {}});
  else
    findings.push_back({"real-time priority", Grade::note, "up to " + priority + " only: ticks of the device loop may come late",
                        "the unit prismesh-deviced has it; else LimitRTPRIO=40, or rtprio in /etc/security/limits.conf"});
  if (!machine.max_locked_kb)
    findings.push_back({"locked memory", Grade::good, "no limit", {}});
  else
    findings.push_back({"locked memory", Grade::note,
                        "at most " + std::to_string(*machine.max_locked_kb) + " KiB: a tick may wait for the disk while memory is short",
                        "the unit prismesh-deviced has no limit; else LimitMEMLOCK=infinity"});
  return findings;
}

std::vector<Finding> check_disk(const Machine& machine) {
  const fs::path& folder = machine.state_directory;
  std::error_code problem;
  fs::path existing = folder;
  while (!existing.empty() && existing != existing.root_path() && !fs::exists(existing, problem)) existing = existing.parent_path();
  struct statvfs disk {};
  if (::statvfs(existing.c_str(), &disk) != 0) return {{"journals", Grade::bad, folder.string() + " can't be reached", "check the disk"}};
  const std::uint64_t free = std::uint64_t{disk.f_bavail} * disk.f_frsize;
  if ((disk.f_flag & ST_RDONLY) != 0)
    return {{"journals", Grade::bad, folder.string() + " is on a disk that can't be written: no edit can be kept", "mount it for writing"}};
  if (::access(existing.c_str(), W_OK) != 0)
    return {{"journals", Grade::bad, folder.string() + " may not be written by this user", "start modeld as its owner"}};
  const std::string says = folder.string() + ", " + gigabytes(free) + " free";
  if (free < kMinFreeBytes) return {{"journals", Grade::bad, says, "make room: without it edits are refused"}};
  if (free < kFewFreeBytes) return {{"journals", Grade::note, says, "a journal of a long session may take a few GiB"}};
  return {{"journals", Grade::good, says, {}}};
}

std::vector<Finding> check_clock(const Machine& machine) {
  const std::time_t now = machine.now_s;
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  char text[32];
  (void)std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &parts);
  if (machine.now_s < kOldestNowS)
    return {{"clock", Grade::bad, std::string(text) + ", which is before this program was made",
             "set it: journals and saved decks carry its times"}};
  if (!machine.clock_synchronized)
    return {{"clock", Grade::note, std::string(text) + ", not synchronized", "systemd-timesyncd keeps it right"}};
  return {{"clock", Grade::good, text, {}}};
}

std::vector<Finding> check_units(const Machine& machine) {
  constexpr std::array kUnits{"prismesh.target",          "prismesh-modeld.socket", "prismesh-modeld.service", "prismesh-deviced.socket",
                              "prismesh-deviced.service", "prismesh-pen.socket",    "prismesh-pen.service",    "prismesh-import.socket",
                              "prismesh-import@.service", "prismesh-kiosk.service"};
  std::vector<std::string> missing;
  for (const char* unit : kUnits) {
    std::error_code problem;
    if (!fs::exists(below(machine, "/usr/lib/systemd/system") / unit, problem) &&
        !fs::exists(below(machine, "/etc/systemd/system") / unit, problem))
      missing.emplace_back(unit);
  }
  if (missing.empty()) return {{"units", Grade::good, "installed", {}}};
  const std::string says =
      missing.size() == kUnits.size()
          ? "none is installed: the programs are started by hand"
          : missing.front() + " is missing" + (missing.size() > 1 ? ", and " + counted(missing.size() - 1, "other") : std::string());
  return {{"units", missing.size() == kUnits.size() ? Grade::note : Grade::bad, says, "docs/appliance.md"}};
}

}  // namespace prismesh::cli
