// Which shell each pixel shows, and what follows from it: which nodes can be seen. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kiosk/render/model_table.h"
#include "kiosk/render/picture.h"
#include "kiosk/stereo/pointer.h"

namespace prismesh::kiosk::render {

struct ItemImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint32_t> items;  ///< rows from the bottom; 0: ground, else ShellIndex + 1

  /// At a pixel counted from the upper left; kNoIndex outside and on the ground.
  std::uint32_t shell_at(int x, int y) const {
    if (x < 0 || y < 0 || x >= width || y >= height) return kNoIndex;
    return items[static_cast<std::size_t>(height - 1 - y) * width + x] - 1;  // 0 wraps to kNoIndex
  }
};

/// Looks for nodes in a picture. Keeps nothing; the image must be of the same model and aim.
class NodeSight {
 public:
  NodeSight(const ModelTable& table, const ItemImage& image, const stereo::Aim& aim);

  /// Whether a node that projects to `pixel` is seen there: its own shell shows at the pixel or beside it, or nothing that shows there
  /// lies in front of it.
  bool seen(std::uint32_t node, const Eigen::Vector2d& pixel) const;
  std::optional<Eigen::Vector2d> pixel_of(std::uint32_t node) const;

  /// Nearest seen node to a pixel among the corners of the shells around it and `others` (ends of lines). Corners of the shell at the
  /// pixel go first.
  std::optional<mesh::NodeIndex> nearest(const Eigen::Vector2d& pixel, double radius, const std::vector<std::uint32_t>& others) const;
  /// Nodes marked in `candidates` inside the rectangle, ascending: those seen, or all (`through`).
  mesh::NodeSet inside(const PixelRect& rect, bool through, const std::vector<std::uint8_t>& candidates) const;

 private:
  bool hides(std::uint32_t shell, const mesh::Vec3& point) const;

  const ModelTable& table_;
  const ItemImage& image_;
  stereo::Aim aim_;
  Eigen::Matrix4d clip_;
  mesh::Vec3 eye_;            ///< deck coordinates
  double pixel_in_deck_ = 1;  ///< length of a pixel at the pivot
};

}  // namespace prismesh::kiosk::render
