#include "daemon/setup/machine.h"

#include <fcntl.h>
#include <linux/rtc.h>
#include <spawn.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <initializer_list>
#include <string>
#include <variant>
#include <vector>

#include "ipc/wire/descriptor.h"

namespace prismesh::setup {
namespace {

/// Runs a tool and waits for its end. Its own words go to the log.
Result<void> run_tool(std::initializer_list<const char*> words) {
  std::vector<char*> arguments;
  for (const char* word : words) arguments.push_back(const_cast<char*>(word));  // NOLINT: posix_spawn writes nothing
  arguments.push_back(nullptr);
  char path[] = "PATH=/usr/bin:/usr/sbin";
  std::array<char*, 2> environment{path, nullptr};
  pid_t pid = 0;
  if (const int error = ::posix_spawn(&pid, arguments[0], nullptr, nullptr, arguments.data(), environment.data()); error != 0)
    return fail(arguments[0], std::string("can't be started: ") + std::strerror(error));
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0)
    if (errno != EINTR) return fail(arguments[0], std::strerror(errno));
  if (status != 0) return fail(arguments[0], "it failed, though the setting is written: start the station anew");
  return {};
}

Result<void> follow_name(const std::string& name) {
  const ipc::Descriptor file(::open("/proc/sys/kernel/hostname", O_WRONLY | O_CLOEXEC));
  if (!file || ::write(file.get(), name.data(), name.size()) != static_cast<ssize_t>(name.size()))
    return fail("name", std::string("it is written, and counts from the next start on: ") + std::strerror(errno));
  return {};
}

Result<void> follow_pairing(bool on) {
  constexpr const char *kTool = "/usr/bin/systemctl", *kSocket = "prismesh-intake.socket", *kService = "prismesh-intake.service";
  if (!on) return run_tool({kTool, "--quiet", "disable", "--now", kService, kSocket});
  if (Result<void> enabled = run_tool({kTool, "--quiet", "enable", kService, kSocket}); !enabled) return enabled;
  if (Result<void> started = run_tool({kTool, "start", kSocket}); !started) return started;
  return run_tool({kTool, "--no-block", "restart", kService});  // it reads its settings when it starts
}

Result<void> follow_clock(const ipc::SetClock& clock) {
  const std::time_t seconds = seconds_of(clock);
  const timespec now{seconds, 0};
  if (::clock_settime(CLOCK_REALTIME, &now) != 0) return fail("time", std::string("the clock can't be set: ") + std::strerror(errno));
  // The clock that goes on while the machine is off. The kernel sets it only where a time server answers.
  const ipc::Descriptor device(::open("/dev/rtc0", O_WRONLY | O_CLOEXEC));
  if (!device) return {};  // a machine without one
  std::tm utc{};
  ::gmtime_r(&seconds, &utc);
  rtc_time time{};
  time.tm_sec = utc.tm_sec;
  time.tm_min = utc.tm_min;
  time.tm_hour = utc.tm_hour;
  time.tm_mday = utc.tm_mday;
  time.tm_mon = utc.tm_mon;
  time.tm_year = utc.tm_year;
  if (::ioctl(device.get(), RTC_SET_TIME, &time) != 0)
    return fail("time", std::string("it is set, but not for the next start: ") + std::strerror(errno));
  return {};
}

}  // namespace

Result<void> follow(const ipc::SetupRequest& request) {
  if (const auto* name = std::get_if<ipc::SetName>(&request)) return follow_name(name->name);
  if (std::holds_alternative<ipc::SetNetwork>(request)) return run_tool({"/usr/bin/networkctl", "reload"});
  if (const auto* pairing = std::get_if<ipc::SetPairing>(&request)) return follow_pairing(pairing->on);
  if (const auto* clock = std::get_if<ipc::SetClock>(&request)) return follow_clock(*clock);
  return {};
}

std::int64_t seconds_of(const ipc::SetClock& clock) {
  std::tm local{};
  ::strptime((clock.date + " " + clock.time).c_str(), "%Y-%m-%d %H:%M", &local);
  local.tm_isdst = -1;  // the zone knows
  return std::mktime(&local);
}

}  // namespace prismesh::setup
