#include "mesh/document/branches.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <unordered_set>
#include <utility>

#include "mesh/document/edit_kinds.h"

namespace prismesh::mesh::document {

namespace {

using States = std::span<const std::shared_ptr<const Generation>>;

States newer(const Document& document) { return States(document.generations).subspan(document.cursor + 1); }

bool only_selects(const Generation& state) {
  const EditKind* kind = find_edit_kind(state.made_by);
  return kind != nullptr && kind->group == EditGroup::selection;
}

std::optional<std::size_t> place_in(States states, std::uint64_t generation) {
  const auto found = std::ranges::find_if(states, [&](const auto& each) { return each->number == generation; });
  return found == states.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - states.begin()));
}

}  // namespace

std::size_t bytes_of(States states) {
  std::size_t bytes = 0;
  for (const auto& state : states) bytes += state->own_bytes;
  return bytes;
}

bool leaves_branch(const Document& document) {
  const States states = newer(document);
  const auto is_fork = [&](const Branch& branch) { return place_in(states, branch.fork).has_value(); };
  return !std::ranges::all_of(states, [](const auto& state) { return only_selects(*state); }) ||
         (!states.empty() && std::ranges::any_of(document.branches, is_fork));
}

void put_newer_aside(Document& document) {
  if (leaves_branch(document)) {
    const States states = newer(document);
    document.branches.push_back({document.next_branch++, document.current().number, {states.begin(), states.end()}});
  }
  document.generations.resize(document.cursor + 1);
}

const Branch* find_branch(const Document& document, std::uint64_t number) {
  const auto found = std::ranges::find(document.branches, number, &Branch::number);
  return found == document.branches.end() ? nullptr : &*found;
}

void take_branch(Document& document, std::uint64_t number) {
  const auto found = std::ranges::find(document.branches, number, &Branch::number);
  std::vector<std::shared_ptr<const Generation>> states = std::move(found->states);
  document.branches.erase(found);
  put_newer_aside(document);
  std::ranges::move(states, std::back_inserter(document.generations));
}

void drop_branches(Document& document, std::size_t oldest) {
  auto& branches = document.branches;
  branches.erase(branches.begin(), branches.begin() + static_cast<std::ptrdiff_t>(std::min(oldest, branches.size())));
  for (std::size_t before = branches.size() + 1; branches.size() < before;) {
    before = branches.size();
    std::unordered_set<std::uint64_t> known;
    for (const auto& state : document.generations) known.insert(state->number);
    for (const Branch& branch : branches)
      for (const auto& state : branch.states) known.insert(state->number);
    std::erase_if(branches, [&](const Branch& branch) { return !known.contains(branch.fork); });
  }
}

Result<std::vector<Edit>> way_to(const Document& document, std::uint64_t generation) {
  // From the target back to the line of the current state; each branch on the way is entered at its fork and walked by redos.
  std::vector<std::pair<const Branch*, std::size_t>> entered;
  std::uint64_t at = generation;
  std::optional<std::size_t> place;
  while (!(place = place_in(document.generations, at))) {
    const Branch* holder = nullptr;
    for (const Branch& branch : document.branches)
      if (const auto within = place_in(branch.states, at)) {
        holder = &branch;
        entered.emplace_back(holder, *within + 1);
      }
    if (holder == nullptr || entered.size() > document.branches.size())
      return fail("", "the history has no state " + std::to_string(generation) + " any more");
    at = holder->fork;
  }
  std::vector<Edit> way(*place < document.cursor ? document.cursor - *place : 0, Undo{});
  way.resize(way.size() + (*place > document.cursor ? *place - document.cursor : 0), Redo{});
  for (std::size_t i = entered.size(); i-- > 0;) {
    way.emplace_back(TakeBranch{entered[i].first->number});
    way.resize(way.size() + entered[i].second, Redo{});
  }
  return way;
}

}  // namespace prismesh::mesh::document
