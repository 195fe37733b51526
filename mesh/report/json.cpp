#include "mesh/report/json.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "mesh/report/id_list.h"
#include "mesh/report/json_values.h"
#include "mesh/report/printable.h"

namespace prismesh::mesh::report {

namespace {

using Json = nlohmann::ordered_json;

Json corner(const Vec3& p) { return Json::array({p.x(), p.y(), p.z()}); }

Json counts_of_elements(const deck::ElementCounts& counts) {
  return {{"quad", counts.quad}, {"tri", counts.tri},     {"quad8", counts.quad8},   {"tri6", counts.tri6},
          {"beam", counts.beam}, {"solid", counts.solid}, {"tshell", counts.tshell}, {"other", counts.other}};
}

Json bad_shells(const quality::Counts& counts) { return {{"warn", counts.warn}, {"fail", counts.fail}}; }

Json stopped_object(const document::StoppedRepair& stopped) {
  return {{"attempt", stopped.attempt},       {"steps", stopped.steps},           {"round", stopped.round},
          {"max_rounds", stopped.max_rounds}, {"bad_before", stopped.bad_before}, {"bad_left", stopped.bad_left}};
}

void add_separated(const document::Separated& separated, Json& object) {
  Json left = Json::array();
  for (const document::RegionLeft& region : separated.regions_left)
    left.push_back({{"a", region.a}, {"b", region.b}, {"why", printable(region.why)}});
  object["regions_before"] = separated.regions_before;
  object["regions_removed"] = separated.regions_removed;
  object["regions_left"] = std::move(left);
  object["depth_before"] = separated.depth_before;
  object["depth_after"] = separated.depth_after;
  object["largest_move"] = separated.largest_move;
}

void add_welded(const document::Welded& welded, Json& object) {
  Json left = Json::array();
  for (const document::SpotLeft& spot : welded.left_out) left.push_back({{"at", spot.at}, {"why", printable(spot.why)}});
  object["welds_added"] = welded.welds_added;
  object["spots_left"] = welded.spots_left;
  object["left_out"] = std::move(left);
}

void add_bonded(const document::Bonded& bonded, Json& object) {
  Json left = Json::array();
  for (const document::SpotLeft& spot : bonded.left_out) left.push_back({{"at", spot.at}, {"why", printable(spot.why)}});
  object["solids_added"] = bonded.solids_added;
  object["solids_left"] = bonded.solids_left;
  object["left_out"] = std::move(left);
  object["thinnest"] = bonded.thinnest;
  object["thickest"] = bonded.thickest;
}

void add_mended(const document::WeldsMended& mended, Json& object) {
  Json left = Json::array();
  for (const document::WeldLeft& weld : mended.left) left.push_back({{"at", weld.at}, {"why", printable(weld.why)}});
  object["welds_broken"] = mended.broken;
  object["welds_mended"] = mended.mended;
  object["welds_left"] = std::move(left);
}

}  // namespace

Json edit_object(const document::EditReport& report) {
  Json notes = Json::array();
  for (const std::string& note : report.notes) notes.push_back(printable(note));
  Json object{{"edit", report.edit},
              {"ok", true},
              {"nodes_moved", report.nodes_moved},
              {"elements_added", report.elements_added},
              {"elements_removed", report.elements_removed},
              {"before", bad_shells(report.before)},
              {"after", bad_shells(report.after)},
              {"clusters_before", report.clusters_before},
              {"clusters_after", report.clusters_after},
              {"triangle_pairs", report.triangle_pairs},
              {"inverted", report.inverted},
              {"notes", std::move(notes)},
              {"ms", std::round(report.milliseconds * 1000) / 1000}};
  object["lost"] = Json::array();
  for (const std::string& lost : report.lost) object["lost"].push_back(printable(lost));
  object["lost_connections"] = report.lost_connections;
  if (report.separated) add_separated(*report.separated, object);
  if (report.welded) add_welded(*report.welded, object);
  if (report.bonded) add_bonded(*report.bonded, object);
  if (report.welds_mended) add_mended(*report.welds_mended, object);
  if (report.stopped) object["stopped"] = stopped_object(*report.stopped);
  if (report.mass_before) object["mass_before"] = *report.mass_before;
  if (report.mass_after) object["mass_after"] = *report.mass_after;
  if (report.centre_before) object["cog_before"] = *report.centre_before;
  if (report.centre_after) object["cog_after"] = *report.centre_after;
  return object;
}

Json info_object(const document::Document& document) {
  const std::vector<PartFigures> parts = part_figures(document.current().model);
  const deck::Deck& deck = *document.deck;
  Json files = Json::array();
  for (const deck::SourceFile& file : deck.files) files.push_back(printable(file.path.string()));
  Json companions = Json::array();
  for (const deck::CompanionFile& file : deck.companions) companions.push_back(printable(file.path.string()));
  Json listed = Json::array();
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const PartFigures& part = parts[p];
    const quality::SizedCriteria judged = judged_by(document).of(PartIndex(p));
    listed.push_back({{"id", part.id},
                      {"name", printable(part.name)},
                      {"quads", part.quads},
                      {"tris", part.tris},
                      {"thickness", or_null(part.thickness)},
                      {"box", part.box ? Json::array({corner(part.box->min), corner(part.box->max)}) : Json(nullptr)},
                      {"target_size", judged.target_size},
                      {"target_size_from", name(document.current().judging->by_part.of(PartIndex(p)).size_from)},
                      {"criteria", printable(judged.criteria.name)}});
  }
  Json warnings = Json::array();
  for (const deck::Warning& w : deck.warnings)
    warnings.push_back(
        {{"file", printable(w.file)}, {"line", w.line}, {"kind", w.kind}, {"message", printable(w.message)}, {"count", w.count}});
  Json cards = Json::object();
  for (const auto& [kind, count] : deck.element_kinds) cards[printable(kind)] = count;
  const document::DocumentSettings& settings = document.settings;
  const document::Judging& judging = *document.current().judging;
  return {{"format", name(deck.format)},
          {"files", std::move(files)},
          {"companions", std::move(companions)},
          {"length_unit", name(settings.length_unit)},
          {"length_unit_guessed", settings.length_unit_guessed},
          {"target_size", judging.deck_size},
          {"target_size_guessed", is_guessed(judging.target_size)},
          {"criteria", printable(judging.criteria.criteria->name)},
          {"nodes", document.current().model.node_index->size()},
          {"elements", counts_of_elements(deck.element_cards.without(deck.left_out_cards))},
          {"elements_left_out", counts_of_elements(deck.left_out_cards)},
          {"element_cards", std::move(cards)},
          {"parts", std::move(listed)},
          {"warnings", std::move(warnings)}};
}

Json field_object(const std::optional<FieldFigures>& field) {
  if (!field) return nullptr;
  return Json{{"nodes", field->measured}, {"min", field->min}, {"mean", field->mean}, {"max", field->max}, {"max_at", field->max_at}};
}

Json diff_object(const Difference& d) {
  return Json{{"nodes_moved", d.nodes_moved},
              {"max_displacement", d.max_displacement},
              {"nodes_added", d.nodes_added},
              {"nodes_removed", d.nodes_removed},
              {"elements_added", d.elements_added},
              {"elements_removed", d.elements_removed},
              {"elements_changed", d.elements_changed},
              {"lines_changed", d.lines_changed},
              {"moved", id_list(d.moved)},
              {"added", id_list(d.added)},
              {"displacement", field_object(d.displacement)},
              {"surface_distance", field_object(d.surface_distance)}};
}

}  // namespace prismesh::mesh::report
