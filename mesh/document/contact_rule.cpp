#include "mesh/document/contact_rule.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "mesh/document/deck_relations.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::document {

namespace {

constexpr int kHalvings = 10;

}  // namespace

Displacement share_of(const Displacement& displacement, double share) {
  return {share * displacement.by, share * displacement.distance, share * displacement.degrees};
}

ContactsOf::ContactsOf(const Generation& generation, ContactSearch* search)
    : generation_(generation),
      before_(search != nullptr
                  ? contact::ContactsBefore(generation.model, search->tree(generation.model), search->thickness(generation))
                  : contact::ContactsBefore(generation.model, spatial::BoxTree(generation.model),
                                            std::make_shared<const contact::ContactThickness>(contact_thickness(generation)))) {}

std::vector<contact::NewContact> ContactsOf::new_in(const Generation& after) const {
  // What a contact says of a shell's thickness may depend on its sides.
  const bool may_differ =
      !after.relations->deck->contacts.cards.empty() || !same_chunks(generation_.model.shell_nodes, after.model.shell_nodes);
  return may_differ ? before_.new_in(after.model, contact_thickness(after)) : before_.new_in(after.model);
}

AllowedWay positions_under(ContactRule rule, const ContactsOf* before, const Motion& motion, const Displacement& displacement,
                           std::span<Vec3> out) {
  AllowedWay way;
  way.held_back = positions_at(motion, displacement, out);
  const bool finite = std::all_of(out.begin(), out.end(), [](const Vec3& position) { return position.allFinite(); });
  if (rule == ContactRule::allow || before == nullptr || !finite) return way;
  Generation moved = before->generation();
  const auto contacts_here = [&] {
    for (std::size_t i = 0; i < out.size(); ++i) moved.model.positions.set(motion.nodes[i].value, out[i]);
    return before->new_in(moved);
  };
  way.ahead = contacts_here();
  if (way.ahead.empty() || rule == ContactRule::refuse) return way;
  double touches = 1;
  way.share = 0;
  for (int halving = 0; halving < kHalvings; ++halving) {
    const double middle = (way.share + touches) / 2;
    positions_at(motion, share_of(displacement, middle), out);
    std::vector<contact::NewContact> found = contacts_here();
    if (found.empty()) {
      way.share = middle;
    } else {
      touches = middle;
      way.ahead = std::move(found);
    }
  }
  way.held_back = positions_at(motion, share_of(displacement, way.share), out);
  return way;
}

Error refused_contact(std::string_view edit, const Model& model, const std::vector<contact::NewContact>& contacts) {
  return {"", 0, std::string(edit) + ": " + contact::in_words(model, contacts) + "; the edit is refused, since \"contact\" is \"refuse\""};
}

}  // namespace prismesh::mesh::document
