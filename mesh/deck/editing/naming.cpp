#include "mesh/deck/editing/naming.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "mesh/deck/formats/formats.h"
#include "mesh/deck/text/number.h"
#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck {
namespace {

/// More digits than this may be fields that touch.
constexpr std::size_t kNarrowestField = 8;

bool separates(char c) {
  return c == ' ' || c == ',' || c == '\t' || c == '\r' || c == '\n' || c == '(' || c == ')' || c == '=' || c == ':' || c == ';' ||
         c == '/';
}

void add_number(std::string_view word, std::vector<std::int64_t>& numbers) {
  std::int64_t value = 0;
  if (word.empty() || !parse_integer(word, value) || value == 0) return;
  numbers.push_back(value < 0 ? -value : value);
}

/// Nastran's fields may carry their sign or a letter in front ("+" continuations); digits that touch others are cut by columns.
void gather_of_line(std::string_view line, std::vector<std::int64_t>& numbers) {
  std::size_t longest = 0;
  for (std::size_t at = 0; at < line.size();) {
    std::size_t end = at;
    while (end < line.size() && !separates(line[end])) ++end;
    if (end > at) {
      add_number(line.substr(at, end - at), numbers);
      longest = std::max(longest, end - at);
    }
    at = end + 1;
  }
  if (longest <= kNarrowestField) return;
  for (const std::size_t width : {std::size_t{8}, std::size_t{10}, std::size_t{16}, std::size_t{20}})
    for (std::size_t at = 0; at < line.size(); at += width) add_number(trim(line.substr(at, width)), numbers);
}

std::string place(const Deck& deck, std::uint32_t file, std::size_t offset) {
  const SourceFile& source = deck.files[file];
  return source.relative.generic_string() + ":" + std::to_string(line_number(source.bytes.text(), offset));
}

Error refusal(const Deck& deck, std::uint32_t file, std::size_t offset, std::string message) {
  const SourceFile& source = deck.files[file];
  return Error{source.path.string(), line_number(source.bytes.text(), offset), std::move(message)};
}

}  // namespace

std::string card_name(Format format, const Referrer& card) {
  const bool star = (format == Format::ls_dyna || format == Format::abaqus) && card.keyword.substr(0, 1) != "*";
  std::string out = (star ? "*" : "") + card.keyword;
  if (card.id > 0) out += " " + std::to_string(card.id);
  return out;
}

std::string unread_name(const Deck& deck, const UnreadText& unread) {
  Referrer card;
  card.keyword = unread.keyword;
  return card_name(deck.format, card) + " isn't read in this version, and may name it";
}

std::vector<std::string> what_names(const Deck& deck, Referred referred, std::int64_t id, std::size_t most) {
  std::vector<Reference> naming = deck.references->naming(referred, id);
  const auto referrer = [&](const Reference& reference) -> const Referrer& { return deck.references->referrers()[reference.referrer]; };
  std::sort(naming.begin(), naming.end(), [&](const Reference& a, const Reference& b) {
    return std::tuple(referrer(a).file, a.card, a.referrer) < std::tuple(referrer(b).file, b.card, b.referrer);
  });
  std::vector<std::string> out;
  std::set<std::uint32_t> told;
  std::size_t more = 0;
  for (const Reference& reference : naming) {
    if (!told.insert(reference.referrer).second) continue;
    if (out.size() < most)
      out.push_back(card_name(deck.format, referrer(reference)) + " (" + place(deck, referrer(reference).file, reference.card) + ")");
    else
      ++more;
  }
  if (more > 0) out.push_back("and " + std::to_string(more) + " more");
  return out;
}

void UnreadNumbers::gather() {
  if (numbers_) return;
  numbers_.emplace();
  std::vector<std::int64_t> found;
  const auto unread = deck_.references->unread();
  for (std::uint32_t u = 0; u < unread.size(); ++u) {
    found.assign(unread[u].parameter_values.begin(), unread[u].parameter_values.end());
    if (!unread[u].encrypted)
      gather_whole_numbers(deck_.files[unread[u].file].bytes.text().substr(unread[u].begin, unread[u].end - unread[u].begin), found);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    for (const std::int64_t number : found) numbers_->emplace_back(number, u);
  }
  std::sort(numbers_->begin(), numbers_->end());
}

std::vector<std::uint32_t> UnreadNumbers::texts_with(Referred referred, std::int64_t id) const {
  // A transformed include has its ids less its offset; which one this text has doesn't matter where any of them would hit.
  std::set<std::int64_t> written{id};
  for (const IdOffsets& offsets : deck_.id_offsets)
    written.insert(id - (referred == Referred::node ? offsets.node : referred == Referred::part ? offsets.part : offsets.element));
  std::vector<std::uint32_t> texts;
  for (const std::int64_t number : written)
    for (auto at = std::lower_bound(numbers_->begin(), numbers_->end(), std::pair(number, std::uint32_t{0}));
         at != numbers_->end() && at->first == number; ++at)
      texts.push_back(at->second);
  std::sort(texts.begin(), texts.end());
  return texts;
}

