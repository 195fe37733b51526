#include "mesh/contact/separate.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "base/readable_number.h"
#include "mesh/contact/contacts_about.h"
#include "mesh/contact/facing_sides.h"
#include "mesh/contact/meant_regions.h"
#include "mesh/contact/perforation_depth.h"
#include "mesh/contact/separation_check.h"
#include "mesh/contact/sort_unique.h"
#include "mesh/contact/spread_lifts.h"
#include "mesh/contact/try_regions.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::contact {

namespace {

constexpr int kMaxRounds = 30;
/// How steeply displacements fall off, the narrowest first: the first that does no harm is taken.
constexpr std::array kSlopes{0.3, 0.15, 0.08, 0.04, 0.02};
/// Tried where the surroundings lose a weld or are pushed into another part: so they move less.
constexpr std::array kSteepSlopes{0.6, 1.2, 2.4, std::numeric_limits<double>::infinity()};
constexpr double kMaxExcess = 0.05;                    ///< of the target size: how much farther than needed a node may go
constexpr double kMinCosOfWish = 0.17364817766693033;  ///< a wished direction within 80 degrees of the way out
constexpr double kMissing = 1e-5;                      ///< of the least distance
constexpr int kDigitsOfWhy = 3;

/// How nodes are moved.
struct Manner {
  bool each_its_own = false;  ///< directions
  bool by_nodes = false;      ///< each first as far as it must by itself; else triangle by triangle
};
/// The first that does no harm is taken.
constexpr std::array<Manner, 4> kManners{{{false, false}, {false, true}, {true, false}, {true, true}}};

/// One way to try.
struct Attempt {
  double upper_share = 1;
  Manner manner;
  double slope = 0;
};

/// What may help where an attempt failed.
enum class Fails : std::uint8_t { for_good, gentler_may_help, steeper_may_help, own_directions_may_help };

struct Outcome {
  SeparatedModel state;  ///< without its contacts
  Contacts at_moved;     ///< of the shells that changed
  NodeSet moved;
  std::string why;  ///< it failed; empty: it didn't
  Fails fails_by = Fails::for_good;
};

class RegionSeparator {
 public:
  RegionSeparator(const SeparationInput& input, const SeparationWish& wish, const SeparatedModel& before, const MeantRegion& region)
      : input_(input), wish_(wish), before_(before), region_(region) {}

  /// The first attempt that does no harm; if none, the reason of the gentlest of the first kind.
  Result<Outcome> separate(const Progress& progress, double fraction) const {
    Outcome first;
    const std::vector<double> all_shares = shares();
    for (const double share : all_shares) {
      const bool is_first = share == all_shares.front();
      bool own_may_help = false;
      for (const Manner& manner : kManners) {
        if (manner.each_its_own && (region_.perforation || wish_.direction || !own_may_help)) continue;
        Result<Outcome> outcome = try_slopes(share, manner, progress, fraction);
        if (!outcome || outcome->why.empty()) return outcome;
        own_may_help = own_may_help || outcome->fails_by == Fails::own_directions_may_help;
        if (first.why.empty() || (is_first && !manner.each_its_own && !manner.by_nodes)) first.why = outcome->why;
      }
    }
    return first;
  }

 private:
  /// The first slope that does no harm; if none, the gentlest but for those that are steeper than usual.
  Result<Outcome> try_slopes(double share, const Manner& manner, const Progress& progress, double fraction) const {
    Outcome gentlest;
    gentlest.fails_by = Fails::gentler_may_help;
    for (const double slope : kSlopes) {
      if (gentlest.fails_by != Fails::gentler_may_help) break;
      if (progress && !progress(fraction)) return fail(cancelled());
      gentlest = attempt({share, manner, slope});
      if (gentlest.why.empty()) return gentlest;
    }
    Fails fails_by = gentlest.fails_by;
    for (const double slope : kSteepSlopes) {
      if (fails_by != Fails::steeper_may_help) break;
      if (progress && !progress(fraction)) return fail(cancelled());
      Outcome outcome = attempt({share, manner, slope});
      if (outcome.why.empty()) return outcome;
      fails_by = outcome.fails_by;
    }
    return gentlest;
  }

  std::vector<double> shares() const {
    const bool upper = region_.may_move[region_.upper], lower = region_.may_move[region_.lower()];
    std::vector<double> shares;
    if (upper && lower && !region_.perforation) shares.push_back(0.5);
    if (upper) shares.push_back(1);
    if (lower) shares.push_back(0);
    return shares;
  }

