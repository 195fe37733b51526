#include "kiosk/render/model_textures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/parallel_for.h"
#include "kiosk/render/palette.h"
#include "mesh/document/generation.h"
#include "mesh/quality/shell_state.h"

namespace prismesh::kiosk::render {

using ipc::SnapshotArray;
using mesh::kChunkSize;
using mesh::Vec3;
using mesh::quality::ShellState;

/// Texture rows of a chunk of shells.
struct ModelTextures::ShellRow {
  std::vector<std::array<std::uint32_t, 4>> nodes;
  std::vector<std::array<std::uint32_t, 2>> surface;
  ShellChunk chunk;
  std::vector<std::uint32_t> depends_on;
  std::vector<bool> selected_faces;
};

namespace {

std::uint16_t as_snorm16(double value) {
  return static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(std::clamp(value, -1.0, 1.0) * 32767)));
}

void add_sorted(std::vector<std::uint32_t>& set, std::uint32_t value) {
  const auto place = std::lower_bound(set.begin(), set.end(), value);
  if (place == set.end() || *place != value) set.insert(place, value);
}

/// Where the box of all nodes is so many times as wide as the middle half of them, few nodes are far away from the others, at whose
/// distance single precision would make one place of the model.
constexpr double kFarOut = 1e4;

struct Spread {
  Vec3 median;
  double width = 0;  ///< of the middle half of the nodes, along the widest axis; > 0
};

/// Of some 2,000 nodes at even steps; nothing if half of them are in one place.
std::optional<Spread> spread_of_nodes(const ModelTable& table) {
  const std::size_t step = table.node_count() / 2'000 + 1;
  std::array<std::vector<double>, 3> along;
  for (std::size_t n = 0; n < table.node_count(); n += step)
    if (const Vec3 at = table.position(n); finite(at))
      for (std::size_t axis = 0; axis < 3; ++axis) along[axis].push_back(at[static_cast<Eigen::Index>(axis)]);
  if (along[0].empty()) return std::nullopt;
  Spread spread;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double>& values = along[axis];
    std::sort(values.begin(), values.end());
    spread.median[static_cast<Eigen::Index>(axis)] = values[values.size() / 2];
    spread.width = std::max(spread.width, values[values.size() * 3 / 4] - values[values.size() / 4]);
  }
  return spread.width > 0 ? std::optional(spread) : std::nullopt;
}

template <class T>
T entry(std::span<const T> values, std::size_t i) {
  return i < values.size() ? values[i] : T{};
}

}  // namespace

std::uint32_t pack_normal(const Vec3& normal) {
  const double sum = std::abs(normal.x()) + std::abs(normal.y()) + std::abs(normal.z());
  if (!(sum > 0)) return as_snorm16(0);
  double x = normal.x() / sum, y = normal.y() / sum;
  if (normal.z() < 0) {
    const double folded = (1 - std::abs(y)) * (x < 0 ? -1 : 1);
    y = (1 - std::abs(x)) * (y < 0 ? -1 : 1);
    x = folded;
  }
  return static_cast<std::uint32_t>(as_snorm16(x)) | static_cast<std::uint32_t>(as_snorm16(y)) << 16;
}

Result<ModelChanges> ModelTextures::update(const ModelTable& table) {
  ModelChanges changes;
  if (!any_document_ || document_ != table.source().document_key()) {
    forget();
    document_ = table.source().document_key();
    any_document_ = true;
    choose_origin(table);
    changes.topology = true;
  }
  changes.topology |= node_count_ != table.node_count() || shell_count_ != table.shell_count();
  changes.visibility = hidden_ != table.hidden_parts();
  if (node_count_ != table.node_count()) shell_versions_.clear();  // nodes that were in range may be out of range now
  node_count_ = table.node_count();
  shell_count_ = table.shell_count();
  hidden_ = table.hidden_parts();

  const auto positions = positions_.reserve(node_count_, "nodes");
  if (!positions) return fail(positions.error());
  if (*positions) position_known_.clear();
  const auto connectivity = connectivity_.reserve(shell_count_, "shells");
  if (!connectivity) return fail(connectivity.error());
  const auto surface = surface_.reserve(shell_count_, "shells");
  if (!surface) return fail(surface.error());
  if (*connectivity || *surface) shell_versions_.clear();

  update_positions(table, changes);
  update_marks(table, changes);
  update_shells(table, changes);
  return changes;
}

