// Which contacts a change of a model makes: what moving, relaxing and repairing are told not to do. docs/contact.md, "The rule".
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mesh/contact/contact_thickness.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::contact {

/// A pair of shells that cross or are too close, where shells of their parts weren't, or less so.
struct NewContact {
  ShellIndex a, b;  ///< a < b
  bool crosses = false;
  double depth = 0;  ///< of two that are too close
  /// The shells that changed and make the contact: those of the pair; else those near it, as where a junction is no more. Never empty.
  ShellSet by;
};

/// A state of a model that others are compared with.
class ContactsBefore {
 public:
  /// Preconditions: the tree and the thickness are those of the model, which has its adjacency; the thickness isn't null.
  ContactsBefore(const Model& model, const spatial::BoxTree& tree, std::shared_ptr<const ContactThickness> thickness);

  /// The contacts of `after` that are new or deeper; ascending, on all cores, the same whatever their number. What counts is as in
  /// find_shell_crossings and find_penetrations, and shells of a perforation that are too close count, too. A pair is compared with the
  /// same pair, and a shell that changed also counts as what its part had where the pair is nearest; so shells may slide along a sheet that
  /// they touch. `after`: another state of the model; shells and nodes that both have keep their index. `thickness`: of it. Costs what
  /// changed and the regions about it, not the model. Precondition: `after` has its adjacency.
  std::vector<NewContact> new_in(const Model& after, const ContactThickness& thickness) const;
  /// With the same shells, and so with the same thickness.
  std::vector<NewContact> new_in(const Model& after) const { return new_in(after, *thickness_); }

  const Model& model() const { return model_; }

 private:
  Model model_;
  spatial::BoxTree tree_;
  std::shared_ptr<const ContactThickness> thickness_;
  double max_thickness_ = 0;
};

/// The worst of them in words: "part 1 and part 2 would cross", or "part 1 and part 2 would be too close, 0.4 deep". Precondition: there is
/// one.
std::string in_words(const Model& model, const std::vector<NewContact>& contacts);

}  // namespace prismesh::mesh::contact
