// Fast access to a source's arrays on the processor, with range checks: no content of a snapshot leads to a read outside it.
#pragma once

#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "kiosk/render/model_source.h"
#include "kiosk/stereo/view.h"
#include "mesh/document/generation.h"

namespace prismesh::kiosk::render {

inline constexpr std::uint32_t kNoIndex = 0xffffffffu;

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
  /// Copies a shell; false if a node is out of range. The shell is read once, as another process could change the memory between a check
  /// and a second read. Precondition: shell < shell_count().
  bool shell(std::size_t shell, mesh::ShellNodes& nodes) const {
    nodes = shells_[shell / mesh::kChunkSize][shell % mesh::kChunkSize];
    for (const mesh::NodeIndex node : nodes.node)
      if (node.value >= node_count_) return false;
    return true;
  }
  bool node_selected(std::size_t node) const {
    const std::size_t chunk = node / mesh::kChunkSize, at = node % mesh::kChunkSize;
    return chunk < node_marks_.size() && at < node_marks_[chunk].size() && (node_marks_[chunk][at] & mesh::document::kSelected) != 0;
  }
  /// Whether all of these are selected, so that the face between them is.
  bool corners_selected(const mesh::ShellNodes& nodes) const {
    for (const mesh::NodeIndex node : nodes.node)
      if (!node_selected(node.value)) return false;
    return true;
  }
  /// The part of a shell's state that it had when the deck was opened.
  mesh::quality::ShellState shell_was(std::size_t shell) const;
  /// Selected as a whole, not by its nodes.
  bool shell_selected(std::size_t shell) const {
    const std::size_t chunk = shell / mesh::kChunkSize, at = shell % mesh::kChunkSize;
    return chunk < shell_marks_.size() && at < shell_marks_[chunk].size() && (shell_marks_[chunk][at] & mesh::document::kSelected) != 0;
  }
  mesh::PartIndex shell_part(std::size_t shell) const { return parts_[shell / mesh::kChunkSize][shell % mesh::kChunkSize]; }
  bool shell_visible(std::size_t shell) const { return !part_hidden(shell_part(shell).value); }
  bool part_hidden(std::size_t part) const { return part < hidden_.size() && hidden_[part] != 0; }
  /// By PartIndex, 1 = hidden.
  const std::vector<std::uint8_t>& hidden_parts() const { return hidden_; }
  bool any_hidden() const { return any_hidden_; }
  /// The source's clusters of triangles whose shell and corner exist.
  const std::vector<ipc::SnapshotCluster>& clusters() const { return clusters_; }

  /// Both ends of a line element; false if an end is out of range or the part is hidden. Precondition: line < line_count().
  bool line(std::size_t line, std::array<std::uint32_t, 2>& ends) const;
  /// Mean of a shell's corners; false if a node is out of range or a coordinate isn't finite.
  bool shell_centre(std::size_t shell, mesh::Vec3& centre) const;
  /// By node: 1 if a visible shell or line element uses it.
  std::vector<std::uint8_t> visible_nodes() const;
  /// Box around the visible nodes with finite coordinates, in axes turned by `rotation`.
  stereo::Box visible_box(const Eigen::Quaterniond& rotation) const;

 private:
  std::shared_ptr<const ModelSource> source_;
  std::size_t node_count_ = 0;
  std::size_t shell_count_ = 0;
  std::size_t line_count_ = 0;
  std::vector<const mesh::Vec3*> positions_;
  std::vector<const mesh::ShellNodes*> shells_;
  std::vector<const mesh::PartIndex*> parts_;
  std::vector<const mesh::NodeIndex*> lines_;
  std::vector<std::span<const mesh::PartIndex>> line_parts_;
  std::vector<std::span<const std::uint8_t>> node_marks_;
  std::vector<std::span<const std::uint8_t>> shell_marks_;
  std::vector<std::uint8_t> hidden_;
  bool any_hidden_ = false;
  std::vector<ipc::SnapshotCluster> clusters_;
};

inline bool finite(const mesh::Vec3& point) { return std::isfinite(point.x()) && std::isfinite(point.y()) && std::isfinite(point.z()); }

}  // namespace prismesh::kiosk::render
