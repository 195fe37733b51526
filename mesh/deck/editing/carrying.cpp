#include "mesh/deck/editing/carrying.h"

#include <algorithm>
#include <map>
#include <set>

#include "mesh/deck/editing/descent.h"
#include "mesh/deck/editing/naming.h"
#include "mesh/deck/editing/new_ids.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck {
namespace {

using Corners = std::array<std::int64_t, 4>;
using CardKey = std::pair<std::uint32_t, std::uint64_t>;  ///< referrer and offset of the line

std::span<const std::int64_t> distinct(const Corners& corners) { return std::span(corners).first(corners[3] == corners[2] ? 3 : 4); }

bool same_nodes(const Corners& a, const Corners& b) {
  return distinct(a).size() == distinct(b).size() && std::all_of(distinct(a).begin(), distinct(a).end(), [&](std::int64_t node) {
           return std::find(b.begin(), b.end(), node) != b.end();
         });
}

/// Whether two orders of the same corners go around the other way.
bool runs_against(const Corners& a, const Corners& b) {
  const std::span<const std::int64_t> ring = distinct(b);
  const auto first = static_cast<std::size_t>(std::find(ring.begin(), ring.end(), a[0]) - ring.begin());
  return ring[(first + 1) % ring.size()] != a[1];
}

Corners reversed(const Corners& c) { return c[3] == c[2] ? Corners{c[0], c[2], c[1], c[1]} : Corners{c[0], c[3], c[2], c[1]}; }

/// Ids that join and leave a set.
struct ListChange {
  std::vector<std::int64_t> joining, leaving;
};

class Carrying {
 public:
  Carrying(const Deck& deck, const Model& original, const Model& model, const Changes& changes, const CardWriter& writer)
      : deck_(deck),
        references_(*deck.references),
        original_(original),
        model_(model),
        changes_(changes),
        writer_(writer),
        deletion_(deck),
        division_(deck) {}

  Result<Carried> run() {
    find_families();
    if (Result<void> done = segments(); !done) return fail(done.error());
    for (const NodeIndex node : changes_.added_nodes)
      if (Result<void> done = new_node(node); !done) return fail(done.error());
    for (const auto& [ancestor, children] : families_)
      if (Result<void> done = split_shell(ancestor, children); !done) return fail(done.error());
    for (const ShellIndex shell : changes_.removed_shells)
      if (Result<void> done = removed(Referred::shell, original_.shell_ids[shell.value]); !done) return fail(done.error());
    for (const NodeIndex node : changes_.removed_nodes)
      if (Result<void> done = removed(Referred::node, original_.node_ids[node.value]); !done) return fail(done.error());
    if (Result<void> done = write_copies(); !done) return fail(done.error());
    if (Result<void> done = write_lists(); !done) return fail(done.error());
    return std::move(out_);
  }

 private:
  const Referrer& referrer(const Reference& reference) const { return references_.referrers()[reference.referrer]; }
  std::string_view text_of(const Referrer& card) const { return deck_.files[card.file].bytes.text(); }
  tl::unexpected<Error> refuse(const Referrer& card, std::uint64_t offset, const std::string& message) const {
    return fail(deck_.files[card.file].path.string(), line_number(text_of(card), offset), message + "; nothing was written");
  }
  static Result<void> and_nothing_written(Result<void> checked) {
    if (!checked) checked.error().message += "; nothing was written";
    return checked;
  }
  std::string words(const Referrer& card) const { return card_name(deck_.format, card); }
  std::string keyword_of(const Referrer& card) const {
    Referrer kind;
    kind.keyword = card.keyword;
    return card_name(deck_.format, kind);
  }

  Result<void> changeable(const Referrer& card, std::uint64_t offset, const std::string& why) const {
    if (deck_.is_held(card.file)) return refuse(card, offset, words(card) + " stands in an include that is used twice, and " + why);
    if (!offsets_of(card))
      return refuse(
          card, offset,
          words(card) + " stands in an include without a mesh, so that it isn't known by how much its ids are shifted, and " + why);
    return {};
  }

  /// What the model's ids are more than those that the card gives; nullopt: it can't be told.
  std::optional<IdOffsets> offsets_of(const Referrer& card) const {
    return writer_.shifts_whole_files() ? offsets_in(deck_, card.file) : IdOffsets();
  }

  std::int64_t raw(Referred referred, std::int64_t id, const Referrer& card) const {
    const IdOffsets offsets = offsets_of(card).value_or(IdOffsets());
    return id - (referred == Referred::node ? offsets.node : offsets.element);
  }

