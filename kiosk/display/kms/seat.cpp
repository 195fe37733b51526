#include "kiosk/display/kms/seat.h"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include <fmt/format.h>
extern "C" {  // the header doesn't say so
#include <libseat.h>
}

namespace prismesh::kiosk::display::kms {
namespace {

constexpr int kFirstAnswerMs = 5000;  ///< a seat that is given at all is given at once

libseat_seat_listener listener_of() {
  libseat_seat_listener listener{};
  listener.enable_seat = [](libseat*, void* active) { *static_cast<bool*>(active) = true; };
  listener.disable_seat = [](libseat*, void* active) { *static_cast<bool*>(active) = false; };
  return listener;
}

}  // namespace

Result<std::unique_ptr<Seat>> Seat::open() {
  static const libseat_seat_listener kListener = listener_of();  // libseat keeps the address
  libseat_set_log_level(LIBSEAT_LOG_LEVEL_SILENT);
  std::unique_ptr<Seat> seat(new Seat);
  seat->seat_ = libseat_open_seat(&kListener, &seat->active_);
  if (seat->seat_ == nullptr)
    return fail("the screen",
                fmt::format("no seat manager gives it to this program ({}): on Debian install seatd, and add this user to the "
                            "group video; or start in an X11 session (DISPLAY)",
                            std::strerror(errno)));
  // The manager gives the seat by its first message, which may have come with the answer already.
  libseat_dispatch(seat->seat_, 0);
  pollfd watched{libseat_get_fd(seat->seat_), POLLIN, 0};
  if (!seat->active_ && ::poll(&watched, 1, kFirstAnswerMs) > 0) libseat_dispatch(seat->seat_, 0);
  if (!seat->active_) return fail("the screen", "another program has it: end that program, or switch to its console and away again");
  seat->name_ = libseat_seat_name(seat->seat_);
  return seat;
}

Seat::~Seat() {
  if (seat_ == nullptr) return;
  while (!devices_.empty()) close_device(devices_.begin()->first);
  libseat_close_seat(seat_);
}

Result<void> Seat::turn() {
  if (libseat_dispatch(seat_, 0) < 0) return fail("the screen", fmt::format("the seat manager is gone ({})", std::strerror(errno)));
  return {};
}

int Seat::descriptor() const { return libseat_get_fd(seat_); }

void Seat::let_go() { libseat_disable_seat(seat_); }

void Seat::switch_to(int console) { libseat_switch_session(seat_, console); }

Result<int> Seat::open_device(const std::string& path) {
  int descriptor = -1;
  const int number = libseat_open_device(seat_, path.c_str(), &descriptor);
  if (number < 0) return fail(path, fmt::format("the seat manager doesn't give this device ({})", std::strerror(errno)));
  devices_[descriptor] = number;
  return descriptor;
}

void Seat::close_device(int descriptor) {
  const auto found = devices_.find(descriptor);
  if (found == devices_.end()) return;
  libseat_close_device(seat_, found->second);
  ::close(descriptor);
  devices_.erase(found);
}

}  // namespace prismesh::kiosk::display::kms
