#include "mesh/document/flanges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

#include "base/counted.h"
#include "mesh/connections/find_flanges.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/part_marks.h"
#include "mesh/document/referenced_node.h"
#include "mesh/select/expression.h"
#include "mesh/select/region.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::document {

namespace {

using connections::Flange;
using connections::Flanges;

Result<Flanges> all_flanges(const Generation& generation, double gap, std::optional<double> max_width, const Progress& progress) {
  const std::vector<std::uint8_t> hidden = hidden_parts(generation);
  connections::FlangeOptions options;
  options.gap = gap;
  options.max_width = max_width;
  options.out_of_sight = hidden;
  bool stopped = false;
  const Progress watched = progress ? Progress([&](double done) { return !(stopped = stopped || !progress(done)); }) : Progress();
  Flanges found = connections::find_flanges(generation.model, spatial::BoxTree(generation.model), options, watched);
  if (stopped) return fail(cancelled());
  return found;
}

bool have_common_shell(const ShellSet& a, const ShellSet& b) {
  for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();) {
    if (*i == *j) return true;
    if (*i < *j)
      ++i;
    else
      ++j;
  }
  return false;
}

std::string part_id(const Model& model, PartIndex part) {
  return part.valid() ? "part:" + std::to_string((*model.parts)[part.value].id) : "no part";
}

/// "part:1 and part:2", "part:1, part:2 and part:5".
std::string parts_of(const Model& model, const Flange& flange) {
  std::string words;
  for (std::size_t s = 0; s < flange.parts.size(); ++s)
    words += (s == 0 ? "" : s + 1 == flange.parts.size() ? " and " : ", ") + part_id(model, flange.parts[s]);
  return words;
}

std::string rounded_length(double length) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.4g", length);
  return text.data();
}

/// "; the nearest is 34.2 away, of part:1 and part:2", or why there may be none at all.
std::string nearest_flange(const Model& model, const Flanges& flanges, const Vec3& place) {
  const Flange* nearest = nullptr;
  double least2 = std::numeric_limits<double>::infinity();
  for (const Flange& flange : flanges.all)
    for (const NodeIndex node : flange.nodes)
      if (const double distance2 = (model.position(node) - place).squaredNorm(); distance2 < least2) least2 = distance2, nearest = &flange;
  if (nearest != nullptr) return "; the nearest is " + rounded_length(std::sqrt(least2)) + " away, of " + parts_of(model, *nearest);
  if (flanges.without_thickness.empty()) return ", nor anywhere else in sight";
  return ", nor anywhere else in sight; " + counted(flanges.without_thickness.size(), "part") +
         (flanges.without_thickness.size() == 1 ? " has" : " have") + " no thickness, so that \"gap\" must say how far apart sheets may be";
}

/// The place in words, its shells and its point.
struct Place {
  std::string words;
  ShellSet shells;
  Vec3 point = Vec3::Zero();
};

Result<Place> place_of(const Generation& generation, const NodeReference& at, const std::string& who) {
  const Model& model = generation.model;
  const std::vector<std::uint8_t> hidden = hidden_parts(generation);
  Place place;
  if (const auto* point = std::get_if<std::array<double, 3>>(&at)) {
    place.point = Vec3((*point)[0], (*point)[1], (*point)[2]);
    place.words = "(" + rounded_length((*point)[0]) + ", " + rounded_length((*point)[1]) + ", " + rounded_length((*point)[2]) + ")";
    place.shells = select::shells_near(model, place.point, hidden);
  } else {
    const Result<NodeIndex> node = find_referenced_node(model, at);
    if (!node) return fail("", who + ": " + node.error().message);
    place.point = model.position(*node);
    place.words = "node " + std::to_string(model.node_ids[node->value]);
    place.shells = select::shells_at(model, *node, hidden);
  }
  if (place.shells.empty()) return fail("", who + ": no shell is in sight at " + place.words + ", so there is no flange");
  return place;
}

