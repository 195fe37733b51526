#include "mesh/deck/editing/segment_changes.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>

#include "mesh/deck/editing/names.h"
#include "mesh/deck/editing/referrer_text.h"
#include "mesh/deck/editing/text_place.h"

namespace prismesh::mesh::deck {
namespace {

using CornerIds = std::array<std::int64_t, 4>;  ///< a triangle repeats its third

std::span<const std::int64_t> distinct(const CornerIds& corners) { return std::span(corners).first(corners[3] == corners[2] ? 3 : 4); }

bool same_nodes(const CornerIds& a, const CornerIds& b) {
  return distinct(a).size() == distinct(b).size() && std::all_of(distinct(a).begin(), distinct(a).end(), [&](std::int64_t node) {
           return std::find(b.begin(), b.end(), node) != b.end();
         });
}

/// Whether two orders of the same corners have opposite directions.
bool runs_against(const CornerIds& a, const CornerIds& b) {
  const std::span<const std::int64_t> ring = distinct(b);
  const auto first = static_cast<std::size_t>(std::find(ring.begin(), ring.end(), a[0]) - ring.begin());
  return ring[(first + 1) % ring.size()] != a[1];
}

CornerIds reversed(const CornerIds& c) { return c[3] == c[2] ? CornerIds{c[0], c[2], c[1], c[1]} : CornerIds{c[0], c[3], c[2], c[1]}; }

CornerIds corner_ids(const Model& model, ShellIndex shell) {
  CornerIds ids{};
  for (std::size_t c = 0; c < 4; ++c) ids[c] = model.node_ids[model.shell(shell).node[c].value];
  return ids;
}

/// A shell of the deck, and the shells that it has become.
struct ShellChange {
  CornerIds before{};
  std::vector<CornerIds> after;  ///< none if it was removed
};

ShellChange change_of(const ModelDifference& difference, const ShellFamilies& families, ShellIndex shell) {
  ShellChange change{corner_ids(difference.original, shell), {}};
  if (!difference.model.is_removed(shell)) change.after.push_back(corner_ids(difference.model, shell));
  if (const auto family = families.find(shell); family != families.end())
    for (const ShellIndex child : family->second) change.after.push_back(corner_ids(difference.model, child));
  return change;
}

/// The corners of a segment, as in the model; nullopt: the format can't tell them.
std::optional<CornerIds> segment_at(const ModelDifference& difference, const Referrer& card, std::uint64_t line) {
  std::optional<CornerIds> corners = difference.writer.segment(text_of(difference.deck, card), card, line);
  if (!corners) return std::nullopt;
  for (std::int64_t& node : *corners) node = id_in_model(difference, Referred::node, node, card);
  return corners;
}

Result<std::vector<Replacement>> replace_segment(const ModelDifference& difference, const Referrer& card, std::uint64_t line,
                                                 const CornerIds& segment, const ShellChange& change) {
  if (Result<void> may = check_changeable(difference, card, line, "a segment of it would have to change"); !may) return fail(may.error());
  std::vector<CornerIds> with = change.after;
  const bool against = runs_against(segment, change.before);
  for (CornerIds& corners : with) {
    if (against) corners = reversed(corners);
    for (std::int64_t& node : corners) node = id_in_text(difference, Referred::node, node, card);
  }
  Result<std::vector<Replacement>> replaced = difference.writer.replace_segment(text_of(difference.deck, card), card, line, with);
  if (!replaced)
    return fail(refusal_at(difference.deck, card.file, line,
                           "a segment of " + card_name(difference.deck.format, card) + " " + replaced.error().message));
  return replaced;
}

Result<void> replace_segments_on(const ModelDifference& difference, const ShellChange& change, SegmentChanges& out) {
  if (change.after.size() == 1 && same_nodes(change.after[0], change.before)) return {};
  const References& references = *difference.deck.references;
  for (const Reference& reference : references.naming(Referred::node, change.before[0])) {
    const CardLine line{reference.referrer, reference.card};
    if (reference.role != ReferenceRole::segment || out.lines.contains(line)) continue;
    const Referrer& card = references.referrers()[reference.referrer];
    const std::optional<CornerIds> segment = segment_at(difference, card, line.offset);
    // A segment that can't be told forbids only the removal of its nodes, which is checked there.
    if (!segment || !same_nodes(*segment, change.before)) continue;
    Result<std::vector<Replacement>> replaced = replace_segment(difference, card, line.offset, *segment, change);
    if (!replaced) return fail(replaced.error());
    for (Replacement& replacement : *replaced) out.replacements.push_back({card.file, std::move(replacement)});
    out.lines.insert(line);
  }
  return {};
}

}  // namespace

Result<SegmentChanges> segment_changes(const ModelDifference& difference, const ShellFamilies& families) {
  const Changes& changes = difference.changes;
  std::set<ShellIndex> affected(changes.reshaped_shells.begin(), changes.reshaped_shells.end());
  affected.insert(changes.removed_shells.begin(), changes.removed_shells.end());
  for (const auto& [ancestor, children] : families) affected.insert(ancestor);
  SegmentChanges out;
  for (const ShellIndex shell : affected)
    if (Result<void> done = replace_segments_on(difference, change_of(difference, families, shell), out); !done) return fail(done.error());
  return out;
}

}  // namespace prismesh::mesh::deck
