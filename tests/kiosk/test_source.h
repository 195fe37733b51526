// Model source for the renderer's tests: arrays with versions, as in a snapshot.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "kiosk/render/model_source.h"

namespace prismesh::test {

class TestSource final : public kiosk::render::ModelSource {
 public:
  std::vector<mesh::Vec3> positions;
  std::vector<std::uint8_t> node_marks;
  std::vector<mesh::ShellNodes> shell_nodes;
  std::vector<mesh::PartIndex> shell_parts;
  std::vector<std::uint8_t> shell_marks;
  std::vector<mesh::quality::ShellState> shell_quality;
  std::vector<mesh::quality::ShellState> shell_damage;  ///< may be empty
  std::vector<mesh::NodeIndex> line_nodes;
  std::vector<mesh::PartIndex> line_parts;
  std::vector<bool> hidden;
  std::vector<std::array<float, 2>> thickness;  ///< by part; parts beyond its end have none
  std::uint64_t key = 1;
  std::vector<ipc::SnapshotCluster> clusters;

  std::uint32_t add_node(const mesh::Vec3& at) {
    positions.push_back(at);
    node_marks.push_back(0);
    return static_cast<std::uint32_t>(positions.size() - 1);
  }
  std::uint32_t add_shell(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d, std::uint32_t part) {
    using mesh::NodeIndex;
    shell_nodes.push_back({{NodeIndex(a), NodeIndex(b), NodeIndex(c), NodeIndex(d)}});
    shell_parts.push_back(mesh::PartIndex(part));
    shell_marks.push_back(0);
    shell_quality.emplace_back();
    if (part >= hidden.size()) hidden.resize(part + 1);
    return static_cast<std::uint32_t>(shell_nodes.size() - 1);
  }
  void add_line(std::uint32_t a, std::uint32_t b, std::uint32_t part) {
    line_nodes.push_back(mesh::NodeIndex(a));
    line_nodes.push_back(mesh::NodeIndex(b));
    line_parts.push_back(mesh::PartIndex(part));
    if (part >= hidden.size()) hidden.resize(part + 1);
  }
  /// Gives a chunk a new version after its content changed.
  void touch(ipc::SnapshotArray array, std::size_t chunk) {
    auto& versions = versions_[static_cast<std::size_t>(array)];
    if (versions.size() <= chunk) versions.resize(chunk + 1, 1);
    versions[chunk] = ++counter_;
  }

  std::size_t size(ipc::SnapshotArray array) const override { return bytes(array).size() / ipc::element_size(array); }
  std::uint64_t chunk_version(ipc::SnapshotArray array, std::size_t chunk) const override {
    const auto& versions = versions_[static_cast<std::size_t>(array)];
    return chunk < versions.size() ? versions[chunk] : 1;
  }
  std::span<const std::byte> chunk_bytes(ipc::SnapshotArray array, std::size_t chunk) const override {
    const std::size_t step = mesh::kChunkSize * ipc::element_size(array);
    const std::span<const std::byte> all = bytes(array);
    return all.subspan(chunk * step, std::min(step, all.size() - chunk * step));
  }
  std::size_t part_count() const override { return hidden.size(); }
  bool part_hidden(std::size_t part) const override { return hidden[part]; }
  std::array<float, 2> part_thickness(std::size_t part) const override {
    return part < thickness.size() ? thickness[part] : std::array<float, 2>{};
  }
  std::uint64_t document_key() const override { return key; }

 private:
  std::span<const std::byte> bytes(ipc::SnapshotArray array) const {
    using ipc::SnapshotArray;
    switch (array) {
      case SnapshotArray::positions: return std::as_bytes(std::span(positions));
      case SnapshotArray::node_marks: return std::as_bytes(std::span(node_marks));
      case SnapshotArray::shell_nodes: return std::as_bytes(std::span(shell_nodes));
      case SnapshotArray::shell_parts: return std::as_bytes(std::span(shell_parts));
      case SnapshotArray::shell_marks: return std::as_bytes(std::span(shell_marks));
      case SnapshotArray::shell_quality: return std::as_bytes(std::span(shell_quality));
      case SnapshotArray::shell_damage: return std::as_bytes(std::span(shell_damage));
      case SnapshotArray::line_nodes: return std::as_bytes(std::span(line_nodes));
      case SnapshotArray::line_parts: return std::as_bytes(std::span(line_parts));
      case SnapshotArray::clusters: return std::as_bytes(std::span(clusters));
      default: return {};
    }
  }
  std::vector<std::uint64_t> versions_[ipc::kSnapshotArrayCount];
  std::uint64_t counter_ = 1;
};

/// Adds a patch of n x m quads; `place` gives the position of node (i / n, j / m).
template <class Place>
inline std::uint32_t add_grid(TestSource& source, std::uint32_t n, std::uint32_t m, std::uint32_t part, const Place& place) {
  const auto first = static_cast<std::uint32_t>(source.positions.size());
  for (std::uint32_t j = 0; j <= m; ++j)
    for (std::uint32_t i = 0; i <= n; ++i) source.add_node(place(static_cast<double>(i) / n, static_cast<double>(j) / m));
  for (std::uint32_t j = 0; j < m; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = first + j * (n + 1) + i;
      source.add_shell(a, a + 1, a + n + 2, a + n + 1, part);
    }
  return first;
}

/// Two plates of 10 x 10 quads, 40 apart: part 0 in front (z = 20), part 1 behind.
inline TestSource two_plates() {
  TestSource source;
  for (const std::uint32_t part : {0U, 1U})
    add_grid(source, 10, 10, part, [&](double u, double v) { return mesh::Vec3(u * 100 - 50, v * 60 - 30, part == 0 ? 20 : -20); });
  return source;
}

/// A crash box on a base plate: a hat section with rounded shoulders (part 0), its closing plate (part 1), a curved panel (part 2) and
/// spot welds as lines (part 3). Lengths in mm; about 1,100 shells.
inline TestSource make_crash_box() {
  TestSource source;
  const double length = 300;
  const auto hat = [&](double u, double v) {
    // Across: flange, wall, roof, wall, flange, by distance along the section.
    const double s = (u - 0.5) * 220, side = s < 0 ? -1 : 1, t = std::abs(s);
    double y = 0, z = 0;
    if (t < 36) {
      y = t, z = 60;
    } else if (t < 86) {
      y = 36 + (t - 36) * 0.24, z = 60 - (t - 36) * 1.1;
    } else {
      y = 48 + (t - 86), z = 5;
    }
    return mesh::Vec3((v - 0.5) * length, side * y, z + 6 * std::sin(v * 3 * std::numbers::pi) * (t < 36 ? 1 : 0));
  };
  const std::uint32_t hat_first = add_grid(source, 22, 30, 0, hat);
  const std::uint32_t plate_first =
      add_grid(source, 15, 30, 1, [&](double u, double v) { return mesh::Vec3((v - 0.5) * length, (u - 0.5) * 150, 0); });
  add_grid(source, 14, 12, 2, [&](double u, double v) {
    const double angle = (u - 0.5) * 1.6;
    return mesh::Vec3(length * 0.5 + 12 + 22 * std::cos(angle) - 22, 110 * std::sin(angle) / 1.0, 5 + (v - 0.2) * 110);
  });
  for (std::uint32_t row = 2; row < 30; row += 4) {
    source.add_line(hat_first + row * 23 + 1, plate_first + row * 16 + 1, 3);
    source.add_line(hat_first + row * 23 + 21, plate_first + row * 16 + 14, 3);
  }
  return source;
}

}  // namespace prismesh::test
