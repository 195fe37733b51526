#include "mesh/deck/findings.h"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "mesh/deck/editing/names.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::deck {
namespace {

/// Where something odd was found.
struct FindingPlace {
  std::uint32_t file = 0;
  std::uint64_t offset = 0;
  std::int64_t id = 0;
  std::uint32_t referrer = 0;
  Referred referred = Referred::node;
  auto order() const { return std::tuple(file, offset, id); }
};

/// Keeps the first places in the deck, and counts all.
class FirstPlaces {
 public:
  void add(const FindingPlace& place, std::size_t count = 1) {
    count_ += count;
    std::size_t at = kept_;
    while (at > 0 && place.order() < places_[at - 1].order()) --at;
    if (at == places_.size()) return;
    for (std::size_t i = std::min(kept_, places_.size() - 1); i > at; --i) places_[i] = places_[i - 1];
    places_[at] = place;
    kept_ = std::min(kept_ + 1, places_.size());
  }

  /// `message` makes the text of the first; the others are told by their lines.
  template <class Message>
  void note(Warnings& warnings, std::string_view kind, const Message& message) const {
    for (std::size_t i = 0; i < kept_; ++i)
      warnings.note(kind, places_[i].file, places_[i].offset, i == 0 ? message(places_[0]) : std::string(), 1);
    // Further places are only counted.
    if (kept_ > 0 && count_ > kept_) warnings.note(kind, places_[0].file, places_[0].offset, {}, count_ - kept_);
  }

 private:
  std::array<FindingPlace, 3> places_;
  std::size_t kept_ = 0;
  std::size_t count_ = 0;
};

std::optional<ElementClass> class_of(Referred referred) {
  switch (referred) {
    case Referred::shell: return ElementClass::shell;
    case Referred::beam: return ElementClass::beam;
    case Referred::solid: return ElementClass::solid;
    case Referred::tshell: return ElementClass::tshell;
    case Referred::discrete: return ElementClass::discrete;
    case Referred::mass: return ElementClass::mass;
    case Referred::sph: return ElementClass::sph;
    case Referred::other: return ElementClass::other;
    default: return std::nullopt;
  }
}

/// The format's word for a part.
std::string_view part_word(Format format) { return format == Format::nastran ? "property" : "part"; }

class Findings {
 public:
  Findings(const Deck& deck, const Model& model, Warnings& warnings)
      : deck_(deck), model_(model), references_(*deck.references), warnings_(warnings) {}

  void run() {
    note_unread();
    for (int r = 0; r < kReferredCount; ++r) note_undefined(static_cast<Referred>(r));
    ranges_.note(warnings_, "empty-range", [&](const FindingPlace& place) {
      return card(place) + " names a range from " + std::to_string(place.id) + " on in which nothing is defined";
    });
    sets_.note(warnings_, "names-undefined-set", [&](const FindingPlace& place) {
      return card(place) + " names " + std::string(name(place.referred)) + " " + std::to_string(place.id) + ", which isn't defined" +
             maybe();
    });
    note_parts();
    note_unused_nodes();
  }

 private:
  std::string card(const FindingPlace& place) const { return card_name(deck_.format, references_.referrers()[place.referrer]); }
  /// A missing include file may define what is missing.
  std::string maybe() const { return deck_.missing_files.empty() ? "" : "; an include file that isn't there may define it"; }

  void note_unread() {
    FirstPlaces encrypted, unread;
    std::set<std::string> keywords;
    for (const UnreadText& text : references_.unread()) {
      (text.encrypted ? encrypted : unread).add({text.file, text.begin, 0, 0, {}});
      Referrer named;
      named.keyword = text.keyword;
      if (!text.encrypted) keywords.insert(card_name(deck_.format, named));
    }
    encrypted.note(warnings_, "encrypted", [](const auto&) {
      return "encrypted text is kept as it is; what it holds isn't shown, and nothing it may name can be removed";
    });
    unread.note(warnings_, "unread-card", [&](const auto&) {
      std::string list;
      std::size_t told = 0;
      for (const std::string& keyword : keywords) {
        if (++told > kMaxKeywords) break;
        list += (told > 1 ? ", " : "") + keyword;
      }
      if (keywords.size() > kMaxKeywords) list += " and " + std::to_string(keywords.size() - kMaxKeywords) + " other keywords";
      return list + ": kept as they are, but not understood; nodes and elements whose numbers they hold can't be removed";
    });
  }

  // --- ids that cards name and nothing defines ---

  /// How many ids from first to last there are.
  template <class Ids>
  static std::int64_t count_in(const Ids& ids, std::int64_t first, std::int64_t last) {
    return static_cast<std::int64_t>(ids.lower_bound(last + 1)) - static_cast<std::int64_t>(ids.lower_bound(first));
  }

