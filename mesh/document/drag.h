// A drag: plans the motion once, then computes positions and quality for each displacement. The document changes only when the drag's edit
// is applied.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/error.h"
#include "mesh/document/edit.h"
#include "mesh/document/generation.h"
#include "mesh/model/node_set.h"
#include "mesh/quality/report.h"
#include "mesh/quality/shell_properties.h"
#include "mesh/quality/shell_state.h"

namespace prismesh::mesh::document {

class ContactSearch;
class ContactsOf;
struct Motion;

/// How a drag spoils elements.
struct Worsening {
  /// Of the shells that are worse than before the drag, the worst: 0 halfway between ideal and failing (a composite of 0.5) and better, 1
  /// where it fails. Composites: mesh/quality/composite.h.
  double badness = 0;
  /// Unit vector, deck's axes: moving this way makes that shell worse fastest. Zero where no way does, or for a drag other than a
  /// Translate or Move.
  Vec3 direction = Vec3::Zero();
};

class Drag {
 public:
  /// `edit` is a Translate, Lift, Slide, Rotate or Move; its displacement is ignored. Errors as `prepare`. `search`: keeps the tree of
  /// the shells for an edit whose rule on contact needs one; null: it is built.
  static Result<Drag> begin(std::shared_ptr<const Generation> base, const Edit& edit, ContactSearch* search = nullptr);

  /// Nodes that can move (weight > 0) and the shells that touch them; fixed for the whole drag.
  const NodeSet& nodes() const;
  const ShellSet& shells() const { return shells_; }
  NodeIndex grab() const;
  /// The unit normal at the grab: the direction of a lift.
  const Vec3& normal() const;

  /// Moves to a displacement, with bit for bit the positions that applying the edit will give: under a rule that keeps shells apart
  /// those at the allowed share of the displacement. A displacement that gives coordinates that aren't finite is ignored.
  void step(const Displacement& displacement);
  const std::vector<Vec3>& positions() const { return positions_; }           ///< of nodes()
  const std::vector<quality::ShellState>& states() const { return states_; }  ///< of shells()
  const quality::Counts& counts() const { return counts_; }                   ///< of the whole document at this step
  /// The share of the last displacement that the edit's rule on contact allows, 0 to 1; at 0 applying the edit is refused.
  double share() const { return share_; }

  /// At this step. Costs the judging of a step once more, the first time twice.
  Worsening worsening();

  /// The edit at the last step's displacement, with the grab's id and coordinates filled in.
  Edit edit() const;

 private:
  std::shared_ptr<const Generation> base_;
  std::shared_ptr<const Motion> motion_;        ///< as applying the edit uses it
  std::shared_ptr<const ContactsOf> contacts_;  ///< null: no rule on contact
  Edit edit_;
  ShellSet shells_;
  std::vector<float> composites_at(std::span<const Vec3> positions) const;
  Vec3 worsening_direction(std::size_t shell, float composite) const;

  Displacement displacement_;  ///< as asked for
  double share_ = 1;           ///< of it, that is allowed
  std::vector<Vec3> positions_;
  std::vector<std::array<std::int32_t, 4>> corners_;  ///< of shells_: >= 0 index into nodes(), < 0: ~index into fixed_
  std::vector<Vec3> fixed_;
  std::vector<quality::ShellProperties> properties_;  ///< of shells_
  std::vector<quality::ShellState> states_;
  std::vector<float> composites_before_;  ///< of shells_, once `worsening` was asked for
  quality::Counts counts_elsewhere_;      ///< of the shells that don't change
  quality::Counts counts_;
};

}  // namespace prismesh::mesh::document
