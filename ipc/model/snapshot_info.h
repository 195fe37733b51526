// The contents of a snapshot: its arrays, and what views show besides them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mesh/document/cluster_signs.h"
#include "mesh/document/generation.h"

namespace prismesh::ipc {

/// The arrays of a snapshot. Element types are those of mesh::Model and mesh::document::Generation.
enum class SnapshotArray : std::uint8_t {
  positions,
  node_ids,
  node_marks,
  shell_nodes,
  shell_ids,
  shell_parts,
  shell_marks,
  shell_quality,
  shell_damage,  ///< ShellState: the metrics by which the document's edits made the shell worse (mesh/document/damage.h)
  line_nodes,
  line_parts,
  clusters,  ///< SnapshotCluster
};
inline constexpr int kSnapshotArrayCount = 12;

using SnapshotCluster = mesh::document::ClusterSign;

/// Bytes of one element of an array.
std::size_t element_size(SnapshotArray array);

struct SnapshotPart {
  std::int64_t id = 0;
  std::string name;
  bool hidden = false;
  bool locked = false;
  std::uint32_t shells = 0;
  double target_size = 1;
  mesh::quality::SizeFrom size_from = mesh::quality::SizeFrom::part;
  std::string criteria{};  ///< its own: a built-in name or a file; empty: the deck's
  float thinnest = 0;      ///< of its shells, deck's length unit; 0: not all have a thickness
  float thickest = 0;
};

struct SnapshotInfo {
  std::uint64_t generation = 0;
  std::string document;     ///< path
  std::string length_unit;  ///< "mm", ...
  double target_size = 1;
  std::string criteria;  ///< the deck's: a built-in name or a file
  mesh::quality::Counts counts;
  std::uint64_t nodes = 0;  ///< existing ones; the arrays also hold removed ones
  std::uint64_t selected_nodes = 0;
  std::uint64_t selected_shells = 0;
  bool can_undo = false;
  bool can_redo = false;
  bool changed = false;             ///< differs from what was last opened or saved
  std::vector<SnapshotPart> parts;  ///< by PartIndex
};

}  // namespace prismesh::ipc
