#include <array>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/json_output.h"
#include "cli/open_deck.h"
#include "cli/report_text.h"
#include "mesh/document/deck_relations.h"
#include "mesh/measure/lengths.h"
#include "mesh/select/expression.h"

namespace prismesh::cli {

namespace {

std::string place_text(const mesh::Vec3& place) {
  return "(" + rounded(place.x()) + ", " + rounded(place.y()) + ", " + rounded(place.z()) + ")";
}

void print_measures(std::ostream& out, const std::vector<std::int64_t>& ids, const mesh::measure::NodeMeasures& measures,
                    const std::string& unit) {
  const auto node = [](std::int64_t id) { return "node:" + std::to_string(id); };
  out << node(ids.front()) << " to " << node(ids.back()) << ": " << rounded(measures.distance) << ' ' << unit << ", as x y z "
      << place_text(measures.between) << '\n';
  if (measures.along_surface)
    out << "along the surface " << rounded(*measures.along_surface) << ' ' << unit << '\n';
  else
    out << "no shells lead from one to the other\n";
  if (ids.size() < 3) return;
  if (measures.angle)
    out << "angle at " << node(ids[1]) << ' ' << rounded(*measures.angle) << " degrees\n";
  else
    out << "no angle at " << node(ids[1]) << ": another node is at the same place\n";
  if (measures.circle)
    out << "radius " << rounded(measures.circle->radius) << ' ' << unit << ", centre " << place_text(measures.circle->centre) << ", axis "
        << place_text(measures.circle->normal) << '\n';
  else
    out << "no radius: the nodes lie on a line\n";
}

}  // namespace

int measure_nodes(const MeasureOptions& options, const Common& common, const Context& context) {
  const auto refuse = [&](const Error& error) {
    say(context, error);
    return kFailed;
  };
  const Result<mesh::document::Document> document = open_deck(options.deck, common, context);
  if (!document) return refuse(document.error());
  const mesh::Model& model = document->current().model;
  std::vector<std::int64_t> ids{options.a, options.b};
  if (options.c) ids.push_back(*options.c);
  std::vector<mesh::NodeIndex> nodes;
  for (const std::int64_t id : ids) {
    const mesh::NodeIndex node = model.find_node(id);
    if (!node.valid()) {
      // An expression of one id tells which ids there are near by.
      const auto chosen =
          mesh::select::evaluate(model, std::to_string(id), mesh::select::EntityKind::node, document->current().relations->names);
      return refuse({options.deck.string(), 0, chosen ? "there is no node " + std::to_string(id) : chosen.error().message});
    }
    nodes.push_back(node);
  }
  say_warnings(context, *document);
  say_unit_guess(context, *document);
  const mesh::measure::NodeMeasures measures = mesh::measure::measure_nodes(model, nodes);
  if (common.json)
    context.out << measure_json(model, nodes, measures) << '\n';
  else
    print_measures(context.out, ids, measures, std::string(name(document->settings.length_unit)));
  return kDone;
}

}  // namespace prismesh::cli
