// Item image: which shell each pixel shows. Finds from it which nodes are visible. No OpenGL.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kiosk/render/cut_picture.h"
#include "kiosk/render/model_table.h"
#include "kiosk/render/picture.h"
#include "kiosk/stereo/pointer.h"

namespace prismesh::kiosk::render {

struct ItemImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint32_t> items;  ///< rows from the bottom; 0: ground, else ShellIndex + 1

  /// The shell at a pixel counted from the upper left; kNoIndex outside the image and on the ground.
  std::uint32_t shell_at(int x, int y) const {
    if (x < 0 || y < 0 || x >= width || y >= height) return kNoIndex;
    return items[static_cast<std::size_t>(height - 1 - y) * width + x] - 1;  // 0 wraps to kNoIndex
  }
};

/// Finds nodes in a picture. The image must be of the same model and aim; `table` and `image` must outlive this.
class NodeFinder {
 public:
  /// Nodes that the cut takes away aren't visible.
  NodeFinder(const ModelTable& table, const ItemImage& image, const stereo::Aim& aim, const std::optional<CutPicture>& cut = {});

  /// Whether a node that projects to `pixel` is visible: one of its shells is at the pixel or beside it, or the shell at the pixel isn't in
  /// front of the node.
  bool seen(std::uint32_t node, const Eigen::Vector2d& pixel) const;
  /// Where a node projects to; empty if it is behind the eye.
  std::optional<Eigen::Vector2d> pixel_of(std::uint32_t node) const;

  /// The visible node nearest to a pixel, at most `radius` pixels away, among the corners of the shells around it and `others` (ends of
  /// line elements). Corners of the shell at the pixel come first.
  std::optional<mesh::NodeIndex> nearest(const Eigen::Vector2d& pixel, double radius, const std::vector<std::uint32_t>& others) const;
  /// Nodes inside the rectangle for which `candidates` is not 0, ascending: the visible ones, or all (`through`).
  mesh::NodeSet inside(const PixelRect& rect, bool through, const std::vector<std::uint8_t>& candidates) const;

 private:
  bool hides(std::uint32_t shell, const mesh::Vec3& point) const;

  const ModelTable& table_;
  const ItemImage& image_;
  stereo::Aim aim_;
  Eigen::Matrix4d clip_;
  std::optional<CutPicture> cut_;  ///< without its segments
  mesh::Vec3 eye_;                 ///< deck coordinates
  double pixel_in_deck_ = 1;       ///< size of a pixel at the screen's depth, deck's unit
};

}  // namespace prismesh::kiosk::render
