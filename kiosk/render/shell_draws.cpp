#include "kiosk/render/shell_draws.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <type_traits>

#include "base/parallel_for.h"

namespace prismesh::kiosk::render {

using ipc::SnapshotArray;
using mesh::ShellIndex;

namespace {

/// Two triangles of a quad. The last corner of each is 0: its values are those of the whole triangle.
constexpr std::array<std::uint32_t, 6> kCorners{1, 2, 0, 2, 3, 0};
constexpr std::size_t kShellsOfRun = 64;
constexpr std::size_t kShellsOfPiece = 65'536;  ///< of an order that isn't held: 1.5 MB
/// Of selected shells that a moving picture shows as they are; where more are selected, coarse triangles have their colour.
constexpr std::size_t kMaxHeld = 20'000;
constexpr double kFinest = 1, kCoarsest = 8, kCoarser = 1.35;  ///< pixels
/// Sides of so many pixels are seen, and so are shells with longer ones; longer than the second they are only hidden if nothing else helps.
constexpr double kMinSeenSide = 4, kMaxSidePixels = 64;

void make_indices(gl::VertexArray& array, gl::Buffer& buffer) {
  array = gl::VertexArray::make();
  buffer = gl::Buffer::make();
  glBindVertexArray(array.get());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer.get());
  glBindVertexArray(0);
}

void upload(const gl::VertexArray& array, const std::vector<std::uint32_t>& indices, GLenum use) {
  glBindVertexArray(array.get());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)), indices.data(), use);
  glBindVertexArray(0);
}

void append_shell(std::uint32_t shell, std::vector<std::uint32_t>& indices) {
  for (const std::uint32_t corner : kCorners) indices.push_back(4 * shell + corner);
}

/// The planes of the view volume: points with a negative product with one of them are outside.
class ViewVolume {
 public:
  explicit ViewVolume(const Eigen::Matrix4d& clip) {
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {1.0, -1.0}) {
        Eigen::Vector4d plane = clip.row(3).transpose() + sign * clip.row(axis).transpose();
        const double length = plane.head<3>().norm();
        planes_[static_cast<std::size_t>(2 * axis + (sign > 0 ? 0 : 1))] = length > 0 ? Eigen::Vector4d(plane / length) : plane;
      }
  }
  bool may_hold(const mesh::lod::Sphere& sphere, double reach = 0) const {
    return sphere.radius >= 0 && std::all_of(planes_.begin(), planes_.end(), [&](const Eigen::Vector4d& plane) {
             return plane.head<3>().dot(sphere.centre) + plane.w() >= -sphere.radius - reach;
           });
  }

 private:
  std::array<Eigen::Vector4d, 6> planes_;
};

}  // namespace

std::vector<std::uint64_t> shell_versions_of(const ModelSource& source) {
  std::vector<std::uint64_t> versions{source.size(SnapshotArray::positions), source.size(SnapshotArray::shell_nodes)};
  for (const SnapshotArray array : {SnapshotArray::shell_nodes, SnapshotArray::shell_parts})
    for (std::size_t c = 0; c < source.chunk_count(array); ++c) versions.push_back(source.chunk_version(array, c));
  return versions;
}

ShellDraws::ShellDraws() {
  make_indices(all_array_, all_indices_);
  make_indices(shell_array_, shell_indices_);
  make_indices(coarse_array_, coarse_indices_);
}

Result<void> ShellDraws::update(const ModelTable& table, const ModelTextures& textures, const ModelChanges& changes) {
  origin_ = textures.origin();
  if (made_ && (made_->document != table.source().document_key() ||
                (changes.topology && made_->shell_versions != shell_versions_of(table.source()))))
    drop_levels();
  if (!made_ && (ordered_ != table.shell_count() || changes.topology)) {
    if (Result<void> done = set_order(table.shell_count()); !done) return done;
  }
  std::vector<std::uint64_t> marks;
  for (std::size_t c = 0; c < table.source().chunk_count(SnapshotArray::shell_marks); ++c)
    marks.push_back(table.source().chunk_version(SnapshotArray::shell_marks, c));
  const bool others = changes.topology || changes.visibility;
  const bool remarked = made_ && (others || marks != marks_);
  marks_ = std::move(marks);
  if (others || !changes.moved_chunks.empty()) {
    std::vector<std::uint8_t> changed(table.node_count() / mesh::kChunkSize + 1, others ? 1 : 0);
    for (const std::uint32_t chunk : changes.moved_chunks) {
      changed[chunk] = 1;
      if (made_) find_moved(table, chunk);
    }
    look_at_runs(table, changed);
  }
  if (remarked) find_selected(table);
  if (made_ && (remarked || others || !changes.moved_chunks.empty())) find_added();
  return {};
}