  Outcome attempt(const Attempt& attempt) const {
    Outcome outcome;
    FacingSides sides(input_, wish_, before_.model, before_.tree, region_, attempt.manner.each_its_own);
    if (sides.cos_of_wish() < kMinCosOfWish) {
      outcome.why = "the direction runs along the shells there";
      return outcome;
    }
    SideLifts needed, lifts;
    outcome.state.model = before_.model;
    bool clear = false;
    if (attempt.manner.by_nodes) {
      sides.add_missing_of_nodes(attempt.upper_share, needed);
      outcome.why = why_not_lifted(needed, attempt.upper_share, sides, outcome.fails_by);
      if (!outcome.why.empty()) return outcome;
      lift(needed, attempt.slope, lifts, outcome);
    }
    for (int round = 0; round < kMaxRounds && !clear; ++round) {
      clear = sides.add_missing(outcome.state.model, lifts, attempt.upper_share, needed) <= kMissing * sides.reach();
      if (clear) break;
      outcome.why = why_not_lifted(needed, attempt.upper_share, sides, outcome.fails_by);
      if (!outcome.why.empty()) return outcome;
      lift(needed, attempt.slope, lifts, outcome);
    }
    if (!clear) {
      outcome.why = "its sides don't get clear of each other";
      outcome.fails_by = Fails::own_directions_may_help;
    } else {
      finish(sides, outcome);
    }
    return outcome;
  }

  void lift(const SideLifts& needed, double slope, SideLifts& lifts, Outcome& outcome) const {
    lifts.upper = spread(needed.upper, slope);
    lifts.lower = spread(needed.lower, slope);
    put(lifts, outcome);
  }

  void finish(const FacingSides& sides, Outcome& outcome) const {
    if (input_.carry) {
      const NodeSet carried = input_.carry(before_.model, outcome.moved, outcome.state.model);
      outcome.moved.insert(outcome.moved.end(), carried.begin(), carried.end());
      sort_unique(outcome.moved);
    }
    outcome.state.tree = before_.tree;
    outcome.state.states = before_.states;
    outcome.state.reach = before_.reach;
    Harm harm = harm_of(input_, wish_, before_, outcome.state, outcome.moved, {sides.upper(), sides.lower()});
    if (harm.why.empty() && input_.why_lost) {
      harm.why = input_.why_lost(before_.model, outcome.state.model, outcome.moved);
      harm.by_surroundings = !harm.why.empty();
    }
    outcome.why = std::move(harm.why);
    outcome.at_moved = std::move(harm.at_moved);
    outcome.fails_by = harm.to_shells ? Fails::gentler_may_help : harm.by_surroundings ? Fails::steeper_may_help : Fails::for_good;
  }

  Lifts spread(const Lifts& needed, double slope) const {
    return spread_lifts(before_.model, needed, slope, [&](NodeIndex node) { return input_.why_stays(node).empty(); });
  }

  /// Upper lifts go along their directions, lower ones against them; a node of both, at which the sides hang together, by both.
  void put(const SideLifts& lifts, Outcome& outcome) const {
    outcome.state.model.positions = before_.model.positions;
    std::map<NodeIndex, Vec3> by;
    for (const auto& [node, lift] : lifts.upper) by.try_emplace(node, Vec3::Zero()).first->second += lift.length * lift.direction;
    for (const auto& [node, lift] : lifts.lower) by.try_emplace(node, Vec3::Zero()).first->second -= lift.length * lift.direction;
    outcome.moved.clear();
    for (const auto& [node, move] : by) {
      outcome.state.model.positions.set(node.value, before_.model.position(node) + move);
      outcome.moved.push_back(node);
    }
  }

  std::string why_not_lifted(const SideLifts& needed, double upper_share, const FacingSides& sides, Fails& fails_by) const {
    double longest = 0, excess = 0;
    const auto look = [&](const Lifts& lifts, double share, std::string& why) {
      for (const auto& [node, lift] : lifts) {
        const std::string_view stays = input_.why_stays(node);
        if (!stays.empty() && why.empty()) why = "nodes of " + part_name(input_.model, part_at(node)) + " " + std::string(stays);
        longest = std::max(longest, lift.length);
        excess = std::max(excess, lift.length - share * region_.way / sides.cos_of_wish() - kMaxExcess * target_size_at(node));
      }
    };
    std::string why;
    look(needed.upper, upper_share, why);
    look(needed.lower, 1 - upper_share, why);
    if (!why.empty()) return why;
    if (wish_.max_move && longest > *wish_.max_move) return "max_move is too small: it takes " + readable(longest, kDigitsOfWhy);
    if (excess > 0) fails_by = Fails::own_directions_may_help;
    if (excess > 0)
      return "the way out is longer than the region is deep: a node would go " + readable(longest, kDigitsOfWhy) +
             (sides.any_stands() ? ", as shells stand more than 60 degrees steep on it" : "");
    return {};
  }

  PartIndex part_at(NodeIndex node) const {
    const auto shells = before_.model.adjacency->shells_of(node);
    return shells.empty() ? PartIndex{} : before_.model.shell_parts[shells.front().value];
  }
  double target_size_at(NodeIndex node) const { return input_.criteria.of(part_at(node)).target_size; }

