#include "drivers/space_mouse/report.h"

#include <algorithm>

namespace prismesh::drivers::space_mouse {
namespace {

constexpr std::uint16_t kLogitech = 0x046D, k3Dconnexion = 0x256F;

/// The public lists of libndofdev and of the npm package spacemouse agree on these.
constexpr std::array kModels{
    SpaceMouseModel{kLogitech, 0xC603, "SpaceMouse"},
    SpaceMouseModel{kLogitech, 0xC605, "CADMan"},
    SpaceMouseModel{kLogitech, 0xC606, "SpaceMouse Classic"},
    SpaceMouseModel{kLogitech, 0xC621, "SpaceBall 5000"},
    SpaceMouseModel{kLogitech, 0xC623, "SpaceTraveler"},
    SpaceMouseModel{kLogitech, 0xC625, "SpacePilot"},
    SpaceMouseModel{kLogitech, 0xC626, "SpaceNavigator"},
    SpaceMouseModel{kLogitech, 0xC627, "SpaceExplorer"},
    SpaceMouseModel{kLogitech, 0xC628, "SpaceNavigator for Notebooks"},
    SpaceMouseModel{kLogitech, 0xC629, "SpacePilot Pro"},
    SpaceMouseModel{kLogitech, 0xC62B, "SpaceMouse Pro"},
    SpaceMouseModel{k3Dconnexion, 0xC62E, "SpaceMouse Wireless (cable)"},
    SpaceMouseModel{k3Dconnexion, 0xC62F, "SpaceMouse Wireless (receiver)"},
    SpaceMouseModel{k3Dconnexion, 0xC631, "SpaceMouse Pro Wireless (cable)"},
    SpaceMouseModel{k3Dconnexion, 0xC632, "SpaceMouse Pro Wireless (receiver)"},
    SpaceMouseModel{k3Dconnexion, 0xC633, "SpaceMouse Enterprise"},
    SpaceMouseModel{k3Dconnexion, 0xC635, "SpaceMouse Compact"},
    SpaceMouseModel{k3Dconnexion, 0xC652, "Universal Receiver"},
};

constexpr std::size_t kAxesBytes = 6;

int axis_at(std::span<const std::byte> bytes, std::size_t which) {
  const auto value =
      static_cast<std::uint16_t>(std::to_integer<unsigned>(bytes[2 * which]) | std::to_integer<unsigned>(bytes[2 * which + 1]) << 8);
  return std::clamp<int>(static_cast<std::int16_t>(value), -kFullDeflection, kFullDeflection);
}

std::array<int, 3> axes(std::span<const std::byte> bytes) { return {axis_at(bytes, 0), axis_at(bytes, 1), axis_at(bytes, 2)}; }

}  // namespace

std::optional<SpaceMouseModel> find_space_mouse(std::uint16_t vendor, std::uint16_t product) {
  const auto found = std::find_if(kModels.begin(), kModels.end(),
                                  [&](const SpaceMouseModel& each) { return each.vendor == vendor && each.product == product; });
  if (found == kModels.end()) return std::nullopt;
  return *found;
}

std::optional<ReportKind> take_report(std::span<const std::byte> report, SpaceMouseState& state) {
  if (report.empty()) return std::nullopt;
  const auto content = report.subspan(1);
  switch (std::to_integer<unsigned>(report[0])) {
    case 1:
      if (content.size() < kAxesBytes) return std::nullopt;
      state.shift = axes(content);
      if (content.size() < 2 * kAxesBytes) return ReportKind::shift;
      state.turn = axes(content.subspan(kAxesBytes));
      return ReportKind::shift_and_turn;
    case 2:
      if (content.size() < kAxesBytes) return std::nullopt;
      state.turn = axes(content);
      return ReportKind::turn;
    case 3: {
      if (content.empty()) return std::nullopt;
      std::uint64_t buttons = 0;
      for (std::size_t i = 0; i < std::min<std::size_t>(content.size(), 8); ++i)
        buttons |= std::to_integer<std::uint64_t>(content[i]) << (8 * i);
      state.buttons = buttons;
      return ReportKind::buttons;
    }
    default: return ReportKind::other;
  }
}

}  // namespace prismesh::drivers::space_mouse
