#include "mesh/repair/repair.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "mesh/relax/relax.h"
#include "mesh/repair/appraisal.h"
#include "mesh/repair/candidates.h"
#include "mesh/repair/settling.h"
#include "mesh/repair/strips.h"

namespace prismesh::mesh::repair {

namespace {

constexpr int kRingsOfPatch = 4;
constexpr int kStripPasses = 4;
// How far a round is when shells are next, and what going through them takes of it.
constexpr double kStripShare = 0.2, kSweepShare = 0.4, kFailShare = kStripShare + kSweepShare;
constexpr double kMinGain = 0.05;
constexpr int kSweepsAtAGlance = 1;
// Candidates that after a glance gain less aren't looked at closer.
constexpr double kMinPromise = -2;

/// How hard is tried: how often nodes settle, how many candidates are looked at closely, before and after one could be accepted, and
/// whether nodes on feature lines settle along those.
struct Effort {
  int sweeps;
  std::size_t looks_longer, looks_closer;
  bool along_lines;
};
constexpr Effort kQuick{4, 12, 4, false}, kThorough{10, 40, 12, true};

std::size_t triangles_in(const Model& model) {
  std::size_t triangles = 0;
  for (std::size_t c = 0; c < model.shell_nodes.chunk_count(); ++c)
    for (const ShellNodes& nodes : model.shell_nodes.chunk(c)) triangles += nodes.is_triangle() && nodes.node[0].valid() ? 1 : 0;
  return triangles;
}

/// Limits to keep a little away from: a deck's fields hold fewer digits than the model.
quality::Limits within(quality::Limits limits) {
  constexpr float kMargin = 1e-3F;
  for (quality::ShapeLimits* shape : {&limits.quad, &limits.triangle})
    for (quality::Threshold& threshold : shape->threshold) {
      const auto tighten = [](float& limit, float toward) {
        if (std::isfinite(limit)) limit += toward * kMargin * std::abs(limit);
      };
      tighten(threshold.warn_low, 1);
      tighten(threshold.fail_low, 1);
      tighten(threshold.warn_high, -1);
      tighten(threshold.fail_high, -1);
    }
  return limits;
}

class Repairer {
 public:
  Repairer(const Model& model, const relax::ReferenceSurface& surface, const ShellSet& scope, const Rules& rules, const relax::Judge& judge,
           const Options& options)
      : patch_(model, scope, kRingsOfPatch, rules, options.relax.feature_angle),
        context_{patch_, surface, judge, options, quality::limits_for(judge.criteria, judge.target_size)} {
    in_scope_.assign(patch_.shell_count(), 0);
    for (const ShellIndex shell : scope)
      if (const LocalShell local = patch_.find(shell); local.valid()) in_scope_[local.value] = 1;
    triangles_ = static_cast<long>(triangles_in(model));
    const auto allowed = static_cast<long>(options.most_triangles_percent / 100 * static_cast<double>(live_shells(model)));
    most_triangles_ = std::max(allowed, triangles_);
  }

  Result<Repaired> run(const Progress& progress) {
    progress_ = &progress;
    const quality::Limits limits = context_.limits;
    judge_all();
    repaired_.bad_before = bad_shells(quality::Grade::warn).size();
    context_.limits = within(limits);
    judge_all();
    relax_neighbourhood();
    for (round_ = 0; round_ < context_.options.most_rounds && !stopped_; ++round_) {
      repaired_.rounds = round_ + 1;
      bool better = false;
      // Nodes that slid along a line hinder the next strip, which would divide it evenly: they may only when nothing else helps.
      along_lines_ = false;
      better = divide_strips() || better;
      if (effort_.along_lines) {
        along_lines_ = true;
        better = divide_strips() || better;
      }
      // The worst first; warnings when nothing fails that could be cured.
      better = sweep(quality::Grade::fail, kStripShare) || better;
      better = sweep(quality::Grade::warn, kFailShare) || better;
      tidy();
      if (!better && effort_.along_lines) break;
      // What is left when nothing is better any more is worth more effort.
      effort_ = better ? kQuick : kThorough;
      if (!better) tried_.clear();
      relax_neighbourhood();
    }
    if (stopped_) return fail(*stopped_);
    context_.limits = limits;
    judge_all();
    finish();
    return std::move(repaired_);
  }

