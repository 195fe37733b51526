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

namespace {

/// Adds the ids of a list or range; false: a range too long to be listed.
bool add_ids(const Reference& reference, std::vector<std::int64_t>& ids) {
  constexpr std::int64_t kMaxListed = 100'000;
  if ((reference.last - reference.first) / reference.step > kMaxListed) return false;
  for (std::int64_t id = reference.first; id <= reference.last; id += reference.step) ids.push_back(id);
  return true;
}

/// The parts that a tie names; nothing if it names something else too.
std::vector<std::int64_t> parts_of_tie(const References& references, std::uint32_t tie) {
  std::vector<std::int64_t> parts, sets;
  for (const Reference& reference : references.all()) {
    if (reference.referrer != tie) continue;
    if (reference.referred == Referred::part ? !add_ids(reference, parts)
                                             : reference.referred != Referred::part_set || !add_ids(reference, sets))
      return {};
  }
  for (const Reference& member : references.all(Referred::part)) {
    const Referrer& set = references.referrers()[member.referrer];
    if (set.defines != Referred::part_set || std::find(sets.begin(), sets.end(), set.id) == sets.end()) continue;
    if (member.takes_away || !add_ids(member, parts)) return {};
  }
  return parts;
}

}  // namespace

std::vector<std::int64_t> parts_tied_with(const References& references, std::int64_t part) {
  std::vector<std::uint32_t> ties;
  for (const Reference& reference : references.naming(Referred::part, part)) {
    const Referrer& card = references.referrers()[reference.referrer];
    if (is_tie(card)) ties.push_back(reference.referrer);
    if (card.defines != Referred::part_set || card.id <= 0) continue;
    for (const Reference& use : references.naming(Referred::part_set, card.id))
      if (is_tie(references.referrers()[use.referrer])) ties.push_back(use.referrer);
  }
  std::sort(ties.begin(), ties.end());
  ties.erase(std::unique(ties.begin(), ties.end()), ties.end());
  std::vector<std::int64_t> tied;
  for (const std::uint32_t tie : ties) {
    const std::vector<std::int64_t> parts = parts_of_tie(references, tie);
    // A side that names nothing is everything; with one part alone the other side isn't by parts.
    if (parts.size() < 2) return {};
    tied.insert(tied.end(), parts.begin(), parts.end());
  }
  std::sort(tied.begin(), tied.end());
  tied.erase(std::unique(tied.begin(), tied.end()), tied.end());
  return tied;
}

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
