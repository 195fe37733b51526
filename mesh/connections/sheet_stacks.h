// Finds which sheets lie on each other at each shell. Private to mesh/connections.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "mesh/connections/flange.h"
#include "mesh/model/model.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::connections {

inline constexpr std::size_t kMaxSheets = 6;

/// The sheets on a shell's normal, in its direction.
struct SheetStack {
  ShellIndex shell;
  std::array<ShellIndex, kMaxSheets> hit{};  ///< itself included
  std::array<PartIndex, kMaxSheets> part{};
  std::uint8_t sheets = 0;
  std::uint8_t own = 0;  ///< which of them the shell itself is
  double distance = 0;   ///< mean, of neighbouring sheets

  /// Whether the other one, of a shell with the same or the opposite normal, is of the same sheets in the same order.
  bool same_order(const SheetStack& other, bool opposite) const;
  bool same_parts(const SheetStack& other) const { return same_order(other, false) || same_order(other, true); }
};

/// Where the line through the point goes through the shell, as a distance along the unit normal; nothing if it doesn't, or if the planes
/// differ by more than kMaxAngleOfFlange.
std::optional<double> height_of(const spatial::BoxTree& tree, ShellIndex shell, const Vec3& point, const Vec3& normal);

/// The unit normal; zero of a shell without area.
Vec3 unit_normal(const Model& model, ShellIndex shell);
double area_of(const Model& model, ShellIndex shell);

/// The stacks of at least two sheets, ascending by shell. Nothing if `progress` stops it.
std::vector<SheetStack> find_stacks(const Model& model, const spatial::BoxTree& tree, const FlangeOptions& options,
                                    const Progress& progress);

}  // namespace prismesh::mesh::connections
