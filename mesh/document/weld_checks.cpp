#include "mesh/document/weld_checks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "base/readable_number.h"
#include "mesh/deck/editing/tied_sets.h"
#include "mesh/document/deck_relations.h"
#include "mesh/model/topology_change.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::document {

namespace {

using connections::CheckedWeld;

class WeldChecker {
 public:
  explicit WeldChecker(const Document& document) : document_(document), model_(document.current().model) {}

  std::string name_of(const CheckedWeld& weld) const {
    return std::string(name(weld.element_class)) + ":" + std::to_string(block(weld).id[weld.element]);
  }
  std::string joined_words(const CheckedWeld& weld) const {
    std::string words;
    for (std::size_t s = 0; s < weld.sheets.size(); ++s) words += (s == 0 ? "" : " and ") + part_words(weld.sheets[s]);
    return words;
  }
  /// The sheets that no contact ties the weld's part to, where cards tell; ids.
  std::vector<std::int64_t> untied(const CheckedWeld& weld) {
    const PartIndex part = block(weld).part[weld.element];
    const bool is_added = model_.topology_change && part.valid() && part.value >= model_.topology_change->deck_parts;
    if (!part.valid() || is_added) return {};
    const auto [known, is_new] = tied_.try_emplace(part);
    if (is_new) known->second = deck::parts_tied_with(*document_.deck->references, (*model_.parts)[part.value].id);
    std::vector<std::int64_t> missing;
    if (known->second.empty()) return missing;
    for (const PartIndex sheet : weld.sheets)
      if (sheet.valid() && !std::binary_search(known->second.begin(), known->second.end(), (*model_.parts)[sheet.value].id))
        missing.push_back((*model_.parts)[sheet.value].id);
    return missing;
  }
  std::string part_words(PartIndex part) const {
    return part.valid() ? "part:" + std::to_string((*model_.parts)[part.value].id) : "shells without a part";
  }

 private:
  const ElementBlock& block(const CheckedWeld& weld) const { return *model_.elements[static_cast<std::size_t>(weld.element_class)]; }

  const Document& document_;
  const Model& model_;
  std::map<PartIndex, std::vector<std::int64_t>> tied_;
};

}  // namespace

WeldChecks check_welds(const Document& document, const connections::WeldCheckOptions& options) {
  const Generation& generation = document.current();
  const Model& model = generation.model;
  const std::vector<CheckedWeld> welds =
      connections::check_welds(model, spatial::BoxTree(model), generation.relations->element_uses, options);
  WeldChecks checks;
  checks.welds = welds.size();
  WeldChecker checker(document);
  for (const CheckedWeld& weld : welds) {
    const std::string name = checker.name_of(weld);
    const auto find = [&](const char* kind, const std::string& words) { checks.findings.push_back({kind, name + words, weld.at}); };
    if (weld.loose_by)
      find("loose-end", ": node:" + std::to_string(model.node_ids[weld.loose_end.value]) +
                            (std::isfinite(*weld.loose_by) ? " lies " + readable(*weld.loose_by, 4) + " from the nearest sheet"
                                                           : " has no sheet to lie on"));
    else if (!weld.joined)
      find("joins-nothing", " joins no two sheets: its ends lie on one, or are farther apart than a joint may be");
    for (const std::int64_t part : checker.untied(weld)) find("not-tied", ": no contact ties it to part:" + std::to_string(part));
    if (weld.edge_distance)
      find("near-edge", " is " + readable(*weld.edge_distance, 4) + " from a free edge of " + checker.joined_words(weld));
    if (weld.neighbour)
      find("near-weld", " is " + readable(weld.neighbour_distance, 4) + " from " + checker.name_of(welds[*weld.neighbour]));
  }
  return checks;
}

}  // namespace prismesh::mesh::document