  const SeparationInput& input_;
  const SeparationWish& wish_;
  const SeparatedModel& before_;
  const MeantRegion& region_;
};

/// What is to be tried for a region: each piece that could be pushed back, the one first whose longest move is the shortest.
std::vector<MeantRegion> ways_of(const SeparationInput& input, const SeparationWish& wish, const SeparatedModel& before,
                                 const MeantRegion& region) {
  std::vector<MeantRegion> ways{region};
  if (!region.perforation) return ways;
  std::vector<double> costs;
  const auto cost_of = [&](const MeantRegion& way) {
    SideLifts unused;
    return FacingSides(input, wish, before.model, before.tree, way, false).add_missing(before.model, {}, 1, unused);
  };
  costs.push_back(cost_of(region));
  for (EnteringPiece& piece : entering_pieces(input.model, input.tree, *region.perforation)) {
    if (!piece.is_larger && piece.depth.a_enters == (region.upper == 0)) continue;
    MeantRegion way = region;
    let_enter(wish, std::move(piece.depth), way);
    costs.push_back(cost_of(way));
    ways.push_back(std::move(way));
  }
  std::vector<std::size_t> order(ways.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) { return costs[x] < costs[y]; });
  std::vector<MeantRegion> sorted;
  for (const std::size_t i : order) sorted.push_back(std::move(ways[i]));
  return sorted;
}

/// The first way that does no harm; if none, the reason of the first.
Result<Outcome> separate_region(const SeparationInput& input, const SeparationWish& wish, const SeparatedModel& before,
                                const MeantRegion& region, const Progress& progress, double fraction) {
  Outcome first;
  for (const MeantRegion& way : ways_of(input, wish, before, region)) {
    Result<Outcome> outcome = RegionSeparator(input, wish, before, way).separate(progress, fraction);
    if (!outcome || outcome->why.empty()) return outcome;
    if (first.why.empty()) first.why = std::move(outcome->why);
  }
  return first;
}

/// The model after one pass over the regions, with the shells that each region changed.
struct Pass {
  SeparatedModel state;
  std::vector<ShellSet> touched;  ///< by region; empty: it was left
  std::vector<std::string> why;   ///< by region; empty: it was removed
};

Result<Pass> separate_all(const SeparationInput& input, const SeparationWish& wish, const SeparatedModel& before,
                          const std::vector<MeantRegion>& regions, const Progress& progress) {
  Pass pass{before, std::vector<ShellSet>(regions.size()), {}};
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const double fraction = static_cast<double>(i) / static_cast<double>(regions.size());
    if (progress && !progress(fraction)) return fail(cancelled());
    pass.why.push_back(regions[i].why_left);
    if (!pass.why.back().empty()) continue;
    Result<Outcome> outcome = separate_region(input, wish, pass.state, regions[i], progress, fraction);
    if (!outcome) return fail(outcome.error());
    pass.why.back() = outcome->why;
    if (!outcome->why.empty()) continue;
    const ShellSet& touched = pass.touched[i] = shells_touching(pass.state.model, outcome->moved);
    const auto has_moved = [&](ShellIndex shell) { return std::binary_search(touched.begin(), touched.end(), shell); };
    Contacts contacts = std::move(pass.state.contacts);
    std::erase_if(contacts, [&](const auto& entry) { return has_moved(entry.first.first) || has_moved(entry.first.second); });
    contacts.merge(outcome->at_moved);
    pass.state = std::move(outcome->state);
    pass.state.contacts = std::move(contacts);
  }
  return pass;
}

/// Marks the regions as left whose change made new contacts that the look at its neighbourhood missed. Returns whether there are any.
bool leave_harmful(const SeparatedModel& before, const Contacts& after, double gap, const Pass& pass, std::vector<MeantRegion>& regions) {
  bool any = false;
  for (const auto& [a, b] : worse_pairs(before.contacts, after, gap))
    for (std::size_t i = 0; i < regions.size(); ++i) {
      const ShellSet& touched = pass.touched[i];
      const bool is_a = std::binary_search(touched.begin(), touched.end(), a);
      if (!is_a && !std::binary_search(touched.begin(), touched.end(), b)) continue;
      regions[i].why_left = "it would push " + part_name(before.model, before.model.shell_parts[(is_a ? a : b).value]) + " into " +
                            part_name(before.model, before.model.shell_parts[(is_a ? b : a).value]);
      any = true;
    }
  return any;
}

