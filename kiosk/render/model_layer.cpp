#include "kiosk/render/model_layer.h"

#include <algorithm>

#include "kiosk/render/glyph_levels.h"

namespace prismesh::kiosk::render {

using ipc::SnapshotArray;

namespace {

void make_glyph_instances(Instances& instances) {
  instances.array = gl::VertexArray::make();
  instances.buffer = gl::Buffer::make();
  glBindVertexArray(instances.array.get());
  glBindBuffer(GL_ARRAY_BUFFER, instances.buffer.get());
  glVertexAttribIPointer(0, 2, GL_UNSIGNED_INT, sizeof(Glyph), nullptr);
  glEnableVertexAttribArray(0);
  glVertexAttribDivisor(0, 1);
  glBindVertexArray(0);
}

void upload_instances(Instances& instances, const std::vector<Glyph>& values) {
  const std::size_t bytes = values.size() * sizeof(Glyph);
  glBindBuffer(GL_ARRAY_BUFFER, instances.buffer.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes), values.data(), GL_DYNAMIC_DRAW);
  instances.count = values.size();
  instances.bytes_uploaded += bytes;
}

/// A visible face that is selected, by itself or by all of its corners. If so, `nodes` are its corners.
bool is_selected_face(const ModelTable& table, std::size_t shell, mesh::ShellNodes& nodes) {
  return table.shell(shell, nodes) && (table.shell_selected(shell) || table.corners_selected(nodes)) && table.shell_visible(shell);
}

/// By node: 1 if it is a corner of a selected face.
std::vector<std::uint8_t> nodes_of_selected_faces(const ModelTable& table) {
  std::vector<std::uint8_t> nodes_on(table.node_count(), 0);
  mesh::ShellNodes nodes;
  for (std::size_t s = 0; s < table.shell_count(); ++s)
    if (is_selected_face(table, s, nodes))
      for (const mesh::NodeIndex node : nodes.node) nodes_on[node.value] = 1;
  return nodes_on;
}

/// Chunks in which the arrays differ; what is beyond an end is 0.
std::vector<std::uint32_t> chunks_that_differ(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  std::vector<std::uint32_t> chunks;
  const std::size_t size = std::max(a.size(), b.size());
  for (std::size_t begin = 0; begin < size; begin += mesh::kChunkSize)
    for (std::size_t n = begin; n < std::min(begin + mesh::kChunkSize, size); ++n)
      if ((n < a.size() ? a[n] : 0) != (n < b.size() ? b[n] : 0)) {
        chunks.push_back(static_cast<std::uint32_t>(begin / mesh::kChunkSize));
        break;
      }
  return chunks;
}

/// The median length of the first side of about 500 shells at even steps.
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

ModelLayer::ModelLayer() {
  make_glyph_instances(model_glyphs_.instances);
  make_glyph_instances(preview_glyphs_.instances);
  make_glyph_instances(marked_);
}

Result<void> ModelLayer::set_model(std::shared_ptr<const ModelSource> source) {
  ++shape_version_;
  model_glyphs_.stale = selection_casting_.stale = true;
  marked_shell_.reset();
  part_looks_stale_ = true;
  if (!source) {
    table_.reset();
    visible_nodes_.reset();
    contact_.clear();
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
  if (const auto done = shell_draws_.update(*table_, textures_, *changes); !done) {
    table_.reset();
    return done;
  }
  plates_.note(*changes);
  if (changes->topology || changes->visibility) visible_nodes_.reset();
  forget_visible_nodes();
  chunks_uploaded_ += changes->uploaded;
  typical_side_ = measure_typical_side(*table_);
  if (changes->topology) {  // their indices refer to the old mesh
    end_preview();
    contact_.clear();
  } else if (changes->visibility) {
    if (const auto done = contact_.update(*table_); !done) return done;
  }
  if (changes->topology || changes->visibility || !changes->moved_chunks.empty()) {
    outline_.update(*table_, changes->topology, changes->visibility, changes->moved_chunks);
    if (const auto done = borders_.upload(outline_.borders(), "free edges"); !done) return done;
    if (const auto done = creases_.upload(outline_.creases(), "creases"); !done) return done;
  }
  if (const auto done = update_line_elements(first || changes->topology || changes->visibility); !done) return done;
  glyph_list_.update(*table_, changes->visibility, changes->topology, glyphs_of_damage_);
  const bool visible_nodes_changed = !visible_nodes_ && table_->any_hidden();
  const bool all = changes->topology || changes->visibility || visible_nodes_changed;
  const auto visible = [this]() -> const std::vector<std::uint8_t>& { return visible_nodes(); };
  if (const auto done = selected_.update(*table_, textures_.origin(), all, changes->moved_chunks, visible); !done) return done;
  covered_.changed.clear();
  if (all || !changes->marked_chunks.empty()) {
    // Which nodes are on no selected face may change with the marks of any other chunk.
    std::vector<std::uint8_t> nodes = selected_.count() > 0 ? nodes_of_selected_faces(*table_) : std::vector<std::uint8_t>();
    covered_.changed = chunks_that_differ(covered_.nodes, nodes);
    covered_.nodes = std::move(nodes);
    const auto is_in = [this, corners = mesh::ShellNodes{}](std::uint32_t shell) mutable {
      return is_selected_face(*table_, shell, corners);
    };
    if (const auto done = selected_rim_.upload(outline_.rim(covered_.nodes, is_in), "edges around selected faces"); !done) return done;
  }
  return loose_.update(*table_, textures_.origin(), all, changes->moved_chunks, visible, &covered_);
}

Result<void> ModelLayer::set_levels(MadeLevels made) { return table_ ? shell_draws_.set_levels(std::move(made), *table_) : Result<void>(); }

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

void ModelLayer::forget_visible_nodes() {
  std::vector<std::uint64_t> versions;
  for (const SnapshotArray array :
       {SnapshotArray::shell_nodes, SnapshotArray::shell_parts, SnapshotArray::line_nodes, SnapshotArray::line_parts})
    for (std::size_t c = 0; c < table_->source().chunk_count(array); ++c) versions.push_back(table_->source().chunk_version(array, c));
  if (versions == visible_versions_) return;
  visible_versions_ = std::move(versions);
  visible_nodes_.reset();
}

void ModelLayer::begin_preview(std::span<const mesh::NodeIndex> nodes, std::span<const mesh::ShellIndex> shells) {
  end_preview();
  preview_casting_.stale = true;
  if (table_) preview_.emplace(*table_, textures_.origin(), nodes, shells);
}

Result<void> ModelLayer::update_preview(const ipc::PreviewFrame& frame) {
  if (!preview_) return {};
  const bool first = !preview_->any_frame();
  if (!preview_->update(frame)) return {};
  preview_glyphs_.stale = true;
  if (first) model_glyphs_.stale = true;  // the model's glyphs must leave out the preview's shells
  if (const auto done = upload_preview_positions(); !done) return done;
  if (const auto done = contact_.set_touching(*table_, *preview_, frame.touches.others); !done) return done;
  return first ? preview_edges_.upload(preview_->edges(), "moving edges") : Result<void>();
}

Result<void> ModelLayer::upload_preview_positions() {
  if (const auto reserved = preview_positions_.reserve(preview_->positions().size(), "moving nodes"); !reserved)
    return fail(reserved.error());
  preview_positions_.upload(std::as_bytes(std::span(preview_->positions())));
  return {};
}

Result<void> ModelLayer::show_change(const MeshChange& change) {
  end_preview();
  if (!table_) return {};
  preview_.emplace(textures_.origin(), change);
  preview_casting_.stale = preview_glyphs_.stale = model_glyphs_.stale = true;
  if (const auto done = upload_preview_positions(); !done) return done;
  return preview_edges_.upload(preview_->edges(), "changed edges");
}

void ModelLayer::end_preview() {
  if (preview_) model_glyphs_.stale = preview_glyphs_.stale = true;
  preview_.reset();
  contact_.end_touching();
}

Result<void> ModelLayer::set_contact(ContactPicture picture) {
  if (table_) return contact_.set(*table_, textures_.origin(), std::move(picture));
  contact_.clear();
  return {};
}

Result<void> ModelLayer::set_cut(std::optional<CutPicture> cut) {
  ++shape_version_;  // what can be picked changes
  cut_ = std::move(cut);
  cut_curves_.clear();
  if (!cut_ || !table_) return {};
  return cut_curves_.set(cut_->segments, textures_.origin(), "curves of the cut");
}

Result<void> ModelLayer::choose_preview_glyphs(std::size_t cap) {
  std::vector<Glyph> live;
  if (previewing()) live = preview_->glyphs(glyphs_of_damage_);
  preview_glyphs_.left_out = live.size() - std::min(live.size(), cap);
  live.erase(live.begin(), live.begin() + static_cast<std::ptrdiff_t>(preview_glyphs_.left_out));  // failures come last and stay
  for (Glyph& glyph : live) glyph.kind |= kShownAtEveryLevel << kGlyphLevelShift;  // what goes bad under the hand is always seen
  upload_instances(preview_glyphs_.instances, live);
  preview_glyphs_.stale = false;
  if (live.empty() || !preview_casting_.stale) return {};
  return upload_casting(preview_casting_, preview_->corners());
}

Result<ModelLayer::Glyphs> ModelLayer::glyphs(std::size_t cap, bool damaged) {
  if (cap != glyph_cap_ || damaged != glyphs_of_damage_) model_glyphs_.stale = preview_glyphs_.stale = true;
  if (damaged != glyphs_of_damage_ && table_) glyph_list_.update(*table_, false, false, damaged);
  glyph_cap_ = cap;
  glyphs_of_damage_ = damaged;
  // The preview's share is reserved for the whole drag, so that the model's glyphs don't come and go with its frames.
  const std::size_t reserved = previewing() ? std::min(kMaxGlyphsOfShell * preview_->shells().size(), cap / 2) : 0;
  if (preview_glyphs_.stale)
    if (const auto chosen = choose_preview_glyphs(reserved); !chosen) return fail(chosen.error());
  if (model_glyphs_.stale) {
    static const std::unordered_set<std::uint32_t> kNone;
    GlyphList::Chosen chosen;
    if (table_) chosen = glyph_list_.choose(*table_, cap - reserved, previewing() ? preview_->shells() : kNone);
    if (table_) set_glyph_levels(*table_, typical_side_, chosen.glyphs);
    upload_instances(model_glyphs_.instances, chosen.glyphs);
    model_glyphs_.left_out = chosen.left_out;
    model_glyphs_.stale = false;
  }
  return Glyphs{model_glyphs_.instances, preview_glyphs_.instances, model_glyphs_.left_out + preview_glyphs_.left_out};
}

Result<void> ModelLayer::update_part_looks(bool damaged) {
  if (!table_ || (!part_looks_stale_ && damaged == part_looks_of_damage_)) return {};
  part_looks_stale_ = false;
  part_looks_of_damage_ = damaged;
  return part_looks_.update(*table_, damaged);
}

Result<void> ModelLayer::update_plates() { return table_ ? plates_.update(*table_) : Result<void>(); }

const Instances& ModelLayer::marked(mesh::ShellIndex shell) {
  if (marked_shell_ == shell) return marked_;
  marked_shell_ = shell;
  mesh::ShellNodes nodes;
  const bool visible =
      table_ && shell.value < table_->shell_count() && table_->shell(shell.value, nodes) && table_->shell_visible(shell.value);
  upload_instances(
      marked_, visible ? std::vector<Glyph>{{shell.value, kMarkedGlyph | kShownAtEveryLevel << kGlyphLevelShift}} : std::vector<Glyph>{});
  return marked_;
}

Result<void> ModelLayer::upload_casting(Casting& casting, const std::vector<std::array<std::uint32_t, 4>>& shells) const {
  casting.shells = 0;
  if (const auto reserved = casting.connectivity.reserve(shells.size(), "shadows"); !reserved) return fail(reserved.error());
  casting.connectivity.upload(std::as_bytes(std::span(shells)));
  casting.shells = shells.size();
  casting.stale = false;
  return {};
}

Result<ModelLayer::ShadowCaster> ModelLayer::shadow_caster() {
  if (previewing()) {
    if (preview_casting_.stale)
      if (const auto done = upload_casting(preview_casting_, preview_->corners()); !done) return fail(done.error());
    return ShadowCaster{&preview_positions_, &preview_casting_.connectivity, preview_casting_.shells};
  }
  if (selection_casting_.stale) {
    std::vector<std::array<std::uint32_t, 4>> shells;
    if (selected_.count() > 0)
      for (std::size_t s = 0; s < table_->shell_count(); ++s) {
        mesh::ShellNodes nodes;
        if (!table_->shell(s, nodes) || !table_->shell_visible(s)) continue;
        const auto selected = [&](mesh::NodeIndex node) { return table_->node_selected(node.value); };
        if (std::all_of(nodes.node.begin(), nodes.node.end(), selected))
          shells.push_back({nodes.node[0].value, nodes.node[1].value, nodes.node[2].value, nodes.node[3].value});
      }
    if (const auto done = upload_casting(selection_casting_, shells); !done) return fail(done.error());
  }
  return ShadowCaster{&textures_.positions(), &selection_casting_.connectivity, selection_casting_.shells};
}

std::size_t ModelLayer::bytes_uploaded() const {
  std::size_t bytes = model_glyphs_.instances.bytes_uploaded + preview_glyphs_.instances.bytes_uploaded + marked_.bytes_uploaded +
                      contact_.bytes_uploaded() + cut_curves_.bytes_uploaded() + plates_.bytes_uploaded();
  for (const RowTexture* texture : row_textures()) bytes += texture->bytes_uploaded();
  return bytes;
}

std::array<const RowTexture*, 14> ModelLayer::row_textures() const {
  return {&textures_.positions(),  &textures_.connectivity(), &textures_.surface(),           &borders_.texture,
          &creases_.texture,       &line_elements_.texture,   &selected_rim_.texture,         &selected_.texture(),
          &loose_.texture(),       &preview_positions_,       &preview_casting_.connectivity, &selection_casting_.connectivity,
          &preview_edges_.texture, &part_looks_.texture()};
}

std::size_t ModelLayer::bytes_held() const {
  std::size_t bytes =
      shell_draws_.order_bytes() + shell_draws_.levels_bytes() + contact_.bytes_held() + cut_curves_.bytes_held() + plates_.bytes_held();
  for (const RowTexture* texture : row_textures()) bytes += texture->bytes_held();
  for (const Instances* instances : {&model_glyphs_.instances, &preview_glyphs_.instances, &marked_})
    bytes += gl::bytes_held(instances->buffer);
  return bytes;
}

std::size_t ModelLayer::bytes_for(const ModelSource& source) {
  const std::size_t nodes = source.size(SnapshotArray::positions), shells = source.size(SnapshotArray::shell_nodes);
  std::size_t bytes = RowTexture::bytes_for(nodes, kPositionTexel) + 2 * RowTexture::bytes_for(nodes, kOneIndex);  // and the selected ones
  bytes += RowTexture::bytes_for(shells, kFourIndices) + RowTexture::bytes_for(shells, kTwoIndices);
  return bytes;
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
