#include "kiosk/tools/shaping/falloff_direction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace prismesh::kiosk::tools::shaping {
namespace {

using mesh::Vec3;

constexpr std::array<std::string_view, 3> kOfView{"view's right", "view's up", "view's depth"};
constexpr double kRoundedToZero = 1e-12;  ///< components smaller than this come from rounding only

/// The unit vector, without the rests that a rotation by right angles leaves.
Vec3 cleaned(const Vec3& direction) {
  Vec3 clean = direction.normalized();
  for (double& component : clean)
    if (std::abs(component) < kRoundedToZero) component = 0;
  return clean.normalized();
}

}  // namespace

FalloffDirection falloff_along(DeckAxis axis) {
  if (axis == DeckAxis::none) return {};
  return {std::string(kDeckAxisNames[static_cast<std::size_t>(axis)]), unit(axis)};
}

FalloffDirection next_falloff(const FalloffDirection& now) {
  for (const DeckAxis axis : {DeckAxis::none, DeckAxis::x, DeckAxis::y})
    if (now == falloff_along(axis)) return falloff_along(next(axis));
  return {};
}

FalloffDirection next_falloff_of_view(const FalloffDirection& now, const Eigen::Quaterniond& screen_from_deck) {
  const std::array<Vec3, 3> screen{Vec3::UnitX(), Vec3::UnitY(), Vec3(-Vec3::UnitZ())};
  const auto before = static_cast<std::size_t>(std::find(kOfView.begin(), kOfView.end(), now.what) - kOfView.begin());
  const std::size_t which = (before + 1) % (kOfView.size() + 1) % kOfView.size();
  return {std::string(kOfView[which]), cleaned(screen_from_deck.conjugate() * screen[which])};
}

FalloffDirection picked_falloff(std::string what, const Vec3& direction) { return {std::move(what), cleaned(direction)}; }

std::string components_text(const Vec3& direction) {
  return fmt::format("{:.3g} {:.3g} {:.3g}", direction.x() + 0.0, direction.y() + 0.0, direction.z() + 0.0);
}

}  // namespace prismesh::kiosk::tools::shaping