  /// Shells of the deck with the added ones that come from them and are still there.
  void find_families() {
    for (const ShellIndex shell : changes_.added_shells) families_[deck_ancestor(model_, shell)].push_back(shell);
  }

  // --- what joins what ---

  /// Sets that name all of `parents`, each once; of a set on several cards, the first that names the first parent.
  std::vector<std::uint32_t> sets_of_all(Referred referred, const std::vector<std::int64_t>& parents) const {
    std::vector<std::uint32_t> sets;
    for (const Reference& reference : references_.naming(referred, parents.front()))
      if (reference.role == ReferenceRole::list || reference.role == ReferenceRole::range) sets.push_back(reference.referrer);
    std::sort(sets.begin(), sets.end());
    sets.erase(std::unique(sets.begin(), sets.end()), sets.end());
    std::erase_if(sets, [&](std::uint32_t set) { return !all_named_by(references_, referred, parents, set); });
    std::vector<std::uint32_t> once;
    for (const std::uint32_t set : sets)
      if (set_among(once, set) == once.end()) once.push_back(set);
    return once;
  }

  /// Where a card of the same set is among those of `sets`.
  std::vector<std::uint32_t>::const_iterator set_among(const std::vector<std::uint32_t>& sets, std::uint32_t card) const {
    const auto cards = references_.referrers();
    return std::find_if(sets.begin(), sets.end(), [&](std::uint32_t set) { return same_set(cards[set], cards[card]); });
  }

  /// Notes the sets that a new id joins. Errors: it would be caught by a range that doesn't hold all it comes from.
  Result<void> join_sets(Referred referred, std::int64_t id, const std::vector<std::int64_t>& parents) {
    const std::vector<std::uint32_t> sets = sets_of_all(referred, parents);
    std::set<std::uint32_t> captured;
    for (const Reference& reference : references_.naming(referred, id)) {
      const auto own = set_among(sets, reference.referrer);
      if (reference.role == ReferenceRole::range && own != sets.end()) {
        captured.insert(*own);
        continue;
      }
      const Referrer& card = referrer(reference);
      return refuse(card, reference.card,
                    "the new " + std::string(name(referred)) + " " + std::to_string(id) + " would be named by " + words(card) +
                        ", to which what it comes from doesn't belong; it needs another id");
    }
    for (const std::uint32_t set : sets)
      if (!captured.contains(set)) lists_[{set, referred == Referred::node}].joining.push_back(id);
    return {};
  }

  Result<void> new_node(NodeIndex node) {
    const std::int64_t id = model_.node_ids[node.value];
    std::vector<std::int64_t> parents;
    for (const NodeIndex ancestor : deck_ancestors(model_, node)) parents.push_back(model_.node_ids[ancestor.value]);
    if (Result<void> may = and_nothing_written(division_.may_be_between(parents)); !may) return may;
    if (Result<void> joined = join_sets(Referred::node, id, parents); !joined) return joined;
    // Cards that name one node alone count for what lies between where all are named by such a card.
    std::map<std::string, std::vector<Reference>> by_keyword;
    for (const Reference& reference : references_.naming(Referred::node, parents.front()))
      if (reference.role == ReferenceRole::single) by_keyword[referrer(reference).keyword].push_back(reference);
    for (const auto& [keyword, first] : by_keyword)
      if (Result<void> done = between_singles(id, parents, keyword, first); !done) return done;
    return {};
  }

  Result<void> between_singles(std::int64_t id, const std::vector<std::int64_t>& parents, const std::string& keyword,
                               const std::vector<Reference>& first) {
    const Reference& example = first.front();
    const Referrer& card = referrer(example);
    const Inheritance inheritance = writer_.inheritance(card, Referred::node);
    if (inheritance == Inheritance::stays) return {};
    std::vector<std::vector<Reference>> others;
    for (std::size_t p = 1; p < parents.size(); ++p) {
      std::vector<Reference>& singles = others.emplace_back();
      for (const Reference& reference : references_.naming(Referred::node, parents[p]))
        if (reference.role == ReferenceRole::single && referrer(reference).keyword == keyword) singles.push_back(reference);
      if (singles.empty()) return {};
    }
    const std::string between = "the new node " + std::to_string(id) + " lies between nodes that " + keyword_of(card);
    if (inheritance == Inheritance::forbids) return refuse(card, example.card, between + " names one by one, which can't be passed on");
    const Result<std::set<std::string>> wanted = copies_for(id, first);
    if (!wanted) return fail(wanted.error());
    for (const std::vector<Reference>& singles : others) {
      const Result<std::set<std::string>> own = copies_for(id, singles);
      if (!own) return fail(own.error());
      if (*own != *wanted) return refuse(card, example.card, between + " holds in different ways");
    }
    for (const Reference& reference : first) copies_[{reference.referrer, reference.card}][id] = {reference, Referred::node};
    return {};
  }

