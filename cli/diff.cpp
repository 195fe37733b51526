#include <algorithm>
#include <ostream>

#include "cli/commands.h"
#include "cli/figures.h"
#include "cli/json_output.h"
#include "cli/line_diff.h"
#include "cli/progress_bar.h"
#include "cli/report_text.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/open.h"
#include "mesh/document/distance_fields.h"

namespace prismesh::cli {

namespace {

using mesh::deck::OpenedDeck;
using mesh::deck::SourceFile;

/// Compares two id indices, ascending: calls `both(index in a, index in b)` for ids in both and `only_in_b(id)`. Returns how many ids were
/// added and removed.
template <class Both, class OnlyInB>
std::pair<std::size_t, std::size_t> compare_ids(const mesh::IdIndex& a, const mesh::IdIndex& b, const Both& both,
                                                const OnlyInB& only_in_b) {
  std::size_t added = 0, removed = 0;
  for (std::size_t i = 0, j = 0; i < a.size() || j < b.size();) {
    if (j == b.size() || (i < a.size() && a.at(i).first < b.at(j).first)) {
      ++removed;
      ++i;
    } else if (i == a.size() || b.at(j).first < a.at(i).first) {
      ++added;
      only_in_b(b.at(j++).first);
    } else {
      both(a.at(i++).second, b.at(j++).second);
    }
  }
  return {added, removed};
}

void compare_nodes(const mesh::Model& a, const mesh::Model& b, Difference& difference) {
  const auto both = [&](std::uint32_t in_a, std::uint32_t in_b) {
    if (a.positions[in_a] == b.positions[in_b]) return;
    ++difference.nodes_moved;
    difference.moved.push_back(b.node_ids[in_b]);
  };
  std::tie(difference.nodes_added, difference.nodes_removed) =
      compare_ids(*a.node_index, *b.node_index, both, [&](std::int64_t id) { difference.added.push_back(id); });
}

void compare_elements(const mesh::Model& a, const mesh::Model& b, Difference& difference) {
  const auto add = [&](const mesh::IdIndex& from, const mesh::IdIndex& to) {
    const auto [added, removed] = compare_ids(
        from, to, [](std::uint32_t, std::uint32_t) {}, [](std::int64_t) {});
    difference.elements_added += added;
    difference.elements_removed += removed;
  };
  const auto both = [&](std::uint32_t in_a, std::uint32_t in_b) {
    const mesh::ShellNodes& from = a.shell_nodes[in_a];
    const mesh::ShellNodes& to = b.shell_nodes[in_b];
    bool same = true;
    for (std::size_t c = 0; c < 4; ++c) same = same && a.node_ids[from.node[c].value] == b.node_ids[to.node[c].value];
    if (!same) ++difference.elements_changed;
  };
  const auto [added, removed] = compare_ids(*a.shell_index, *b.shell_index, both, [](std::int64_t) {});
  difference.elements_added += added;
  difference.elements_removed += removed;
  for (std::size_t c = 0; c < a.elements.size(); ++c)
    if (a.elements[c] && b.elements[c]) add(mesh::IdIndex(a.elements[c]->id), mesh::IdIndex(b.elements[c]->id));
}

/// Matches include files by their path in the deck, and the main files with each other.
std::size_t compare_lines(const mesh::deck::Deck& a, const mesh::deck::Deck& b) {
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

Difference compare(const OpenedDeck& a, const OpenedDeck& b) {
  Difference difference;
  compare_nodes(a.model, b.model, difference);
  // the fields that also colour views; absent without common nodes or shells
  if (const auto field = mesh::document::displacement_field(a.model, b.model, LengthUnit::mm))
    difference.displacement = figures_of(*field, b.model);
  if (const auto field = mesh::document::surface_distance_field(a.model, b.model, LengthUnit::mm))
    difference.surface_distance = figures_of(*field, b.model);
  if (difference.displacement) difference.max_displacement = difference.displacement->max;
  compare_elements(a.model, b.model, difference);
  difference.lines_changed = compare_lines(*a.deck, *b.deck);
  return difference;
}

Result<OpenedDeck> open_one(const std::filesystem::path& path, const Context& context) {
  MonotonicClock clock;
  ProgressBar bar(context, "reading " + path.filename().string(), clock);
  Result<OpenedDeck> opened = mesh::deck::open(path, bar.progress());
  if (!opened && opened.error().file.empty()) opened.error().file = path.string();
  return opened;
}

}  // namespace

int diff(const DiffOptions& options, const Common& common, const Context& context) {
  const Result<OpenedDeck> a = open_one(options.a, context);
  const Result<OpenedDeck> b = a ? open_one(options.b, context) : a;
  if (!b) {
    say(context, b.error());
    return kFailed;
  }
  const Difference d = compare(*a, *b);
  if (common.json) {
    context.out << diff_json(d) << '\n';
    return kDone;
  }
  context.out << "nodes: " << d.nodes_moved << " moved (max " << rounded(d.max_displacement) << "), " << d.nodes_added << " added, "
              << d.nodes_removed << " removed\n"
              << "elements: " << d.elements_added << " added, " << d.elements_removed << " removed, " << d.elements_changed << " changed\n"
              << "lines: " << d.lines_changed << " changed\n";
  const auto say_field = [&](const char* what, const std::optional<FieldFigures>& field) {
    if (field && field->max > 0)
      context.out << what << ": max " << rounded(field->max) << " (" << field->max_at << "), mean " << rounded(field->mean) << " over "
                  << field->measured << " nodes\n";
  };
  if (!d.displacement) context.out << "displacement: the two decks have no node in common\n";
  say_field("displacement", d.displacement);
  say_field("distance of the second deck's shells from the first's", d.surface_distance);
  return kDone;
}

}  // namespace prismesh::cli
