#include "kiosk/render/preview_patch.h"

#include <algorithm>
#include <unordered_map>

namespace prismesh::kiosk::render {

using mesh::Vec3;

namespace {

std::array<float, 4> texel(const Vec3& point) {
  const Eigen::Vector3f at = point.cast<float>();
  if (!at.allFinite()) return {};
  return {at.x(), at.y(), at.z(), 1};
}

}  // namespace

PreviewPatch::PreviewPatch(const ModelTable& table, const Vec3& origin, std::span<const mesh::NodeIndex> nodes,
                           std::span<const mesh::ShellIndex> shells)
    : origin_(origin), node_count_(nodes.size()), shell_count_(shells.size()) {
  std::vector<std::pair<mesh::ShellNodes, std::uint32_t>> shown;
  std::vector<std::uint32_t> used;
  for (std::size_t i = 0; i < shells.size(); ++i) {
    mesh::ShellNodes corners;
    if (shells[i].value >= table.shell_count() || !table.shell(shells[i].value, corners)) continue;
    touched_.insert(shells[i].value);
    if (!table.shell_visible(shells[i].value)) continue;
    shown.emplace_back(corners, static_cast<std::uint32_t>(i));
    for (const mesh::NodeIndex node : corners.node) used.push_back(node.value);
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  const auto local = [&](std::uint32_t node) {
    const auto place = std::lower_bound(used.begin(), used.end(), node);
    return place != used.end() && *place == node ? static_cast<std::uint32_t>(place - used.begin()) : kNoIndex;
  };
  for (const std::uint32_t node : used) positions_.push_back(texel(table.position(node) - origin));
  for (const mesh::NodeIndex node : nodes) local_of_moving_.push_back(local(node.value));
  for (const auto& [corners, state] : shown) {
    Shell shell;
    shell.state = state;
    shell.was = table.shell_was(shells[state].value);
    for (std::size_t k = 0; k < 4; ++k) shell.corner[k] = local(corners.node[k].value);
    shells_.push_back(shell);
  }
  add_clusters(table, shells);
  add_edges();
}

void PreviewPatch::add_clusters(const ModelTable& table, std::span<const mesh::ShellIndex> shells) {
  if (table.clusters().empty()) return;
  std::unordered_map<std::uint32_t, Shell*> of_model;
  for (Shell& shell : shells_) of_model.emplace(shells[shell.state].value, &shell);
  for (const ipc::SnapshotCluster& cluster : table.clusters()) {
    const auto carrier = of_model.find(cluster.shell.value);
    if (carrier == of_model.end()) continue;
    const auto bit = static_cast<std::uint8_t>(1U << cluster.corner);
    carrier->second->clusters |= bit;
    if (cluster.worse != 0) carrier->second->worse_clusters |= bit;
  }
}

PreviewPatch::PreviewPatch(const Vec3& origin, const MeshChange& change) : origin_(origin), states_(change.states), any_frame_(true) {
  for (const Vec3& point : change.points) positions_.push_back(texel(point - origin));
  states_.resize(change.corners.size());
  for (std::size_t s = 0; s < change.corners.size(); ++s) {
    const std::array<std::uint32_t, 4>& corner = change.corners[s];
    if (*std::max_element(corner.begin(), corner.end()) >= positions_.size()) continue;
    const std::uint8_t clusters = s < change.clusters.size() ? change.clusters[s] : std::uint8_t{0};
    shells_.push_back({corner, static_cast<std::uint32_t>(s), {}, clusters, clusters});
  }
  for (const mesh::ShellIndex shell : change.replaced) touched_.insert(shell.value);
  add_edges();
}

void PreviewPatch::add_edges() {
  for (const Shell& shell : shells_)
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t a = shell.corner[k], b = shell.corner[(k + 1) % 4];
      if (a != b) edges_.push_back({std::min(a, b), std::max(a, b)});
    }
  std::sort(edges_.begin(), edges_.end());
  edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
}

bool PreviewPatch::update(const ipc::PreviewFrame& frame) {
  if (frame.positions.size() != node_count_ || frame.states.size() != shell_count_) return false;
  for (std::size_t i = 0; i < node_count_; ++i)
    if (local_of_moving_[i] != kNoIndex) positions_[local_of_moving_[i]] = texel(frame.positions[i] - origin_);
  states_ = frame.states;
  touches_ = frame.touches;
  any_frame_ = true;
  return true;
}

std::vector<std::array<std::uint32_t, 4>> PreviewPatch::corners() const {
  std::vector<std::array<std::uint32_t, 4>> corners;
  for (const Shell& shell : shells_) corners.push_back(shell.corner);
  return corners;
}

std::vector<std::array<std::uint32_t, 4>> PreviewPatch::touching_corners() const {
  std::vector<std::array<std::uint32_t, 4>> corners;
  for (const Shell& shell : shells_)
    if (touches_.touches(shell.state)) corners.push_back(shell.corner);
  return corners;
}

std::vector<Glyph> PreviewPatch::glyphs(bool damaged) const {
  std::vector<Glyph> glyphs;
  if (!any_frame_) return glyphs;
  for (const bool failing : {false, true})
    for (std::size_t s = 0; s < shells_.size(); ++s) {
      const Shell& shell = shells_[s];
      mesh::quality::ShellState state = states_[shell.state];
      if (damaged) {
        state.warn = static_cast<std::uint16_t>(state.warn & ~shell.was.warn);
        state.fail = static_cast<std::uint16_t>(state.fail & ~shell.was.fail);
      }
      const unsigned clusters = failing ? 0U : damaged ? shell.worse_clusters : shell.clusters;
      const bool is_bad = (state.warn | state.fail) != 0 && (state.fail != 0) == failing;
      if (!is_bad && clusters == 0) continue;
      const std::size_t corners = shell.corner[3] == shell.corner[2] ? 3 : 4;
      std::array<Vec3, 4> at;
      bool whole = true;
      for (std::size_t k = 0; k < corners; ++k) {
        const std::array<float, 4>& place = positions_[shell.corner[k]];
        at[k] = Vec3(place[0], place[1], place[2]);
        whole = whole && place[3] != 0;
      }
      if (!whole) continue;  // a corner isn't finite
      for (std::uint32_t corner = 0; corner < corners; ++corner)
        if ((clusters >> corner & 1U) != 0)
          glyphs.push_back({static_cast<std::uint32_t>(s), static_cast<std::uint32_t>(GlyphShape::cluster) | corner << kGlyphPlaceShift});
      if (!is_bad) continue;
      for (const GlyphShape shape : shapes_of(state))
        glyphs.push_back({static_cast<std::uint32_t>(s), static_cast<std::uint32_t>(shape) | (failing ? kFailingGlyph : 0) |
                                                             glyph_place(shape, std::span(at).first(corners)) << kGlyphPlaceShift});
    }
  return glyphs;
}

}  // namespace prismesh::kiosk::render
