#include "mesh/report/comparison.h"

#include <algorithm>
#include <string_view>
#include <tuple>
#include <utility>

#include "mesh/deck/data/deck.h"
#include "mesh/document/distance_fields.h"
#include "mesh/report/line_diff.h"

namespace prismesh::mesh::report {

namespace {

using deck::OpenedDeck;
using deck::SourceFile;

/// Compares two id indices, ascending: calls `both(index in a, index in b)` for ids in both, `only_in_a(id)` and `only_in_b(id)`. Returns
/// how many ids were added and removed.
template <class Both, class OnlyInA, class OnlyInB>
std::pair<std::size_t, std::size_t> compare_ids(const IdIndex& a, const IdIndex& b, const Both& both, const OnlyInA& only_in_a,
                                                const OnlyInB& only_in_b) {
  std::size_t added = 0, removed = 0;
  for (std::size_t i = 0, j = 0; i < a.size() || j < b.size();) {
    if (j == b.size() || (i < a.size() && a.at(i).first < b.at(j).first)) {
      ++removed;
      only_in_a(a.at(i++).first);
    } else if (i == a.size() || b.at(j).first < a.at(i).first) {
      ++added;
      only_in_b(b.at(j++).first);
    } else {
      both(a.at(i++).second, b.at(j++).second);
    }
  }
  return {added, removed};
}

void compare_nodes(const Model& a, const Model& b, Difference& difference) {
  const auto both = [&](std::uint32_t in_a, std::uint32_t in_b) {
    if (a.positions[in_a] == b.positions[in_b]) return;
    ++difference.nodes_moved;
    difference.moved.push_back(b.node_ids[in_b]);
  };
  std::tie(difference.nodes_added, difference.nodes_removed) = compare_ids(
      *a.node_index, *b.node_index, both, [&](std::int64_t id) { difference.removed.push_back(id); },
      [&](std::int64_t id) { difference.added.push_back(id); });
}

void compare_elements(const Model& a, const Model& b, Difference& difference) {
  const auto add = [&](const IdIndex& from, const IdIndex& to) {
    const auto [added, removed] = compare_ids(
        from, to, [](std::uint32_t, std::uint32_t) {}, [](std::int64_t) {}, [](std::int64_t) {});
    difference.elements_added += added;
    difference.elements_removed += removed;
  };
  const auto both = [&](std::uint32_t in_a, std::uint32_t in_b) {
    const ShellNodes& from = a.shell_nodes[in_a];
    const ShellNodes& to = b.shell_nodes[in_b];
    bool same = true;
    for (std::size_t c = 0; c < 4; ++c) same = same && a.node_ids[from.node[c].value] == b.node_ids[to.node[c].value];
    if (same) return;
    ++difference.elements_changed;
    difference.shells_changed.push_back(b.shell_ids[in_b]);
  };
  const auto [added, removed] = compare_ids(
      *a.shell_index, *b.shell_index, both, [&](std::int64_t id) { difference.shells_removed.push_back(id); },
      [&](std::int64_t id) { difference.shells_added.push_back(id); });
  difference.elements_added += added;
  difference.elements_removed += removed;
  for (std::size_t c = 0; c < a.elements.size(); ++c)
    if (a.elements[c] && b.elements[c]) add(IdIndex(a.elements[c]->id), IdIndex(b.elements[c]->id));
}

/// Matches include files by their path in the deck, and the main files with each other.
std::size_t compare_lines(const deck::Deck& a, const deck::Deck& b) {
  std::size_t changed = lines_changed(a.files[0].bytes.text(), b.files[0].bytes.text());
  std::vector<bool> seen(b.files.size(), false);
  for (std::size_t i = 1; i < a.files.size(); ++i) {
    const auto same =
        std::find_if(b.files.begin() + 1, b.files.end(), [&](const SourceFile& f) { return f.relative == a.files[i].relative; });
    if (same != b.files.end()) seen[static_cast<std::size_t>(same - b.files.begin())] = true;
    changed += lines_changed(a.files[i].bytes.text(), same == b.files.end() ? std::string_view() : same->bytes.text());
  }
  for (std::size_t j = 1; j < b.files.size(); ++j)
    if (!seen[j]) changed += lines_changed({}, b.files[j].bytes.text());
  return changed;
}

}  // namespace

Difference compare(const OpenedDeck& a, const OpenedDeck& b) {
  Difference difference;
  compare_nodes(a.model, b.model, difference);
  // the fields that also colour views; absent without common nodes or shells
  if (const auto field = document::displacement_field(a.model, b.model, LengthUnit::mm))
    difference.displacement = figures_of(*field, b.model);
  if (const auto field = document::surface_distance_field(a.model, b.model, LengthUnit::mm))
    difference.surface_distance = figures_of(*field, b.model);
  if (difference.displacement) difference.max_displacement = difference.displacement->max;
  compare_elements(a.model, b.model, difference);
  difference.lines_changed = compare_lines(*a.deck, *b.deck);
  return difference;
}

}  // namespace prismesh::mesh::report
