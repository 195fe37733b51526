// Keeps edits from making contacts: how far a motion may go, and what an edit made. docs/contact.md, "The rule". Private to mesh/document.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "mesh/contact/new_contacts.h"
#include "mesh/document/contacts.h"
#include "mesh/document/edit.h"
#include "mesh/document/generation.h"
#include "mesh/document/motion.h"

namespace prismesh::mesh::document {

/// What the later states of a generation are compared with, as the deck's contacts see it.
class ContactsOf {
 public:
  /// Costs the tree of all shells, but where a search has it. The generation must outlive it.
  explicit ContactsOf(const Generation& generation, ContactSearch* search = nullptr);

  /// What crosses or is too close in a later state and wasn't, or less so, in the generation.
  std::vector<contact::NewContact> new_in(const Generation& after) const;
  const Generation& generation() const { return generation_; }

 private:
  const Generation& generation_;
  contact::ContactsBefore before_;
};

/// How far a motion goes under a rule.
struct AllowedWay {
  double share = 1;                          ///< of the whole displacement; 0: none of it is free
  std::vector<contact::NewContact> ahead{};  ///< at the smallest share that isn't free, of those tried
  std::size_t held_back = 0;                 ///< nodes that max_move stopped
};
Displacement share_of(const Displacement& displacement, double share);
/// Puts the positions of a motion. `before`: null where no contact is looked for. Under `keep_apart` they are those at the largest share of
/// the displacement, to a thousandth, at which there is no new contact: by bisection, so what is touched only on the way doesn't count.
/// Under `refuse`, and where positions aren't finite, they are those of the whole displacement. Deterministic.
AllowedWay positions_under(ContactRule rule, const ContactsOf* before, const Motion& motion, const Displacement& displacement,
                           std::span<Vec3> out);

/// "relax: part 1 and part 2 would cross ...": the refusal under ContactRule::refuse.
Error refused_contact(std::string_view edit, const Model& model, const std::vector<contact::NewContact>& contacts);

}  // namespace prismesh::mesh::document