  /// Ids of one class of elements, or of all of them.
  struct KnownIds {
    const IdIndex* index = nullptr;
    IdIndex own;
    bool is_defined(std::int64_t id) const { return index && index->find(id) != IdIndex::kNotFound; }
  };

  KnownIds known_of(Referred referred) const {
    KnownIds known;
    if (referred == Referred::node) known.index = model_.node_index.get();
    if (referred == Referred::shell) known.index = model_.shell_index.get();
    if (known.index) return known;
    std::vector<std::int64_t> ids;
    if (const std::optional<ElementClass> element_class = class_of(referred)) {
      ids = model_.elements[static_cast<std::size_t>(*element_class)]->id;
    } else if (referred == Referred::any_element) {
      for (std::size_t s = 0; s < model_.shell_count(); ++s) ids.push_back(model_.shell_ids[s]);
      for (const auto& block : model_.elements)
        if (block) ids.insert(ids.end(), block->id.begin(), block->id.end());
    } else if (referred == Referred::part) {
      for (const Part& part : *model_.parts)
        if (part.defined) ids.push_back(part.id);
    }
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    known.own = IdIndex(ids);
    return known;
  }

  bool defined_elsewhere(Referred referred, std::int64_t id) const {
    if (!is_element(referred)) return references_.defined(referred, id);
    return std::binary_search(deck_.left_out_elements.begin(), deck_.left_out_elements.end(), id);
  }

  void note_undefined(Referred referred) {
    const std::span<const Reference> all = references_.all(referred);
    if (all.empty()) return;
    KnownIds known = known_of(referred);
    if (!known.index) known.index = &known.own;
    FirstPlaces undefined;
    for (const Reference& reference : all) {
      const FindingPlace at{references_.referrers()[reference.referrer].file, reference.card, reference.first, reference.referrer,
                            referred};
      if (reference.role == ReferenceRole::range) {
        if (reference.step == 1 && !is_set(referred) && reference.first > 1 && count_in(*known.index, reference.first, reference.last) == 0)
          ranges_.add(at);
        continue;
      }
      // The groups of Radioss don't say what they define (Referrer::defines).
      if (is_set(referred) && deck_.format == Format::radioss) continue;
      note_missing(referred, *known.index, reference, at, is_set(referred) ? sets_ : undefined);
    }
    undefined.note(warnings_, "names-undefined-" + std::string(name(referred)), [&](const FindingPlace& place) {
      const std::string what = referred == Referred::part ? std::string(part_word(deck_.format)) : std::string(name(referred));
      return card(place) + " names " + what + " " + std::to_string(place.id) + ", which isn't defined" + maybe();
    });
  }

  void note_missing(Referred referred, const IdIndex& ids, const Reference& reference, FindingPlace at, FirstPlaces& undefined) const {
    if (reference.first == reference.last) {
      if (ids.find(reference.first) == IdIndex::kNotFound && !defined_elsewhere(referred, reference.first)) undefined.add(at);
      return;
    }
    // Consecutive ids of a list are one reference: none is missing if there are as many ids.
    if (count_in(ids, reference.first, reference.last) == reference.last - reference.first + 1) return;
    std::size_t missing = 0;
    for (std::int64_t id = reference.first; id <= reference.last; id += reference.step) {
      if (ids.find(id) != IdIndex::kNotFound || defined_elsewhere(referred, id)) continue;
      if (missing++ == 0) at.id = id;
    }
    if (missing > 0) undefined.add(at, missing);
  }

  // --- parts and nodes that nothing uses ---

  /// Parts by index that elements or cards name.
  std::vector<std::uint8_t> used_parts() const {
    std::vector<std::uint8_t> used(model_.parts->size());
    const auto use = [&](PartIndex part) {
      if (part.valid()) used[part.value] = 1;
    };
    for (std::size_t s = 0; s < model_.shell_count(); ++s) use(model_.shell_parts[s]);
    for (const auto& block : model_.elements)
      if (block)
        for (const PartIndex part : block->part) use(part);
    const std::vector<Part>& parts = *model_.parts;
    std::size_t reach = 0;
    for (const Reference& reference : references_.all(Referred::part)) {
      const auto first =
          std::lower_bound(parts.begin(), parts.end(), reference.first, [](const Part& p, std::int64_t id) { return p.id < id; });
      for (auto p = std::max(reach, static_cast<std::size_t>(first - parts.begin())); p < parts.size() && parts[p].id <= reference.last;
           ++p) {
        used[p] = 1;
        reach = p + 1;
      }
    }
    return used;
  }