void ModelTextures::forget() {
  position_known_.clear();
  mark_versions_.clear();
  shell_versions_.clear();
  hidden_.clear();
  node_count_ = shell_count_ = 0;
}

void ModelTextures::choose_origin(const ModelTable& table) {
  stereo::Box box;
  for (std::size_t n = 0; n < table.node_count(); ++n)
    if (const Vec3 point = table.position(n); finite(point)) box.add(point);
  origin_ = box.empty() ? Vec3(Vec3::Zero()) : Vec3(0.5 * (box.low + box.high));
  if (const std::optional<Spread> spread = spread_of_nodes(table); spread && (box.high - box.low).maxCoeff() > kFarOut * spread->width)
    origin_ = spread->median;
}

void ModelTextures::update_positions(const ModelTable& table, ModelChanges& changes) {
  const std::size_t chunks = table.source().chunk_count(SnapshotArray::positions);
  position_known_.resize(chunks, false);
  position_versions_.resize(chunks, 0);
  std::vector<std::array<float, 4>> texels;
  for (std::size_t c = 0; c < chunks; ++c) {
    const std::uint64_t version = table.source().chunk_version(SnapshotArray::positions, c);
    if (position_known_[c] && position_versions_[c] == version) continue;
    position_known_[c] = true;
    position_versions_[c] = version;
    changes.moved_chunks.push_back(static_cast<std::uint32_t>(c));
    const std::size_t begin = c * kChunkSize, end = std::min(begin + kChunkSize, table.node_count());
    texels.clear();
    for (std::size_t n = begin; n < end; ++n) {
      const Eigen::Vector3f at = (table.position(n) - origin_).cast<float>();
      const bool finite_texel = std::isfinite(at.x()) && std::isfinite(at.y()) && std::isfinite(at.z());
      texels.push_back(finite_texel ? std::array<float, 4>{at.x(), at.y(), at.z(), 1} : std::array<float, 4>{});
    }
    positions_.upload_row(c, std::as_bytes(std::span(texels)));
    ++changes.uploaded;
  }
}

void ModelTextures::update_marks(const ModelTable& table, ModelChanges& changes) {
  const std::size_t chunks = table.source().chunk_count(SnapshotArray::node_marks);
  mark_versions_.resize(chunks, std::numeric_limits<std::uint64_t>::max());
  for (std::size_t c = 0; c < chunks; ++c)
    if (const std::uint64_t version = table.source().chunk_version(SnapshotArray::node_marks, c); version != mark_versions_[c]) {
      mark_versions_[c] = version;
      changes.marked_chunks.push_back(static_cast<std::uint32_t>(c));
    }
}

void ModelTextures::update_shells(const ModelTable& table, ModelChanges& changes) {
  const ModelSource& source = table.source();
  const std::size_t chunks = (table.shell_count() + kChunkSize - 1) / kChunkSize;
  shell_versions_.resize(chunks);
  shell_chunks_.resize(chunks);
  const auto version = [&](SnapshotArray array, std::size_t c) {
    return c < source.chunk_count(array) ? source.chunk_version(array, c) : 0;
  };
  struct Stale {
    std::uint32_t chunk = 0;
    bool geometry = true;
  };
  std::vector<Stale> stale;
  for (std::uint32_t c = 0; c < chunks; ++c) {
    ShellVersions& known = shell_versions_[c];
    const std::uint64_t nodes = source.chunk_version(SnapshotArray::shell_nodes, c);
    const std::array<std::uint64_t, 3> look{version(SnapshotArray::shell_parts, c), version(SnapshotArray::shell_marks, c),
                                            version(SnapshotArray::shell_quality, c)};
    const auto depends = [&](std::uint32_t moved) { return std::binary_search(known.depends_on.begin(), known.depends_on.end(), moved); };
    const bool same = known.known && known.nodes == nodes && known.look == look && !changes.visibility &&
                      std::none_of(changes.moved_chunks.begin(), changes.moved_chunks.end(), depends);
    if (same) {
      // A face is selected by its corners: the row's look may be another one, its geometry isn't.
      if (std::any_of(changes.marked_chunks.begin(), changes.marked_chunks.end(), depends) &&
          selected_faces(table, c) != known.selected_faces)
        stale.push_back({c, false});
      continue;
    }
    if (!known.known || known.nodes != nodes) changes.topology = true;
    changes.reparted |= known.known && known.look[0] != look[0];
    known.known = true;
    known.nodes = nodes;
    known.look = look;
    stale.push_back({c, true});
  }
  // Rows are built on all cores, in batches, and uploaded from this thread.
  constexpr std::size_t kBatch = 64;
  std::vector<ShellRow> rows(std::min(kBatch, stale.size()));
  for (std::size_t first = 0; first < stale.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, stale.size() - first);
    parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) rows[i] = build_row(table, stale[first + i].chunk);
    });
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t c = stale[first + i].chunk;
      if (stale[first + i].geometry) {
        connectivity_.upload_row(c, std::as_bytes(std::span(rows[i].nodes)));
        ++changes.uploaded;
      }
      surface_.upload_row(c, std::as_bytes(std::span(rows[i].surface)));
      shell_chunks_[c] = rows[i].chunk;
      shell_versions_[c].depends_on = std::move(rows[i].depends_on);
      shell_versions_[c].selected_faces = std::move(rows[i].selected_faces);
      ++changes.uploaded;
    }
  }
}

