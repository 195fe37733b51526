#include "mesh/deck/editing/other_kind.h"

#include <algorithm>
#include <span>
#include <utility>

#include "mesh/deck/editing/deck_card.h"
#include "mesh/deck/editing/names.h"

namespace prismesh::mesh::deck {

bool has_midside_nodes(const Model& model, ShellIndex shell) {
  const auto& all = *model.midside;
  const auto at = std::lower_bound(all.begin(), all.end(), shell, [](const MidsideNodes& m, ShellIndex s) { return m.shell < s; });
  return at != all.end() && at->shell == shell;
}

const std::optional<std::string>& OtherKind::why_no_companion(std::uint32_t set) {
  const auto [known, is_new] = no_companion_.try_emplace(set);
  if (!is_new) return known->second;
  const Referrer& card = deck_.references->referrers()[set];
  const Result<std::optional<std::uint32_t>> companion = writer_.companion(deck_, set);
  if (!companion)
    known->second = companion.error().message;
  else if (const UnreadText* unread = unread_.holding_all(Referred::shell, std::span(&card.id, 1)); unread != nullptr)
    known->second = "and " + unread_name(deck_, *unread);
  else if (!deck_.missing_files.empty())
    known->second = "and the include file " + deck_.missing_files.front() + " isn't there, and may use it";
  return known->second;
}

std::string OtherKind::card_that_forbids(ShellIndex shell, bool triangle) {
  const References& references = *deck_.references;
  const std::int64_t id = original_.shell_ids[shell.value];
  for (const Reference& reference : references.naming(Referred::shell, id)) {
    const Referrer& card = references.referrers()[reference.referrer];
    if (reference.takes_away || writer_.can_name(card, triangle)) continue;
    const std::optional<std::string> none = reference.role == ReferenceRole::list ? why_no_companion(reference.referrer) : "";
    if (none) return card_name(deck_.format, card) + " names it, which can't name one" + (none->empty() ? "" : ", " + *none);
  }
  const UnreadText* unread = unread_.holding_all(Referred::shell, std::span(&id, 1));
  return unread != nullptr ? unread_name(deck_, *unread) : "";
}

/// The last shell before the given one in the same part and file that has the wanted number of corners and no mid-side nodes, else the
/// first after it; invalid: none.
ShellIndex OtherKind::find_neighbour(ShellIndex shell, bool triangle) const {
  const std::uint32_t file = deck_.run_of(shell).file;
  const auto fits = [&](ShellIndex other) {
    return original_.shell_parts[other.value] == original_.shell_parts[shell.value] && original_.shell(other).is_triangle() == triangle &&
           deck_.run_of(other).file == file && !has_midside_nodes(original_, other);
  };
  for (std::size_t other = shell.value; other-- > 0;)
    if (fits(ShellIndex(other))) return ShellIndex(other);
  for (std::size_t other = shell.value + 1; other < original_.shell_count(); ++other)
    if (fits(ShellIndex(other))) return ShellIndex(other);
  return {};
}

/// find_neighbour of the first shell that asks from this file and part; all others of them get the same answer.
ShellIndex OtherKind::neighbour_of(ShellIndex shell, bool triangle) {
  const std::tuple key(deck_.run_of(shell).file, original_.shell_parts[shell.value], triangle);
  const auto [known, is_new] = neighbours_.try_emplace(key);
  if (is_new) known->second = find_neighbour(shell, triangle);
  return known->second;
}

Result<OtherKind::Place> OtherKind::place(ShellIndex shell, const ShellCard& wanted) {
  const bool triangle = wanted.nodes[3] == wanted.nodes[2];
  const CardRef example = card_of(deck_, shell).ref();
  Place place;
  place.behind = neighbour_of(shell, triangle);
  if (place.behind.valid()) {
    Result<WrittenCard> written = writer_.shell_in_manner(example, card_of(deck_, place.behind).ref(), wanted);
    if (written) {
      place.card = std::move(*written);
      return place;
    }
    place.behind = {};
  }
  Result<CardWriter::NewBlock> block = writer_.block_of_kind(example, triangle);
  if (!block) return fail(block.error());
  Result<WrittenCard> written = writer_.shell_in_block(example, wanted);
  if (!written) return fail(written.error());
  if (written->by_parameter) return fail("", "has a field that a parameter gives");
  place.block = std::move(*block);
  place.card = std::move(*written);
  return place;
}

}  // namespace prismesh::mesh::deck
