#include <ostream>

#include "cli/commands.h"
#include "cli/figures.h"
#include "cli/json_output.h"
#include "cli/open_deck.h"
#include "cli/report_text.h"
#include "cli/shell_name.h"
#include "mesh/contact/find_perforations.h"
#include "mesh/contact/perforation_depth.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::cli {

namespace {

namespace contact = mesh::contact;

std::string part_name(const mesh::Model& model, mesh::PartIndex part) {
  return part.valid() ? "part:" + std::to_string((*model.parts)[part.value].id) : "";
}

std::vector<CrossingRegion> find_regions(const mesh::Model& model) {
  const std::vector<contact::Perforation> found = contact::find_perforations(model, mesh::spatial::BoxTree(model));
  const std::vector<contact::PerforationDepth> depths = contact::perforation_depths(model, found, 0);
  std::vector<CrossingRegion> regions;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const contact::Perforation& perforation = found[i];
    const auto& [a, b] = perforation.crossings.front();
    const mesh::NodeIndex deepest = depths[i].deepest;
    regions.push_back({part_name(model, perforation.part_a),
                       part_name(model, perforation.part_b),
                       perforation.shells_a.size(),
                       perforation.shells_b.size(),
                       perforation.length,
                       depths[i].max,
                       deepest.valid() ? model.position(deepest) : perforation.curve.front().from,
                       {shell_name(model, a), shell_name(model, b)}});
  }
  return regions;
}

}  // namespace

int penetrations(const PenetrationsOptions& options, const Common& common, const Context& context) {
  const Result<mesh::document::Document> document = open_deck(options.deck, common, context);
  if (!document) {
    say(context, document.error());
    return kFailed;
  }
  say_warnings(context, *document);
  const std::vector<CrossingRegion> regions = find_regions(document->current().model);
  if (common.json) {
    context.out << penetrations_json(regions) << '\n';
    return kDone;
  }
  if (regions.empty()) context.out << "no shells cross\n";
  const auto unit = name(document->settings.length_unit);
  for (const CrossingRegion& region : regions) {
    context.out << region.a << " and " << region.b << " cross along " << rounded(region.length) << ' ' << unit << ", ";
    if (region.depth)
      context.out << rounded(*region.depth) << ' ' << unit << " deep";
    else
      context.out << "half through";
    context.out << ", at (" << region.at.transpose() << "): " << region.shells.first << ", " << region.shells.second << '\n';
  }
  return kDone;
}

}  // namespace prismesh::cli
