#include "base/supervisor.h"

#include <cstdint>
#include <cstdlib>
#include <thread>

#include <systemd/sd-daemon.h>

namespace prismesh::supervisor {

void tell_ready(const std::string& status) { (void)::sd_notify(0, ("READY=1\nSTATUS=" + status).c_str()); }
void tell_ending() { (void)::sd_notify(0, "STOPPING=1"); }
void tell_alive() { (void)::sd_notify(0, "WATCHDOG=1"); }

void set_max_silence(std::chrono::microseconds time) { (void)::sd_notify(0, ("WATCHDOG_USEC=" + std::to_string(time.count())).c_str()); }

void wait_before_failing() {
  const char* systemd = std::getenv("NOTIFY_SOCKET");
  if (systemd != nullptr && *systemd != 0) std::this_thread::sleep_for(std::chrono::seconds(2));
}

std::optional<std::chrono::microseconds> period() {
  std::uint64_t period_us = 0;
  if (::sd_watchdog_enabled(0, &period_us) <= 0) return std::nullopt;
  return std::chrono::microseconds(period_us / 2);
}

}  // namespace prismesh::supervisor
