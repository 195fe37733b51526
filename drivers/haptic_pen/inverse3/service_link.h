// The connection to the Haply Inverse Service on this machine: a thread sends forces and receives places, the loop's thread neither blocks
// nor allocates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "drivers/port/usb_port.h"

namespace prismesh::drivers::haptic_pen::inverse3 {

/// A force in the service's axes.
struct LinkForce {
  std::array<double, 3> newton{};
  std::int64_t asked_ns = 0;
  std::int64_t valid_until_ns = 0;
};

/// What the service has answered to a force.
struct LinkAnswer {
  std::int64_t asked_ns = 0, answered_ns = 0;
  bool ready = false, has_position = false, has_orientation = false;
  std::array<double, 3> position_m{};
  std::array<double, 4> orientation{1, 0, 0, 0};  ///< w x y z
  std::uint32_t buttons = 0;
};

/// Why a connection has ended.
enum class LinkEnd : std::uint8_t {
  none,
  closed,     ///< by the service, or the system
  bad_reply,  ///< an answer that can't be read
  unplugged,  ///< the service doesn't know the device any more
  guarded,    ///< the guard has the line, and its messages are answered too: nobody could say which answer is to which question
};

/// So many questions may be without an answer before the next force waits. A zero after a force doesn't wait.
inline constexpr std::size_t kMaxAsked = 3;

class ServiceLink {
 public:
  /// Connects to 127.0.0.1 within a third of a second and chooses the device. Each message that is sent takes `gate`. `realtime_priority`:
  /// of the thread, where the system grants it; 0: an ordinary one. Errors, each a sentence: the service doesn't run, doesn't answer, isn't
  /// one; those of choose_device.
  static Result<std::unique_ptr<ServiceLink>> open(std::uint16_t port, port::UsbGate gate, int realtime_priority);
  virtual ~ServiceLink() = default;

  // For the loop's thread.
  /// The newest force counts. False: the thread takes none any more.
  virtual bool put(const LinkForce& force) = 0;
  virtual std::optional<LinkAnswer> take() = 0;
  /// Of the forces that were put: those that the thread has sent, or has replaced by newer ones.
  virtual std::uint64_t handled() const = 0;

  // For any thread.
  virtual LinkEnd end() const = 0;
  /// For a guard: a descriptor of the connection, and the bytes that set the force to zero.
  virtual int descriptor() const = 0;
  virtual const std::vector<std::byte>& zero_frame() const = 0;
};

}  // namespace prismesh::drivers::haptic_pen::inverse3
