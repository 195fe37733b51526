#include "mesh/deck/editing/tied_sets.h"

#include <algorithm>
#include <string>

#include "base/letter_case.h"

namespace prismesh::mesh::deck {
namespace {

constexpr int kMaxSetsOfSets = 8;  ///< levels

bool is_tie(const Referrer& card) {
  const std::string keyword = upper(card.keyword);
  const auto has = [&](const char* word) { return keyword.find(word) != std::string::npos; };
  return has("INTER/TYPE2") || (has("CONTACT") && (has("TIED") || has("SPOTWELD")));
}

/// Referrers of Radioss don't say what they define.
bool is_node_set(const Referrer& card) { return card.defines == Referred::node_set || card.keyword.starts_with("GRNOD"); }

bool is_tied(const References& references, const Referrer& set, int level) {
  if (set.id <= 0 || !is_node_set(set) || level > kMaxSetsOfSets) return false;
  for (const Reference& use : references.naming(Referred::node_set, set.id)) {
    const Referrer& user = references.referrers()[use.referrer];
    if (is_tie(user) || is_tied(references, user, level + 1)) return true;
  }
  return false;
}

}  // namespace

std::vector<std::uint32_t> tied_sets_of(const References& references, std::int64_t node) {
  std::vector<std::uint32_t> sets;
  for (const Reference& reference : references.naming(Referred::node, node)) {
    if (reference.role != ReferenceRole::list && reference.role != ReferenceRole::range) continue;
    const Referrer& set = references.referrers()[reference.referrer];
    const bool known = std::any_of(sets.begin(), sets.end(), [&](std::uint32_t s) { return same_set(references.referrers()[s], set); });
    if (!known && is_tied(references, set, 0)) sets.push_back(reference.referrer);
  }
  return sets;
}

}  // namespace prismesh::mesh::deck
