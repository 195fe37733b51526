#include "kiosk/render/glyphs.h"

#include <algorithm>
#include <limits>
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
  if (visibility_changed || topology_changed) find_clusters(table);
}

void GlyphList::find_clusters(const ModelTable& table) {
  clusters_.clear();
  const double max_triangles = table.source().max_triangles_at_node();
  mesh::ShellNodes shell;
  std::vector<std::uint16_t> triangles(table.node_count());
  bool any = false;
  for (std::size_t s = 0; s < table.shell_count(); ++s) {
    if (!table.shell(s, shell) || !shell.is_triangle() || !table.shell_visible(s)) continue;
    for (std::size_t k = 0; k < 3; ++k)
      if (std::uint16_t& at = triangles[shell.node[k].value]; at < std::numeric_limits<std::uint16_t>::max()) any |= ++at > max_triangles;
  }
  if (!any) return;
  std::vector<std::uint8_t> crowded(table.node_count());  // too many triangles, and at least one quad
  for (std::size_t s = 0; s < table.shell_count(); ++s) {
    if (!table.shell(s, shell) || shell.is_triangle()) continue;
    for (const mesh::NodeIndex node : shell.node) crowded[node.value] = triangles[node.value] > max_triangles;
  }
  // The first of the node's triangles carries the glyph.
  for (std::size_t s = 0; s < table.shell_count(); ++s) {
    if (!table.shell(s, shell) || !shell.is_triangle() || !table.shell_visible(s)) continue;
    for (std::uint8_t k = 0; k < 3; ++k)
      if (std::exchange(crowded[shell.node[k].value], std::uint8_t{0}) != 0)
        clusters_.push_back({static_cast<std::uint32_t>(s), GlyphShape::cluster, false, k});
  }
}

GlyphList::Chosen GlyphList::choose(const ModelTable& table, std::size_t cap, const std::unordered_set<std::uint32_t>& except) const {
  std::vector<BadShell> failing, warning;
  const auto sort_in = [&](const BadShell& bad) {
    if (!except.contains(bad.shell)) (bad.failing ? failing : warning).push_back(bad);
  };
  for (const Chunk& chunk : chunks_) std::for_each(chunk.bad.begin(), chunk.bad.end(), sort_in);
  if (!damaged_) std::for_each(clusters_.begin(), clusters_.end(), sort_in);
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
