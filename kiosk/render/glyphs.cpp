#include "kiosk/render/glyphs.h"

#include <algorithm>

namespace prismesh::kiosk::render {

using ipc::SnapshotArray;
using mesh::quality::Metric;
using mesh::quality::ShellState;

namespace {

constexpr std::uint16_t bits(std::initializer_list<Metric> metrics) {
  unsigned all = 0;
  for (const Metric metric : metrics) all |= 1U << static_cast<unsigned>(metric);
  return static_cast<std::uint16_t>(all);
}

struct ShapeMetrics {
  GlyphShape shape;
  std::uint16_t metrics;
};
constexpr std::array<ShapeMetrics, 4> kShapes{{{GlyphShape::warped, bits({Metric::warpage})},
                                               {GlyphShape::length, bits({Metric::min_length, Metric::max_length})},
                                               {GlyphShape::angle, bits({Metric::min_angle_quad, Metric::max_angle_quad,
                                                                         Metric::min_angle_tri, Metric::max_angle_tri, Metric::skew})},
                                               {GlyphShape::aspect, bits({Metric::aspect})}}};

/// Adds the glyphs of every n-th of these so that about `room` remain.
template <class List, class Add>
std::size_t spread(const List& list, std::size_t room, const Add& add) {
  if (list.empty() || room == 0) return list.size();
  const std::size_t drawn = std::min(room, list.size());
  for (std::size_t i = 0; i < drawn; ++i) add(list[i * list.size() / drawn]);
  return list.size() - drawn;
}

}  // namespace

GlyphShape shape_of(const ShellState& state) {
  const std::uint16_t wrong = state.fail != 0 ? state.fail : state.warn;
  for (const ShapeMetrics& candidate : kShapes)
    if ((wrong & candidate.metrics) != 0) return candidate.shape;
  return GlyphShape::other;
}

std::uint32_t glyph_kind(const ShellState& state) {
  return static_cast<std::uint32_t>(shape_of(state)) + (state.fail != 0 ? kFailingGlyph : 0);
}

void GlyphList::update(const ModelTable& table, bool visibility_changed) {
  const ModelSource& source = table.source();
  chunks_.resize(source.chunk_count(SnapshotArray::shell_quality));
  for (std::size_t c = 0; c < chunks_.size(); ++c) {
    Chunk& chunk = chunks_[c];
    const std::size_t begin = c * mesh::kChunkSize;
    if (begin >= table.shell_count()) {
      chunk = {};
      continue;
    }
    const std::array<std::uint64_t, 2> versions{source.chunk_version(SnapshotArray::shell_quality, c),
                                                source.chunk_version(SnapshotArray::shell_parts, c)};
    if (chunk.known && chunk.versions == versions && !visibility_changed) continue;
    chunk.known = true;
    chunk.versions = versions;
    chunk.bad.clear();
    const std::span<const ShellState> states = source.chunk<ShellState>(SnapshotArray::shell_quality, c);
    const std::size_t count = std::min(states.size(), table.shell_count() - begin);
    for (std::size_t i = 0; i < count; ++i)
      if ((states[i].warn | states[i].fail) != 0 && table.shell_visible(begin + i))
        chunk.bad.push_back({static_cast<std::uint32_t>(begin + i), glyph_kind(states[i])});
  }
}

GlyphList::Chosen GlyphList::choose(const ModelTable& table, const mesh::Vec3& origin, std::size_t cap,
                                    const std::unordered_set<std::uint32_t>& except) const {
  std::vector<Bad> failing, warning;
  for (const Chunk& chunk : chunks_)
    for (const Bad& bad : chunk.bad)
      if (!except.contains(bad.shell)) ((bad.kind & kFailingGlyph) != 0 ? failing : warning).push_back(bad);
  Chosen chosen;
  const auto add = [&](const Bad& bad) {
    mesh::Vec3 centre;
    if (!table.shell_centre(bad.shell, centre)) return;
    const Eigen::Vector3f at = (centre - origin).cast<float>();
    chosen.glyphs.push_back({{at.x(), at.y(), at.z()}, bad.kind});
  };
  chosen.left_out = spread(warning, cap - std::min(cap, failing.size()), add);
  chosen.left_out += spread(failing, cap, add);
  return chosen;
}

}  // namespace prismesh::kiosk::render