  /// What the cards would say of a new id. Errors: one of them can't be written for another.
  Result<std::set<std::string>> copies_for(std::int64_t id, const std::vector<Reference>& singles) const {
    std::set<std::string> texts;
    for (const Reference& single : singles) {
      const Referrer& card = referrer(single);
      const std::int64_t own = raw(Referred::node, id, card);
      const auto copies = writer_.copy_single(text_of(card), card, single, std::span(&own, 1));
      if (!copies)
        return refuse(
            card, single.card,
            "the new node " + std::to_string(id) + " can't have a card like this one: " + words(card) + " " + copies.error().message);
      for (const Replacement& copy : *copies) texts.insert(std::string(trim(copy.text)));
    }
    return texts;
  }

  Result<void> split_shell(ShellIndex ancestor, const std::vector<ShellIndex>& children) {
    const std::int64_t parent = original_.shell_ids[ancestor.value];
    if (Result<void> may = and_nothing_written(division_.may_be_divided(parent)); !may) return may;
    std::vector<std::int64_t> ids;
    for (const ShellIndex child : children) ids.push_back(model_.shell_ids[child.value]);
    for (const std::int64_t id : ids)
      if (Result<void> joined = join_sets(Referred::shell, id, {parent}); !joined) return joined;
    for (const Reference& reference : references_.naming(Referred::shell, parent)) {
      if (reference.role != ReferenceRole::single) continue;
      const Referrer& card = referrer(reference);
      if (writer_.inheritance(card, Referred::shell) == Inheritance::stays) continue;
      for (const std::int64_t id : ids) copies_[{reference.referrer, reference.card}][id] = {reference, Referred::shell};
    }
    return {};
  }

  // --- segments ---

  Corners corner_ids(const Model& model, ShellIndex shell) const {
    Corners ids{};
    for (std::size_t c = 0; c < 4; ++c) ids[c] = model.node_ids[model.shell(shell).node[c].value];
    return ids;
  }

  Result<void> segments() {
    std::set<ShellIndex> affected(changes_.reshaped_shells.begin(), changes_.reshaped_shells.end());
    affected.insert(changes_.removed_shells.begin(), changes_.removed_shells.end());
    for (const auto& [ancestor, children] : families_) affected.insert(ancestor);
    for (const ShellIndex shell : affected)
      if (Result<void> done = segments_on(shell); !done) return done;
    return {};
  }

  Result<void> segments_on(ShellIndex shell) {
    const Corners before = corner_ids(original_, shell);
    std::vector<Corners> after;
    if (!model_.is_removed(shell)) after.push_back(corner_ids(model_, shell));
    if (const auto family = families_.find(shell); family != families_.end())
      for (const ShellIndex child : family->second) after.push_back(corner_ids(model_, child));
    for (const Reference& reference : references_.naming(Referred::node, before[0])) {
      const CardKey key{reference.referrer, reference.card};
      if (reference.role != ReferenceRole::segment || replaced_segments_.contains(key)) continue;
      const Referrer& card = referrer(reference);
      const std::optional<Corners> raw_corners = writer_.segment(text_of(card), card, reference.card);
      if (!raw_corners) continue;  // whether it matters shows when a node of it goes
      Corners segment = *raw_corners;
      const std::int64_t offset = offsets_of(card).value_or(IdOffsets()).node;
      for (std::int64_t& node : segment) node += offset;
      if (!same_nodes(segment, before)) continue;
      if (Result<void> done = replace_segment(key, card, segment, before, after); !done) return done;
    }
    return {};
  }

  Result<void> replace_segment(const CardKey& key, const Referrer& card, const Corners& segment, const Corners& before,
                               std::vector<Corners> after) {
    if (after.size() == 1 && same_nodes(after[0], before)) return {};
    if (Result<void> may = changeable(card, key.second, "a segment of it would have to change"); !may) return may;
    const bool against = runs_against(segment, before);
    for (Corners& corners : after) {
      if (against) corners = reversed(corners);
      for (std::int64_t& node : corners) node = raw(Referred::node, node, card);
    }
    Result<std::vector<Replacement>> text = writer_.replace_segment(text_of(card), card, key.second, after);
    if (!text) return refuse(card, key.second, "a segment of " + words(card) + " " + text.error().message);
    take(card.file, std::move(*text));
    replaced_segments_.insert(key);
    ++out_.cards;
    return {};
  }