void ShellDraws::drop_levels() {
  made_.reset();
  moved_by_ = added_ = cluster_moved_ = {};
  selected_ = {};
  farthest_ = 0;
  ordered_ = 0;
}

Result<void> ShellDraws::set_levels(MadeLevels made, const ModelTable& table) {
  if (made.document != table.source().document_key() || made.shell_versions != shell_versions_of(table.source())) return {};
  const std::vector<mesh::lod::CoarseTriangle>& triangles = made.levels.triangles;
  if (const auto reserved = coarse_.reserve(std::max<std::size_t>(triangles.size(), 1), "coarse triangles"); !reserved)
    return fail(reserved.error());
  static_assert(sizeof(mesh::lod::CoarseTriangle) == 4 * sizeof(std::uint32_t) && std::is_standard_layout_v<mesh::lod::CoarseTriangle>);
  coarse_.upload(std::as_bytes(std::span(triangles)));  // three nodes and the shell
  made.levels.triangles = {};
  made_ = std::move(made);
  if (Result<void> done = set_order(made_->levels.shells.size()); !done) return done;
  runs_.clear();
  for (std::size_t c = 0; c < made_->levels.shell_clusters; ++c)
    runs_.push_back({made_->levels.clusters[c].first, made_->levels.clusters[c].count, {}, true});
  moved_by_.clear();
  for (std::size_t chunk = 0; chunk * mesh::kChunkSize < table.node_count(); ++chunk) find_moved(table, chunk);
  look_at_runs(table, std::vector<std::uint8_t>(table.node_count() / mesh::kChunkSize + 1, 1));
  find_selected(table);
  find_added();
  return {};
}

Result<void> ShellDraws::give_up_levels(const ModelTable& table) {
  if (!made_) return {};
  drop_levels();
  coarse_ = RowTexture(kFourIndices);
  upload(shell_array_, {}, GL_STREAM_DRAW);
  upload(coarse_array_, {}, GL_STREAM_DRAW);
  shell_list_ = coarse_list_ = {};
  if (Result<void> done = set_order(table.shell_count()); !done) return done;
  look_at_runs(table, std::vector<std::uint8_t>(table.node_count() / mesh::kChunkSize + 1, 1));
  return {};
}

std::size_t ShellDraws::levels_bytes() const {
  return coarse_.bytes_held() + gl::bytes_held(shell_indices_) + gl::bytes_held(coarse_indices_);
}

Result<void> ShellDraws::set_order_in_pieces(bool in_pieces) {
  if (in_pieces == order_in_pieces_) return {};
  order_in_pieces_ = in_pieces;
  return upload_order();
}

/// Uploads the order, or frees what it takes.
Result<void> ShellDraws::upload_order() const {
  std::vector<std::uint32_t> indices;
  if (!order_in_pieces_) {
    indices.reserve(ordered_ * kCorners.size());
    for (std::size_t i = 0; i < ordered_; ++i) append_shell(shell_at(i), indices);
  }
  while (glGetError() != GL_NO_ERROR) {
  }
  upload(all_array_, indices, GL_STATIC_DRAW);
  if (glGetError() == GL_OUT_OF_MEMORY) return fail("graphics", "no memory for " + std::to_string(ordered_) + " shells");
  return {};
}

Result<void> ShellDraws::set_order(std::size_t shells) {
  ordered_ = shells;
  if (Result<void> done = upload_order(); !done) {
    ordered_ = 0;
    return done;
  }
  runs_.clear();
  for (std::size_t first = 0; first < shells; first += kShellsOfRun)
    runs_.push_back({static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(std::min(kShellsOfRun, shells - first)), {}, true});
  return {};
}

