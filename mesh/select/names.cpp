#include "mesh/select/names.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "base/letter_case.h"
#include "base/nearest_name.h"

namespace prismesh::mesh::select {

namespace {

bool begins(std::string_view text, std::string_view with) { return text.substr(0, with.size()) == with; }

/// Radioss' groups and surfaces by the first word of their keyword.
std::optional<Referred> group_kind(std::string_view keyword) {
  constexpr std::pair<std::string_view, Referred> kGroups[] = {
      {"GRNOD/", Referred::node_set},      {"GRSHEL/", Referred::shell_set}, {"GRSH3N/", Referred::shell_set},
      {"GRBEAM/", Referred::beam_set},     {"GRTRUS/", Referred::beam_set},  {"GRBRIC/", Referred::solid_set},
      {"GRSPRI/", Referred::discrete_set}, {"GRPART/", Referred::part_set},  {"GRQUAD/", Referred::element_set},
      {"GRTRIA/", Referred::element_set},  {"SURF/", Referred::segment_set}, {"LINE/", Referred::segment_set}};
  if (begins(keyword, "/")) keyword.remove_prefix(1);
  for (const auto& [word, kind] : kGroups)
    if (begins(keyword, word)) return kind;
  return std::nullopt;
}

/// The cards that use a set of Nastran decide what its numbers mean.
Referred kind_of_members(std::span<const Reference> members) {
  for (const Reference& member : members)
    if (member.referred == Referred::node) return Referred::node_set;
  for (const Reference& member : members)
    if (member.referred == Referred::part) return Referred::part_set;
  return Referred::element_set;
}

std::optional<Referred> set_kind(const Referrer& card, std::span<const Reference> members) {
  if (card.defines) return is_set(*card.defines) ? card.defines : std::nullopt;
  if (card.keyword == "NSET") return Referred::node_set;
  if (card.keyword == "ELSET") return Referred::element_set;
  if (card.keyword == "SET" || card.keyword == "SET1" || card.keyword == "SET3") return kind_of_members(members);
  return group_kind(card.keyword);
}

/// References by referrer, in the order of the lines; members that are removed come after the others of their line.
struct ByReferrer {
  explicit ByReferrer(const References& references) : first(references.referrers().size() + 1, 0) {
    for (const Reference& reference : references.all()) ++first[reference.referrer + 1];
    for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
    all.resize(references.all().size());
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    for (const Reference& reference : references.all()) all[next[reference.referrer]++] = reference;
    for (std::size_t r = 0; r + 1 < first.size(); ++r)
      std::stable_sort(
          all.begin() + static_cast<std::ptrdiff_t>(first[r]), all.begin() + static_cast<std::ptrdiff_t>(first[r + 1]),
          [](const Reference& a, const Reference& b) { return std::tie(a.card, a.takes_away) < std::tie(b.card, b.takes_away); });
  }
  std::span<const Reference> of(std::size_t referrer) const {
    return std::span(all).subspan(first[referrer], first[referrer + 1] - first[referrer]);
  }

