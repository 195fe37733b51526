#include "mesh/contact/kept_contacts.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <tuple>
#include <utility>

#include "base/parallel_for.h"
#include "mesh/contact/changed_shells.h"
#include "mesh/contact/close_shells.h"
#include "mesh/contact/find_penetrations.h"
#include "mesh/contact/find_perforations.h"
#include "mesh/contact/perforation_depth.h"
#include "mesh/contact/shell_crossings.h"
#include "mesh/contact/shell_triangles.h"
#include "mesh/contact/sort_unique.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::contact {

namespace {

constexpr std::size_t kMaxChangedShare = 8;  ///< where more than one in so many changed, all is searched
constexpr double kCrossingsShare = 0.4;      ///< of the whole time
constexpr std::size_t kNearGrain = 512;
constexpr float kMaxSlack = 1.2F;  ///< shells are looked about together while the sides of their box are at most this many times their own

double half_perimeter(const spatial::FloatBox& box) {
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) sum += static_cast<double>(box.high[axis]) - static_cast<double>(box.low[axis]);
  return sum;
}

/// A set of shells, as a mark each.
class Marks {
 public:
  explicit Marks(std::size_t shells) : marks_(shells, 0) {}
  bool has(ShellIndex shell) const { return marks_[shell.value] != 0; }
  /// Whether it is new.
  bool add(ShellIndex shell) { return std::exchange(marks_[shell.value], std::uint8_t{1}) == 0; }
  /// Those of `shells` that are new.
  ShellSet add_all(std::span<const ShellIndex> shells) {
    ShellSet added;
    for (const ShellIndex shell : shells)
      if (add(shell)) added.push_back(shell);
    return added;
  }

 private:
  std::vector<std::uint8_t> marks_;
};

/// Shells within `reach` of some of `shells`, and others near by; in any order, and some more than once. On all cores.
ShellSet near_any(const spatial::BoxTree& tree, const ShellSet& shells, double reach) {
  std::vector<ShellSet> of_range((shells.size() + kNearGrain - 1) / kNearGrain);
  parallel_for(shells.size(), kNearGrain, [&](std::size_t begin, std::size_t end) {
    ShellSet& near = of_range[begin / kNearGrain];
    const auto look = [&](const spatial::FloatBox& box) {
      const Vec3 low(box.low[0], box.low[1], box.low[2]), high(box.high[0], box.high[1], box.high[2]);
      if (!can_decide(low) || !can_decide(high)) return;
      tree.near_box(low, high, reach, [&](ShellIndex shell, const spatial::FloatBox&) {
        near.push_back(shell);
        return true;
      });
    };
    spatial::FloatBox together;
    double own_sides = 0;  // of the shells in the box
    for (std::size_t s = begin; s < end; ++s) {
      if (!tree.contains(shells[s])) continue;
      const spatial::FloatBox box = tree.box_of(shells[s]);
      spatial::FloatBox both = together;
      both.add(box);
      if (own_sides > 0 && half_perimeter(both) <= kMaxSlack * (own_sides + half_perimeter(box))) {
        together = both;
        own_sides += half_perimeter(box);
        continue;
      }
      if (own_sides > 0) look(together);
      together = box;
      own_sides = half_perimeter(box);
      if (!(own_sides > 0)) look(box);  // a shell that is a point
    }
    if (own_sides > 0) look(together);
  });
  ShellSet all;
  for (const ShellSet& near : of_range) all.insert(all.end(), near.begin(), near.end());
  return all;
}

double max_of(const ContactThickness& thickness) {
  return thickness.of_shell.empty() ? 0 : std::max(0.0, *std::max_element(thickness.of_shell.begin(), thickness.of_shell.end()));
}

/// What a depth was measured by: the area of the shells at what is cut off, and the distances of the entering nodes.
spatial::FloatBox measured_box(const Model& model, const spatial::BoxTree& tree, const PerforationDepth& depth) {
  spatial::FloatBox pieces;
  if (depth.entering.empty()) return pieces;
  for (const NodeSet* nodes : {&depth.entering, &depth.other_cut_off})
    for (const NodeIndex node : *nodes)
      for (const ShellIndex shell : model.adjacency->shells_of(node))
        if (tree.contains(shell)) pieces.add(tree.box_of(shell));
  const auto margin = static_cast<float>((1 + 1e-6) * depth.max.value_or(0));
  for (std::size_t axis = 0; axis < 3; ++axis) pieces.low[axis] -= margin, pieces.high[axis] += margin;
  return pieces;
}

}  // namespace

/// The way from a state to another one.
class KeptContacts::Update {
 public:
  Update(const State& before, const State& after)
      : before_(before), after_(after), is_whole_(std::max(before.model.shell_count(), after.model.shell_count())) {}

