// Where the model is in the pen's space, and how the pen stands in it. Pure.
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Geometry>

#include "ipc/pen/page.h"
#include "kiosk/link/pen_link.h"
#include "kiosk/stereo/view.h"
#include "mesh/field/placement.h"

namespace prismesh::kiosk::tools::pen {

using mesh::Vec3;
using mesh::field::Placement;

/// The pen's axes are the screen's: x right, y up, z toward the viewer. The middle of its space is what is in the middle of the screen, in
/// the screen's plane. `mm_per_unit`: millimetres of the pen for one length of the deck.
Placement place_in_view(const stereo::View& view, double mm_per_unit);

link::PenPlace told_place(const Placement& place, std::uint64_t document);

/// What the hand does with the pen now.
struct PenPose {
  bool usable = false;  ///< the pen's process runs it, and it is neither away nor latched: it can hold something
  Vec3 position_mm = Vec3::Zero();
  std::optional<Eigen::Quaterniond> orientation{};  ///< unit
  bool grab = false;                                ///< its first button is down
  bool clutch = false;                              ///< its second button is down
};
/// A page that wasn't written for so long is one of a process that stands still.
inline constexpr std::int64_t kSilenceNs = 500'000'000;
PenPose pose_of(const ipc::PenState& state, std::int64_t now_ns);
/// Whether there is a pose to show, also of a pen that is latched.
bool can_be_shown(const ipc::PenState& state, std::int64_t now_ns);

/// The shaft from the tip to the hand in the pen's space, unit. A pen that doesn't tell its orientation is held as a right hand or a left
/// one holds it.
Vec3 shaft_of(const PenPose& pose, bool left_handed);

}  // namespace prismesh::kiosk::tools::pen
