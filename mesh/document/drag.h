// A drag under way: weights once, then positions and quality of what moves for each displacement. Nothing is kept until
// the edit it stands for is applied.
#pragma once

#include "mesh/document/document.h"

namespace prismesh::mesh::document {

class Drag {
 public:
  /// `edit` is a Translate or Lift; its displacement is ignored. Errors as `prepare`.
  static Result<Drag> begin(std::shared_ptr<const Generation> base, const Settings& settings, const Edit& edit);

  /// Nodes that can move (weight > 0) and the shells that touch them; fixed for the whole drag.
  const NodeSet& nodes() const { return nodes_; }
  const ShellSet& shells() const { return shells_; }
  NodeIndex grab() const { return grab_; }
  /// The unit normal at the grab: the direction of a lift.
  const Vec3& normal() const { return normal_; }

  /// Moves to a displacement: `by` for a translate, `distance` for a lift. Bit for bit what applying the edit will give.
  void step(const Vec3& by, double distance);
  const std::vector<Vec3>& positions() const { return positions_; }           ///< of nodes()
  const std::vector<quality::ShellState>& states() const { return states_; }  ///< of shells()
  const quality::Counts& counts() const { return counts_; }                   ///< of the whole document at this step

  /// The edit at the last step's displacement, with the grab as coordinates and id resolved.
  Edit edit() const;

 private:
  std::shared_ptr<const Generation> base_;
  Settings settings_;
  Edit edit_;
  NodeSet nodes_;
  ShellSet shells_;
  NodeIndex grab_;
  Vec3 normal_ = Vec3::Zero();
  std::vector<double> weight_;
  std::vector<Vec3> start_;
  std::vector<Vec3> normals_;
  std::vector<Vec3> positions_;
  std::vector<std::array<std::int32_t, 4>> corners_;  ///< of shells_: >= 0 index into nodes_, < 0: ~index into fixed_
  std::vector<Vec3> fixed_;
  std::vector<quality::ShellState> states_;
  quality::Counts base_counts_;
  quality::Counts counts_;
};

}  // namespace prismesh::mesh::document
