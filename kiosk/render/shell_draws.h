// Which shells a picture draws, and how: all of them in an order that follows space, or coarse triangles for those that are small in it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kiosk/render/draw_span.h"
#include "kiosk/render/model_textures.h"
#include "mesh/lod/choose.h"
#include "mesh/lod/levels.h"

namespace prismesh::kiosk::render {

/// Levels of detail with the places of the nodes that they were made of.
struct MadeLevels {
  mesh::lod::Levels levels;
  mesh::Vec3 origin = mesh::Vec3::Zero();
  std::vector<Eigen::Vector3f> places;        ///< by node, from `origin`; not finite: not drawn
  std::uint64_t document = 0;                 ///< ModelSource::document_key
  std::vector<std::uint64_t> shell_versions;  ///< of the chunks of ModelSource's shell_nodes and shell_parts
};

/// The versions that MadeLevels::shell_versions holds.
std::vector<std::uint64_t> shell_versions_of(const ModelSource& source);

/// How often a shell is drawn, for the faces of its plate (gl_InstanceID), and how far these are from the shell at most (model's unit).
struct FacesOfShell {
  int count = 1;
  double reach = 0;
};

class ShellDraws {
 public:
  ShellDraws();

  /// Follows the model. Levels of other shells are dropped. Errors: no graphics memory.
  Result<void> update(const ModelTable& table, const ModelTextures& textures, const ModelChanges& changes);
  /// Takes levels over; ignored if they were made of other shells. Errors: no graphics memory.
  Result<void> set_levels(MadeLevels made, const ModelTable& table);
  bool has_levels() const { return made_.has_value(); }
  /// Gives levels up, to take less memory. Errors: no graphics memory.
  Result<void> give_up_levels(const ModelTable& table);
  /// Whether the order in which shells are drawn is uploaded in pieces while they are drawn, instead of held. The same is drawn. Errors: no
  /// graphics memory.
  Result<void> set_order_in_pieces(bool in_pieces);
  /// Bytes on the graphics card: of the order, and of levels with what is chosen.
  std::size_t order_bytes() const { return gl::bytes_held(all_indices_); }
  std::size_t levels_bytes() const;
  /// Bytes of an order that is held.
  static std::size_t order_bytes_of(std::size_t shells) { return shells * 6 * sizeof(std::uint32_t); }
  /// Whether nodes have moved since the levels were made.
  bool is_out_of_date() const { return !moved_by_.empty(); }

  /// Draws those in the span of all shells that may be seen, four vertices each: gl_VertexID is four times the shell, plus the corner. The
  /// program, the textures and their uniforms must be set.
  void draw_all(const Eigen::Matrix4d& clip_from_model, const FacesOfShell& faces, DrawSpan& span) const;
  /// Chooses what is drawn for a viewpoint (deck's coordinates): the finest that has at most `triangles`. Shells whose sides are seen are
  /// drawn as they are as long as `triangles` allow it; then triangles are off by 1 to 8 pixels. Precondition: has_levels().
  void choose(const mesh::lod::Viewpoint& from, const Eigen::Matrix4d& clip_from_model, std::size_t triangles);
  /// Draws the chosen shells as draw_all does, so many faces of each.
  void draw_chosen_shells(int faces) const;
  /// Draws the chosen coarse triangles: gl_VertexID is three times the row in `coarse()`, plus the corner.
  void draw_chosen_coarse() const;
  const RowTexture& coarse() const { return coarse_; }
  std::size_t chosen_triangles() const { return chosen_triangles_; }
  double chosen_pixels() const { return chosen_pixels_; }

 private:
  /// Neighbours in the order of drawing that are culled together.
  struct Run {
    std::uint32_t first = 0, count = 0;  ///< shells
    mesh::lod::Sphere bounds;            ///< model's coordinates (relative to the origin)
    bool shown = true;
  };
  /// That of the levels, or else of the shells.
  std::uint32_t shell_at(std::size_t place) const { return made_ ? made_->levels.shells[place].value : static_cast<std::uint32_t>(place); }
  Result<void> set_order(std::size_t shells);
  Result<void> upload_order() const;
  void add_to_piece(std::size_t first, std::size_t count, int instances, std::vector<std::uint32_t>& piece) const;
  void draw_piece(int instances, std::vector<std::uint32_t>& piece) const;
  void find_moved(const ModelTable& table, std::size_t chunk);
  void look_at_runs(const ModelTable& table, const std::vector<std::uint8_t>& changed_chunks);
  void look_at_run(const ModelTable& table, std::size_t run, const std::vector<std::uint8_t>& changed_chunks);
  void find_selected(const ModelTable& table);
  void find_added();
  void drop_levels();

  std::size_t shells_ = 0;
  gl::VertexArray all_array_, shell_array_, coarse_array_;
  gl::Buffer all_indices_, shell_indices_, coarse_indices_;
  std::size_t ordered_ = 0;         ///< shells in the order
  bool order_in_pieces_ = false;    ///< all_indices_ has only the last piece
  std::vector<Run> runs_;           ///< with levels: their clusters of shells
  std::optional<MadeLevels> made_;  ///< without triangles: they are in coarse_
  RowTexture coarse_{kFourIndices};
  std::vector<float> moved_by_;         ///< by node, since the levels were made; empty: none has moved
  std::vector<float> cluster_moved_;    ///< by cluster of shells: the longest way of one of their nodes
  std::vector<std::uint8_t> selected_;  ///< by cluster of shells: some must be seen as they are
  std::vector<float> added_;            ///< by group of the levels
  float farthest_ = 0;                  ///< of moved_by_
  std::vector<std::uint64_t> marks_;    ///< versions of the shells' marks, of which selected_ is
  mesh::Vec3 origin_ = mesh::Vec3::Zero();
  std::vector<std::uint32_t> clusters_, shell_list_, coarse_list_;
  std::size_t chosen_triangles_ = 0;
  double chosen_pixels_ = 0;
};

}  // namespace prismesh::kiosk::render
