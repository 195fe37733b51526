#include "mesh/deck/editing/new_ids.h"

#include <algorithm>
#include <limits>

#include "base/letter_case.h"
#include "mesh/deck/editing/ancestors.h"
#include "mesh/deck/editing/element_place.h"
#include "mesh/deck/formats/formats.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck {
namespace {

constexpr std::int64_t kMaxId = std::numeric_limits<std::int64_t>::max();
/// Steps of one search over taken ids and ranges: more than any deck has blocks of ids.
constexpr int kMaxSteps = 200'000;

/// Columns between the numbers of a range in unread text: more than two fields.
constexpr std::size_t kMaxBetween = 40;

/// The first id from `id` on that isn't in the index. Searches consecutive ids by bisection.
std::int64_t beyond_block(const IdIndex& index, std::int64_t id) {
  if (index.find(id) == IdIndex::kNotFound) return id;
  const std::size_t rank = index.lower_bound(id);
  std::size_t low = 0, high = index.size() - rank;  // the block holds `low` more, and not `high` more
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    if (index.at(rank + middle).first - id == static_cast<std::int64_t>(middle))
      low = middle;
    else
      high = middle;
  }
  const std::int64_t last = index.at(rank + low).first;
  return last == kMaxId ? kMaxId : last + 1;
}

/// The next id to try after `id`, which the reference names: past the end of a range without gaps, else the next one.
std::int64_t beyond(const Reference& reference, std::int64_t id) {
  const std::int64_t last = reference.step == 1 ? reference.last : id;
  return last == kMaxId ? kMaxId : last + 1;
}

/// "THRU" or "TO" between two numbers.
bool is_range_word(std::string_view between) {
  between = trim(between);
  return between.size() >= 2 && between.size() <= 4 && (upper(between) == "THRU" || upper(between) == "THR" || upper(between) == "TO");
}

/// Every whole number in the text, and the ranges "a THRU b".
void gather_numbers(std::string_view text, std::vector<std::int64_t>& numbers, std::vector<IdRange>& ranges) {
  std::size_t last_end = 0;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] < '0' || text[at] > '9') {
      ++at;
      continue;
    }
    std::int64_t value = 0;
    std::size_t digits = 0;
    const std::size_t begin = at;
    for (; at < text.size() && text[at] >= '0' && text[at] <= '9'; ++at)
      if (++digits <= 18) value = value * 10 + (text[at] - '0');
    if (digits <= 18 && value > 0 && (numbers.empty() || numbers.back() != value)) {
      if (!numbers.empty() && begin - last_end <= kMaxBetween && is_range_word(text.substr(last_end, begin - last_end)))
        ranges.push_back({numbers.back(), value});
      numbers.push_back(value);
    }
    last_end = at;
  }
}

}  // namespace

bool all_named_by(const References& references, Referred referred, std::span<const std::int64_t> parents, std::uint32_t referrer) {
  const Referrer& set = references.referrers()[referrer];
  return std::all_of(parents.begin(), parents.end(), [&](std::int64_t parent) {
    const std::vector<Reference> naming = references.naming(referred, parent);
    return std::any_of(naming.begin(), naming.end(), [&](const Reference& r) {
      return same_set(references.referrers()[r.referrer], set) && (r.role == ReferenceRole::list || r.role == ReferenceRole::range);
    });
  });
}

NewIds::NewIds(const Deck& deck, const Model& model) : deck_(deck), model_(model), writer_(card_writer(deck.format)) {
  for (const auto& block : model.elements)
    if (block && block->size() > 0) other_elements_.emplace_back(block->id);
  largest_in_shells_ = kMaxId;
  for (const CardRun& run : deck.shell_runs)
    largest_in_shells_ =
        std::min(largest_in_shells_, writer_->largest_shell_id(run.style) + std::min<std::int64_t>(0, deck.offsets_of(run).node));
}

Result<NewIds::IdSearch> NewIds::node_search(const NodeOrigin& origin) const {
  const NodeIndex example = example_node(model_, origin);
  if (!example.valid())
    return fail(deck_.files[0].path.string(),
                "a new node would have to stand in an include that is used twice, or beside nodes that have no cards of their own");
  const CardRun& run = deck_.run_of(example);
  IdSearch search{Referred::node, {}, run.file, deck_.last_ids[run.file].node, 1, 0};
  const std::int64_t offset = deck_.offsets_of(run).node;
  search.min = std::max<std::int64_t>(1, offset + 1);
  // Shells have narrower fields for node ids than nodes in some layouts, and in some files.
  search.max = std::min(writer_->largest_node_id(run.style) + std::min<std::int64_t>(offset, 0), largest_in_shells_);
  return search;
}

