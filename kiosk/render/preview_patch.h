// The patch of shells that a drag moves, or that an edit would change. The cost of a frame depends on the patch alone. No OpenGL.
#pragma once

#include <span>
#include <unordered_set>
#include <vector>

#include "ipc/model/preview.h"
#include "kiosk/render/glyphs.h"
#include "kiosk/render/mesh_change.h"
#include "kiosk/render/outline.h"

namespace prismesh::kiosk::render {

class PreviewPatch {
 public:
  /// A patch of `shells` with all their corners. `nodes`: those that move. Indices out of range and shells of hidden parts are left out.
  /// Positions are relative to `origin`.
  PreviewPatch(const ModelTable& table, const mesh::Vec3& origin, std::span<const mesh::NodeIndex> nodes,
               std::span<const mesh::ShellIndex> shells);

  /// The patch of an edit's result, complete without frames. Shells with corners out of range are left out.
  PreviewPatch(const mesh::Vec3& origin, const MeshChange& change);

  /// Takes over a frame; false if its number of nodes or shells isn't the drag's.
  bool update(const ipc::PreviewFrame& frame);

  bool any_frame() const { return any_frame_; }
  const std::vector<std::array<float, 4>>& positions() const { return positions_; }  ///< from the origin; w = 0: not finite
  const std::vector<NodePair>& edges() const { return edges_; }                      ///< into positions()
  const std::unordered_set<std::uint32_t>& shells() const { return touched_; }
  std::vector<std::array<std::uint32_t, 4>> corners() const;  ///< of the visible shells, into positions()
  /// Of the visible shells that touch others in the newest frame, into positions().
  std::vector<std::array<std::uint32_t, 4>> touching_corners() const;
  /// Glyphs of the newest frame, warnings first. Their shells are indices into corners(). `damaged`: only those that the shells didn't have
  /// when the deck was opened.
  std::vector<Glyph> glyphs(bool damaged = false) const;

 private:
  struct Shell {
    std::array<std::uint32_t, 4> corner{};  ///< into positions_
    std::uint32_t state = 0;                ///< index into the frame's states
    mesh::quality::ShellState was;          ///< the part of its state that it had when the deck was opened
    std::uint8_t clusters = 0;              ///< bit k: corner k carries the sign of a cluster, which the patch doesn't change
    std::uint8_t worse_clusters = 0;        ///< those that the document's edits made worse
  };
  void add_clusters(const ModelTable& table, std::span<const mesh::ShellIndex> shells);
  void add_edges();

  mesh::Vec3 origin_;
  std::size_t node_count_ = 0;
  std::size_t shell_count_ = 0;
  std::vector<std::uint32_t> local_of_moving_;  ///< by node of the drag, into positions_; kNoIndex: not drawn
  std::vector<std::array<float, 4>> positions_;
  std::vector<NodePair> edges_;
  std::vector<Shell> shells_;
  std::unordered_set<std::uint32_t> touched_;
  std::vector<mesh::quality::ShellState> states_;
  ipc::PreviewTouches touches_;
  bool any_frame_ = false;
};

}  // namespace prismesh::kiosk::render