  /// Whether little enough changed for it to be worth while.
  bool is_small() {
    if (before_.gap != after_.gap || before_.model.parts != after_.model.parts) return false;
    changed_ = changed_shells(before_.model, after_.model);
    if (before_.thickness != after_.thickness) {
      const auto &was = before_.thickness->of_shell, &is = after_.thickness->of_shell;
      for (std::size_t s = 0; s < std::min(was.size(), is.size()); ++s)
        if (was[s] != is[s]) changed_.emplace_back(s);
    }
    if (!same_chunks(before_.model.shell_parts, after_.model.shell_parts))
      for (std::size_t s = 0; s < std::min(before_.model.shell_count(), after_.model.shell_count()); ++s)
        if (before_.model.shell_parts[s] != after_.model.shell_parts[s]) changed_.emplace_back(s);
    sort_unique(changed_);
    return changed_.size() <= after_.model.shell_count() / kMaxChangedShare;
  }

  /// Brings the pairs up to date. `kept`: what was found before.
  Regions run(Pairs& pairs, Regions kept) {
    if (changed_.empty()) return kept;
    const ShellSet shells = shells_to_measure();
    measure(shells, pairs);
    take_connected(pairs, with_neighbours(shells));
    Regions next;
    add_perforations(group_crossings(after_.model, crossings_), next);
    next.penetrations = group_close_shells(after_.model, *after_.thickness, std::move(close_), crossings_, after_.gap, nullptr);
    add_kept_perforations(kept, next);
    const auto middle = static_cast<std::ptrdiff_t>(next.penetrations.size());
    for (Penetration& region : kept.penetrations)
      if (is_untouched(region)) next.penetrations.push_back(std::move(region));
    std::inplace_merge(next.penetrations.begin(), next.penetrations.begin() + middle, next.penetrations.end(),
                       [](const Penetration& x, const Penetration& y) { return comes_first(x, y); });
    return next;
  }

 private:
  /// The shells of all pairs that may have become, changed, or be no more.
  ShellSet shells_to_measure() {
    const double path = kMinPathInLeastDistances * std::max(before_.reach, after_.reach);
    ShellSet near = changed_;
    for (const State* state : {&before_, &after_}) {
      const ShellSet found = near_any(state->tree, changed_, path);
      near.insert(near.end(), found.begin(), found.end());
    }
    ShellSet shells = is_whole_.add_all(near);
    std::sort(shells.begin(), shells.end());
    return shells;
  }

  /// Brings the pairs of these shells up to date. All others are as before.
  void measure(const ShellSet& shells, Pairs& pairs) const {
    for (const ShellIndex shell : shells) {
      pairs.crossings.remove_of(shell);
      pairs.close.remove_of(shell);
    }
    ShellSet among;
    std::copy_if(shells.begin(), shells.end(), std::back_inserter(among), [&](ShellIndex shell) { return after_.tree.contains(shell); });
    const ShellSet near = near_any(after_.tree, among, after_.reach);
    among.insert(among.end(), near.begin(), near.end());
    sort_unique(among);
    const auto put = [&]<class Pair>(std::vector<Pair> found, PairPool<Pair>& pool) {
      for (Pair& pair : found)
        if (is_whole_.has(pair.a) || is_whole_.has(pair.b)) pool.add(std::move(pair));
    };
    put(find_shell_crossings(after_.model, after_.tree, &among), pairs.crossings);
    put(find_close_shells(after_.model, after_.tree, *after_.thickness, after_.gap, &among), pairs.close);
  }

  /// The shells at the nodes of those that were measured, too: with these other pairs were connected.
  ShellSet with_neighbours(const ShellSet& shells) {
    ShellSet front = shells;
    for (const State* state : {&before_, &after_})
      for (const ShellIndex shell : shells) add_at_nodes(*state, shell, front);
    return front;
  }

  void add_at_nodes(const State& state, ShellIndex shell, ShellSet& front) {
    if (!state.tree.contains(shell)) return;
    for (const NodeIndex node : state.model.shell(shell).node)
      for (const ShellIndex neighbour : state.model.adjacency->shells_of(node))
        if (is_whole_.add(neighbour)) front.push_back(neighbour);
  }