 private:
  /// Tells how far a round is (0 to 1); false: cancelled. Nobody knows how many rounds it takes, but each finds less to do.
  bool goes_on(double done) {
    if (!stopped_ && *progress_ && !(*progress_)(1 - std::pow(0.6, round_ + done))) stopped_ = cancelled();
    return !stopped_;
  }

  void judge_all() {
    patch_.begin();
    std::vector<LocalShell> all;
    for (std::size_t s = 0; s < patch_.shell_count(); ++s)
      if (patch_.shell(LocalShell(s)).is_alive) all.push_back(LocalShell(s));
    judge_shells(context_, all);
    patch_.keep();
  }

  bool is_in_scope(LocalShell shell) const { return shell.value >= in_scope_.size() || in_scope_[shell.value] != 0; }

  /// Live shells in scope that are at least that bad, the worst first.
  std::vector<LocalShell> bad_shells(quality::Grade least) const {
    std::vector<LocalShell> bad;
    for (std::size_t s = 0; s < patch_.shell_count(); ++s) {
      const PatchShell& shell = patch_.shell(LocalShell(s));
      if (shell.is_alive && shell.state.grade() >= least && is_in_scope(LocalShell(s))) bad.push_back(LocalShell(s));
    }
    std::stable_sort(bad.begin(), bad.end(),
                     [&](LocalShell a, LocalShell b) { return patch_.shell(a).composite < patch_.shell(b).composite; });
    return bad;
  }

  /// Shells that are at least that bad, one by one; `done`: how far the round is.
  bool sweep(quality::Grade least, double done) {
    bool better = false;
    const std::vector<LocalShell> bad = bad_shells(least);
    const double each = kSweepShare / static_cast<double>(std::max<std::size_t>(bad.size(), 1));
    for (const LocalShell shell : bad) {
      if (!goes_on(done)) break;
      done += each;
      if (!patch_.shell(shell).is_alive || patch_.shell(shell).state.grade() < least || !is_worth_trying(shell)) continue;
      if (improve(candidates_for(context_, shell), shell, false))
        better = true;
      else
        tried_[shell] = changes_;
    }
    return better;
  }

  /// Strips and relaxing by turns, as long as that helps.
  bool divide_strips() {
    int pass = 0;
    for (; pass < kStripPasses && work_on_strips(); ++pass) relax_neighbourhood();
    return pass > 0;
  }

  /// Whole strips of quads where shells are long or short across: that leaves no triangles, or few.
  bool work_on_strips() {
    bool better = false;
    // Strips that were refused aren't tried again from each of their shells.
    std::set<std::pair<LocalShell, int>> refused;
    for (const LocalShell shell : bad_shells(quality::Grade::warn))
      for (int edge = 0; edge < 2; ++edge) {
        if (!patch_.shell(shell).is_alive || patch_.shell(shell).state.grade() == quality::Grade::ok) break;
        if (refused.contains({shell, edge})) continue;
        const std::vector<Candidate> found = strips_for(context_, shell, edge);
        if (found.empty()) continue;
        if (!goes_on(0)) return false;
        if (improve(found, shell, false))
          better = true;
        else
          for (const StripQuad& quad : course_of(patch_, {shell, edge}).quads) refused.emplace(quad.shell, quad.edge);
      }
    return better;
  }

  /// Triangles that a repair left side by side are joined or moved apart where that makes nothing worse.
  void tidy() {
    for (std::size_t s = 0; s < patch_.shell_count(); ++s) {
      const LocalShell shell(s);
      if (!patch_.shell(shell).is_alive || !is_touched(shell) || corner_count(patch_.shell(shell).corners) != 3) continue;
      if (!goes_on(kFailShare + kSweepShare)) return;
      improve(tidying_for(context_, shell), shell, true);
    }
  }

  bool is_touched(LocalShell shell) const {
    return !patch_.shell(shell).model.valid() || (shell.value < touched_.size() && touched_[shell.value] != 0);
  }

  struct Outcome {
    double gain = 0;
    std::string_view why;
    int rank = 0;  ///< how telling the reason is
  };

  /// What a candidate gains after a glance, without its neighbours having been moved much; nothing if it can't be done.
  std::optional<double> glance(const Candidate& candidate, Outcome& reason) {
    patch_.begin();
    std::optional<double> gain;
    if (const Refusal refusal = candidate.apply()) {
      if (reason.rank < 0) reason = {0, *refusal, 0};
    } else {
      settle(context_, kSweepsAtAGlance, along_lines_);
      judge_shells(context_, patch_.changed_shells());
      gain = cost_before(patch_).weight - cost_now(patch_).weight;
    }
    patch_.take_back();
    return gain;
  }

