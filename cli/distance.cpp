#include "mesh/spatial/distance.h"

#include <ostream>

#include "cli/commands.h"
#include "cli/figures.h"
#include "cli/json_output.h"
#include "cli/open_deck.h"
#include "cli/report_text.h"
#include "mesh/document/distance_fields.h"
#include "mesh/document/make_field.h"

namespace prismesh::cli {

namespace {

namespace spatial = mesh::spatial;

Gap::End end_of(const mesh::Model& model, const spatial::Closest::End& end) {
  const std::string entity = end.shell.valid() ? "shell:" + std::to_string(model.shell_ids[end.shell.value])
                                               : "node:" + std::to_string(model.node_ids[end.node.value]);
  return {entity, end.point};
}

}  // namespace

int distance(const DistanceOptions& options, const Common& common, const Context& context) {
  const auto refuse = [&](const Error& error) {
    say(context, error);
    return kFailed;
  };
  const Result<mesh::document::Document> document = open_deck(options.deck, common, context);
  if (!document) return refuse(document.error());
  say_warnings(context, *document);
  const mesh::Model& model = document->current().model;
  const Result<spatial::Shape> from = mesh::document::shape_named(document->current(), options.from);
  if (!from) return refuse(from.error());
  const Result<spatial::Shape> to = mesh::document::shape_named(document->current(), options.to);
  if (!to) return refuse(to.error());
  const std::optional<spatial::Closest> closest = spatial::shortest_distance(model, *from, *to);
  if (!closest) return refuse({"expression", 1, "names no entity with coordinates"});
  Gap gap{closest->distance, end_of(model, closest->a), end_of(model, closest->b), {}};
  if (const auto field = mesh::document::gap_field(model, *from, *to, document->settings.length_unit))
    gap.nodes = figures_of(*field, model);
  if (common.json) {
    context.out << distance_json(gap) << '\n';
    return kDone;
  }
  context.out << rounded(gap.distance) << ' ' << name(document->settings.length_unit) << " from " << gap.from.entity << " ("
              << gap.from.point.transpose() << ") to " << gap.to.entity << " (" << gap.to.point.transpose() << ")\n";
  if (gap.nodes)
    context.out << gap.nodes->measured << " nodes: " << rounded(gap.nodes->min) << " to " << rounded(gap.nodes->max) << " ("
                << gap.nodes->max_at << "), mean " << rounded(gap.nodes->mean) << '\n';
  return kDone;
}

}  // namespace prismesh::cli