  // --- what goes ---

  Result<void> removed(Referred referred, std::int64_t id) {
    const std::string what = std::string(name(referred)) + " " + std::to_string(id);
    for (const Reference& reference : references_.naming(referred, id)) {
      const Referrer& card = referrer(reference);
      if (reference.role == ReferenceRole::list) {
        lists_[{reference.referrer, referred == Referred::node}].leaving.push_back(id);
      } else if (reference.role == ReferenceRole::single) {
        return refuse(card, reference.card, what + " can't be removed: " + words(card) + " names it");
      } else if (reference.role == ReferenceRole::segment && !replaced_segments_.contains({reference.referrer, reference.card})) {
        return refuse(card, reference.card, what + " can't be removed: a segment of " + words(card) + " names it");
      }
    }
    return and_nothing_written(deletion_.unnamed_in_unread(referred, id));
  }

  // --- writing ---

  void take(std::uint32_t file, std::vector<Replacement> replacements) {
    for (Replacement& replacement : replacements) out_.replacements.emplace_back(file, std::move(replacement));
  }

  Result<void> write_copies() {
    for (const auto& [key, copies] : copies_) {
      const Reference& single = copies.begin()->second.first;
      const Referrer& card = referrer(single);
      if (Result<void> may = changeable(card, key.second, "it would have to name new ones"); !may) return may;
      std::vector<std::int64_t> ids;
      for (const auto& [id, from] : copies) ids.push_back(raw(from.second, id, card));
      Result<std::vector<Replacement>> text = writer_.copy_single(text_of(card), card, single, ids);
      if (!text) return refuse(card, key.second, words(card) + " " + text.error().message);
      take(card.file, std::move(*text));
      ++out_.cards;
    }
    return {};
  }

  Result<void> write_lists() {
    for (auto& [key, change] : lists_) {
      const Referrer& card = references_.referrers()[key.first];
      if (Result<void> may = changeable(card, card.offset, "it would have to change"); !may) return may;
      for (std::vector<std::int64_t>* ids : {&change.joining, &change.leaving}) {
        std::sort(ids->begin(), ids->end());
        ids->erase(std::unique(ids->begin(), ids->end()), ids->end());
        for (std::int64_t& id : *ids) id = raw(key.second ? Referred::node : Referred::shell, id, card);
      }
      Result<std::vector<Replacement>> text = writer_.change_list(text_of(card), card, change.joining, change.leaving);
      if (!text) return refuse(card, card.offset, words(card) + " " + text.error().message);
      take(card.file, std::move(*text));
      ++out_.cards;
    }
    return {};
  }

  const Deck& deck_;
  const References& references_;
  const Model& original_;
  const Model& model_;
  const Changes& changes_;
  const CardWriter& writer_;
  DeletionCheck deletion_;
  DivisionCheck division_;
  std::map<ShellIndex, std::vector<ShellIndex>> families_;
  std::map<std::pair<std::uint32_t, bool>, ListChange> lists_;  ///< by set, and whether nodes change in it (else elements)
  std::map<CardKey, std::map<std::int64_t, std::pair<Reference, Referred>>> copies_;
  std::set<CardKey> replaced_segments_;
  Carried out_;
};

}  // namespace

std::optional<IdOffsets> offsets_in(const Deck& deck, std::uint32_t file) {
  const auto shifted = [](const IdOffsets& offsets) { return !(offsets == IdOffsets()); };
  if (std::none_of(deck.id_offsets.begin(), deck.id_offsets.end(), shifted)) return IdOffsets();
  std::optional<IdOffsets> found;
  for (const auto* runs : {&deck.node_runs, &deck.shell_runs})
    for (const CardRun& run : *runs) {
      if (run.file != file) continue;
      const IdOffsets offsets = deck.offsets_of(run);
      if (found && !(*found == offsets)) return std::nullopt;
      found = offsets;
    }
  // A file without a mesh tells nothing, but the main file is never shifted.
  if (!found && file == 0) return IdOffsets();
  return found;
}

Result<Carried> carry_along(const Deck& deck, const Model& original, const Model& model, const Changes& changes, const CardWriter& writer) {
  return Carrying(deck, original, model, changes, writer).run();
}

}  // namespace prismesh::mesh::deck
