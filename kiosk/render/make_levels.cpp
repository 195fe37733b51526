#include "kiosk/render/make_levels.h"

#include <algorithm>

#include "mesh/model/model.h"

namespace prismesh::kiosk::render {

using ipc::SnapshotArray;

namespace {

template <class T>
void copy(const ModelSource& source, SnapshotArray array, mesh::ChunkedArray<T>& to) {
  to.resize(source.size(array));
  for (std::size_t c = 0; c < to.chunk_count(); ++c) {
    const std::span<const T> from = source.chunk<T>(array, c);
    const std::span<T> into = to.own_chunk(c);
    std::copy_n(from.begin(), std::min(from.size(), into.size()), into.begin());
  }
}

/// A shell with a node out of range is none. Checked in the copy: another process may change what it was made of.
void leave_out_bad_shells(mesh::Model& model) {
  const mesh::ShellNodes none{};
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    const mesh::ShellNodes& nodes = model.shell_nodes[s];
    if (std::any_of(nodes.node.begin(), nodes.node.end(), [&](mesh::NodeIndex node) { return node.value >= model.node_count(); }))
      model.shell_nodes.set(s, none);
  }
}

}  // namespace

Result<MadeLevels> make_levels(const ModelSource& source, const Progress& progress) {
  MadeLevels made;
  made.document = source.document_key();
  made.shell_versions = shell_versions_of(source);
  mesh::Model model;
  copy(source, SnapshotArray::positions, model.positions);
  copy(source, SnapshotArray::shell_nodes, model.shell_nodes);
  copy(source, SnapshotArray::shell_parts, model.shell_parts);
  model.shell_parts.resize(model.shell_count());
  leave_out_bad_shells(model);
  made.places.reserve(model.node_count());
  for (std::size_t n = 0; n < model.node_count(); ++n) made.places.emplace_back(model.positions[n].cast<float>());
  Result<mesh::lod::Levels> levels = mesh::lod::build_levels(model, progress);
  if (!levels) return fail(std::move(levels.error()));
  made.levels = std::move(*levels);
  return made;
}

}  // namespace prismesh::kiosk::render