/// The greatest depth of what is left of the regions, as the model is now.
double depth_left(const SeparationInput& input, const SeparationWish& wish, const SeparatedModel& state, const FoundContacts& found,
                  const std::vector<MeantRegion>& regions) {
  const SeparationInput now{state.model, state.tree, input.thickness, input.criteria, state.states, input.joints, input.why_stays, {}, {}};
  SeparationWish anywhere = wish;
  anywhere.at.reset();
  ShellSet meant;
  for (const MeantRegion& region : regions)
    for (const ShellSet& shells : region.shells) meant.insert(meant.end(), shells.begin(), shells.end());
  sort_unique(meant);
  const auto is_of_them = [&](const MeantRegion& region) {
    return std::any_of(region.shells[0].begin(), region.shells[0].end(),
                       [&](ShellIndex shell) { return std::binary_search(meant.begin(), meant.end(), shell); });
  };
  double depth = 0;
  for (const MeantRegion& region : find_meant_regions(now, anywhere, found))
    if (is_of_them(region)) depth = std::max(depth, region.depth.value_or(0));
  return depth;
}

SeparatedModel state_before(const SeparationInput& input, const SeparationWish& wish, const FoundContacts& found) {
  const auto& thickness = input.thickness.of_shell;
  const double thickest = thickness.empty() ? 0 : *std::max_element(thickness.begin(), thickness.end());
  return {input.model, input.tree, input.states, by_pair(found, wish.gap), wish.gap + thickest};
}

/// What became of the regions, and the contacts that may differ or are of them.
struct SeparatedRegions {
  Pass pass;
  FoundContacts found;
};

/// Until no change is left that makes new contacts farther away.
Result<SeparatedRegions> separate_regions(const SeparationInput& input, const SeparationWish& wish, const SeparatedModel& before,
                                          std::vector<MeantRegion> regions, const Progress& progress) {
  ShellSet meant;
  for (const MeantRegion& region : regions)
    for (const ShellSet& shells : region.shells) meant.insert(meant.end(), shells.begin(), shells.end());
  for (;;) {
    Result<Pass> pass = separate_all(input, wish, before, regions, progress);
    if (!pass) return fail(pass.error());
    ShellSet moved;
    for (const ShellSet& touched : pass->touched) moved.insert(moved.end(), touched.begin(), touched.end());
    sort_unique(moved);
    FoundContacts found = find_contacts_about(input, wish, before, pass->state, moved, meant);
    if (!leave_harmful(before, by_pair(found, wish.gap), wish.gap, *pass, regions))
      return SeparatedRegions{std::move(*pass), std::move(found)};
  }
}

}  // namespace

Result<Separation> separate(const SeparationInput& input, const SeparationWish& wish, const Progress& progress) {
  const FoundContacts found = find_contacts(input, wish, input.model, input.tree);
  const std::vector<MeantRegion> regions = find_meant_regions(input, wish, found);
  Separation done;
  done.regions_before = regions.size();
  for (const MeantRegion& region : regions) done.depth_before = std::max(done.depth_before, region.depth.value_or(0));
  if (regions.empty()) return done;
  const Result<SeparatedRegions> separated = separate_regions(input, wish, state_before(input, wish, found), regions, progress);
  if (!separated) return fail(separated.error());
  const Pass& pass = separated->pass;
  for (std::size_t i = 0; i < regions.size(); ++i)
    if (!pass.why[i].empty()) done.left.push_back({regions[i].part[0], regions[i].part[1], pass.why[i]});
  done.nodes = moved_nodes(input.model, pass.state.model);
  for (const NodeIndex node : done.nodes) {
    done.positions.push_back(pass.state.model.position(node));
    done.largest_move = std::max(done.largest_move, (done.positions.back() - input.model.position(node)).norm());
  }
  done.depth_after = done.nodes.empty() ? done.depth_before : depth_left(input, wish, pass.state, separated->found, regions);
  return done;
}

Result<std::vector<RegionTrial>> try_regions(const SeparationInput& input, const SeparationWish& wish, std::size_t limit,
                                             const Progress& progress) {
  const FoundContacts found = find_contacts(input, wish, input.model, input.tree);
  const std::vector<MeantRegion> regions = find_meant_regions(input, wish, found);
  const SeparatedModel before = state_before(input, wish, found);
  std::vector<RegionTrial> trials;
  for (std::size_t i = 0, tried = 0; i < regions.size(); ++i) {
    const double fraction = static_cast<double>(i) / static_cast<double>(regions.size());
    if (regions[i].why_left.empty() && tried++ >= limit) continue;
    RegionTrial& trial = trials.emplace_back(RegionTrial{regions[i].perforation.has_value(), regions[i].shells, regions[i].why_left});
    if (!trial.why.empty()) continue;
    const Result<SeparatedRegions> separated =
        separate_regions(input, wish, before, {regions[i]}, [&](double) { return !progress || progress(fraction); });
    if (!separated) return fail(separated.error());
    trial.why = separated->pass.why.front();
  }
  return trials;
}

}  // namespace prismesh::mesh::contact