/// How far the nodes of a chunk have moved since the levels were made.
void ShellDraws::find_moved(const ModelTable& table, std::size_t chunk) {
  const std::size_t begin = chunk * mesh::kChunkSize, end = std::min(begin + mesh::kChunkSize, table.node_count());
  const auto way = [&](std::size_t n) {
    const Eigen::Vector3f at = (table.position(n) - made_->origin).cast<float>(), before = made_->places[n];
    if ((at.array() == before.array()).all()) return 0.0F;
    if (at.allFinite() && before.allFinite()) return std::max((at - before).norm(), std::numeric_limits<float>::min());
    return at.allFinite() || before.allFinite() ? std::numeric_limits<float>::infinity() : 0.0F;
  };
  for (std::size_t n = begin; n < end && n < made_->places.size(); ++n) {
    const float moved = way(n);
    if (moved > 0 && moved_by_.empty()) moved_by_.resize(table.node_count());
    if (!moved_by_.empty()) moved_by_[n] = moved;
  }
}

/// Finds how far the shells of each run have moved, and the bounds of those with nodes in a chunk that has changed.
void ShellDraws::look_at_runs(const ModelTable& table, const std::vector<std::uint8_t>& changed_chunks) {
  cluster_moved_.resize(runs_.size());
  parallel_for(runs_.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) look_at_run(table, r, changed_chunks);
  });
}

void ShellDraws::look_at_run(const ModelTable& table, std::size_t index, const std::vector<std::uint8_t>& changed_chunks) {
  Run& run = runs_[index];
  bool changed = false;
  float moved = 0;
  mesh::ShellNodes nodes;
  for (std::uint32_t i = run.first; i < run.first + run.count; ++i) {
    if (!table.shell(shell_at(i), nodes)) continue;
    for (const mesh::NodeIndex node : nodes.node) {
      changed = changed || changed_chunks[node.value / mesh::kChunkSize] != 0;
      if (!moved_by_.empty()) moved = std::max(moved, moved_by_[node.value]);
    }
  }
  cluster_moved_[index] = moved;
  if (!changed && run.bounds.radius >= 0) return;
  stereo::Box box;
  run.shown = false;
  for (std::uint32_t i = run.first; i < run.first + run.count; ++i) {
    if (!table.shell(shell_at(i), nodes) || !table.shell_visible(shell_at(i))) continue;
    run.shown = true;
    for (const mesh::NodeIndex node : nodes.node)
      if (const mesh::Vec3 at = table.position(node.value); finite(at)) box.add(mesh::Vec3(at - origin_));
  }
  run.shown = run.shown && !box.empty();
  run.bounds = run.shown ? mesh::lod::Sphere{(box.low + box.high) / 2, (box.high - box.low).norm() / 2} : mesh::lod::Sphere{};
}

/// Selected shells are seen as they are, unless there are too many.
void ShellDraws::find_selected(const ModelTable& table) {
  std::vector<std::uint32_t> selected(made_->levels.shell_clusters);
  parallel_for(selected.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const mesh::lod::Cluster& cluster = made_->levels.clusters[c];
      for (std::uint32_t i = cluster.first; i < cluster.first + cluster.count; ++i)
        selected[c] += table.shell_selected(made_->levels.shells[i].value) ? 1 : 0;
    }
  });
  const std::size_t all = std::accumulate(selected.begin(), selected.end(), std::size_t{0});
  selected_.assign(selected.size(), 0);
  if (all <= kMaxHeld)
    for (std::size_t c = 0; c < selected.size(); ++c) selected_[c] = selected[c] > 0 ? 1 : 0;
}

void ShellDraws::find_added() {
  std::vector<float> by_cluster = cluster_moved_;
  by_cluster.resize(made_->levels.shell_clusters);
  farthest_ = 0;
  for (const float moved : by_cluster)
    if (std::isfinite(moved)) farthest_ = std::max(farthest_, moved);
  for (std::size_t c = 0; c < by_cluster.size(); ++c)
    if (selected_[c] != 0) by_cluster[c] = std::numeric_limits<float>::infinity();
  added_ = mesh::lod::added_errors(made_->levels, by_cluster);
}

