#include "mesh/repair/manual_operation.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <tuple>

#include "mesh/model/adjacency.h"
#include "mesh/repair/acceptance.h"
#include "mesh/repair/collapse.h"
#include "mesh/repair/divide.h"
#include "mesh/repair/patch_geometry.h"
#include "mesh/repair/redivide.h"

namespace prismesh::mesh::repair {

namespace {

constexpr int kRingsOfManualPatch = 2;

std::string shell_text(const Model& model, ShellIndex shell) { return "shell " + std::to_string(model.shell_ids[shell.value]); }
std::string node_text(const Model& model, NodeIndex node) { return "node " + std::to_string(model.node_ids[node.value]); }

std::string pair_text(const Model& model, std::span<const ShellIndex> shells) {
  return shell_text(model, shells[0]) + " and " + shell_text(model, shells[1]);
}

Result<void> refused(const std::string& who, std::string_view why) { return fail("", who + ": " + std::string(why)); }

struct ManualTask {
  const RepairContext& context;
  const Model& model;
  std::span<const ShellIndex> shells;
  std::span<const NodeIndex> nodes;

  LocalShell shell(std::size_t i) const { return context.patch.find(shells[i]); }

  Result<void> done(const Refusal& refusal, const std::string& who) const {
    if (refusal) return refused(who, *refusal);
    if (!conforms(context.patch)) return refused(who, "the mesh would be torn or folded");
    return {};
  }
};

/// The common edge of two shells. Errors: they have none.
Result<std::pair<LocalNode, LocalNode>> common_edge(const ManualTask& task) {
  const Patch& patch = task.context.patch;
  const Corners& corners = patch.shell(task.shell(0)).corners;
  const int count = corner_count(corners);
  for (int i = 0; i < count; ++i) {
    const LocalNode a = corners[static_cast<std::size_t>(i)], b = corners[static_cast<std::size_t>((i + 1) % count)];
    const std::vector<LocalShell> at = patch.shells_at(a, b);
    if (std::find(at.begin(), at.end(), task.shell(1)) != at.end()) return std::pair(a, b);
  }
  return fail("", pair_text(task.model, task.shells) + " have no edge in common");
}

/// The distance of the middle of a quad's diagonal from the surface.
double off_surface(const RepairContext& context, LocalNode a, LocalNode b, const Vec3& normal) {
  const Vec3 middle = 0.5 * (context.patch.position(a) + context.patch.position(b));
  const double size = (context.patch.position(a) - context.patch.position(b)).norm();
  const auto place = context.surface.project(middle, size, normal);
  return place ? place->distance : size;
}

Result<void> split_one(const ManualTask& task) {
  const Patch& patch = task.context.patch;
  const LocalShell quad = task.shell(0);
  const Corners c = patch.shell(quad).corners;
  const std::string who = shell_text(task.model, task.shells[0]);
  if (corner_count(c) != 4) return refused(who, "a triangle has no diagonal; name a neighbour to divide it with");
  const Vec3 normal = area_normal(patch, c).normalized();
  const double off0 = off_surface(task.context, c[0], c[2], normal), off1 = off_surface(task.context, c[1], c[3], normal);
  const double noise = 1e-3 * (patch.position(c[0]) - patch.position(c[2])).norm();
  // The diagonal nearer to the surface; of equals the shorter one, whose triangles have better angles.
  const bool second = std::abs(off0 - off1) > noise ? off1 < off0
                                                    : (patch.position(c[1]) - patch.position(c[3])).squaredNorm() <
                                                          (patch.position(c[0]) - patch.position(c[2])).squaredNorm();
  return task.done(split_quad(task.context, quad, second ? 1 : 0), who);
}

/// Takes the possible way whose worst shell has the highest composite. Errors: why none is possible.
template <class Ways>
Result<void> best_way(const ManualTask& task, const std::string& who, const Ways& ways) {
  Patch& patch = task.context.patch;
  std::optional<std::size_t> best;
  double max_worst = -1;
  Result<void> why = refused(who, "there is no other way");
  for (std::size_t i = 0; i < ways.size(); ++i) {
    patch.begin();
    const Result<void> done = task.done(ways[i](), who);
    if (done) {
      judge_shells(task.context, patch.changed_shells());
      const double worst = static_cast<double>(cost_now(patch).worst) + 2;
      if (worst > max_worst) {
        max_worst = worst;
        best = i;
      }
    } else {
      why = done;
    }
    patch.take_back();
  }
  if (!best) return why;
  patch.begin();
  ways[*best]();
  return {};
}

Result<void> split_two(const ManualTask& task) {
  const auto edge = common_edge(task);
  if (!edge) return fail(edge.error());
  std::vector<std::function<Refusal()>> ways;
  for (const RowEnd forward : {RowEnd::low_triangle, RowEnd::high_triangle})
    for (const RowEnd back : {RowEnd::low_triangle, RowEnd::high_triangle})
      ways.push_back([&task, edge = *edge, forward, back] { return divide_edge(task.context, edge.first, edge.second, forward, back); });
  return best_way(task, pair_text(task.model, task.shells), ways);
}

Result<void> collapse(const ManualTask& task) {
  const Patch& patch = task.context.patch;
  LocalNode a, b;
  if (task.nodes.size() == 2) {
    a = patch.find(task.nodes[0]);
    b = patch.find(task.nodes[1]);
    if (patch.shells_at(a, b).empty())
      return fail("", node_text(task.model, task.nodes[0]) + " and " + node_text(task.model, task.nodes[1]) + " have no edge between them");
  } else if (task.shells.size() == 2) {
    const auto edge = common_edge(task);
    if (!edge) return fail(edge.error());
    std::tie(a, b) = *edge;
  } else {
    const Corners& corners = patch.shell(task.shell(0)).corners;
    const int count = corner_count(corners);
    double shortest = -1;
    for (int i = 0; i < count; ++i) {
      const LocalNode c = corners[static_cast<std::size_t>(i)], d = corners[static_cast<std::size_t>((i + 1) % count)];
      const double length = (patch.position(c) - patch.position(d)).squaredNorm();
      if (shortest >= 0 && length >= shortest) continue;
      shortest = length;
      a = c;
      b = d;
    }
  }
  const std::string who =
      "the edge from " + node_text(task.model, patch.node(a).model) + " to " + node_text(task.model, patch.node(b).model);
  const auto pair = collapse_of(task.context, a, b);
  if (!pair) return refused(who, "both nodes hold the part's shape or are needed by something else");
  return task.done(collapse_nodes(task.context, {*pair}), who);
}

Result<void> merge(const ManualTask& task) {
  const Patch& patch = task.context.patch;
  const std::string who = pair_text(task.model, task.shells);
  if (const auto edge = common_edge(task); !edge) return fail(edge.error());
  for (std::size_t i = 0; i < 2; ++i)
    if (corner_count(patch.shell(task.shell(i)).corners) != 3)
      return refused(shell_text(task.model, task.shells[i]), "it isn't a triangle");
  const Loop loop = loop_of(patch, task.shell(0), task.shell(1));
  if (loop.empty()) return refused(who, "they have more than an edge in common");
  return task.done(redivide(task.context, task.shell(0), task.shell(1), {loop}), who);
}

Result<void> swap(const ManualTask& task) {
  if (const auto edge = common_edge(task); !edge) return fail(edge.error());
  const Loop loop = loop_of(task.context.patch, task.shell(0), task.shell(1));
  if (loop.empty()) return refused(pair_text(task.model, task.shells), "they have more than an edge in common");
  std::vector<std::function<Refusal()>> ways;
  const Corners corners = task.context.patch.shell(task.shell(0)).corners;
  for (const std::vector<Loop>& pieces : divisions(loop, loop.size() == 6 ? 0 : 2)) {
    if (pieces.size() != 2) continue;
    // Skip the division that is there already.
    Loop first(corners.begin(), corners.begin() + corner_count(corners)), piece = pieces[0], other = pieces[1];
    std::sort(first.begin(), first.end());
    std::sort(piece.begin(), piece.end());
    std::sort(other.begin(), other.end());
    if (first == piece || first == other) continue;
    ways.push_back([&task, pieces] { return redivide(task.context, task.shell(0), task.shell(1), pieces); });
  }
  return best_way(task, pair_text(task.model, task.shells), ways);
}

Result<void> carry_out(const ManualTask& task, Operation operation) {
  const bool two = task.shells.size() == 2;
  switch (operation) {
    case Operation::split:
      if (task.shells.size() == 1) return split_one(task);
      if (two) return split_two(task);
      return fail("", "name one quad, or two shells with an edge in common");
    case Operation::collapse:
      if (two || task.shells.size() == 1 || task.nodes.size() == 2) return collapse(task);
      return fail("", "name a shell, two shells with an edge in common, or the two nodes of an edge");
    case Operation::merge:
      if (two) return merge(task);
      return fail("", "name two triangles with an edge in common");
    case Operation::swap:
      if (two) return swap(task);
      return fail("", "name two shells with an edge in common");
    case Operation::move: break;
  }
  return fail("", "nodes are moved by translate, lift, slide or rotate");
}

}  // namespace

Result<Restructuring> apply_manual_operation(const RepairInput& input, const ManualOperation& manual) {
  ShellSet scope(manual.shells.begin(), manual.shells.end());
  for (const NodeIndex node : manual.nodes)
    for (const ShellIndex shell : input.model.adjacency->shells_of(node)) scope.push_back(shell);
  std::sort(scope.begin(), scope.end());
  scope.erase(std::unique(scope.begin(), scope.end()), scope.end());
  if (scope.empty()) return fail("", "there is no shell");
  Patch patch(input.model, scope, kRingsOfManualPatch, input.rules, input.options.relax.feature_angle);
  const RepairContext context{patch, input.surface, input.criteria, input.options, quality::limits_for(input.criteria)};
  patch.begin();
  const Result<void> done = carry_out({context, input.model, manual.shells, manual.nodes}, manual.operation);
  if (!done) return fail(done.error());
  patch.keep();
  return patch.result().change;
}

}  // namespace prismesh::mesh::repair