const UnreadText* UnreadNumbers::holding_all(Referred referred, std::span<const std::int64_t> ids) {
  if (deck_.references->unread().empty()) return nullptr;
  gather();
  std::vector<std::uint32_t> all = texts_with(referred, ids.front());
  for (const std::int64_t id : ids.subspan(1)) {
    if (all.empty()) break;
    const std::vector<std::uint32_t> others = texts_with(referred, id);
    std::erase_if(all, [&](std::uint32_t text) { return !std::binary_search(others.begin(), others.end(), text); });
  }
  return all.empty() ? nullptr : &deck_.references->unread()[all.front()];
}

std::optional<Error> DeletionCheck::named_by_card(Referred referred, std::int64_t id, const std::string& what) const {
  for (const Reference& reference : deck_.references->naming(referred, id)) {
    if (reference.role != ReferenceRole::single && reference.role != ReferenceRole::segment) continue;
    const Referrer& card = deck_.references->referrers()[reference.referrer];
    const bool segment = reference.role == ReferenceRole::segment;
    return refusal(deck_, card.file, reference.card,
                   what + " can't be removed: " + (segment ? "a segment of " : "") + card_name(deck_.format, card) + " names it");
  }
  return std::nullopt;
}

std::optional<Error> DeletionCheck::named_unseen(const std::string& what) const {
  for (const UnreadText& unread : deck_.references->unread())
    if (unread.encrypted) return refusal(deck_, unread.file, unread.begin, what + " can't be removed: the encrypted text here may name it");
  if (!deck_.missing_files.empty())
    return Error{deck_.files[0].path.string(), 0,
                 what + " can't be removed: the include file " + deck_.missing_files.front() + " isn't there, and may name it"};
  return std::nullopt;
}

std::optional<Error> DeletionCheck::named_in_unread(Referred referred, std::int64_t id, const std::string& what) {
  const UnreadText* unread = unread_.holding_all(referred, std::span(&id, 1));
  if (unread == nullptr) return std::nullopt;
  return refusal(deck_, unread->file, unread->begin, what + " can't be removed: " + unread_name(deck_, *unread));
}

Result<void> DeletionCheck::may_be_deleted(Referred referred, std::int64_t id) {
  const std::string what = std::string(name(referred)) + " " + std::to_string(id);
  if (std::optional<Error> error = named_by_card(referred, id, what)) return fail(std::move(*error));
  return unnamed_in_unread(referred, id);
}

Result<void> DeletionCheck::unnamed_in_unread(Referred referred, std::int64_t id) {
  const std::string what = std::string(name(referred)) + " " + std::to_string(id);
  std::optional<Error> error = named_unseen(what);
  if (!error) error = named_in_unread(referred, id, what);
  if (error) return fail(std::move(*error));
  return {};
}

DivisionCheck::DivisionCheck(const Deck& deck) : deck_(deck), writer_(card_writer(deck.format)), unread_(deck) {}
DivisionCheck::~DivisionCheck() = default;

Result<void> DivisionCheck::may_be_divided(std::int64_t shell) {
  const std::string what = "shell " + std::to_string(shell) + " can't be divided: ";
  for (const Reference& reference : deck_.references->naming(Referred::shell, shell)) {
    if (reference.role != ReferenceRole::single) continue;
    const Referrer& card = deck_.references->referrers()[reference.referrer];
    if (writer_->inheritance(card, Referred::shell) == Inheritance::forbids)
      return fail(refusal(deck_, card.file, reference.card,
                          what + card_name(deck_.format, card) + " names it, which can't be passed on to its pieces"));
  }
  const UnreadText* unread = unread_.holding_all(Referred::shell, std::span(&shell, 1));
  if (unread == nullptr) return {};
  return fail(refusal(deck_, unread->file, unread->begin, what + unread_name(deck_, *unread)));
}

Result<void> DivisionCheck::may_be_between(std::span<const std::int64_t> nodes) {
  const UnreadText* unread = unread_.holding_all(Referred::node, nodes);
  if (unread == nullptr) return {};
  std::string named;
  for (const std::int64_t node : nodes) named += (named.empty() ? "" : ", ") + std::to_string(node);
  Referrer card;
  card.keyword = unread->keyword;
  return fail(refusal(deck_, unread->file, unread->begin,
                      "no node can come between the nodes " + named + ": " + card_name(deck_.format, card) +
                          " isn't read in this version, and may say of them what would hold of it too"));
}

Result<void> may_be_deleted(const Deck& deck, Referred referred, std::int64_t id) {
  return DeletionCheck(deck).may_be_deleted(referred, id);
}

void gather_whole_numbers(std::string_view text, std::vector<std::int64_t>& numbers) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    gather_of_line(text.substr(0, end), numbers);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

}  // namespace prismesh::mesh::deck