Result<std::int64_t> NewIds::placed_node(const NodeOrigin& origin, std::uint32_t joins) {
  if (joins != kJoinsNone) return node(origin);
  const Result<IdSearch> search = node_search(origin);
  return search ? find(*search) : fail(search.error());
}

Result<NewIds::IdSearch> NewIds::search_for_node(const NodeOrigin& origin) const {
  Result<IdSearch> search = node_search(origin);
  if (!search) return fail(search.error());
  for (int p = 0; p < origin.count(); ++p)
    for (const NodeIndex ancestor : deck_ancestors(model_, origin.parent[static_cast<std::size_t>(p)]))
      search->parents.push_back(model_.node_ids[ancestor.value]);
  std::sort(search->parents.begin(), search->parents.end());
  search->parents.erase(std::unique(search->parents.begin(), search->parents.end()), search->parents.end());
  return search;
}

Result<std::int64_t> NewIds::node(const NodeOrigin& origin) {
  const Result<IdSearch> search = search_for_node(origin);
  return search ? find(*search) : fail(search.error());
}

Result<bool> NewIds::take_node(const NodeOrigin& origin, std::int64_t wanted) {
  const Result<IdSearch> search = search_for_node(origin);
  if (!search) return fail(search.error());
  return take(*search, wanted);
}

Result<std::int64_t> NewIds::element(ElementClass element_class, std::uint32_t example) {
  const auto known = of_examples_.find({element_class, example});
  if (known != of_examples_.end()) return find(known->second);
  IdSearch search{referred(element_class), {}, 0, 0, 1, writer_->largest_shell_id(0)};
  const auto& block = model_.elements[static_cast<std::size_t>(element_class)];
  if (example == kNoExample) {
    if (block && !block->id.empty()) search.last_in_file = *std::max_element(block->id.begin(), block->id.end());
  } else {
    const Result<ElementPlace> place = place_of_element(deck_, model_, *writer_, element_class, example);
    if (!place) return fail(place.error());
    const std::int64_t offset = deck_.offsets_in(place->file).value_or(IdOffsets()).element;
    search.parents = {block->id[example]};
    search.file = place->file;
    search.last_in_file = place->last_in_file + offset;
    search.min = std::max<std::int64_t>(1, offset + 1);
    search.max = writer_->largest_shell_id(place->style) + std::min<std::int64_t>(offset, 0);
  }
  return find(of_examples_.emplace(std::pair(element_class, example), std::move(search)).first->second);
}

NewIds::IdSearch NewIds::search_for_shell(ShellIndex parent) const {
  const ShellIndex ancestor = deck_ancestor(model_, parent);
  const CardRun& run = deck_.run_of(ancestor);
  const std::int64_t offset = deck_.offsets_of(run).element;
  return {Referred::shell,
          {model_.shell_ids[ancestor.value]},
          run.file,
          deck_.last_ids[run.file].shell,
          std::max<std::int64_t>(1, offset + 1),
          writer_->largest_shell_id(run.style) + std::min<std::int64_t>(offset, 0)};
}

Result<std::int64_t> NewIds::shell(ShellIndex parent) { return find(search_for_shell(parent)); }

Result<bool> NewIds::take_shell(ShellIndex parent, std::int64_t wanted) { return take(search_for_shell(parent), wanted); }

bool NewIds::take(const IdSearch& search, std::int64_t wanted) {
  if (wanted < search.min || wanted > search.max || first_free(search, wanted, wanted) != wanted) return false;
  std::vector<std::int64_t>& given = given_[search.referred];
  given.insert(std::upper_bound(given.begin(), given.end(), wanted), wanted);
  return true;
}