  std::vector<std::size_t> first;
  std::vector<Reference> all;
};

std::string kind_word(Referred kind) {
  std::string word(name(kind));
  std::replace(word.begin(), word.end(), ' ', '_');
  return word;
}

std::string list_of(const std::vector<const NamedSet*>& sets) {
  constexpr std::size_t kMax = 5;
  std::string list;
  for (std::size_t i = 0; i < std::min(sets.size(), kMax); ++i)
    list += (i == 0 ? "" : i + 1 == sets.size() ? " or " : ", ") + sets[i]->label();
  if (sets.size() > kMax) list += " or " + std::to_string(sets.size() - kMax) + " more";
  return list;
}

/// Of sets with one name those of the preferred kind, if there are any.
std::vector<const NamedSet*> preferred_of(const std::vector<const NamedSet*>& found, const WantedSet& wanted) {
  std::vector<const NamedSet*> out;
  for (const NamedSet* set : found)
    if (set->kind == wanted.preferred) out.push_back(set);
  return out.empty() ? found : out;
}

std::string nothing_like(std::span<const NamedSet> sets, const WantedSet& wanted) {
  const std::string word = wanted.kind ? std::string(name(*wanted.kind)) : "set";
  std::vector<const NamedSet*> of_kind;
  for (const NamedSet& set : sets)
    if (!wanted.kind || set.kind == *wanted.kind) of_kind.push_back(&set);
  if (of_kind.empty()) return "there is no " + word + " in the deck";
  if (wanted.id > 0) {
    const auto apart = [&](const NamedSet* set) { return set->id > wanted.id ? set->id - wanted.id : wanted.id - set->id; };
    const NamedSet* nearest =
        *std::min_element(of_kind.begin(), of_kind.end(), [&](const NamedSet* a, const NamedSet* b) { return apart(a) < apart(b); });
    return "there is no " + word + " " + std::to_string(wanted.id) + "; the nearest is " + nearest->label();
  }
  std::vector<std::string_view> titles;
  for (const NamedSet* set : of_kind)
    if (!set->title.empty()) titles.push_back(set->title);
  const std::string no = "there is no " + word + " \"" + std::string(wanted.title.substr(0, 40)) + "\"";
  if (titles.empty()) return no + ": no " + word + " has a name; the first is " + of_kind.front()->label();
  return no + "; did you mean \"" + std::string(nearest_name(wanted.title, titles)) + "\"?";
}

}  // namespace

std::string NamedSet::label() const {
  if (id > 0) return kind_word(kind) + ":" + std::to_string(id);
  const char quote = title.find('"') == std::string::npos ? '"' : '\'';
  return kind_word(kind) + ":" + quote + title + quote;
}

std::vector<NamedSet> find_sets(const References& references) {
  const ByReferrer by_referrer(references);
  std::map<std::tuple<Referred, std::int64_t, std::string>, NamedSet> sets;
  for (std::size_t r = 0; r < references.referrers().size(); ++r) {
    const Referrer& card = references.referrers()[r];
    const std::span<const Reference> members = by_referrer.of(r);
    const std::optional<Referred> kind = set_kind(card, members);
    if (!kind || (card.id <= 0 && card.title.empty())) continue;
    NamedSet& set = sets[{*kind, std::max<std::int64_t>(card.id, 0), card.id > 0 ? "" : lower(card.title)}];
    set.kind = *kind;
    set.id = std::max<std::int64_t>(card.id, 0);
    if (set.title.empty()) set.title = card.title;
    set.intersects = set.intersects || card.keyword.find("_INTERSECT") != std::string::npos;
    set.members.insert(set.members.end(), members.begin(), members.end());
  }
  std::vector<NamedSet> out;
  out.reserve(sets.size());
  for (auto& [key, set] : sets) out.push_back(std::move(set));
  return out;
}

FoundSet find_set(std::span<const NamedSet> sets, const WantedSet& wanted) {
  const std::string title = lower(wanted.title);
  std::vector<const NamedSet*> found;
  for (const NamedSet& set : sets) {
    if (wanted.kind && set.kind != *wanted.kind) continue;
    if (wanted.id > 0 ? set.id == wanted.id : !set.title.empty() && lower(set.title) == title) found.push_back(&set);
  }
  if (found.empty()) return {nullptr, nothing_like(sets, wanted)};
  found = preferred_of(found, wanted);
  if (found.size() == 1) return {found.front(), ""};
  const std::string called = wanted.id > 0 ? std::to_string(wanted.id) : "\"" + std::string(wanted.title) + "\"";
  return {nullptr, "several sets are called " + called + ": write " + list_of(found)};
}

std::optional<std::uint32_t> find_file(std::span<const std::string> files, std::string_view name, std::string& problem) {
  const auto ends_like = [&](std::string_view file, bool any_case) {
    if (file.size() < name.size()) return false;
    const std::string_view end = file.substr(file.size() - name.size());
    const bool whole = end.size() == file.size() || file[file.size() - end.size() - 1] == '/';
    return whole && (any_case ? lower(end) == lower(name) : end == name);
  };
  std::vector<std::string_view> known(files.begin(), files.end());
  for (std::size_t f = 0; f < files.size(); ++f)
    if (files[f] == name) return static_cast<std::uint32_t>(f);
  for (const bool any_case : {false, true}) {
    std::vector<std::size_t> found;
    for (std::size_t f = 0; f < files.size(); ++f)
      if (ends_like(files[f], any_case)) found.push_back(f);
    if (found.size() == 1) return static_cast<std::uint32_t>(found.front());
    if (found.size() < 2) continue;
    problem = "several files are called \"" + std::string(name) + "\": write \"" + files[found[0]] + "\" or \"" + files[found[1]] + "\"";
    return std::nullopt;
  }
  // a name without folders is compared with names without folders: folders would count more than a mistyped letter
  std::vector<std::string_view> ends;
  for (const std::string_view file : known) ends.push_back(file.substr(file.rfind('/') + 1));
  const std::string_view end = name.substr(name.rfind('/') + 1);
  problem = "there is no file \"" + std::string(name.substr(0, 80)) + "\" in the deck";
  if (!ends.empty()) problem += "; did you mean \"" + std::string(nearest_name(end, ends)) + "\"?";
  return std::nullopt;
}

std::vector<PartIndex> parts_called(const std::vector<Part>& parts, std::string_view name) {
  std::vector<PartIndex> found;
  for (std::size_t p = 0; p < parts.size(); ++p)
    if (lower(parts[p].name) == lower(name)) found.emplace_back(p);
  return found;
}

std::string no_part_called(const std::vector<Part>& parts, std::string_view name) {
  std::vector<std::string_view> known;
  for (const Part& part : parts)
    if (!part.name.empty()) known.push_back(part.name);
  const std::string no = "there is no part \"" + std::string(name.substr(0, 40)) + "\"";
  return known.empty() ? no + ": no part has a name" : no + "; did you mean \"" + std::string(nearest_name(name, known)) + "\"?";
}

}  // namespace prismesh::mesh::select
