#include "mesh/document/edit_targets.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "mesh/document/deck_relations.h"
#include "mesh/document/flanges.h"
#include "mesh/document/joined_sheets.h"
#include "mesh/document/part_marks.h"
#include "mesh/model/adjacency.h"
#include "mesh/select/loops.h"
#include "mesh/select/outline.h"
#include "mesh/select/region.h"
#include "mesh/select/visible.h"

namespace prismesh::mesh::document {

namespace {

/// The shells that a region begins with. Errors: no such node, no shell in sight.
Result<ShellSet> region_start(const Model& model, const NodeReference& reference, OutOfSight hidden) {
  if (const auto* point = std::get_if<std::array<double, 3>>(&reference)) {
    ShellSet near = select::shells_near(model, Vec3((*point)[0], (*point)[1], (*point)[2]), hidden);
    if (near.empty()) return fail("", "no shell is in sight, so there is no region");
    return near;
  }
  const Result<NodeIndex> node = find_referenced_node(model, reference);
  if (!node) return fail(node.error());
  ShellSet around = select::shells_at(model, *node, hidden);
  if (around.empty())
    return fail("", "node " + std::to_string(model.node_ids[node->value]) + " lies on no shell in sight, so there is no region around it");
  return around;
}

/// Errors: no free edge there.
Result<Selection> loop_at(const Generation& generation, const SelectRegion& recipe, const ShellSet& start, OutOfSight hidden) {
  const Model& model = generation.model;
  if (recipe.across_welds)
    return fail("", "select_region: a loop of free edges ends with its sheet, so \"across_welds\" doesn't go with \"by\": \"free_edge\"");
  Vec3 place;
  if (const auto* point = std::get_if<std::array<double, 3>>(&recipe.at))
    place = Vec3((*point)[0], (*point)[1], (*point)[2]);
  else
    place = model.position(model.find_node(std::get<std::int64_t>(recipe.at)));
  Selection loop{select::free_edge_loop(model, start, place, hidden), {}, select::EntityKind::node};
  if (loop.nodes.empty())
    return fail("", "the sheet at shell " + std::to_string(model.shell_ids[start.front().value]) + " has no free edge in sight");
  return loop;
}

}  // namespace

Result<Selection> region_at(const Generation& generation, const SelectRegion& recipe) {
  const Model& model = generation.model;
  const std::vector<std::uint8_t> hidden = hidden_parts(generation);
  const Result<ShellSet> start = region_start(model, recipe.at, hidden);
  if (!start) return fail(start.error());
  if (recipe.by == RegionBy::free_edge) return loop_at(generation, recipe, *start, hidden);
  select::RegionOptions options{select::RegionBound::features, recipe.angle, hidden, nullptr};
  if (recipe.by == RegionBy::creases) options.bound = select::RegionBound::creases;
  if (recipe.by == RegionBy::part) options.bound = select::RegionBound::part;
  if (recipe.by == RegionBy::piece) options.bound = select::RegionBound::piece;
  connections::JoinedSheets joined;
  if (recipe.across_welds) {
    joined = joined_sheets(generation, hidden);
    options.across = &joined;
  }
  ShellSet shells = select::region(model, *start, options);
  NodeSet nodes = nodes_of(model, shells);
  return Selection{std::move(nodes), std::move(shells), select::EntityKind::element};
}

Result<NodeSet> nodes_in_outline(const Generation& generation, const SelectLasso& recipe) {
  NodeSet nodes = select::inside_outline(generation.model, recipe.view, recipe.outline);
  std::erase_if(nodes, [&](NodeIndex node) { return (generation.node_marks[node.value] & kHidden) != 0; });
  if (!recipe.visible) return nodes;
  Result<NodeSet> visible = select::visible_nodes(generation.model, recipe.view, nodes, hidden_parts(generation));
  if (!visible) return fail("", "select_lasso: " + visible.error().message);
  return visible;
}

Result<NodeSet> nodes_at(const Generation& generation, const TargetNodes& target) {
  const Model& model = generation.model;
  const auto expression_nodes = [&](std::string_view expression, select::EntityKind kind) -> Result<NodeSet> {
    Result<select::Chosen> chosen = select::evaluate(model, expression, kind, generation.relations->names);
    if (!chosen) return fail(chosen.error());
    return std::move(chosen->nodes);
  };
  if (const auto* expression = std::get_if<std::string>(&target)) return expression_nodes(*expression, select::EntityKind::node);
  if (const auto* recipe = std::get_if<Select>(&target)) return expression_nodes(recipe->expr, recipe->kind);
  if (const auto* lasso = std::get_if<SelectLasso>(&target)) return nodes_in_outline(generation, *lasso);
  const auto* flange = std::get_if<SelectFlange>(&target);
  Result<Selection> found = flange != nullptr ? flange_at(generation, *flange) : region_at(generation, std::get<SelectRegion>(target));
  if (!found) return fail(found.error());
  return std::move(found->nodes);
}

}  // namespace prismesh::mesh::document
