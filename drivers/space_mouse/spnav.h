// The events of spacenavd, the free driver that shares SpaceMouse devices among programs: protocol version 0, eight 32-bit integers an
// event. Source: libspnav (spnav.c) and spacenavd (proto_unix.c).
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "base/error.h"
#include "drivers/port/hid_port.h"
#include "drivers/space_mouse/report.h"

namespace prismesh::drivers::space_mouse {

inline constexpr std::size_t kSpnavEventBytes = 32;

/// Puts events together from a stream that may cut them anywhere. Pure.
class SpnavEvents {
 public:
  /// Takes bytes in their order. spacenavd's axes (y up, z away from the user) become those of SpaceMouseState. Unknown events and buttons
  /// above 63 are passed over. Calls `changed(state)` after each event that was understood.
  template <class Changed>
  void take(std::span<const std::byte> bytes, SpaceMouseState& state, const Changed& changed) {
    for (const std::byte each : bytes) {
      event_[filled_++] = each;
      if (filled_ < kSpnavEventBytes) continue;
      filled_ = 0;
      if (apply(state)) changed(state);
    }
  }

 private:
  bool apply(SpaceMouseState& state) const;

  std::array<std::byte, kSpnavEventBytes> event_{};
  std::size_t filled_ = 0;
};

/// Where spacenavd listens: $SPNAV_SOCKET, else /var/run/spnav.sock.
std::string spnav_socket_path();
/// Connects without waiting. A read gives a piece of the stream. Errors: nobody listens there.
Result<std::unique_ptr<port::HidPort>> connect_to_spnav(const std::string& path);

}  // namespace prismesh::drivers::space_mouse
