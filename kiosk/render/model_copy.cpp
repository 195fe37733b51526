#include "kiosk/render/model_copy.h"

#include <algorithm>
#include <limits>
#include <span>

namespace prismesh::kiosk::render {

using ipc::SnapshotArray;

namespace {

constexpr std::uint64_t kNoVersion = std::numeric_limits<std::uint64_t>::max();

/// `taken(chunk)` is called for each chunk that was copied.
template <class T, class Taken>
void copy_changed(const ModelSource& source, SnapshotArray array, const T& fill, mesh::ChunkedArray<T>& to,
                  std::vector<std::uint64_t>& versions, const Taken& taken) {
  // A last chunk that grew has another version, so what a resize leaves in it is copied over.
  to.resize(source.size(array), fill);
  versions.resize(to.chunk_count(), kNoVersion);
  for (std::size_t c = 0; c < to.chunk_count(); ++c) {
    const std::uint64_t version = source.chunk_version(array, c);
    if (versions[c] == version) continue;
    versions[c] = version;
    const std::span<const T> from = source.chunk<T>(array, c);
    const std::span<T> into = to.own_chunk(c);
    std::copy_n(from.begin(), std::min(from.size(), into.size()), into.begin());
    taken(into);
  }
}

}  // namespace

void ModelCopy::update(const ModelSource& source) {
  if (source.document_key() != document_) clear();
  document_ = source.document_key();
  const auto nothing = [](const auto&) {};
  const std::size_t nodes_before = model_.node_count();
  copy_changed<mesh::Vec3>(source, SnapshotArray::positions, mesh::Vec3::Zero(), model_.positions, versions_[0], nothing);
  if (model_.node_count() < nodes_before) versions_[1].clear();  // corners that were in range may not be
  copy_changed<mesh::ShellNodes>(
      source, SnapshotArray::shell_nodes, {}, model_.shell_nodes, versions_[1], [&](std::span<mesh::ShellNodes> shells) {
        for (mesh::ShellNodes& nodes : shells)
          if (std::any_of(nodes.node.begin(), nodes.node.end(), [&](mesh::NodeIndex node) { return node.value >= model_.node_count(); }))
            nodes = {};
      });
  copy_changed<mesh::PartIndex>(source, SnapshotArray::shell_parts, {}, model_.shell_parts, versions_[2],
                                [&](std::span<mesh::PartIndex> parts) {
                                  for (mesh::PartIndex& part : parts)
                                    if (part.value >= source.part_count()) part = {};
                                });
  model_.shell_parts.resize(model_.shell_count());
  hidden_.resize(source.part_count());
  for (std::size_t p = 0; p < hidden_.size(); ++p) hidden_[p] = source.part_hidden(p) ? 1 : 0;
}

}  // namespace prismesh::kiosk::render
