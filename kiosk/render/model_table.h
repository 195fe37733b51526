// Fast, checked access to a source's arrays on the CPU: nothing in a snapshot can lead outside it.
#pragma once

#include <memory>
#include <vector>

#include "kiosk/render/model_source.h"
#include "kiosk/stereo/view.h"

namespace prismesh::kiosk::render {

class ModelTable {
 public:
  ModelTable() = default;
  explicit ModelTable(std::shared_ptr<const ModelSource> source);

  const ModelSource& source() const { return *source_; }
  std::size_t node_count() const { return node_count_; }
  std::size_t shell_count() const { return shell_count_; }
  std::size_t line_count() const { return line_count_; }

  /// Precondition: node < node_count().
  mesh::Vec3 position(std::size_t node) const { return positions_[node / mesh::kChunkSize][node % mesh::kChunkSize]; }
  /// A copy whose nodes are all within range; false where the shell's aren't. A shell of another process could change between a check
  /// and a second read: so it is read once.
  bool shell(std::size_t shell, mesh::ShellNodes& nodes) const {
    nodes = shells_[shell / mesh::kChunkSize][shell % mesh::kChunkSize];
    for (const mesh::NodeIndex node : nodes.node)
      if (node.value >= node_count_) return false;
    return true;
  }
  bool shell_visible(std::size_t shell) const {
    const std::uint32_t part = parts_[shell / mesh::kChunkSize][shell % mesh::kChunkSize].value;
    return part >= hidden_.size() || hidden_[part] == 0;
  }
  bool part_hidden(std::size_t part) const { return part < hidden_.size() && hidden_[part] != 0; }
  const std::vector<std::uint8_t>& hidden_parts() const { return hidden_; }
  /// Both ends of a line; false where they are out of range.
  bool line(std::size_t line, std::uint32_t& a, std::uint32_t& b) const;

 private:
  std::shared_ptr<const ModelSource> source_;
  std::size_t node_count_ = 0;
  std::size_t shell_count_ = 0;
  std::size_t line_count_ = 0;
  std::vector<const mesh::Vec3*> positions_;
  std::vector<const mesh::ShellNodes*> shells_;
  std::vector<const mesh::PartIndex*> parts_;
  std::vector<std::uint8_t> hidden_;
};

}  // namespace prismesh::kiosk::render
