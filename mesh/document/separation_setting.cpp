#include "mesh/document/separation_setting.h"

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

namespace prismesh::mesh::document {

namespace {

/// As predicates of nodes, in the order of Stays.
constexpr std::array<std::string_view, 5> kStayAsPredicates{"are locked", "are held by the deck", "have elements other than shells",
                                                            "are joined by cards", "are beside mid-side nodes that can't follow"};

}  // namespace

SeparationSetting::SeparationSetting(const Document& document, contact::ContactThickness thickness)
    : generation_(document.current()),
      criteria_(judged_by(document)),
      thickness_(std::move(thickness)),
      tree_(generation_.model),
      welds_(generation_),
      pins_(generation_, &welds_),
      joints_(welds_.pairs()) {}

contact::SeparationInput SeparationSetting::input() const {
  return {generation_.model,
          tree_,
          thickness_,
          criteria_,
          generation_.quality,
          joints_,
          [this](NodeIndex node) {
            const Stays why = pins_.of(node);
            return why == Stays::goes ? std::string_view() : kStayAsPredicates[static_cast<std::size_t>(why)];
          },
          [this](const Model& before, const NodeSet& moved, Model& after) { return welds_.carry(before, moved, after); },
          [this](const Model& before, const Model& after, const NodeSet& moved) { return welds_.why_lost(before, after, moved); }};
}

}  // namespace prismesh::mesh::document
