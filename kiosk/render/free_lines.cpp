#include "kiosk/render/free_lines.h"

#include <cstdint>
#include <span>

namespace prismesh::kiosk::render {

Result<void> FreeLines::set(const std::vector<std::array<mesh::Vec3, 2>>& segments, const mesh::Vec3& origin, const char* what) {
  lines_.count = 0;
  std::vector<std::array<float, 4>> places;
  std::vector<NodePair> pairs;
  for (const std::array<mesh::Vec3, 2>& segment : segments) {
    const auto first = static_cast<std::uint32_t>(places.size());
    for (const mesh::Vec3& end : segment) {
      const Eigen::Vector3f at = (end - origin).cast<float>();
      places.push_back({at.x(), at.y(), at.z(), at.allFinite() ? 1.0F : 0.0F});
    }
    pairs.push_back({first, first + 1});
  }
  if (const auto reserved = positions_.reserve(places.size(), what); !reserved) return fail(reserved.error());
  positions_.upload(std::as_bytes(std::span(places)));
  return lines_.upload(pairs, what);
}

}  // namespace prismesh::kiosk::render
