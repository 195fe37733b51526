// How shells that have a thickness are drawn as plates: for each corner the way from the mid-surface to the outer face, and the sides where
// no neighbour's faces go on. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kiosk/render/model_table.h"

namespace prismesh::kiosk::render {

/// Corner k of a shell: its way (kPlateWayBits for each coordinate, signed, in kPlateWayUnit, times half of the thickness; toward the upper
/// face), and kPlateSide if the side from corner k to the next one is closed by a face. A triangle's fourth corner is its third.
using PlateRow = std::array<std::uint32_t, 4>;
inline constexpr int kPlateWayBits = 10;
inline constexpr double kPlateWayUnit = 1.0 / 256;
inline constexpr std::uint32_t kPlateSide = 1U << 30;
/// Longest way, in half thicknesses: that of a bend by 116 degrees.
inline constexpr double kMaxPlateWay = 1.9;
/// Two shells that share an edge alone have a common way at its ends up to this bend: their outer faces meet there, as in a mitre joint.
inline constexpr double kMaxMitreDegrees = 100;

mesh::Vec3 plate_way(std::uint32_t corner);

/// Thickness of each part's plates, by PartIndex: the mean of its thinnest and its thickest shell; 0: drawn as a surface.
std::vector<float> plate_thicknesses(const ModelSource& source);

/// Of the visible shells of a model. Shells that aren't drawn have rows of 0.
class PlateShape {
 public:
  /// Computes all rows.
  void make(const ModelTable& table, std::span<const float> thickness_of_part);
  /// Computes the rows that depend on moved nodes; the shells, their parts' thicknesses and what is hidden are those of make(). Returns the
  /// chunks whose rows were computed.
  std::vector<std::uint32_t> move(const ModelTable& table, std::span<const std::uint32_t> moved_chunks);

  std::size_t shell_count() const { return ways_.size(); }
  PlateRow row(std::size_t shell) const;

 private:
  struct Fan;
  void find_normals(const ModelTable& table, std::size_t chunk);
  void find_ways(const ModelTable& table, std::size_t chunk);
  void find_sides(std::size_t chunk);
  std::span<const std::uint32_t> around(std::uint32_t node) const {
    return std::span(shells_of_).subspan(first_of_[node], first_of_[node + 1] - first_of_[node]);
  }
  std::uint32_t pack_way(const ModelTable& table, std::uint32_t shell, std::size_t corner) const;
  bool faces_go_on(std::uint32_t shell, std::size_t side) const;
  std::size_t chunk_count() const { return (ways_.size() + mesh::kChunkSize - 1) / mesh::kChunkSize; }

  std::vector<PlateRow> ways_;                         ///< without sides
  std::vector<std::uint8_t> sides_;                    ///< by shell; bit k: kPlateSide
  std::vector<std::array<std::uint32_t, 4>> corners_;  ///< by shell; kNoIndex: not drawn
  std::vector<float> thickness_;                       ///< by shell
  std::vector<Eigen::Vector3f> normals_;               ///< by shell, unit; 0: none
  std::vector<std::uint32_t> first_of_, shells_of_;    ///< by node: its shells
};

}  // namespace prismesh::kiosk::render