  /// Takes all pairs of the front, and of what is connected with it.
  void take_connected(const Pairs& pairs, ShellSet front) {
    const auto take = [&]<class Pair>(const PairPool<Pair>& pool, ShellIndex of, std::vector<bool>& taken, std::vector<Pair>& all) {
      pool.each_of(of, [&](std::uint32_t number, const Pair& pair) {
        if (taken[number]) return;
        taken[number] = true;
        for (const ShellIndex shell : {pair.a, pair.b}) {
          if (is_whole_.add(shell)) front.push_back(shell);
          add_at_nodes(after_, shell, front);
        }
        all.push_back(pair);
      });
    };
    std::vector<bool> crossings_taken(pairs.crossings.numbers()), close_taken(pairs.close.numbers());
    for (std::size_t i = 0; i < front.size(); ++i) {
      const ShellIndex shell = front[i];
      take(pairs.crossings, shell, crossings_taken, crossings_);
      take(pairs.close, shell, close_taken, close_);
    }
    const auto less = [](const auto& x, const auto& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); };
    std::sort(crossings_.begin(), crossings_.end(), less);
    std::sort(close_.begin(), close_.end(), less);
  }

  template <class Region>
  bool is_untouched(const Region& region) const {
    for (const ShellSet* shells : {&region.shells_a, &region.shells_b})
      for (const ShellIndex shell : *shells)
        if (is_whole_.has(shell)) return false;
    return true;
  }

  void add_perforations(std::vector<Perforation> found, Regions& next) const {
    const std::vector<PerforationDepth> depths = perforation_depths(after_.model, after_.tree, found, 0);
    for (std::size_t i = 0; i < found.size(); ++i) {
      next.perforations.push_back(std::move(found[i]));
      next.measured.push_back(measured_box(after_.model, after_.tree, depths[i]));
      next.depths.push_back(depths[i]);
    }
  }

  /// The depths of regions that stay are kept, too, where nothing changed that they were measured by.
  void add_kept_perforations(Regions& kept, Regions& next) const {
    if (kept.perforations.empty()) return;
    const bool same_structure = same_chunks(before_.model.shell_nodes, after_.model.shell_nodes);
    const spatial::FloatBox changed = changed_box();
    std::vector<Perforation> to_measure;
    for (std::size_t i = 0; i < kept.perforations.size(); ++i) {
      if (!is_untouched(kept.perforations[i])) continue;
      if (!same_structure || spatial::distance2(kept.measured[i], changed) <= 0) {
        to_measure.push_back(std::move(kept.perforations[i]));
        continue;
      }
      next.perforations.push_back(std::move(kept.perforations[i]));
      next.depths.push_back(std::move(kept.depths[i]));
      next.measured.push_back(kept.measured[i]);
    }
    add_perforations(std::move(to_measure), next);
    sort(next);
  }

  spatial::FloatBox changed_box() const {
    spatial::FloatBox box;
    for (const State* state : {&before_, &after_})
      for (const ShellIndex shell : changed_)
        if (state->tree.contains(shell)) box.add(state->tree.box_of(shell));
    return box;
  }

  static void sort(Regions& regions) {
    std::vector<std::size_t> order(regions.perforations.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(),
              [&](std::size_t x, std::size_t y) { return comes_first(regions.perforations[x], regions.perforations[y]); });
    Regions sorted;
    for (const std::size_t i : order) {
      sorted.perforations.push_back(std::move(regions.perforations[i]));
      sorted.depths.push_back(std::move(regions.depths[i]));
      sorted.measured.push_back(regions.measured[i]);
    }
    regions.perforations = std::move(sorted.perforations);
    regions.depths = std::move(sorted.depths);
    regions.measured = std::move(sorted.measured);
  }

  const State& before_;
  const State& after_;
  ShellSet changed_;
  Marks is_whole_;
  std::vector<ShellCrossing> crossings_;
  std::vector<CloseShells> close_;
};

bool KeptContacts::search(const StateToSearch& state, const Progress& progress) {
  if (progress && !progress(0)) return false;
  const bool same_thickness = at_ && at_->thickness == state.thickness && at_->gap == state.gap;
  State next{state.model, state.tree, state.thickness, state.gap, same_thickness ? at_->reach : state.gap + max_of(*state.thickness)};
  Regions found;
  std::optional<State> before = at_;
  std::optional<Update> update;
  if (before) update.emplace(*before, next);
  if (update && update->is_small()) {
    at_.reset();  // where there is no memory on the way, the next search begins anew
    found = update->run(pairs_, std::move(found_));
  } else {
    bool stopped = false;
    const auto from_to = [&](double from, double to) -> Progress {
      return [&, from, to](double fraction) {
        stopped = stopped || (progress && !progress(from + (to - from) * fraction));
        return !stopped;
      };
    };
    const std::vector<ShellCrossing> crossings = find_shell_crossings(next.model, next.tree, nullptr, from_to(0, kCrossingsShare));
    if (stopped) return false;
    std::vector<CloseShells> close =
        find_close_shells(next.model, next.tree, *next.thickness, next.gap, nullptr, from_to(kCrossingsShare, 1));
    if (stopped) return false;
    at_.reset();
    pairs_ = {};
    for (const ShellCrossing& crossing : crossings) pairs_.crossings.add(crossing);
    for (const CloseShells& pair : close) pairs_.close.add(pair);
    found.penetrations = group_close_shells(next.model, *next.thickness, std::move(close), crossings, next.gap, nullptr);
    found.perforations = group_crossings(next.model, crossings);
    found.depths = perforation_depths(next.model, next.tree, found.perforations, 0);
    for (const PerforationDepth& depth : found.depths) found.measured.push_back(measured_box(next.model, next.tree, depth));
  }
  at_ = std::move(next);
  found_ = std::move(found);
  return true;
}

}  // namespace prismesh::mesh::contact