void ShellDraws::draw_all(const Eigen::Matrix4d& clip_from_model, const FacesOfShell& faces, DrawSpan& span) const {
  glBindVertexArray(all_array_.get());
  const ViewVolume volume(clip_from_model);
  std::size_t first = 0, last = 0;  // neighbours are drawn in one call
  std::vector<std::uint32_t> piece;
  const auto flush = [&] {
    const DrawSpan::Part now = span.take(last - first);
    if (now.count == 0) return;
    if (order_in_pieces_)
      add_to_piece(first + now.first, now.count, faces.count, piece);
    else
      glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(now.count * kCorners.size()), GL_UNSIGNED_INT,
                              reinterpret_cast<const void*>((first + now.first) * kCorners.size() * sizeof(std::uint32_t)), faces.count);
  };
  for (const Run& run : runs_) {
    if (!run.shown || !volume.may_hold(run.bounds, faces.reach)) continue;
    if (run.first != last) {
      flush();
      first = run.first;
    }
    last = run.first + run.count;
  }
  flush();
  draw_piece(faces.count, piece);
  glBindVertexArray(0);
}

/// Appends shells of the order to a piece, and draws it each time it is full.
void ShellDraws::add_to_piece(std::size_t first, std::size_t count, int instances, std::vector<std::uint32_t>& piece) const {
  for (std::size_t i = first; i < first + count; ++i) {
    append_shell(shell_at(i), piece);
    if (piece.size() >= kShellsOfPiece * kCorners.size()) draw_piece(instances, piece);
  }
}

void ShellDraws::draw_piece(int instances, std::vector<std::uint32_t>& piece) const {
  if (piece.empty()) return;
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(piece.size() * sizeof(std::uint32_t)), piece.data(), GL_STREAM_DRAW);
  glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(piece.size()), GL_UNSIGNED_INT, nullptr, instances);
  piece.clear();
}

void ShellDraws::choose(const mesh::lod::Viewpoint& from, const Eigen::Matrix4d& clip_from_model, std::size_t triangles) {
  const mesh::lod::Levels& levels = made_->levels;
  const ViewVolume volume(clip_from_model);
  const auto is_seen = [&](std::uint32_t c) {
    if (c < levels.shell_clusters) return runs_[c].shown && volume.may_hold(runs_[c].bounds);
    mesh::lod::Sphere bounds = levels.clusters[c].bounds;
    bounds.centre -= origin_;
    bounds.radius += farthest_;
    return volume.may_hold(bounds);
  };
  for (mesh::lod::Limits limits{kFinest, kMinSeenSide};;) {
    clusters_.clear();
    mesh::lod::choose(levels, added_, from, limits, clusters_);
    std::erase_if(clusters_, [&](std::uint32_t c) { return !is_seen(c); });
    chosen_triangles_ = mesh::lod::triangles_of(levels, clusters_);
    chosen_pixels_ = limits.error_pixels;
    if (chosen_triangles_ <= triangles || limits.error_pixels >= kCoarsest) break;
    if (limits.side_pixels < kMaxSidePixels)
      limits.side_pixels *= kCoarser;
    else
      limits = {limits.error_pixels * kCoarser};
  }
  shell_list_.clear();
  coarse_list_.clear();
  for (const std::uint32_t c : clusters_) {
    const mesh::lod::Cluster& cluster = levels.clusters[c];
    if (c < levels.shell_clusters) {
      for (std::uint32_t i = cluster.first; i < cluster.first + cluster.count; ++i) append_shell(levels.shells[i].value, shell_list_);
    } else {
      const std::size_t before = coarse_list_.size();
      coarse_list_.resize(before + 3 * cluster.count);
      std::iota(coarse_list_.begin() + static_cast<std::ptrdiff_t>(before), coarse_list_.end(), 3 * cluster.first);
    }
  }
  upload(shell_array_, shell_list_, GL_STREAM_DRAW);
  upload(coarse_array_, coarse_list_, GL_STREAM_DRAW);
}

void ShellDraws::draw_chosen_shells(int faces) const {
  if (shell_list_.empty()) return;
  glBindVertexArray(shell_array_.get());
  glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(shell_list_.size()), GL_UNSIGNED_INT, nullptr, faces);
  glBindVertexArray(0);
}

void ShellDraws::draw_chosen_coarse() const {
  if (coarse_list_.empty()) return;
  glBindVertexArray(coarse_array_.get());
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(coarse_list_.size()), GL_UNSIGNED_INT, nullptr);
  glBindVertexArray(0);
}

}  // namespace prismesh::kiosk::render
