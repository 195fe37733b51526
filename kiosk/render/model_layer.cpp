#include "kiosk/render/model_layer.h"

#include <algorithm>

#include "mesh/document/document.h"

namespace prismesh::kiosk::render {

using ipc::SnapshotArray;

namespace {

void make_instances(Instances& instances, bool of_nodes) {
  instances.array = gl::VertexArray::make();
  instances.buffer = gl::Buffer::make();
  glBindVertexArray(instances.array.get());
  glBindBuffer(GL_ARRAY_BUFFER, instances.buffer.get());
  if (of_nodes) {
    glVertexAttribIPointer(0, 1, GL_UNSIGNED_INT, 0, nullptr);
  } else {
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Glyph), nullptr);
    glVertexAttribIPointer(1, 1, GL_UNSIGNED_INT, sizeof(Glyph), reinterpret_cast<const void*>(offsetof(Glyph, kind)));
    glEnableVertexAttribArray(1);
    glVertexAttribDivisor(1, 1);
  }
  glEnableVertexAttribArray(0);
  glVertexAttribDivisor(0, 1);
  glBindVertexArray(0);
}

template <class T>
void upload_instances(Instances& instances, const std::vector<T>& values) {
  glBindBuffer(GL_ARRAY_BUFFER, instances.buffer.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(values.size() * sizeof(T)), values.data(), GL_DYNAMIC_DRAW);
  instances.count = values.size();
}

/// The median length of the first side of some 500 shells, evenly spread.
double measure_typical_side(const ModelTable& table) {
  const std::size_t step = table.shell_count() / 500 + 1;
  std::vector<double> lengths;
  mesh::ShellNodes nodes;
  for (std::size_t s = 0; s < table.shell_count(); s += step) {
    if (!table.shell(s, nodes)) continue;
    const double length = (table.position(nodes.node[1].value) - table.position(nodes.node[0].value)).norm();
    if (std::isfinite(length) && length > 0) lengths.push_back(length);
  }
  if (lengths.empty()) return 0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

}  // namespace

Result<void> LineSet::upload(const std::vector<NodePair>& lines, const char* what) {
  count = 0;
  if (const auto reserved = texture.reserve(lines.size(), what); !reserved) return fail(reserved.error());
  texture.upload(std::as_bytes(std::span(lines)));
  count = lines.size();
  return {};
}

ModelLayer::ModelLayer() {
  make_instances(selected_, true);
  make_instances(glyphs_, false);
}

Result<void> ModelLayer::set_model(std::shared_ptr<const ModelSource> source) {
  ++shape_version_;
  glyphs_stale_ = true;
  visible_nodes_.reset();
  if (!source) {
    table_.reset();
    end_preview();
    return {};
  }
  const bool first = !table_;
  table_.emplace(std::move(source));
  const Result<ModelChanges> changes = textures_.update(*table_);
  if (!changes) {
    table_.reset();
    return fail(changes.error());
  }
  chunks_uploaded_ += changes->uploaded;
  typical_side_ = measure_typical_side(*table_);
  if (changes->topology) end_preview();  // its indices are of another mesh
  if (changes->topology || changes->visibility || !changes->moved_chunks.empty()) {
    outline_.update(*table_, changes->topology, changes->visibility, changes->moved_chunks);
    if (const auto done = borders_.upload(outline_.borders(), "free edges"); !done) return done;
    if (const auto done = creases_.upload(outline_.creases(), "creases"); !done) return done;
  }
  if (const auto done = update_line_elements(first || changes->topology || changes->visibility); !done) return done;
  glyph_list_.update(*table_, changes->topology || changes->visibility);
  update_selected(changes->topology || changes->visibility);
  return {};
}

Result<void> ModelLayer::update_line_elements(bool changed) {
  std::vector<std::uint64_t> versions;
  for (const SnapshotArray array : {SnapshotArray::line_nodes, SnapshotArray::line_parts})
    for (std::size_t c = 0; c < table_->source().chunk_count(array); ++c) versions.push_back(table_->source().chunk_version(array, c));
  if (!changed && versions == line_versions_) return {};
  line_versions_ = std::move(versions);
  std::vector<NodePair> lines;
  NodePair ends;
  for (std::size_t l = 0; l < table_->line_count(); ++l)
    if (table_->line(l, ends) && ends[0] != ends[1]) lines.push_back(ends);
  line_nodes_.clear();
  for (const NodePair& line : lines) line_nodes_.insert(line_nodes_.end(), line.begin(), line.end());
  std::sort(line_nodes_.begin(), line_nodes_.end());
  line_nodes_.erase(std::unique(line_nodes_.begin(), line_nodes_.end()), line_nodes_.end());
  return line_elements_.upload(lines, "line elements");
}