Result<std::vector<Flange>> flanges_at_place(const Generation& generation, const Flanges& flanges, const NodeReference& at,
                                             const std::string& who) {
  const Result<Place> place = place_of(generation, at, who);
  if (!place) return fail(place.error());
  // At a node where two flanges meet, the one that more of its shells belong to; of equal ones the longer.
  const Flange* best = nullptr;
  std::size_t most = 0;
  for (const Flange& flange : flanges.all) {
    const auto there = static_cast<std::size_t>(std::count_if(place->shells.begin(), place->shells.end(), [&](ShellIndex shell) {
      return std::binary_search(flange.shells.begin(), flange.shells.end(), shell);
    }));
    if (there > most) most = there, best = &flange;
  }
  if (best != nullptr) return std::vector<Flange>{*best};
  return fail("", who + ": there is no flange at " + place->words + nearest_flange(generation.model, flanges, place->point));
}

Result<std::vector<Flange>> flanges_between(const Model& model, const Flanges& flanges, const std::vector<PartIndex>& parts,
                                            const SelectFlange& edit, const std::string& who) {
  std::vector<Flange> wanted;
  for (const Flange& flange : flanges.all) {
    const auto of_these = std::count_if(flange.parts.begin(), flange.parts.end(),
                                        [&](PartIndex part) { return std::find(parts.begin(), parts.end(), part) != parts.end(); });
    if (of_these >= 2) wanted.push_back(flange);
  }
  if (!wanted.empty()) return wanted;
  std::string why = who + ": no flange in sight has two sheets of \"" + *edit.between + "\"";
  for (const PartIndex part : flanges.without_thickness)
    if (std::find(parts.begin(), parts.end(), part) != parts.end())
      return fail("", why + "; " + part_id(model, part) + " has no thickness, so that \"gap\" must say how far apart sheets may be");
  return fail("", why);
}

}  // namespace

Result<Flanges> find_flanges(const Generation& generation, const FlangeWish& wish, const Progress& progress) {
  std::optional<ShellSet> selected;
  if (wish.select) {
    Result<select::Chosen> chosen =
        select::evaluate(generation.model, *wish.select, select::EntityKind::element, generation.relations->names, progress);
    if (!chosen) return fail(chosen.error());
    selected = std::move(chosen->shells);
    std::sort(selected->begin(), selected->end());
  }
  Result<Flanges> found = all_flanges(generation, wish.gap, wish.max_width, progress);
  if (found && selected) std::erase_if(found->all, [&](const Flange& flange) { return !have_common_shell(flange.shells, *selected); });
  return found;
}

Result<std::vector<Flange>> flanges_wanted(const Generation& generation, const SelectFlange& edit, const std::string& who,
                                           const Progress& progress) {
  const Model& model = generation.model;
  if (edit.at.has_value() == edit.between.has_value())
    return fail("", who + " needs either \"at\", a place on the flange, or \"between\", the parts whose flanges it " +
                        (who == "select_flange" ? "selects" : "welds") + (edit.at ? "; both are given" : ""));
  std::vector<PartIndex> parts;
  if (edit.between) {
    Result<select::Chosen> chosen = select::evaluate(model, *edit.between, select::EntityKind::part, generation.relations->names, progress);
    if (!chosen) return fail(chosen.error());
    parts = std::move(chosen->parts);
  } else if (const Result<Place> place = place_of(generation, *edit.at, who); !place) {
    return fail(place.error());  // before the search, which costs the model
  }
  const Result<Flanges> flanges = all_flanges(generation, edit.gap, edit.max_width, progress);
  if (!flanges) return fail(flanges.error());
  return edit.at ? flanges_at_place(generation, *flanges, *edit.at, who) : flanges_between(model, *flanges, parts, edit, who);
}

Result<Selection> flange_at(const Generation& generation, const SelectFlange& edit, const Progress& progress) {
  const Result<std::vector<Flange>> flanges = flanges_wanted(generation, edit, "select_flange", progress);
  if (!flanges) return fail(flanges.error());
  ShellSet shells;
  for (const Flange& flange : *flanges) shells.insert(shells.end(), flange.shells.begin(), flange.shells.end());
  std::sort(shells.begin(), shells.end());
  NodeSet nodes = nodes_of(generation.model, shells);
  return Selection{std::move(nodes), std::move(shells), select::EntityKind::element};
}

}  // namespace prismesh::mesh::document
