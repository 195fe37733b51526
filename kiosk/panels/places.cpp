#include "kiosk/panels/places.h"

#include <algorithm>
#include <cmath>

namespace prismesh::kiosk::panels {
namespace {

// In font sizes. What is narrower or lower has no room for the panel beside a view that one can work in.
constexpr float kRailEms = 7.5F, kShortRailEms = 2.5F, kNarrowestDockEms = 11, kWidestDockEms = 40;
constexpr float kWidthForRailEms = 20, kWidthForNamesEms = 40, kWidthForDockEms = 30, kHeightForOptionsEms = 22;
constexpr float kUsualDockShare = 0.32F, kMaxDockShare = 0.4F;  ///< of the picture's width: unless the user wants more, and at most
constexpr float kMinHalfShare = 0.15F;                          ///< of the dock's height

/// Whole pixels, so that panels touch without a seam.
float row_height(float em, float ems) { return std::round(em * ems); }

}  // namespace

Arrangement within_limits(const Arrangement& wanted) {
  const Arrangement usual;
  const float dock = std::isfinite(wanted.dock_ems) ? wanted.dock_ems : usual.dock_ems;
  const float upper = std::isfinite(wanted.upper_share) ? wanted.upper_share : usual.upper_share;
  return {std::clamp(dock, kNarrowestDockEms, kWidestDockEms), std::clamp(upper, kMinHalfShare, 1 - kMinHalfShare), wanted.tab};
}

Places place_panels(display::PixelSize picture, float em, const Arrangement& arrangement) {
  const Arrangement set = within_limits(arrangement);
  const auto width = static_cast<float>(picture.width), height = static_cast<float>(picture.height);
  Places places;
  places.bar = {0, 0, width, std::min(height, row_height(em, 2.25F))};
  const float status = std::min(height - places.bar.height, row_height(em, 1.75F));
  places.status = {0, height - status, width, status};
  const float top = places.bar.bottom(), middle = places.status.y - top;
  places.short_rail = width < kWidthForNamesEms * em;
  const float rail = width < kWidthForRailEms * em ? 0 : std::round(em * (places.short_rail ? kShortRailEms : kRailEms));
  const float dock =
      width < kWidthForDockEms * em
          ? 0
          : std::round(std::min(set.dock_ems * em, (set.dock_ems > Arrangement().dock_ems ? kMaxDockShare : kUsualDockShare) * width));
  places.rail = {0, top, rail, middle};
  places.dock = {width - dock, top, dock, middle};
  const float upper = std::round(middle * set.upper_share);
  places.upper = {places.dock.x, top, dock, upper};
  places.lower = {places.dock.x, top + upper, dock, middle - upper};
  const float options = height < kHeightForOptionsEms * em ? 0 : row_height(em, 2.25F);
  places.options = {rail, places.status.y - options, width - rail - dock, options};
  places.view = {rail, top, width - rail - dock, middle - options};
  return places;
}

}  // namespace prismesh::kiosk::panels
