// Messages of the Haply Inverse Service: JSON over a websocket [Haply 3.5]. The service sends one message when a client connects, and then
// one for each that it gets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "base/error.h"

namespace prismesh::drivers::haptic_pen::inverse3 {

/// What the service says of an Inverse3. Metres in the service's own axes: x to the right, y away from the user, z up.
struct DeviceState {
  std::string id;
  std::optional<Eigen::Vector3d> position_m;
  bool ready = true, powered = true, used_by_another = false;
  bool turned = false;  ///< its axes or scale were changed in the service, so places aren't in the usual axes
};

/// What the service says of a grip, with or without a cable.
struct GripState {
  std::optional<Eigen::Quaterniond> orientation;  ///< of length 1, in the service's axes
  std::uint32_t buttons = 0;                      ///< bit 0: a, 1: b, 2: c
};

struct ServiceState {
  std::vector<DeviceState> devices;
  std::vector<GripState> grips;
  bool has_session = false;  ///< so do services since 3.5
};

/// Longest message that is read.
inline constexpr std::size_t kMaxMessageBytes = std::size_t{64} << 10;

/// Reads any message of the service. What it doesn't know is skipped. Numbers are finite, and no place is further than 10 m. Errors, each a
/// sentence that goes on after "the service on port .. ": it isn't JSON, isn't a list of devices, holds values that can't be.
Result<ServiceState> read_message(std::string_view text);

/// The device to use, from the first message. Errors, each a sentence: none, several, used by another program, axes that were changed.
Result<std::string> choose_device(const ServiceState& state);

/// A message that sets the force in the service's axes. No component is longer than it was; what isn't finite is zero. `since_3_5`: how
/// services since 3.5 name the vector.
std::string force_message(std::string_view device_id, const Eigen::Vector3d& newton, bool since_3_5);

/// The message as one frame from a client (RFC 6455). Its mask is zero, so the text stands in it as it is.
std::vector<std::byte> text_frame(std::string_view text);

// Between the service's axes and those of pens: x to the right, y up, z toward the user.
Eigen::Vector3d to_pen_axes(const Eigen::Vector3d& service);
Eigen::Vector3d to_service_axes(const Eigen::Vector3d& pen);
Eigen::Quaterniond to_pen_axes(const Eigen::Quaterniond& service);

/// The middle of the workspace in the service's axes, in metres: about where the grip is in the maker's examples.
Eigen::Vector3d workspace_middle_m();

}  // namespace prismesh::drivers::haptic_pen::inverse3
