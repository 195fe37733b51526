#include "kiosk/render/glyphs.h"

#include <algorithm>
#include <utility>

namespace prismesh::kiosk::render {

using ipc::SnapshotArray;
using mesh::quality::ShellState;

namespace {

/// Adds at most `count` entries of the list, at even steps. Returns the number left out.
template <class List, class Add>
std::size_t spread(const List& list, std::size_t count, const Add& add) {
  if (list.empty() || count == 0) return list.size();
  const std::size_t drawn = std::min(count, list.size());
  for (std::size_t i = 0; i < drawn; ++i) add(list[i * list.size() / drawn]);
  return list.size() - drawn;
}

}  // namespace

void GlyphList::update(const ModelTable& table, bool visibility_changed, bool topology_changed, bool damaged) {
  const ModelSource& source = table.source();
  const SnapshotArray array = damaged ? SnapshotArray::shell_damage : SnapshotArray::shell_quality;
  if (damaged != std::exchange(damaged_, damaged)) chunks_.clear();
  chunks_.resize(source.chunk_count(array));
  for (std::size_t c = 0; c < chunks_.size(); ++c) {
    Chunk& chunk = chunks_[c];
    const std::size_t begin = c * mesh::kChunkSize;
    if (begin >= table.shell_count()) {
      chunk = {};
      continue;
    }
    const std::array<std::uint64_t, 2> versions{source.chunk_version(array, c), source.chunk_version(SnapshotArray::shell_parts, c)};
    if (chunk.known && chunk.versions == versions && !visibility_changed && !topology_changed) continue;
    chunk.known = true;
    chunk.versions = versions;
    chunk.bad.clear();
    const std::span<const ShellState> states = source.chunk<ShellState>(array, c);
    const std::size_t count = std::min(states.size(), table.shell_count() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      if ((states[i].warn | states[i].fail) == 0 || !table.shell_visible(begin + i)) continue;
      for (const GlyphShape shape : shapes_of(states[i]))
        chunk.bad.push_back({static_cast<std::uint32_t>(begin + i), shape, states[i].fail != 0, 0});
    }
  }
  find_clusters(table, damaged);
}

void GlyphList::find_clusters(const ModelTable& table, bool damaged) {
  clusters_.clear();
  for (const ipc::SnapshotCluster& cluster : table.clusters())
    if (table.shell_visible(cluster.shell.value) && (!damaged || cluster.worse != 0))
      clusters_.push_back({cluster.shell.value, GlyphShape::cluster, false, cluster.corner});
}

GlyphList::Chosen GlyphList::choose(const ModelTable& table, std::size_t cap, const std::unordered_set<std::uint32_t>& except) const {
  std::vector<BadShell> failing, warning;
  const auto sort_in = [&](const BadShell& bad) {
    if (!except.contains(bad.shell)) (bad.failing ? failing : warning).push_back(bad);
  };
  for (const Chunk& chunk : chunks_) std::for_each(chunk.bad.begin(), chunk.bad.end(), sort_in);
  std::for_each(clusters_.begin(), clusters_.end(), sort_in);
  Chosen chosen;
  const auto add = [&](const BadShell& bad) {
    mesh::ShellNodes nodes;
    if (!table.shell(bad.shell, nodes)) return;
    std::array<mesh::Vec3, 4> corner;
    for (std::size_t k = 0; k < 4; ++k) corner[k] = table.position(nodes.node[k].value);
    const unsigned place = bad.shape == GlyphShape::cluster
                               ? bad.corner
                               : glyph_place(bad.shape, std::span(corner).first(static_cast<std::size_t>(nodes.corners())));
    chosen.glyphs.push_back(
        {bad.shell, static_cast<std::uint32_t>(bad.shape) | (bad.failing ? kFailingGlyph : 0) | place << kGlyphPlaceShift});
  };
  chosen.left_out = spread(warning, cap - std::min(cap, failing.size()), add);
  chosen.left_out += spread(failing, cap, add);
  return chosen;
}

}  // namespace prismesh::kiosk::render
