// The directions along which a pull can fall off: the deck's axes, the view's, and those picked in the model.
#pragma once

#include <string>

#include <Eigen/Geometry>

#include "kiosk/tools/shaping/shaping_options.h"

namespace prismesh::kiosk::tools::shaping {

/// None: in all directions.
FalloffDirection falloff_along(DeckAxis axis);
/// The next of: all directions, x, y, z. After any other direction: all directions.
FalloffDirection next_falloff(const FalloffDirection& now);

/// A direction of the screen, in the deck's axes: to the right first; if `now` is one, the next of right, up, into the picture.
/// `screen_from_deck`: the view's rotation.
FalloffDirection next_falloff_of_view(const FalloffDirection& now, const Eigen::Quaterniond& screen_from_deck);

/// A direction that was picked in the model. `what`: "two nodes", "free edge", ..
FalloffDirection picked_falloff(std::string what, const mesh::Vec3& direction);

/// "0.707 0.707 0": the direction's components for a person.
std::string components_text(const mesh::Vec3& direction);

}  // namespace prismesh::kiosk::tools::shaping