  void note_parts() {
    const std::vector<Part>& parts = *model_.parts;
    const std::vector<std::uint8_t> used = used_parts();
    FirstPlaces unused, undefined;
    std::vector<std::int64_t> lone;
    std::vector<std::size_t> nameless;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (parts[p].defined && !used[p]) lone.push_back(parts[p].id);
      if (!parts[p].defined && !references_.defined(Referred::part, parts[p].id)) nameless.push_back(p);
    }
    for (const Referrer& card : references_.referrers())
      if (card.defines == Referred::part && std::binary_search(lone.begin(), lone.end(), card.id)) {
        unused.add({card.file, card.offset, card.id, 0});
        lone.erase(std::lower_bound(lone.begin(), lone.end(), card.id));
      }
    const std::string word(part_word(deck_.format));
    for (const std::int64_t id : lone) unused.add({0, 0, id, 0, {}});
    unused.note(warnings_, "unused-part", [&](const auto& place) {
      return word + " " + std::to_string(place.id) + " is defined, but no element and no card uses it";
    });
    if (nameless.empty()) return;
    std::vector<std::uint8_t> wanted(parts.size());
    for (const std::size_t p : nameless) wanted[p] = 1;
    find_first_elements(wanted, undefined);
    for (const std::size_t p : nameless)
      if (wanted[p]) undefined.add({0, 0, parts[p].id, 0});
    undefined.note(warnings_, "undefined-part", [&](const auto& place) {
      if (deck_.format == Format::abaqus) return unsectioned(name_of(place.id)) + maybe();
      return "elements name " + word + " " + std::to_string(place.id) + ", which isn't defined" + maybe();
    });
  }

  static std::string unsectioned(const std::string& set) {
    return set.empty() ? "elements that are in no set have no section" : "the elements of set " + set + " have no section";
  }
  const std::string& name_of(std::int64_t part) const { return (*model_.parts)[model_.find_part(part).value].name; }

  /// Where shells first name each wanted part.
  void find_first_elements(std::vector<std::uint8_t>& wanted, FirstPlaces& undefined) const {
    for (std::size_t s = 0; s < model_.shell_count(); ++s) {
      const PartIndex part = model_.shell_parts[s];
      if (!part.valid() || !wanted[part.value]) continue;
      wanted[part.value] = 0;
      undefined.add({deck_.run_of(ShellIndex(s)).file, deck_.shell_line[s], (*model_.parts)[part.value].id, 0});
    }
  }

  /// Marks nodes that cards name, alone or in ranges. Overlapping ranges are searched once.
  void mark_named(std::vector<std::uint8_t>& used) const {
    const IdIndex& ids = *model_.node_index;
    std::size_t reach = 0;
    for (const Reference& reference : references_.all(Referred::node)) {
      if (reference.first == reference.last) {
        const std::uint32_t node = ids.find(reference.first);
        if (node != IdIndex::kNotFound) used[node] = 1;
        continue;
      }
      for (std::size_t rank = std::max(reach, ids.lower_bound(reference.first)); rank < ids.size(); ++rank) {
        const auto [id, node] = ids.at(rank);
        if (id > reference.last) break;
        used[node] = 1;
        reach = rank + 1;
      }
    }
  }

  void note_unused_nodes() {
    bool any_element = model_.shell_count() > 0;
    for (const auto& block : model_.elements) any_element |= block && block->size() > 0;
    // A file of nodes alone is meant to be included.
    if (!any_element) return;
    std::vector<std::uint8_t> used(model_.node_count());
    const Adjacency& adjacency = *model_.adjacency;
    for (std::size_t n = 0; n < used.size(); ++n)
      used[n] = adjacency.node_first[n] != adjacency.node_first[n + 1] || (model_.node_holds[n] & kHeldByMissing) != 0;
    for (const MidsideNodes& midside : *model_.midside)
      for (const NodeIndex node : midside.node)
        if (node.valid()) used[node.value] = 1;
    for (const auto& block : model_.elements)
      if (block)
        for (const NodeIndex node : block->nodes) used[node.value] = 1;
    mark_named(used);
    FirstPlaces unused;
    for (std::size_t n = 0; n < used.size(); ++n)
      if (!used[n]) unused.add({deck_.run_of(NodeIndex(n)).file, deck_.node_line[n], model_.node_ids[n], 0});
    unused.note(warnings_, "unused-node", [](const FindingPlace& place) {
      return "node " + std::to_string(place.id) + " belongs to no element, and no card names it";
    });
  }

  static constexpr std::size_t kMaxKeywords = 5;

  const Deck& deck_;
  const Model& model_;
  const References& references_;
  Warnings& warnings_;
  FirstPlaces ranges_;
  FirstPlaces sets_;
};

}  // namespace

void note_findings(const Deck& deck, const Model& model, Warnings& warnings) { Findings(deck, model, warnings).run(); }

}  // namespace prismesh::mesh::deck