Result<std::int64_t> NewIds::find(const IdSearch& search) {
  // The ids within all ranges that hold all parents: nothing has to be written for a new one to belong to these.
  const References& references = *deck_.references;
  std::optional<std::pair<std::int64_t, std::int64_t>> within;
  const std::vector<Reference> naming =
      search.parents.empty() ? std::vector<Reference>() : references.naming(search.referred, search.parents.front());
  for (const Reference& range : naming)
    if (range.role == ReferenceRole::range && range.step == 1 &&
        std::all_of(search.parents.begin(), search.parents.end(), [&](std::int64_t p) { return range.names(p); }))
      within = within ? std::pair(std::max(within->first, range.first), std::min(within->second, range.last))
                      : std::pair(range.first, range.last);
  std::int64_t& next = next_.try_emplace({search.referred, search.file}, search.last_in_file + 1).first->second;
  std::int64_t& lowest = lowest_.try_emplace(search.referred, 1).first->second;
  std::optional<std::int64_t> id;
  if (within) {
    const std::int64_t from = std::max(within->first, search.min);
    const std::int64_t to = std::min(within->second, search.max);
    if (from <= next) id = first_free(search, next, to);
    if (!id) id = first_free(search, from, to);
  }
  if (!id) id = first_free(search, std::max(next, search.min), search.max);
  if (!id && (id = first_free(search, std::max(lowest, search.min), search.max))) lowest = *id + 1;
  if (!id)
    return fail(deck_.files[search.file].path.string(),
                "no id is left for a new " + std::string(name(search.referred)) + ": those up to " + std::to_string(search.max) +
                    ", the largest that the file's fields hold, are taken, or lie in ranges of ids that mean something else");
  if (*id == next) ++next;
  std::vector<std::int64_t>& given = given_[search.referred];
  given.insert(std::upper_bound(given.begin(), given.end(), *id), *id);
  return *id;
}

std::optional<std::int64_t> NewIds::first_free(const IdSearch& search, std::int64_t from, std::int64_t to) {
  std::int64_t id = from;
  for (int step = 0; step < kMaxSteps && id <= to; ++step) {
    const std::int64_t before = id;
    id = beyond_taken(search.referred, id);
    if (id > to) break;
    id = beyond_references(search, id);
    if (id != before) continue;
    if (!named_in_unread(id)) return id;
    ++id;
  }
  return std::nullopt;
}

std::int64_t NewIds::beyond_taken(Referred referred, std::int64_t id) {
  const bool is_node = referred == Referred::node;
  if (const IdRange* taken = range_with(is_node ? deck_.taken.nodes : deck_.taken.elements, id); taken != nullptr)
    return taken->last == kMaxId ? kMaxId : taken->last + 1;
  if (is_node) {
    id = beyond_block(*model_.node_index, id);
  } else {
    // Some formats number all elements together.
    id = beyond_block(*model_.shell_index, id);
    for (const IdIndex& others : other_elements_) id = beyond_block(others, id);
    const auto& left_out = deck_.left_out_elements;
    if (std::binary_search(left_out.begin(), left_out.end(), id)) return id + 1;
  }
  const std::vector<std::int64_t>& given = given_[referred];
  return std::binary_search(given.begin(), given.end(), id) || was_removed(referred, id) ? id + 1 : id;
}

/// Ids of removed ones aren't given again: unread text may still name them.
bool NewIds::was_removed(Referred referred, std::int64_t id) {
  if (!model_.topology_change) return false;
  const TopologyChange& topology_change = *model_.topology_change;
  if (referred != Referred::node && referred != Referred::shell) return false;
  const std::size_t count = referred == Referred::node ? topology_change.removed_nodes.size() : topology_change.removed_shells.size();
  RemovedIds& removed = removed_[referred];
  if (removed.seen != count) {
    removed.seen = count;
    removed.ids.clear();
    if (referred == Referred::node)
      for (const NodeIndex node : topology_change.removed_nodes) removed.ids.push_back(model_.node_ids[node.value]);
    else
      for (const ShellIndex shell : topology_change.removed_shells) removed.ids.push_back(model_.shell_ids[shell.value]);
    std::sort(removed.ids.begin(), removed.ids.end());
  }
  return std::binary_search(removed.ids.begin(), removed.ids.end(), id);
}

std::int64_t NewIds::beyond_references(const IdSearch& search, std::int64_t id) const {
  for (const Reference& reference : deck_.references->naming(search.referred, id)) {
    if (reference.role == ReferenceRole::range && !search.parents.empty() &&
        all_named_by(*deck_.references, search.referred, search.parents, reference.referrer))
      continue;
    return beyond(reference, id);
  }
  return id;
}

bool NewIds::named_in_unread(std::int64_t id) {
  if (!unread_numbers_) {
    unread_numbers_.emplace();
    for (const UnreadText& unread : deck_.references->unread())
      if (!unread.encrypted)
        gather_numbers(deck_.files[unread.file].bytes.text().substr(unread.begin, unread.end - unread.begin), *unread_numbers_,
                       unread_ranges_);
    unite(unread_ranges_);
    std::sort(unread_numbers_->begin(), unread_numbers_->end());
  }
  return std::binary_search(unread_numbers_->begin(), unread_numbers_->end(), id) || range_with(unread_ranges_, id) != nullptr;
}

}  // namespace prismesh::mesh::deck
