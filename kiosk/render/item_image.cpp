#include "kiosk/render/item_image.h"

#include <algorithm>
#include <cmath>

#include "base/parallel_for.h"

namespace prismesh::kiosk::render {

using mesh::Vec3;

namespace {

// A shell hides a node if it lies farther in front of it than this share of its size (for curved sheets) plus this many pixels (for the
// image's resolution).
constexpr double kShareOfShell = 0.05;
constexpr double kPixels = 1.5;
// The end of a line element is picked only if it is nearer by this much than the corners of the shell under the pointer.
constexpr double kLineLagPixels = 4;

bool has_corner(const mesh::ShellNodes& nodes, std::uint32_t node) {
  return std::any_of(nodes.node.begin(), nodes.node.end(), [&](mesh::NodeIndex corner) { return corner.value == node; });
}

}  // namespace

NodeFinder::NodeFinder(const ModelTable& table, const ItemImage& image, const stereo::Aim& aim, const std::optional<CutPicture>& cut)
    : table_(table),
      image_(image),
      aim_(aim),
      clip_(aim.clip_from_deck()),
      eye_(stereo::to_deck(aim.view, aim.eye_mm)),
      pixel_in_deck_(aim.mm_per_pixel() / aim.view.mm_per_unit) {
  if (cut) cut_ = CutPicture{cut->point, cut->normal};
}

std::optional<Eigen::Vector2d> NodeFinder::pixel_of(std::uint32_t node) const {
  const Eigen::Vector4d clip = clip_ * table_.position(node).homogeneous();
  if (!(clip.w() > 0)) return std::nullopt;
  return Eigen::Vector2d((0.5 + 0.5 * clip.x() / clip.w()) * aim_.width, (0.5 - 0.5 * clip.y() / clip.w()) * aim_.height);
}

bool NodeFinder::hides(std::uint32_t shell, const Vec3& point) const {
  mesh::ShellNodes nodes;
  Vec3 centre;
  if (shell >= table_.shell_count() || !table_.shell(shell, nodes) || !table_.shell_centre(shell, centre)) return false;
  const Vec3 a = table_.position(nodes.node[2].value) - table_.position(nodes.node[0].value);
  const Vec3 b = table_.position(nodes.node[3].value) - table_.position(nodes.node[1].value);
  const Vec3 normal = a.cross(b);
  const Vec3 sight = point - eye_;
  const double closing = normal.dot(sight);
  if (closing == 0) return false;
  const double reached = normal.dot(centre - eye_) / closing;  // 1: the shell's plane passes through the point
  const double slack = kShareOfShell * std::max(a.norm(), b.norm()) + kPixels * pixel_in_deck_;
  return (1 - reached) * sight.norm() > slack;
}

bool NodeFinder::seen(std::uint32_t node, const Eigen::Vector2d& pixel) const {
  if (!(pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < image_.width && pixel.y() < image_.height)) return false;
  if (cut_ && cut_->takes_away(table_.position(node))) return false;
  const int x = static_cast<int>(pixel.x()), y = static_cast<int>(pixel.y());
  const std::uint32_t here = image_.shell_at(x, y);
  if (here == kNoIndex || !hides(here, table_.position(node))) return true;
  mesh::ShellNodes nodes;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      if (const std::uint32_t shell = image_.shell_at(x + dx, y + dy);
          shell < table_.shell_count() && table_.shell(shell, nodes) && has_corner(nodes, node))
        return true;
  return false;
}

std::optional<mesh::NodeIndex> NodeFinder::nearest(const Eigen::Vector2d& pixel, double radius,
                                                   const std::vector<std::uint32_t>& others) const {
  if (!(radius >= 0 && radius < 4096) || !pixel.allFinite() || pixel.cwiseAbs().maxCoeff() > 1e6) return std::nullopt;
  std::vector<std::uint32_t> candidates = others;
  std::uint32_t last = kNoIndex;
  mesh::ShellNodes nodes;
  const auto reach = static_cast<int>(std::ceil(radius));
  const int cx = static_cast<int>(std::floor(pixel.x())), cy = static_cast<int>(std::floor(pixel.y()));
  for (int y = std::max(cy - reach, 0); y <= std::min(cy + reach, image_.height - 1); ++y)
    for (int x = std::max(cx - reach, 0); x <= std::min(cx + reach, image_.width - 1); ++x) {
      const std::uint32_t shell = image_.shell_at(x, y);
      if (shell == last || shell >= table_.shell_count() || !table_.shell(shell, nodes)) continue;
      last = shell;
      for (const mesh::NodeIndex node : nodes.node) candidates.push_back(node.value);
    }
  // Where sheets nearly coincide their nodes are at the same pixel. The nodes of the visible shell come first: other shells' corners are
  // moved away by the whole radius.
  const std::uint32_t under = image_.shell_at(cx, cy);
  mesh::ShellNodes corners;
  const bool on_shell = under < table_.shell_count() && table_.shell(under, corners);
  const auto lag = [&](std::uint32_t node) {
    if (!on_shell || has_corner(corners, node)) return 0.0;
    return std::find(others.begin(), others.end(), node) != others.end() ? kLineLagPixels : radius;
  };
  std::sort(candidates.begin(), candidates.end());
  candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
  std::optional<mesh::NodeIndex> best;
  double best_distance = 2 * radius + kLineLagPixels;
  for (const std::uint32_t node : candidates) {
    const auto at = pixel_of(node);
    if (!at) continue;
    const double distance = (*at - pixel).norm();
    if (!(distance <= radius)) continue;
    const double lagging = distance + lag(node);
    if (!(lagging < best_distance) || !seen(node, *at)) continue;
    best = mesh::NodeIndex(node);
    best_distance = lagging;
  }
  return best;
}

mesh::NodeSet NodeFinder::inside(const PixelRect& rect, bool through, const std::vector<std::uint8_t>& candidates) const {
  constexpr std::size_t kGrain = 16384;
  const double x0 = std::min(rect.x0, rect.x1), x1 = std::max(rect.x0, rect.x1);
  const double y0 = std::min(rect.y0, rect.y1), y1 = std::max(rect.y0, rect.y1);
  std::vector<mesh::NodeSet> found((candidates.size() + kGrain - 1) / kGrain);
  parallel_for(candidates.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      if (candidates[n] == 0) continue;
      const auto node = static_cast<std::uint32_t>(n);
      const auto at = pixel_of(node);
      if (!at || !(at->x() >= x0 && at->x() <= x1 && at->y() >= y0 && at->y() <= y1)) continue;
      if (through || seen(node, *at)) found[begin / kGrain].push_back(mesh::NodeIndex(node));
    }
  });
  mesh::NodeSet nodes;
  for (const mesh::NodeSet& part : found) nodes.insert(nodes.end(), part.begin(), part.end());
  return nodes;
}

}  // namespace prismesh::kiosk::render
