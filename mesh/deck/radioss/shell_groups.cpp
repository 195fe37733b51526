#include "mesh/deck/radioss/shell_groups.h"

#include <algorithm>
#include <cstdlib>

#include "mesh/deck/radioss/block.h"
#include "mesh/deck/radioss/references.h"
#include "mesh/deck/radioss/text_columns.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::radioss {
namespace {

/// A block that uses a group of four-node shells and one of three-node shells on one line.
struct UserRule {
  std::string_view word;
  std::size_t line;              ///< from 0, the title's
  std::size_t quads, triangles;  ///< fields, from 0
};
constexpr UserRule kUserRules[] = {{"SECT", 3, 2, 6}, {"ACTIV", 1, 3, 7}};

/// Blocks that use groups of one kind, or of both in places that aren't read.
constexpr std::string_view kOtherUsers[] = {"GRSHEL/GRSHEL", "GRSH3N/GRSH3N", "GRNOD/GRSHEL",  "GRNOD/GRSH3N", "SURF/GRSHEL",
                                            "SURF/GRSH3N",   "LINE/GRSHEL",   "LINE/GRSH3N",   "PLY",          "PROP/PLY",
                                            "PROP/TYPE19",   "DRAPE",         "FAIL/ALTER",    "SET",          "FAIL/FRACTAL_DMG",
                                            "SLIPRING",      "THPART/GRSHEL", "THPART/GRSH3N", "TABLE/DRAPE"};

bool begins_with_words(std::string_view keyword, std::string_view words) {
  return keyword.starts_with(words) && (keyword.size() == words.size() || keyword[words.size()] == '/');
}

bool is_list(std::string_view keyword) { return keyword == "GRSHEL/SHEL" || keyword == "GRSHEL/SHELL" || keyword == "GRSH3N/SH3N"; }

/// The whole numbers in fields and between blanks.
std::vector<std::int64_t> numbers_in(std::string_view body) {
  std::vector<std::int64_t> numbers;
  const auto add = [&](std::string_view word) {
    std::int64_t number = 0;
    if (parse_integer(trim(word), number)) numbers.push_back(std::abs(number));
  };
  Lines lines(body, 0, body.size());
  std::string_view data;
  for (std::size_t offset = 0; lines.next(data, offset);) {
    const std::string plain = without_tabs(data);
    for (std::size_t f = 0; f * kField < plain.size(); ++f) add(field(plain, kField, f));
    for (std::size_t at = 0; (at = plain.find_first_not_of(' ', at)) != std::string::npos;) {
      const std::size_t end = std::min(plain.find(' ', at), plain.size());
      add(std::string_view(plain).substr(at, end - at));
      at = end;
    }
  }
  return numbers;
}

constexpr std::string_view kGroupWords[2] = {"GRSHEL", "GRSH3N"};

}  // namespace

ShellGroups::ShellGroups(const Deck& deck) : deck_(deck) {
  for (const Referrer& card : deck.references->referrers())
    if (is_old(card.style) || adds_to_ids(card.style))
      unclear_ = "and the cards that use it have old columns or stand in a submodel that adds to ids";
  for (std::uint32_t file = 0; file < deck.files.size(); ++file) search(file);
}

void ShellGroups::search(std::uint32_t file) {
  const std::string_view text = deck_.files[file].bytes.text();
  std::size_t line = 0;
  const auto next_line = [&](std::size_t from) {
    const std::size_t end = text.find('\n', from);
    return end == std::string_view::npos ? text.size() : end + 1;
  };
  const auto next_keyword = [&](std::size_t from) {
    while (from < text.size() && text[from] != '/') from = next_line(from);
    return from;
  };
  for (line = next_keyword(0); line < text.size();) {
    const std::size_t body = next_line(line), end = next_keyword(body);
    const Keyword keyword = keyword_at(text, line);
    const std::string words = keyword.joined();
    const std::string name = words + (keyword.number(0) > 0 ? " " + std::to_string(keyword.number(0)) : "");
    if (words == "END") return;
    if (text.substr(line).starts_with("//")) unclear_ = "and the deck has submodels";
    for (const Kind kind : {quads, triangles})
      if (keyword.word(0) == kGroupWords[kind]) ++groups_[kind][keyword.number(0)];
    for (const UserRule& rule : kUserRules)
      if (keyword.word(0) == rule.word) read_use(file, body, end, name, {"", 0, 0, {rule.quads, rule.triangles}, {}}, rule.line);
    for (const std::string_view other : kOtherUsers)
      if (begins_with_words(words, other)) read_other(text.substr(body, end - body), name);
    line = end;
  }
}

void ShellGroups::read_use(std::uint32_t file, std::size_t begin, std::size_t end, const std::string& name, const Use& places,
                           std::size_t line) {
  const std::string_view text = deck_.files[file].bytes.text();
  Use use = places;
  use.name = name;
  use.file = file;
  Lines lines(text, begin, end);
  std::string_view data;
  for (std::size_t i = 0; i <= line; ++i)
    if (!lines.next(data, use.line)) {
      unclear_ = "and " + name + ", which may use it, isn't complete in its file";
      return;
    }
  for (const Kind kind : {quads, triangles}) {
    const std::string plain = without_tabs(data);
    const std::string_view number = trim(field(plain, kField, use.field[kind]));
    if (!number.empty() && !parse_integer(number, use.group[kind])) unclear_ = "and " + name + " names its groups by parameters";
  }
  uses_.push_back(std::move(use));
}

