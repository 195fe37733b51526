#include "kiosk/toolkit/selected_nodes.h"

namespace prismesh::kiosk::toolkit {

using ipc::SnapshotArray;
using mesh::Vec3;
using render::ModelSource;

std::optional<Vec3> selection_centre(const ModelSource& model) {
  Vec3 sum = Vec3::Zero();
  std::size_t count = 0;
  const std::size_t nodes = model.size(SnapshotArray::positions);
  for_each_selected(model, [&](std::size_t n) {
    if (n >= nodes) return;
    sum += model.at<Vec3>(SnapshotArray::positions, n);
    ++count;
  });
  return count == 0 ? std::nullopt : std::optional<Vec3>(sum / static_cast<double>(count));
}

}  // namespace prismesh::kiosk::toolkit