  Outcome try_out(const Candidate& candidate, bool only_tidy) {
    if (const Refusal refusal = candidate.apply()) return {0, *refusal, 0};
    settle(context_, effort_.sweeps, along_lines_);
    judge_shells(context_, patch_.changed_shells());
    const Cost before = cost_before(patch_), now = cost_now(patch_);
    const double gain = before.weight - now.weight;
    if (gain < kMinGain) return {0, "no operation makes it better", 4};
    if (only_tidy) {
      if (now.failing > before.failing || now.warning > before.warning) return {};
    } else {
      const bool cures = now.failing + now.warning < before.failing + before.warning;
      if (now.failing >= before.failing && now.worst < before.worst + (cures ? -1e-4F : 1e-3F))
        return {0, "no operation makes it better", 4};
    }
    if (harms(patch_)) return {0, "every operation makes a neighbour fail", 2};
    if (!conforms(patch_)) return {0, "every operation would tear or fold the mesh", 1};
    if (now.triangles > before.triangles && triangles_ + now.triangles - before.triangles > most_triangles_)
      return {0, "there would be too many triangles", 5};
    if (now.triangle_pairs > before.triangle_pairs && pairs_ + now.triangle_pairs - before.triangle_pairs > 0)
      return {0, "there would be two triangles side by side", 5};
    if (!keeps_to_surface(context_)) return {0, "every operation leaves the surface", 3};
    return {gain, {}, 0};
  }

