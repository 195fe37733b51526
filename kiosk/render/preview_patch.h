// The piece of the model that a drag moves, cut out so that a frame costs the piece: pure.
#pragma once

#include <span>
#include <unordered_set>
#include <vector>

#include "ipc/preview.h"
#include "kiosk/render/glyphs.h"
#include "kiosk/render/mesh_change.h"
#include "kiosk/render/outline.h"

namespace prismesh::kiosk::render {

class PreviewPatch {
 public:
  /// The shells touched and all their corners; `nodes` are those that move. Indices out of range, and shells of hidden parts, are left out.
  PreviewPatch(const ModelTable& table, const mesh::Vec3& origin, std::span<const mesh::NodeIndex> nodes,
               std::span<const mesh::ShellIndex> shells);

  /// What an edit would change, which is there at once and takes no frames. Shells with corners out of range are left out.
  PreviewPatch(const mesh::Vec3& origin, const MeshChange& change);

  /// Takes over a frame; false if its sizes aren't those of the drag.
  bool update(const ipc::PreviewFrame& frame);

  bool any_frame() const { return any_frame_; }
  const std::vector<std::array<float, 4>>& positions() const { return positions_; }  ///< from the origin; w = 0: nowhere
  const std::vector<NodePair>& edges() const { return edges_; }                      ///< into positions()
  const std::unordered_set<std::uint32_t>& shells() const { return touched_; }
  std::vector<std::array<std::uint32_t, 4>> corners() const;  ///< of the shells drawn, into positions()
  /// Glyphs of the newest frame, by their place in corners(), warnings first. `damaged`: only what the shells hadn't when the deck was
  /// opened.
  std::vector<Glyph> glyphs(bool damaged = false) const;

 private:
  struct Shell {
    std::array<std::uint32_t, 4> corner{};  ///< into positions_
    std::uint32_t state = 0;                ///< which of the frame's states
    mesh::quality::ShellState was;          ///< what of its state it had when the deck was opened
  };
  void add_edges();

  mesh::Vec3 origin_;
  std::size_t node_count_ = 0;
  std::size_t shell_count_ = 0;
  std::vector<std::uint32_t> local_of_moving_;  ///< per node of the drag; kNoIndex: not drawn
  std::vector<std::array<float, 4>> positions_;
  std::vector<NodePair> edges_;
  std::vector<Shell> shells_;
  std::unordered_set<std::uint32_t> touched_;
  std::vector<mesh::quality::ShellState> states_;
  bool any_frame_ = false;
};

}  // namespace prismesh::kiosk::render