void ShellGroups::read_other(std::string_view body, const std::string& name) {
  if (body.find('&') != std::string_view::npos) unclear_ = "and " + name + " names groups by parameters";
  if (body.find("#include") != std::string_view::npos) unclear_ = "and " + name + " goes on in an include";
  for (const std::int64_t number : numbers_in(body)) {
    if (name.find("GRSH3N") == std::string::npos) others_[quads].emplace(number, name);
    if (name.find("GRSHEL") == std::string::npos) others_[triangles].emplace(number, name);
  }
}

std::vector<const ShellGroups::Use*> ShellGroups::uses_of(Kind kind, std::int64_t group) const {
  std::vector<const Use*> found;
  for (const Use& use : uses_)
    if (use.group[kind] == group) found.push_back(&use);
  return found;
}

/// The list with the id, if it is the only group with it.
std::optional<std::uint32_t> ShellGroups::only_group(Kind kind, std::int64_t id) const {
  const auto count = groups_[kind].find(id);
  if (count == groups_[kind].end() || count->second != 1) return std::nullopt;
  const auto cards = deck_.references->referrers();
  for (std::uint32_t i = 0; i < cards.size(); ++i)
    if (cards[i].id == id && is_list(cards[i].keyword) && cards[i].keyword.starts_with(kGroupWords[kind])) return i;
  return std::nullopt;
}

Result<std::optional<std::uint32_t>> ShellGroups::companion(std::uint32_t set) const {
  const Referrer& card = deck_.references->referrers()[set];
  if (!is_list(card.keyword)) return fail("", "");
  const Kind kind = card.keyword.starts_with(kGroupWords[quads]) ? quads : triangles;
  const Kind other = kind == quads ? triangles : quads;
  if (!unclear_.empty()) return fail("", unclear_);
  if (only_group(kind, card.id) != set) return fail("", "and another group has its number");
  if (const auto user = others_[kind].find(card.id); user != others_[kind].end())
    return fail("", "and " + user->second + " uses it, which can't use a group of the other kind as well");
  const std::vector<const Use*> uses = uses_of(kind, card.id);
  std::int64_t with = 0;
  for (const Use* use : uses) {
    if (deck_.is_held(use->file)) return fail("", "and " + use->name + " uses it in an include that is used twice");
    if (use != uses.front() && use->group[other] != with) return fail("", "and is used with different groups of the other kind");
    with = use->group[other];
  }
  if (with == 0) {
    const std::string_view text = deck_.files[card.file].bytes.text();
    if (list_lines(text, card).empty() || is_include(text.substr(std::min<std::size_t>(card.end, text.size()))))
      return fail("", "and goes on in an include");
    return std::optional<std::uint32_t>();
  }
  const std::optional<std::uint32_t> there = only_group(other, with);
  const std::vector<const Use*> theirs = uses_of(other, with);
  const bool is_shared = std::any_of(theirs.begin(), theirs.end(), [&](const Use* use) { return use->group[kind] != card.id; });
  if (!there || is_shared || others_[other].contains(with))
    return fail("", "and the group that is used with it, " + std::string(kGroupWords[other]) + " " + std::to_string(with) +
                        ", is used elsewhere or isn't a list");
  return there;
}

std::vector<FileReplacement> ShellGroups::new_companion(std::uint32_t set, std::span<const std::int64_t> ids) const {
  const Referrer& card = deck_.references->referrers()[set];
  const Kind kind = card.keyword.starts_with(kGroupWords[quads]) ? quads : triangles;
  const Kind other = kind == quads ? triangles : quads;
  // The same number, or the next one that no group of the other kind has and no card names.
  std::int64_t id = card.id;
  while (groups_[other].contains(id) || others_[other].contains(id) || !uses_of(other, id).empty()) ++id;
  const std::string_view text = deck_.files[card.file].bytes.text();
  const std::vector<ListLine> lines = list_lines(text, card);
  const std::size_t end = lines.back().offset + lines.back().text.size();
  const std::string eol = line_end_at(text, end);
  std::string block =
      (kind == quads ? "/GRSH3N/SH3N/" : "/GRSHEL/SHEL/") + std::to_string(id) + eol + std::string(lines.front().text) + eol;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::string number = std::to_string(ids[i]);
    block += std::string(kField - std::min(kField, number.size()), ' ') + number;
    if (i % kIdsPerLine == kIdsPerLine - 1 || i + 1 == ids.size()) block += eol;
  }
  const std::size_t newline = text.find('\n', end);
  std::vector<FileReplacement> changes;
  if (newline == std::string_view::npos)
    changes.push_back({card.file, {text.size(), 0, eol + block}});
  else
    changes.push_back({card.file, {newline + 1, 0, std::move(block)}});
  for (const Use* use : uses_of(kind, card.id)) {
    const std::string_view theirs = deck_.files[use->file].bytes.text();
    const std::string_view old = line_at(theirs, use->line);
    std::string line = without_tabs(old);
    put(line, use->field[other] * kField, kField, std::to_string(id));
    changes.push_back({use->file, {use->line, old.size(), std::move(line)}});
  }
  return changes;
}

}  // namespace prismesh::mesh::deck::radioss
