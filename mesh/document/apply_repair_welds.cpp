#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/counted.h"
#include "base/readable_number.h"
#include "mesh/connections/check_welds.h"
#include "mesh/connections/seat_weld.h"
#include "mesh/connections/sheet_reach.h"
#include "mesh/deck/editing/tied_sets.h"
#include "mesh/document/apply.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/grow_relations.h"
#include "mesh/document/history.h"
#include "mesh/document/part_marks.h"
#include "mesh/model/adjacency.h"
#include "mesh/model/topology_change.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::document {

namespace {

using connections::CheckedWeld;

constexpr std::size_t kMaxWeldsToldLeft = 1000;

/// Welds that hang together by their nodes, in a row.
struct WeldChain {
  std::vector<std::uint32_t> welds;  ///< places in the list of welds
  std::vector<NodeIndex> nodes;      ///< in order; fewer than two: they aren't in a row
};

class WeldMender {
 public:
  WeldMender(const Document& document, const RepairWelds& edit, Generation& next, EditReport& report)
      : document_(document),
        before_(document.current()),
        edit_(edit),
        next_(next),
        mended_(report.welds_mended.emplace()),
        all_(before_.model),
        seen_(all_),
        hidden_(hidden_parts(before_)) {
    ShellSet out;
    for (std::size_t s = 0; !hidden_.empty() && s < before_.model.shell_count(); ++s)
      if (is_hidden(ShellIndex(s)) && all_.contains(ShellIndex(s))) out.emplace_back(s);
    seen_.leave_out(out);
  }

  /// Errors: a name in "at" that is no weld.
  Result<void> mend() {
    welds_ = connections::check_welds(before_.model, all_, before_.relations->element_uses, connections::WeldCheckOptions{});
    for (std::uint32_t w = 0; w < welds_.size(); ++w) place_of_.emplace(std::pair(welds_[w].element_class, welds_[w].element), w);
    const Result<std::vector<std::uint32_t>> wanted = wanted_welds();
    if (!wanted) return fail(wanted.error());
    std::set<std::uint32_t> done;
    for (const std::uint32_t w : *wanted) {
      if (!is_broken(welds_[w]) || done.contains(w)) continue;
      const WeldChain chain = chain_of(w);
      done.insert(chain.welds.begin(), chain.welds.end());
      const std::string why = mend_chain(chain);
      for (const std::uint32_t each : chain.welds) {
        const CheckedWeld& weld = welds_[each];
        if (!is_broken(weld)) continue;
        ++mended_.broken;
        if (why.empty())
          ++mended_.mended;
        else if (mended_.left.size() < kMaxWeldsToldLeft)
          mended_.left.push_back({{weld.at.x(), weld.at.y(), weld.at.z()}, name_of(weld) + why});
      }
    }
    return {};
  }

 private:
  static bool is_broken(const CheckedWeld& weld) { return weld.loose_by || !weld.joined; }
  static bool is_line(const CheckedWeld& weld) {
    return weld.element_class == ElementClass::beam || weld.element_class == ElementClass::discrete;
  }
  bool is_hidden(ShellIndex shell) const {
    const PartIndex part = before_.model.shell_parts[shell.value];
    return !hidden_.empty() && part.valid() && hidden_[part.value] != 0;
  }
  const ElementBlock& block_of(const CheckedWeld& weld) const {
    return *before_.model.elements[static_cast<std::size_t>(weld.element_class)];
  }
  std::span<const NodeIndex> nodes_of(const CheckedWeld& weld) const {
    const ElementBlock& block = block_of(weld);
    return std::span(block.nodes)
        .subspan(block.first_node[weld.element], block.first_node[weld.element + 1] - block.first_node[weld.element]);
  }
  PartIndex part_of(const CheckedWeld& weld) const { return block_of(weld).part[weld.element]; }
  std::string name_of(const CheckedWeld& weld) const {
    return std::string(name(weld.element_class)) + ":" + std::to_string(block_of(weld).id[weld.element]);
  }
  std::string part_words(PartIndex part) const { return "part:" + std::to_string((*before_.model.parts)[part.value].id); }

