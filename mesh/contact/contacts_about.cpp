#include "mesh/contact/contacts_about.h"

#include <algorithm>
#include <iterator>

#include "mesh/contact/close_shells.h"
#include "mesh/contact/near_shells.h"
#include "mesh/contact/sort_unique.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::contact {

namespace {

bool is_in(const ShellSet& shells, ShellIndex shell) { return std::binary_search(shells.begin(), shells.end(), shell); }

/// Adds the shells of all pairs with a shell of `front`, whether they count or not, and those at their nodes: what may be of one region.
void add_partners(const ContactState& state, double gap, double reach, const ShellSet& front, ShellSet& partners) {
  const Model& model = state.model;
  const ShellSet among = shells_about(state, reach, front);
  ShellSet of_pairs;
  const auto add_pair = [&](ShellIndex a, ShellIndex b) {
    if (is_in(front, a) || is_in(front, b)) of_pairs.insert(of_pairs.end(), {a, b});
  };
  for (const ShellCrossing& crossing : find_shell_crossings(model, state.tree, &among)) add_pair(crossing.a, crossing.b);
  for (const CloseShells& pair : find_close_shells(model, state.tree, state.thickness, gap, &among)) add_pair(pair.a, pair.b);
  sort_unique(of_pairs);
  for (const ShellIndex shell : of_pairs)
    for (const NodeIndex node : model.shell(shell).node)
      for (const ShellIndex neighbour : model.adjacency->shells_of(node)) partners.push_back(neighbour);
}

}  // namespace

ShellSet shells_about(const ContactState& state, double reach, const ShellSet& whole) {
  ShellSet among;
  std::copy_if(whole.begin(), whole.end(), std::back_inserter(among), [&](ShellIndex shell) { return state.tree.contains(shell); });
  add_near_shells(state.tree, whole, reach, among);
  sort_unique(among);
  return among;
}

ShellSet shells_of_changed_regions(const ContactState& before, const ContactState& after, double gap, double reach, const ShellSet& changed,
                                   const ShellSet& about) {
  ShellSet front = about;
  front.insert(front.end(), changed.begin(), changed.end());
  for (const ContactState* state : {&before, &after}) add_near_shells(state->tree, changed, kMinPathInLeastDistances * reach, front);
  sort_unique(front);
  ShellSet whole = front;
  while (!front.empty()) {
    ShellSet partners;
    for (const ContactState* state : {&before, &after}) add_partners(*state, gap, reach, front, partners);
    sort_unique(partners);
    front.clear();
    std::set_difference(partners.begin(), partners.end(), whole.begin(), whole.end(), std::back_inserter(front));
    const auto middle = static_cast<std::ptrdiff_t>(whole.size());
    whole.insert(whole.end(), front.begin(), front.end());
    std::inplace_merge(whole.begin(), whole.begin() + middle, whole.end());
  }
  return whole;
}

FoundContacts find_contacts_about(const SeparationInput& input, const SeparationWish& wish, const SeparatedModel& before,
                                  const SeparatedModel& after, const ShellSet& moved, const ShellSet& about) {
  const ContactState was{before.model, before.tree, input.thickness}, is{after.model, after.tree, input.thickness};
  const ShellSet whole = shells_of_changed_regions(was, is, wish.gap, after.reach, moved, about);
  const ShellSet among = shells_about(is, after.reach, whole);
  FoundContacts found = find_contacts(input, wish, after.model, after.tree, &among);
  // Beside the whole regions there are pieces of others, which don't count as they are.
  std::erase_if(found.crossings, [&](const ShellCrossing& pair) { return !is_in(whole, pair.a) && !is_in(whole, pair.b); });
  std::erase_if(found.penetrations, [&](const Penetration& region) {
    return std::none_of(region.pairs.begin(), region.pairs.end(),
                        [&](const CloseShells& pair) { return is_in(whole, pair.a) || is_in(whole, pair.b); });
  });
  return found;
}

}  // namespace prismesh::mesh::contact
