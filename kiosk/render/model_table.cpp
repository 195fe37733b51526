#include "kiosk/render/model_table.h"

#include <algorithm>

namespace prismesh::kiosk::render {

using ipc::SnapshotArray;
using mesh::kChunkSize;

namespace {

template <class T>
std::vector<const T*> chunk_pointers(const ModelSource& source, SnapshotArray array) {
  std::vector<const T*> pointers(source.chunk_count(array));
  for (std::size_t c = 0; c < pointers.size(); ++c) pointers[c] = source.chunk<T>(array, c).data();
  return pointers;
}

}  // namespace

ModelTable::ModelTable(std::shared_ptr<const ModelSource> source)
    : source_(std::move(source)),
      node_count_(source_->size(SnapshotArray::positions)),
      shell_count_(std::min(source_->size(SnapshotArray::shell_nodes), source_->size(SnapshotArray::shell_parts))),
      line_count_(source_->size(SnapshotArray::line_nodes) / 2),
      positions_(chunk_pointers<mesh::Vec3>(*source_, SnapshotArray::positions)),
      shells_(chunk_pointers<mesh::ShellNodes>(*source_, SnapshotArray::shell_nodes)),
      parts_(chunk_pointers<mesh::PartIndex>(*source_, SnapshotArray::shell_parts)),
      lines_(chunk_pointers<mesh::NodeIndex>(*source_, SnapshotArray::line_nodes)),
      hidden_(source_->part_count()) {
  for (std::size_t part = 0; part < hidden_.size(); ++part) hidden_[part] = source_->part_hidden(part) ? 1 : 0;
  any_hidden_ = std::find(hidden_.begin(), hidden_.end(), 1) != hidden_.end();
  for (std::size_t c = 0; c < source_->chunk_count(SnapshotArray::line_parts); ++c)
    line_parts_.push_back(source_->chunk<mesh::PartIndex>(SnapshotArray::line_parts, c));
  for (std::size_t c = 0; c < source_->chunk_count(SnapshotArray::node_marks); ++c)
    node_marks_.push_back(source_->chunk<std::uint8_t>(SnapshotArray::node_marks, c));
  for (std::size_t c = 0; c < source_->chunk_count(SnapshotArray::shell_marks); ++c)
    shell_marks_.push_back(source_->chunk<std::uint8_t>(SnapshotArray::shell_marks, c));
  for (std::size_t c = 0; c < source_->chunk_count(SnapshotArray::clusters); ++c)
    for (const ipc::SnapshotCluster& cluster : source_->chunk<ipc::SnapshotCluster>(SnapshotArray::clusters, c))
      if (cluster.shell.value < shell_count_ && cluster.corner < 3) clusters_.push_back(cluster);
}

mesh::quality::ShellState ModelTable::shell_was(std::size_t shell) const {
  using ipc::SnapshotArray;
  using mesh::quality::ShellState;
  if (shell >= source_->size(SnapshotArray::shell_quality) || shell >= source_->size(SnapshotArray::shell_damage)) return {};
  const auto now = source_->at<ShellState>(SnapshotArray::shell_quality, shell);
  const auto worse = source_->at<ShellState>(SnapshotArray::shell_damage, shell);
  return {static_cast<std::uint16_t>(now.warn & ~worse.warn), static_cast<std::uint16_t>(now.fail & ~worse.fail)};
}

bool ModelTable::line(std::size_t line, std::array<std::uint32_t, 2>& ends) const {
  const std::size_t chunk = line / kChunkSize, at = line % kChunkSize;
  if (chunk < line_parts_.size() && at < line_parts_[chunk].size() && part_hidden(line_parts_[chunk][at].value)) return false;
  for (std::size_t end = 0; end < 2; ++end) {
    ends[end] = lines_[(2 * line + end) / kChunkSize][(2 * line + end) % kChunkSize].value;
    if (ends[end] >= node_count_) return false;
  }
  return true;
}

bool ModelTable::shell_centre(std::size_t shell_index, mesh::Vec3& centre) const {
  mesh::ShellNodes nodes;
  if (!shell(shell_index, nodes)) return false;
  centre.setZero();
  for (int corner = 0; corner < nodes.corners(); ++corner) centre += position(nodes.node[static_cast<std::size_t>(corner)].value);
  centre /= nodes.corners();
  return finite(centre);
}

std::vector<std::uint8_t> ModelTable::visible_nodes() const {
  std::vector<std::uint8_t> visible(node_count_, 0);
  mesh::ShellNodes nodes;
  for (std::size_t s = 0; s < shell_count_; ++s)
    if (shell_visible(s) && shell(s, nodes))
      for (const mesh::NodeIndex node : nodes.node) visible[node.value] = 1;
  std::array<std::uint32_t, 2> ends;
  for (std::size_t l = 0; l < line_count_; ++l)
    if (line(l, ends)) visible[ends[0]] = visible[ends[1]] = 1;
  return visible;
}

stereo::Box ModelTable::visible_box(const Eigen::Quaterniond& rotation) const {
  const Eigen::Matrix3d turn = rotation.toRotationMatrix();
  const std::vector<std::uint8_t> visible = visible_nodes();
  stereo::Box box;
  for (std::size_t n = 0; n < node_count_; ++n)
    if (visible[n] != 0)
      if (const mesh::Vec3 point = position(n); finite(point)) box.add(mesh::Vec3(turn * point));
  return box;
}

}  // namespace prismesh::kiosk::render
