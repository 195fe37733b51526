#include <algorithm>
#include <ostream>

#include "base/counted.h"
#include "cli/commands.h"
#include "cli/figures.h"
#include "cli/json_output.h"
#include "cli/open_deck.h"
#include "cli/report_text.h"
#include "cli/shell_name.h"
#include "mesh/contact/find_penetrations.h"
#include "mesh/contact/find_perforations.h"
#include "mesh/contact/joints_of_parts.h"
#include "mesh/contact/perforation_depth.h"
#include "mesh/contact/shell_area.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/joined_sheets.h"
#include "mesh/select/expression.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::cli {

namespace {

namespace contact = mesh::contact;

/// Fills in what regions of both kinds have.
class RegionWriter {
 public:
  RegionWriter(const mesh::document::Generation& generation, const contact::ContactThickness& thickness)
      : model_(generation.model), thickness_(thickness), joints_(model_, mesh::document::joints(generation)) {}

  ContactRegion perforation(const contact::Perforation& found, const contact::PerforationDepth& depth) const {
    ContactRegion region = common("perforation", found.part_a, found.part_b, found.shells_a, found.shells_b);
    region.length = found.length;
    region.max_depth = depth.max;
    region.mean_depth = depth.mean;
    region.area = contact::area_of_smaller(model_, found.shells_a, found.shells_b);
    region.at = depth.deepest.valid() ? model_.position(depth.deepest) : found.curve.front().from;
    const auto& [a, b] = found.crossings.front();
    region.shells = {shell_name(model_, a), shell_name(model_, b)};
    return region;
  }

  ContactRegion penetration(const contact::Penetration& found) const {
    ContactRegion region =
        common(found.is_clearance ? "clearance" : "penetration", found.part_a, found.part_b, found.shells_a, found.shells_b);
    region.max_depth = found.max_depth;
    region.mean_depth = found.mean_depth;
    region.area = found.area;
    region.at = (found.worst.on_a + found.worst.on_b) / 2;
    region.shells = {shell_name(model_, found.worst.a), shell_name(model_, found.worst.b)};
    return region;
  }

 private:
  const mesh::Part* part(mesh::PartIndex index) const { return index.valid() ? &(*model_.parts)[index.value] : nullptr; }

  ContactRegion common(const char* kind, mesh::PartIndex a, mesh::PartIndex b, const mesh::ShellSet& shells_a,
                       const mesh::ShellSet& shells_b) const {
    ContactRegion region;
    region.kind = kind;
    if (const mesh::Part* of_a = part(a)) region.a = "part:" + std::to_string(of_a->id), region.name_a = of_a->name;
    if (const mesh::Part* of_b = part(b)) region.b = "part:" + std::to_string(of_b->id), region.name_b = of_b->name;
    region.shells_a = shells_a.size();
    region.shells_b = shells_b.size();
    region.joined = joints_.join_there(a, b, shells_a, shells_b, thickness_);
    const std::string from_a(contact::name(thickness_.from(a))), from_b(contact::name(thickness_.from(b)));
    region.thickness_from = from_a == from_b ? from_a : from_a + ", " + from_b;
    return region;
  }

  const mesh::Model& model_;
  const contact::ContactThickness& thickness_;
  contact::JointsOfParts joints_;
};

bool has_any(const mesh::ShellSet& shells, const mesh::ShellSet& of) {
  return std::any_of(shells.begin(), shells.end(), [&](mesh::ShellIndex shell) { return std::binary_search(of.begin(), of.end(), shell); });
}

/// `selected`: ascending; null: all.
ContactFigures find_figures(const mesh::document::Generation& generation, const PenetrationsOptions& options,
                            const mesh::ShellSet* selected) {
  const mesh::Model& model = generation.model;
  const mesh::spatial::BoxTree tree(model);
  const contact::ContactThickness thickness =
      options.thickness ? contact::given_thickness(model, *options.thickness) : contact::section_thickness(model);
  const std::vector<contact::ShellCrossing> crossings = contact::find_shell_crossings(model, tree);
  std::vector<contact::Perforation> crossed = contact::group_crossings(model, crossings);
  if (selected != nullptr)
    std::erase_if(crossed, [&](const contact::Perforation& found) {
      return !has_any(found.shells_a, *selected) && !has_any(found.shells_b, *selected);
    });
  const std::vector<contact::PerforationDepth> depths = contact::perforation_depths(model, tree, crossed, 0);
  const RegionWriter writer(generation, thickness);
  ContactFigures figures;
  figures.perforations = crossed.size();
  for (std::size_t i = 0; i < crossed.size(); ++i) figures.regions.push_back(writer.perforation(crossed[i], depths[i]));
  for (const contact::Penetration& found : contact::find_penetrations(model, tree, thickness, crossings, {options.gap, selected})) {
    ++(found.is_clearance ? figures.clearances : figures.penetrations);
    figures.regions.push_back(writer.penetration(found));
  }
  for (const mesh::PartIndex part : thickness.without) figures.without_thickness.push_back((*model.parts)[part.value].id);
  return figures;
}

void print_region(std::ostream& out, const ContactRegion& region, std::string_view unit) {
  const auto with_name = [](const std::string& part, const std::string& name) {
    return (part.empty() ? "no part" : part) + (name.empty() ? "" : " " + printable(name));
  };
  out << with_name(region.a, region.name_a) << " and " << with_name(region.b, region.name_b);
  if (region.kind == "perforation")
    out << " cross along " << rounded(region.length) << ' ' << unit << ", ";
  else
    out << (region.kind == "penetration" ? " are too close, " : " are apart by less than the gap, ");
  if (region.max_depth)
    out << rounded(*region.max_depth) << ' ' << unit << " deep";
  else
    out << "half through";
  out << ", at (" << region.at.transpose() << "): " << region.shells.first << ", " << region.shells.second;
  out << (region.joined ? "; joined there\n" : "\n");
}

}  // namespace

int penetrations(const PenetrationsOptions& options, const Common& common, const Context& context) {
  const auto refuse = [&](const Error& error) {
    say(context, error);
    return kFailed;
  };
  const Result<mesh::document::Document> document = open_deck(options.deck, common, context);
  if (!document) return refuse(document.error());
  const mesh::document::Generation& generation = document->current();
  mesh::ShellSet selected;
  if (options.select) {
    Result<mesh::select::Chosen> chosen =
        mesh::select::evaluate(generation.model, *options.select, mesh::select::EntityKind::element, generation.relations->names);
    if (!chosen) return refuse(chosen.error());
    selected = std::move(chosen->shells);
    std::sort(selected.begin(), selected.end());
  }
  say_warnings(context, *document);
  const ContactFigures figures = find_figures(generation, options, options.select ? &selected : nullptr);
  if (common.json) {
    context.out << penetrations_json(figures) << '\n';
    return kDone;
  }
  if (figures.regions.empty()) context.out << "no shells cross or are too close\n";
  for (const ContactRegion& region : figures.regions) print_region(context.out, region, name(document->settings.length_unit));
  if (!figures.without_thickness.empty())
    context.out << counted(figures.without_thickness.size(), "part")
                << " without a thickness: what is too close to them isn't known (--thickness gives one)\n";
  return kDone;
}

}  // namespace prismesh::cli
