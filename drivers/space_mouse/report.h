// The reports of SpaceMouse devices by 3Dconnexion: what the hand does to the cap, and which buttons it presses. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace prismesh::drivers::space_mouse {

/// A device of the table; `report` doesn't depend on it: reports are told apart by their length.
struct SpaceMouseModel {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string_view name;
};
/// Nothing: no such device. Numbers with the wireless receiver are the receiver's, whichever device is behind it.
std::optional<SpaceMouseModel> find_space_mouse(std::uint16_t vendor, std::uint16_t product);

/// At the end of the cap's way; more is cut.
inline constexpr int kFullDeflection = 350;

/// The cap, each axis from -350 to 350: x to the right, y toward the user, z down; rotations about these axes. A device at rest sends
/// zeros.
struct SpaceMouseState {
  std::array<int, 3> shift{};
  std::array<int, 3> turn{};
  std::uint64_t buttons = 0;  ///< a bit each; the first is 0
  bool operator==(const SpaceMouseState&) const = default;
};

enum class ReportKind : std::uint8_t { shift, turn, shift_and_turn, buttons, other };

/// Takes a report with its number in the first byte. Report 1 is a shift if three axes follow (7 bytes), shift and turn if six do (13
/// bytes); 2 is a turn; 3 is buttons, up to eight bytes. `other`: a battery's or an unknown one; the state stays as it is. Nothing: a
/// report that ends too early or is empty; the state stays as it is.
std::optional<ReportKind> take_report(std::span<const std::byte> report, SpaceMouseState& state);

}  // namespace prismesh::drivers::space_mouse