std::vector<bool> ModelTextures::selected_faces(const ModelTable& table, std::size_t c) {
  const std::size_t begin = c * kChunkSize, end = std::min(begin + kChunkSize, table.shell_count());
  std::vector<bool> selected(end - begin);
  mesh::ShellNodes nodes;
  for (std::size_t s = begin; s < end; ++s) selected[s - begin] = table.shell(s, nodes) && table.corners_selected(nodes);
  return selected;
}

ModelTextures::ShellRow ModelTextures::build_row(const ModelTable& table, std::size_t c) const {
  const ModelSource& source = table.source();
  const auto states = c < source.chunk_count(SnapshotArray::shell_quality) ? source.chunk<ShellState>(SnapshotArray::shell_quality, c)
                                                                           : std::span<const ShellState>();
  const auto marks = c < source.chunk_count(SnapshotArray::shell_marks) ? source.chunk<std::uint8_t>(SnapshotArray::shell_marks, c)
                                                                        : std::span<const std::uint8_t>();
  const std::size_t begin = c * kChunkSize, end = std::min(begin + kChunkSize, table.shell_count());
  ShellRow row;
  row.nodes.resize(end - begin);
  row.surface.resize(end - begin);
  row.selected_faces = selected_faces(table, c);
  for (std::size_t s = begin; s < end; ++s) {
    const std::size_t i = s - begin;
    mesh::ShellNodes nodes;
    bool whole = table.shell(s, nodes);
    std::array<Vec3, 4> corner;
    for (std::size_t k = 0; k < 4 && whole; ++k) {
      const std::uint32_t node = nodes.node[k].value;
      add_sorted(row.depends_on, static_cast<std::uint32_t>(node / kChunkSize));
      corner[k] = table.position(node) - origin_;
      whole = corner[k].cast<float>().allFinite();  // as the card holds it
      row.nodes[i][k] = node;
    }
    std::uint32_t word = static_cast<std::uint32_t>(colour_of_part(table.shell_part(s).value, source.part_count())) |
                         static_cast<std::uint32_t>(entry(states, i).grade()) << shell_word::kGradeShift |
                         ((entry(marks, i) & mesh::document::kSelected) != 0 || row.selected_faces[i] ? shell_word::kSelected : 0) |
                         std::min(table.shell_part(s).value, shell_word::kNoPart) << shell_word::kPartShift;
    if (!whole) {
      row.nodes[i] = {};
      word |= shell_word::kGone;
    } else if (!table.shell_visible(s)) {
      word |= shell_word::kGone;
    } else {
      row.chunk.shown = true;
      for (const Vec3& point : corner) row.chunk.box.add(point);
    }
    row.surface[i] = {word, whole ? pack_normal((corner[2] - corner[0]).cross(corner[3] - corner[1])) : 0};
  }
  return row;
}

}  // namespace prismesh::kiosk::render
