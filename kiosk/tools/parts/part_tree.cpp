#include "kiosk/tools/parts/part_tree.h"

#include <algorithm>
#include <numeric>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "base/letter_case.h"

namespace prismesh::kiosk::tools::parts {
namespace {

bool contains(std::string_view text, std::string_view wanted) {
  return std::search(text.begin(), text.end(), wanted.begin(), wanted.end(), [](char a, char b) { return lower(a) == lower(b); }) !=
         text.end();
}

int compare_names(std::string_view a, std::string_view b) {
  const auto less = [](char x, char y) { return static_cast<unsigned char>(lower(x)) < static_cast<unsigned char>(lower(y)); };
  if (std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), less)) return -1;
  return std::lexicographical_compare(b.begin(), b.end(), a.begin(), a.end(), less) ? 1 : 0;
}

template <class Number>
int compare(const Number& a, const Number& b) {
  return a < b ? -1 : b < a ? 1 : 0;
}

int compare_errors(const Errors& a, const Errors& b) { return compare(std::tuple(a.fail, a.warn), std::tuple(b.fail, b.warn)); }

}  // namespace

void PartTree::set_facts(PartFacts facts) {
  facts_ = std::move(facts);
  build();
}

void PartTree::forget() { *this = {}; }

void PartTree::set_filter(const std::string& text) {
  filter_ = text;
  build();
}

void PartTree::sort(SortBy by) {
  const bool counts = by == SortBy::shells || by == SortBy::errors;
  descending_ = by == by_ ? !descending_ : counts;
  by_ = by;
  build();
}

void PartTree::fold(std::size_t file) {
  if (const std::string& name = facts_.files[file].name; folded_.erase(name) == 0) folded_.insert(name);
  build();
}

void PartTree::choose(std::size_t row, Choice choice) {
  const std::vector<std::int64_t> here = parts_of(row);
  const auto begins = anchor_ ? std::ranges::find(rows_, *anchor_) : rows_.end();
  if (choice == Choice::up_to && begins != rows_.end()) {
    chosen_.clear();
    const auto from = static_cast<std::size_t>(begins - rows_.begin());
    for (std::size_t r = std::min(from, row); r <= std::max(from, row); ++r)
      for (const std::int64_t id : parts_of(r)) chosen_.insert(id);
  } else if (choice == Choice::other) {
    const bool all = std::ranges::all_of(here, [&](std::int64_t id) { return chosen_.contains(id); });
    for (const std::int64_t id : here) all ? void(chosen_.erase(id)) : void(chosen_.insert(id));
    anchor_ = rows_[row];
  } else {
    chosen_ = {here.begin(), here.end()};
    anchor_ = rows_[row];
  }
  find_acted_on();
}

void PartTree::choose_none() {
  chosen_.clear();
  anchor_.reset();
  find_acted_on();
}

/// The parts that a row stands for; of a file those that match.
std::vector<std::int64_t> PartTree::parts_of(std::size_t row) const {
  const TreeRow& at = rows_[row];
  if (!at.is_file()) return {facts_.parts[at.part].id};
  const std::vector<std::int64_t>& its = facts_.files[at.file].parts;
  std::vector<std::int64_t> ids;
  for (std::size_t p = 0; p < facts_.parts.size(); ++p)
    if (part_matches_[p] != 0 && std::ranges::binary_search(its, facts_.parts[p].id)) ids.push_back(facts_.parts[p].id);
  return ids;
}

void PartTree::build() {
  find_matches();
  rows_.clear();
  std::unordered_map<std::int64_t, std::size_t> place;  // in the order of the rows
  const std::vector<std::size_t> sorted = sorted_parts();
  for (std::size_t i = 0; i < sorted.size(); ++i) place.emplace(facts_.parts[sorted[i]].id, i);
  std::vector<std::uint8_t> in_file(sorted.size(), 0);
  for (const std::size_t file : sorted_files()) {
    std::vector<std::size_t> its;
    for (const std::int64_t id : facts_.files[file].parts)
      if (const auto found = place.find(id); found != place.end()) its.push_back(found->second);
    std::ranges::sort(its);
    for (const std::size_t i : its) in_file[i] = 1;
    std::erase_if(its, [&](std::size_t i) { return part_matches_[sorted[i]] == 0; });
    if (its.empty() && file_matches_[file] == 0) continue;
    rows_.push_back({file, TreeRow::kNone});
    if (folded(file)) continue;
    for (const std::size_t i : its) rows_.push_back({file, sorted[i]});
  }
  for (std::size_t i = 0; i < sorted.size(); ++i)
    if (in_file[i] == 0 && part_matches_[sorted[i]] != 0) rows_.push_back({TreeRow::kNone, sorted[i]});
  find_acted_on();
}

void PartTree::find_matches() {
  part_matches_.assign(facts_.parts.size(), 1);
  file_matches_.assign(facts_.files.size(), 1);
  if (filter_.empty()) return;
  std::set<std::int64_t> of_files;
  for (std::size_t f = 0; f < facts_.files.size(); ++f) {
    file_matches_[f] = contains(facts_.files[f].name, filter_) ? 1 : 0;
    if (file_matches_[f] != 0) of_files.insert(facts_.files[f].parts.begin(), facts_.files[f].parts.end());
  }
  for (std::size_t p = 0; p < facts_.parts.size(); ++p) {
    const PartRow& part = facts_.parts[p];
    const bool matches = contains(std::to_string(part.id), filter_) || contains(part.name, filter_) || of_files.contains(part.id);
    part_matches_[p] = matches ? 1 : 0;
  }
}

void PartTree::find_acted_on() {
  acted_on_.clear();
  for (std::size_t p = 0; p < facts_.parts.size(); ++p)
    if (part_matches_[p] != 0 && chosen(p)) acted_on_.push_back(p);
  acts_on_chosen_ = !acted_on_.empty();
  if (acts_on_chosen_) return;
  for (std::size_t p = 0; p < facts_.parts.size(); ++p)
    if (part_matches_[p] != 0) acted_on_.push_back(p);
}

std::vector<std::size_t> PartTree::sorted_parts() const {
  std::vector<std::size_t> order(facts_.parts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto before = [&](std::size_t i, std::size_t j) {
    const PartRow &a = facts_.parts[i], &b = facts_.parts[j];
    const int by_column = by_ == SortBy::name     ? compare_names(a.name, b.name)
                          : by_ == SortBy::shells ? compare(a.shells, b.shells)
                          : by_ == SortBy::errors ? compare_errors(a.errors, b.errors)
                                                  : compare(a.id, b.id);
    if (by_column != 0) return descending_ ? by_column > 0 : by_column < 0;
    return a.id < b.id;
  };
  std::ranges::stable_sort(order, before);
  return order;
}

/// Files have no id: by that they keep the deck's order.
std::vector<std::size_t> PartTree::sorted_files() const {
  std::vector<std::size_t> order(facts_.files.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto before = [&](std::size_t i, std::size_t j) {
    const FileRow &a = facts_.files[i], &b = facts_.files[j];
    const int by_column = by_ == SortBy::name     ? compare_names(a.name, b.name)
                          : by_ == SortBy::shells ? compare(a.shells, b.shells)
                          : by_ == SortBy::errors ? compare_errors(a.errors, b.errors)
                                                  : 0;
    return descending_ ? by_column > 0 : by_column < 0;
  };
  std::ranges::stable_sort(order, before);
  return order;
}

}  // namespace prismesh::kiosk::tools::parts
