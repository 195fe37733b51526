#include "mesh/spatial/distance.h"

#include <algorithm>
#include <ostream>

#include "cli/commands.h"
#include "cli/figures.h"
#include "cli/json_output.h"
#include "cli/open_deck.h"
#include "cli/report_text.h"
#include "mesh/document/surroundings.h"
#include "mesh/select/expression.h"

namespace prismesh::cli {

namespace {

namespace select = mesh::select;
namespace spatial = mesh::spatial;

/// Shells, parts, sets of those and files count with their surfaces (and with the nodes of their other elements); as soon as an
/// expression names anything else, with all its nodes.
Result<spatial::Shape> shape_of(const mesh::document::Generation& generation, const std::string& expression) {
  const mesh::Model& model = generation.model;
  const select::Names& names = generation.around->names;
  Result<select::Chosen> nodes = select::evaluate(model, expression, select::Kind::node, names);
  if (!nodes) return fail(nodes.error());
  if (!nodes->of_surfaces) return spatial::Shape{std::move(nodes->nodes), {}};
  Result<select::Chosen> shells = select::evaluate(model, expression, select::Kind::element, names);
  if (!shells) return spatial::Shape{std::move(nodes->nodes), {}};  // a file without shells
  spatial::Shape shape;
  shape.shells = std::move(shells->shells);
  const mesh::NodeSet covered = mesh::nodes_of(model, shape.shells);
  std::set_difference(nodes->nodes.begin(), nodes->nodes.end(), covered.begin(), covered.end(), std::back_inserter(shape.nodes));
  return shape;
}

Gap::End end_of(const mesh::Model& model, const spatial::Closest::End& end) {
  const std::string entity = end.shell.valid() ? "shell:" + std::to_string(model.shell_ids[end.shell.value])
                                               : "node:" + std::to_string(model.node_ids[end.node.value]);
  return {entity, end.point};
}

}  // namespace

int distance(const DistanceOptions& options, const Common& common, const Surroundings& surroundings) {
  const auto refuse = [&](const Error& error) {
    say(surroundings, error);
    return kFailed;
  };
  const Result<mesh::document::Document> document = open_deck(options.deck, common, surroundings);
  if (!document) return refuse(document.error());
  say_warnings(surroundings, *document);
  const mesh::Model& model = document->current().model;
  const Result<spatial::Shape> from = shape_of(document->current(), options.from);
  if (!from) return refuse(from.error());
  const Result<spatial::Shape> to = shape_of(document->current(), options.to);
  if (!to) return refuse(to.error());
  const std::optional<spatial::Closest> closest = spatial::shortest_distance(model, *from, *to);
  if (!closest) return refuse({"expression", 1, "names nothing that has a place"});
  const Gap gap{closest->distance, end_of(model, closest->a), end_of(model, closest->b)};
  if (common.json) {
    surroundings.out << distance_json(gap) << '\n';
    return kDone;
  }
  surroundings.out << shortest(gap.distance) << ' ' << name(document->settings.length_unit) << " from " << gap.from.entity << " ("
                   << gap.from.point.transpose() << ") to " << gap.to.entity << " (" << gap.to.point.transpose() << ")\n";
  return kDone;
}

}  // namespace prismesh::cli