void ModelLayer::update_selected(bool visibility_changed) {
  const ModelSource& source = table_->source();
  marks_.resize(source.chunk_count(SnapshotArray::node_marks));
  bool changed = visibility_changed;
  for (std::size_t c = 0; c < marks_.size(); ++c) {
    MarkChunk& chunk = marks_[c];
    const std::uint64_t version = source.chunk_version(SnapshotArray::node_marks, c);
    if (chunk.known && chunk.version == version && !visibility_changed) continue;
    chunk.known = changed = true;
    chunk.version = version;
    chunk.selected.clear();
    const auto marks = source.chunk<std::uint8_t>(SnapshotArray::node_marks, c);
    for (std::size_t i = 0; i < marks.size(); ++i)
      if (const std::size_t node = c * mesh::kChunkSize + i; (marks[i] & mesh::document::kSelected) != 0 && node < table_->node_count())
        chunk.selected.push_back(static_cast<std::uint32_t>(node));
  }
  if (!changed) return;
  std::vector<std::uint32_t> nodes;
  for (const MarkChunk& chunk : marks_)
    for (const std::uint32_t node : chunk.selected)
      if (!table_->any_hidden() || visible_nodes()[node] != 0) nodes.push_back(node);
  upload_instances(selected_, nodes);
}

void ModelLayer::begin_preview(std::span<const mesh::NodeIndex> nodes, std::span<const mesh::ShellIndex> shells) {
  end_preview();
  if (table_) preview_.emplace(*table_, textures_.origin(), nodes, shells);
}

Result<void> ModelLayer::update_preview(const ipc::PreviewFrame& frame) {
  if (!preview_) return {};
  const bool first = !preview_->any_frame();
  if (!preview_->update(frame)) return {};
  glyphs_stale_ = true;
  if (const auto reserved = preview_positions_.reserve(preview_->positions().size(), "moving nodes"); !reserved)
    return fail(reserved.error());
  preview_positions_.upload(std::as_bytes(std::span(preview_->positions())));
  return first ? preview_edges_.upload(preview_->edges(), "moving edges") : Result<void>();
}

void ModelLayer::end_preview() {
  if (preview_) glyphs_stale_ = true;
  preview_.reset();
}

const Instances& ModelLayer::glyphs(std::size_t cap) {
  if (!glyphs_stale_ && cap == glyph_cap_) return glyphs_;
  static const std::unordered_set<std::uint32_t> kNone;
  GlyphList::Chosen chosen;
  std::vector<Glyph> live;
  if (previewing()) live = preview_->glyphs();
  if (live.size() > cap) {  // failures come last: keep them
    chosen.left_out = live.size() - cap;
    live.erase(live.begin(), live.end() - static_cast<std::ptrdiff_t>(cap));
  }
  if (table_) {
    const std::size_t left_out = chosen.left_out;
    chosen = glyph_list_.choose(*table_, textures_.origin(), cap - live.size(), previewing() ? preview_->shells() : kNone);
    chosen.left_out += left_out;
  }
  chosen.glyphs.insert(chosen.glyphs.end(), live.begin(), live.end());
  upload_instances(glyphs_, chosen.glyphs);
  glyphs_left_out_ = chosen.left_out;
  glyph_cap_ = cap;
  glyphs_stale_ = false;
  return glyphs_;
}

stereo::Box ModelLayer::shown_box() const {
  stereo::Box box;
  if (!table_) return box;
  for (const ModelTextures::ShellChunk& chunk : textures_.shell_chunks())
    if (chunk.shown) {
      box.add(mesh::Vec3(chunk.box.low + textures_.origin()));
      box.add(mesh::Vec3(chunk.box.high + textures_.origin()));
    }
  for (const std::uint32_t node : line_nodes_)
    if (const mesh::Vec3 point = table_->position(node); finite(point)) box.add(point);
  return box;
}

const std::vector<std::uint8_t>& ModelLayer::visible_nodes() {
  if (!visible_nodes_) visible_nodes_ = table_ ? table_->visible_nodes() : std::vector<std::uint8_t>();
  return *visible_nodes_;
}

}  // namespace prismesh::kiosk::render
