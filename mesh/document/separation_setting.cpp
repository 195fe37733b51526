#include "mesh/document/separation_setting.h"

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include "mesh/contact/contact_surface.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::document {

namespace {

/// As predicates of nodes, in the order of Stays.
constexpr std::array<std::string_view, 5> kStayAsPredicates{"are locked", "are held by the deck", "have elements other than shells",
                                                            "are joined by cards", "are beside mid-side nodes that can't follow"};

constexpr std::string_view kOffset = "are offset from the contact's surface";

}  // namespace

SeparationSetting::SeparationSetting(const Document& document, contact::ContactThickness thickness)
    : generation_(document.current()),
      criteria_(judged_by(document)),
      thickness_(std::move(thickness)),
      surface_(thickness_.offset.empty() ? generation_.model : contact::contact_surface(generation_.model, thickness_.offset)),
      tree_(surface_),
      welds_(generation_),
      pins_(generation_, &welds_),
      joints_(welds_.pairs()) {
  const NodeSet offset = moved_nodes(generation_.model, surface_);
  if (offset.empty()) return;
  beside_offset_.assign(generation_.model.node_count(), 0);
  for (const NodeIndex node : nodes_of(generation_.model, shells_touching(generation_.model, offset))) beside_offset_[node.value] = 1;
}

std::string_view SeparationSetting::why_stays(NodeIndex node) const {
  const Stays why = pins_.of(node);
  if (why != Stays::goes) return kStayAsPredicates[static_cast<std::size_t>(why)];
  return !beside_offset_.empty() && beside_offset_[node.value] != 0 ? kOffset : std::string_view();
}

contact::SeparationInput SeparationSetting::input() const {
  return {surface_,
          tree_,
          thickness_,
          criteria_,
          generation_.quality,
          joints_,
          [this](NodeIndex node) { return why_stays(node); },
          [this](const Model& before, const NodeSet& moved, Model& after) { return welds_.carry(before, moved, after); },
          [this](const Model& before, const Model& after, const NodeSet& moved) { return welds_.why_lost(before, after, moved); }};
}

}  // namespace prismesh::mesh::document
