#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/counted.h"
#include "base/readable_number.h"
#include "mesh/connections/check_welds.h"
#include "mesh/connections/seat_weld.h"
#include "mesh/document/apply.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/grow_relations.h"
#include "mesh/document/history.h"
#include "mesh/model/adjacency.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::document {

namespace {

using connections::CheckedWeld;

constexpr std::size_t kMaxWeldsToldLeft = 1000;

class WeldMender {
 public:
  WeldMender(const Generation& before, const RepairWelds& edit, Generation& next, EditReport& report)
      : before_(before), edit_(edit), next_(next), mended_(report.welds_mended.emplace()), tree_(before.model) {}

  /// Errors: a name in "at" that is no weld.
  Result<void> mend() {
    const std::vector<CheckedWeld> welds =
        connections::check_welds(before_.model, tree_, before_.relations->element_uses, connections::WeldCheckOptions{});
    const Result<std::vector<std::uint32_t>> wanted = wanted_of(welds);
    if (!wanted) return fail(wanted.error());
    for (const CheckedWeld& weld : welds)
      if (is_broken(weld)) broken_.insert({weld.element_class, weld.element});
    for (const std::uint32_t w : *wanted) {
      const CheckedWeld& weld = welds[w];
      if (!is_broken(weld)) continue;
      ++mended_.broken;
      const std::string why = mend_one(weld);
      if (why.empty())
        ++mended_.mended;
      else if (mended_.left.size() < kMaxWeldsToldLeft)
        mended_.left.push_back({{weld.at.x(), weld.at.y(), weld.at.z()}, name_of(weld) + why});
    }
    return {};
  }

 private:
  static bool is_broken(const CheckedWeld& weld) { return weld.loose_by || !weld.joined; }
  const ElementBlock& block_of(const CheckedWeld& weld) const {
    return *before_.model.elements[static_cast<std::size_t>(weld.element_class)];
  }
  std::string name_of(const CheckedWeld& weld) const {
    return std::string(name(weld.element_class)) + ":" + std::to_string(block_of(weld).id[weld.element]);
  }

  /// Places in `welds`, ascending.
  Result<std::vector<std::uint32_t>> wanted_of(const std::vector<CheckedWeld>& welds) const {
    std::vector<std::uint32_t> wanted;
    std::map<std::string, std::uint32_t> places;
    for (std::uint32_t w = 0; w < welds.size(); ++w)
      edit_.at ? static_cast<void>(places.emplace(name_of(welds[w]), w)) : wanted.push_back(w);
    if (!edit_.at) return wanted;
    for (const std::string& each : *edit_.at) {
      const auto place = places.find(each);
      if (place == places.end()) return fail("", "repair_welds: \"at\": there is no weld " + each);
      wanted.push_back(place->second);
    }
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    return wanted;
  }

  /// Whether something else has the node: a shell, a card, a locked part, an element that isn't a broken weld, or a weld mended before.
  bool is_fixed(NodeIndex node) const {
    const Model& model = before_.model;
    if (!model.adjacency->shells_of(node).empty() || is_joined(*before_.relations, node)) return true;
    if ((before_.node_marks[node.value] & kLocked) != 0 || model.node_holds[node.value] != 0) return true;
    if (std::binary_search(moved_.begin(), moved_.end(), node)) return true;
    for (const ElementUse& use : uses_at(*before_.relations, node))
      if (!broken_.contains({use.element_class, use.element})) return true;
    return false;
  }

  std::string mend_one(const CheckedWeld& weld) {
    const ElementBlock& block = block_of(weld);
    if (const PartIndex part = block.part[weld.element]; part.valid() && (*before_.parts)[part.value].locked)
      return ": part:" + std::to_string((*before_.model.parts)[part.value].id) + " is locked";
    const std::uint32_t first = block.first_node[weld.element];
    const bool is_line = weld.element_class == ElementClass::beam || weld.element_class == ElementClass::discrete;
    if (!is_line || block.first_node[weld.element + 1] - first != 2) return ": this version mends beams and springs with two nodes";
    const std::array<NodeIndex, 2> nodes{block.nodes[first], block.nodes[first + 1]};
    const std::array<Vec3, 2> ends{next_.model.position(nodes[0]), next_.model.position(nodes[1])};
    const connections::WeldSeat seat =
        connections::seat_weld(before_.model, tree_, ends, {is_fixed(nodes[0]), is_fixed(nodes[1])}, {2, edit_.gap, edit_.max_move});
    if (!seat.why.empty()) return seat.why;
    for (std::size_t e = 0; e < 2; ++e)
      if (seat.to[e]) {
        next_.model.positions.set(nodes[e].value, *seat.to[e]);
        moved_.insert(std::upper_bound(moved_.begin(), moved_.end(), nodes[e]), nodes[e]);
      }
    return {};
  }

  const Generation& before_;
  const RepairWelds& edit_;
  Generation& next_;
  WeldsMended& mended_;
  spatial::BoxTree tree_;
  NodeSet moved_;  ///< so far
  std::set<std::pair<ElementClass, std::uint32_t>> broken_;
};

}  // namespace

Result<void> apply_edit(const Document& document, const RepairWelds& edit, Generation& next, EditReport& report) {
  const Generation& before = document.current();
  if (const Result<void> mended = WeldMender(before, edit, next, report).mend(); !mended) return mended;
  const WeldsMended& done = *report.welds_mended;
  const NodeSet moved = moved_nodes(before.model, next.model);
  report.nodes_moved = moved.size();
  report.largest_move = largest_move(before.model, next.model, moved);
  place_anew(moved, next);
  report.notes.push_back(done.broken == 0 ? std::string("no weld has a loose end or joins nothing")
                                          : "mended " + std::to_string(done.mended) + " of " + counted(done.broken, "weld") +
                                                " that had a loose end or joined nothing");
  if (!done.left.empty()) report.notes.push_back("left; the first: " + done.left.front().why);
  return {};
}

}  // namespace prismesh::mesh::document