  /// Places in the list, ascending.
  Result<std::vector<std::uint32_t>> wanted_welds() const {
    std::vector<std::uint32_t> wanted;
    std::map<std::string, std::uint32_t> places;
    for (std::uint32_t w = 0; w < welds_.size(); ++w)
      edit_.at ? static_cast<void>(places.emplace(name_of(welds_[w]), w)) : wanted.push_back(w);
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

  /// The welds of two nodes at a node.
  std::vector<std::uint32_t> welds_at(NodeIndex node) const {
    std::vector<std::uint32_t> found;
    for (const ElementUse& use : uses_at(*before_.relations, node))
      if (const auto place = place_of_.find({use.element_class, use.element}); place != place_of_.end())
        if (is_line(welds_[place->second]) && nodes_of(welds_[place->second]).size() == 2) found.push_back(place->second);
    return found;
  }

  /// From a weld on both sides along the nodes that it shares with one other each.
  WeldChain chain_of(std::uint32_t first) const {
    WeldChain chain;
    chain.welds = {first};
    if (!is_line(welds_[first]) || nodes_of(welds_[first]).size() != 2) return chain;
    chain.nodes = {nodes_of(welds_[first])[0], nodes_of(welds_[first])[1]};
    for (const bool forward : {true, false})
      while (true) {
        const NodeIndex end = forward ? chain.nodes.back() : chain.nodes.front();
        std::vector<std::uint32_t> more = welds_at(end);
        std::erase_if(more, [&](std::uint32_t w) { return std::find(chain.welds.begin(), chain.welds.end(), w) != chain.welds.end(); });
        if (more.size() != 1 || !before_.model.adjacency->shells_of(end).empty()) break;
        const auto nodes = nodes_of(welds_[more.front()]);
        const NodeIndex next = nodes[0] == end ? nodes[1] : nodes[0];
        if (std::find(chain.nodes.begin(), chain.nodes.end(), next) != chain.nodes.end()) break;
        chain.welds.push_back(more.front());
        chain.nodes.insert(forward ? chain.nodes.end() : chain.nodes.begin(), next);
      }
    return chain;
  }

  /// Whether something else has the node: a shell, a card, a locked part, an element that isn't of the chain.
  bool is_fixed(NodeIndex node, const WeldChain& chain) const {
    const Model& model = before_.model;
    if (!model.adjacency->shells_of(node).empty() || is_joined(*before_.relations, node)) return true;
    if ((before_.node_marks[node.value] & kLocked) != 0 || model.node_holds[node.value] != 0) return true;
    for (const ElementUse& use : uses_at(*before_.relations, node)) {
      const auto place = place_of_.find({use.element_class, use.element});
      if (place == place_of_.end() || std::find(chain.welds.begin(), chain.welds.end(), place->second) == chain.welds.end()) return true;
    }
    return false;
  }

  /// The parts to which contacts tie the weld's part, ids ascending; empty: cards don't tell.
  std::vector<std::int64_t> tied_parts(PartIndex part) const {
    const Model& model = before_.model;
    const bool is_added = model.topology_change && part.valid() && part.value >= model.topology_change->deck_parts;
    if (!part.valid() || is_added) return {};
    return deck::parts_tied_with(*document_.deck->references, (*model.parts)[part.value].id);
  }

  /// Why it can't be mended; empty: it is.
  std::string mend_chain(const WeldChain& chain) {
    if (chain.nodes.size() < 2) return ": this version mends beams and springs with two nodes";
    for (const std::uint32_t w : chain.welds)
      if (const PartIndex part = part_of(welds_[w]); part.valid() && (*before_.parts)[part.value].locked)
        return ": " + part_words(part) + " is locked";
    const Model& model = before_.model;
    std::vector<connections::WeldEnd> ends;
    for (const NodeIndex node : chain.nodes) {
      const Vec3& at = model.position(node);
      ends.push_back({at, is_fixed(node, chain)});
      const auto on = at.allFinite() ? all_.closest(at) : std::nullopt;
      if (on && is_hidden(on->shell) && on->distance <= connections::sheet_reach(model, on->shell, connections::Attachment::placed))
        return ": " + part_words(model.shell_parts[on->shell.value]) + ", on which it lies, is hidden";
    }
    connections::SeatOptions options;
    options.gap = edit_.gap;
    options.max_move = edit_.max_move;
    if (std::vector<std::int64_t> tied = tied_parts(part_of(welds_[chain.welds.front()])); !tied.empty())
      options.is_tied = [&model, tied = std::move(tied)](PartIndex part) {
        return part.valid() && std::binary_search(tied.begin(), tied.end(), (*model.parts)[part.value].id);
      };
    const connections::WeldSeat seat = connections::seat_weld(model, seen_, ends, options);
    if (!seat.why.empty()) return seat.why;
    for (std::size_t e = 0; e < chain.nodes.size(); ++e)
      if (seat.to[e]) next_.model.positions.set(chain.nodes[e].value, *seat.to[e]);
    return {};
  }

  const Document& document_;
  const Generation& before_;
  const RepairWelds& edit_;
  Generation& next_;
  WeldsMended& mended_;
  spatial::BoxTree all_, seen_;  ///< of all shells, and of those in sight
  std::vector<std::uint8_t> hidden_;
  std::vector<CheckedWeld> welds_;
  std::map<std::pair<ElementClass, std::uint32_t>, std::uint32_t> place_of_;  ///< in the list
};

}  // namespace

Result<void> apply_edit(const Document& document, const RepairWelds& edit, Generation& next, EditReport& report) {
  const Generation& before = document.current();
  if (const Result<void> mended = WeldMender(document, edit, next, report).mend(); !mended) return mended;
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