  /// Carries out the best of the candidates; false: none makes it better.
  bool improve(const std::vector<Candidate>& candidates, LocalShell shell, bool only_tidy) {
    Outcome reason{0, "no operation is possible", -1};
    std::vector<std::pair<double, std::size_t>> promising;
    for (std::size_t i = 0; i < candidates.size(); ++i)
      if (const auto gain = glance(candidates[i], reason); gain && *gain > kMinPromise) promising.emplace_back(*gain, i);
    std::stable_sort(promising.begin(), promising.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    const Candidate* best = nullptr;
    double most = 0;
    for (std::size_t i = 0; i < promising.size() && i < (best != nullptr ? effort_.looks_closer : effort_.looks_longer); ++i) {
      const Candidate& candidate = candidates[promising[i].second];
      patch_.begin();
      const Outcome outcome = try_out(candidate, only_tidy);
      patch_.take_back();
      if (outcome.gain > most * 1.0001) {
        most = outcome.gain;
        best = &candidate;
      }
      if (outcome.rank > reason.rank) reason = outcome;
    }
    if (best == nullptr) {
      if (!only_tidy) why_[shell] = reason.why;
      return false;
    }
    patch_.begin();
    try_out(*best, only_tidy);
    keep_change();
    if (best->operation) ++repaired_.done[static_cast<std::size_t>(*best->operation)];
    return true;
  }

  void keep_change() {
    const Cost before = cost_before(patch_), now = cost_now(patch_);
    triangles_ += now.triangles - before.triangles;
    pairs_ += now.triangle_pairs - before.triangle_pairs;
    touched_.resize(patch_.shell_count(), 0);
    ++changes_;
    for (const LocalShell changed : patch_.changed_shells()) touched_[changed.value] = changes_;
    for (const auto& [changed, was] : patch_.old_shells())
      if (patch_.shell(changed).is_alive && patch_.shell(changed).state.grade() > was.state.grade() && changed.value < in_scope_.size())
        in_scope_[changed.value] = 1;
    patch_.keep();
  }

  /// Whether something near a shell changed since nothing could be done for it.
  bool is_worth_trying(LocalShell shell) {
    const auto tried = tried_.find(shell);
    if (tried == tried_.end()) return true;
    for (const LocalNode corner : patch_.shell(shell).corners)
      for (const LocalShell near : patch_.node(corner).shells)
        for (const LocalNode node : patch_.shell(near).corners)
          for (const LocalShell other : patch_.node(node).shells)
            if (other.value < touched_.size() && touched_[other.value] > tried->second) return true;
    return false;
  }

  /// Nodes of shells that were changed or are bad, and of those about them.
  NodeSet movable() const {
    std::vector<std::uint8_t> near(patch_.node_count(), 0);
    for (std::size_t s = 0; s < patch_.shell_count(); ++s) {
      const LocalShell shell(s);
      if (!patch_.shell(shell).is_alive) continue;
      if (!is_touched(shell) && (patch_.shell(shell).state.grade() == quality::Grade::ok || !is_in_scope(shell))) continue;
      for (const LocalNode corner : patch_.shell(shell).corners)
        for (const LocalShell other : patch_.node(corner).shells)
          for (const LocalNode node : patch_.shell(other).corners) near[node.value] = 1;
    }
    NodeSet nodes;
    for (std::size_t n = 0; n < near.size(); ++n) {
      const PatchNode& node = patch_.node(LocalNode(n));
      if (near[n] != 0 && node.is_alive && node.is_whole && (node.rules & kStays) == 0 && !node.is_off_surface)
        nodes.push_back(NodeIndex(n));
    }
    return nodes;
  }

  void relax_neighbourhood() {
    if (!goes_on(0)) return;
    std::vector<LocalShell> shells;
    const Model small = patch_.as_model(shells);
    relax::Options options = context_.options.relax;
    options.checks_on_the_way = false;
    std::vector<Vec3> at_first;
    for (std::size_t n = 0; n < patch_.node_count(); ++n) {
      const NodeIndex node = patch_.node(LocalNode(n)).model;
      at_first.push_back(node.valid() ? patch_.model().position(node) : Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
    }
    options.limits_from = &at_first;
    const Result<relax::Relaxed> relaxed =
        relax::relax(small, context_.surface, movable(), context_.judge, options, [&](double) { return goes_on(0); });
    if (!relaxed) {
      stopped_ = relaxed.error();
      return;
    }
    patch_.begin();
    for (std::size_t i = 0; i < relaxed->nodes.size(); ++i) patch_.move(LocalNode(relaxed->nodes[i].value), relaxed->positions[i]);
    judge_shells(context_, patch_.changed_shells());
    if (harms(patch_) || !conforms(patch_))
      patch_.take_back();
    else
      keep_change();
  }

  /// What can be told of a shell for which nothing helped.
  std::string_view reason_of(LocalShell shell) const {
    const PatchShell& s = patch_.shell(shell);
    const auto is_held = [&](LocalNode n) { return !patch_.node(n).lines.empty() || patch_.node(n).freedom != relax::Freedom::surface; };
    if (std::all_of(s.corners.begin(), s.corners.end(), is_held)) return "it lies between edges of the part that have to stay";
    const auto why = why_.find(shell);
    return why == why_.end() ? "no operation makes it better" : why->second;
  }

  void finish() {
    std::vector<ShellIndex> index_of;
    repaired_.change = patch_.result(&index_of);
    repaired_.relaxed = repaired_.change.moved.size();
    for (const LocalShell shell : bad_shells(quality::Grade::fail))
      repaired_.unrepaired.push_back({index_of[shell.value], std::string(reason_of(shell))});
    std::sort(repaired_.unrepaired.begin(), repaired_.unrepaired.end(),
              [](const Unrepaired& a, const Unrepaired& b) { return a.shell < b.shell; });
  }

  Patch patch_;
  RepairContext context_;
  std::vector<std::uint8_t> in_scope_;  ///< of the patch's first shells; what came later is
  std::vector<std::uint32_t> touched_;  ///< the last change of each shell
  std::map<LocalShell, std::uint32_t> tried_;
  std::uint32_t changes_ = 0;
  std::map<LocalShell, std::string_view> why_;
  Effort effort_ = kQuick;
  bool along_lines_ = false;  ///< nodes on feature lines settle as well now
  const Progress* progress_ = nullptr;
  int round_ = 0;
  std::optional<Error> stopped_;  ///< why nothing more is to be done
  long triangles_ = 0, most_triangles_ = 0;
  int pairs_ = 0;  ///< of triangles side by side, more than there were
  Repaired repaired_;
};

}  // namespace

Result<Repaired> repair(const Model& model, const relax::ReferenceSurface& surface, const ShellSet& scope, const Rules& rules,
                        const relax::Judge& judge, const Options& options, const Progress& progress) {
  return Repairer(model, surface, scope, rules, judge, options).run(progress);
}

}  // namespace prismesh::mesh::repair
