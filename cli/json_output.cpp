#include "cli/json_output.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "cli/id_list.h"
#include "cli/json_values.h"
#include "cli/report_text.h"

namespace prismesh::cli {

namespace {

using Json = nlohmann::ordered_json;
namespace deck = mesh::deck;
namespace document = mesh::document;
namespace quality = mesh::quality;

Json point(const mesh::Vec3& p) { return Json::array({p.x(), p.y(), p.z()}); }

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

}  // namespace

std::string info_json(const document::Document& document, const std::vector<PartFigures>& parts) {
  const deck::Deck& deck = *document.deck;
  Json files = Json::array();
  for (const deck::SourceFile& file : deck.files) files.push_back(printable(file.path.string()));
  Json companions = Json::array();
  for (const deck::CompanionFile& file : deck.companions) companions.push_back(printable(file.path.string()));
  Json listed = Json::array();
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const PartFigures& part = parts[p];
    const mesh::quality::SizedCriteria judged = judged_by(document).of(mesh::PartIndex(p));
    listed.push_back({{"id", part.id},
                      {"name", printable(part.name)},
                      {"quads", part.quads},
                      {"tris", part.tris},
                      {"thickness", or_null(part.thickness)},
                      {"box", part.box ? Json::array({point(part.box->min), point(part.box->max)}) : Json(nullptr)},
                      {"target_size", judged.target_size},
                      {"target_size_from", name(document.current().judging->by_part.of(mesh::PartIndex(p)).size_from)},
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
  const Json json = {{"format", name(deck.format)},
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
  return json.dump();
}

std::string edit_json(const document::EditReport& report) { return edit_object(report).dump(); }

std::string failed_edit_json(const std::string& edit, const std::string& reason) {
  return Json{{"edit", edit}, {"ok", false}, {"error", printable(reason)}}.dump();
}

std::string replay_json(const std::vector<document::ReplayStep>& steps, const std::string& deck_hash, bool other_deck) {
  Json listed = Json::array();
  std::size_t applied = 0;
  for (const document::ReplayStep& step : steps) {
    Json entry = step.applied ? edit_object(step.report) : Json{{"edit", step.edit}, {"ok", false}, {"error", printable(step.message)}};
    entry["line"] = step.line;
    applied += step.applied;
    listed.push_back(std::move(entry));
  }
  return Json{{"edits", steps.size()},     {"applied", applied},       {"not_applied", steps.size() - applied},
              {"journal_deck", deck_hash}, {"other_deck", other_deck}, {"steps", std::move(listed)}}
      .dump();
}

namespace {

Json field_json(const std::optional<FieldFigures>& field) {
  if (!field) return nullptr;
  return Json{{"nodes", field->measured}, {"min", field->min}, {"mean", field->mean}, {"max", field->max}, {"max_at", field->max_at}};
}

}  // namespace

std::string diff_json(const Difference& d) {
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
              {"displacement", field_json(d.displacement)},
              {"surface_distance", field_json(d.surface_distance)}}
      .dump();
}

std::string distance_json(const Gap& gap) {
  return Json{{"distance", gap.distance},
              {"from", {{"entity", gap.from.entity}, {"point", point(gap.from.point)}}},
              {"to", {{"entity", gap.to.entity}, {"point", point(gap.to.point)}}},
              {"nodes", field_json(gap.nodes)}}
      .dump();
}

std::string welds_json(const mesh::document::WeldChecks& checks) {
  Json list = Json::array();
  for (const mesh::document::WeldFinding& finding : checks.findings)
    list.push_back({{"kind", finding.kind}, {"words", finding.words}, {"at", point(finding.at)}});
  return Json{{"welds", checks.welds}, {"findings", std::move(list)}}.dump();
}

std::string measure_json(const mesh::Model& model, std::span<const mesh::NodeIndex> nodes, const mesh::measure::NodeMeasures& measures) {
  Json ids = Json::array();
  for (const mesh::NodeIndex node : nodes) ids.push_back(model.node_ids[node.value]);
  Json said{{"nodes", std::move(ids)},
            {"between", point(measures.between)},
            {"distance", measures.distance},
            {"along_surface", measures.along_surface ? Json(*measures.along_surface) : Json(nullptr)}};
  if (nodes.size() == 3) {
    said["angle"] = measures.angle ? Json(*measures.angle) : Json(nullptr);
    said["circle"] = measures.circle ? Json{{"radius", measures.circle->radius},
                                            {"centre", point(measures.circle->centre)},
                                            {"normal", point(measures.circle->normal)}}
                                     : Json(nullptr);
  }
  return said.dump();
}

std::string cross_section_json(const mesh::Model& model, const mesh::measure::CrossSection& section) {
  Json curves = Json::array();
  for (const mesh::measure::SectionCurve& curve : section.curves) {
    Json points = Json::array();
    for (const mesh::Vec3& each : curve.points) points.push_back(point(each));
    curves.push_back({{"part", curve.part.valid() ? Json((*model.parts)[curve.part.value].id) : Json(nullptr)},
                      {"closed", curve.closed},
                      {"length", curve.length},
                      {"points", std::move(points)}});
  }
  return Json{{"shells", section.shells}, {"length", section.length}, {"curves", std::move(curves)}}.dump();
}

std::string flanges_json(const mesh::Model& model, const mesh::connections::Flanges& flanges) {
  Json list = Json::array();
  for (const mesh::connections::Flange& flange : flanges.all) {
    Json parts = Json::array(), middle = Json::array();
    for (const mesh::PartIndex part : flange.parts)
      parts.push_back(part.valid() ? Json("part:" + std::to_string((*model.parts)[part.value].id)) : Json(nullptr));
    for (const mesh::Vec3& place : flange.middle) middle.push_back(point(place));
    list.push_back({{"parts", std::move(parts)},
                    {"sheets", flange.sheets()},
                    {"shells", flange.shells.size()},
                    {"nodes", flange.nodes.size()},
                    {"length", flange.length},
                    {"width", {{"mean", flange.mean_width}, {"min", flange.min_width}}},
                    {"distance", flange.distance},
                    {"at", point(flange.centre())},
                    {"shell", "shell:" + std::to_string(model.shell_ids[flange.shells.front().value])},
                    {"closed", flange.closed},
                    {"middle", std::move(middle)}});
  }
  Json without = Json::array();
  for (const mesh::PartIndex part : flanges.without_thickness) without.push_back((*model.parts)[part.value].id);
  return Json{{"flanges", std::move(list)}, {"without_thickness", std::move(without)}}.dump();
}

std::string penetrations_json(const mesh::document::Contacts& contacts) {
  Json list = Json::array();
  for (const mesh::document::ContactRegion& region : contacts.regions) {
    Json entry{{"kind", region.kind},
               {"a", region.a},
               {"b", region.b},
               {"shells_a", region.shells_a.size()},
               {"shells_b", region.shells_b.size()},
               {"depth", region.max_depth ? Json{{"max", *region.max_depth}, {"mean", region.mean_depth}} : Json(nullptr)},
               {"area", region.area},
               {"at", point(region.at)},
               {"worst", {region.worst_a, region.worst_b}},
               {"joined", region.joined},
               {"contact", region.contact.empty() ? Json(nullptr) : Json(region.contact)},
               {"clear", region.clear},
               {"why", region.why},
               {"thickness_from", region.thickness_from}};
    if (region.kind == "perforation") entry["length"] = region.length;
    list.push_back(std::move(entry));
  }
  return Json{{"perforations", contacts.perforations},
              {"penetrations", contacts.penetrations},
              {"clearances", contacts.clearances},
              {"regions", list},
              {"without_thickness", contacts.without_thickness}}
      .dump();
}

namespace {

/// Units stand in the fields' names: the size is "bytes", "nodes" or "shells", its rate "bytes_per_s" and so on.
Json bench_figure_json(const BenchFigure& figure) {
  Json object{{"name", figure.name}, {"runs", figure.timing ? figure.timing->runs : 0}};
  const auto milliseconds = [&](double Timing::*field) { return figure.timing ? Json((*figure.timing).*field) : Json(nullptr); };
  object["median_ms"] = milliseconds(&Timing::median_ms);
  object["min_ms"] = milliseconds(&Timing::min_ms);
  object["cpu_ms"] = milliseconds(&Timing::cpu_ms);
  const std::string unit(name(figure.unit));
  object[unit] = figure.timing ? Json(figure.size) : Json(nullptr);
  object[unit + "_per_s"] = figure.timing ? Json(rate_per_s(figure)) : Json(nullptr);
  object["note"] = figure.note.empty() ? Json(nullptr) : Json(printable(figure.note));
  return object;
}

}  // namespace

std::string bench_json(const BenchReport& report) {
  Json figures = Json::array();
  for (const BenchFigure& figure : report.figures) figures.push_back(bench_figure_json(figure));
  const std::string& processor = report.machine.processor;
  Json json{{"version", PRISMESH_VERSION},
            {"threads", report.machine.threads},
            {"processor", processor.empty() ? Json(nullptr) : Json(printable(processor))},
            {"deck", report.is_sample ? Json(nullptr) : Json(printable(report.deck))},
            {"format", report.format},
            {"bytes", report.bytes},
            {"nodes", report.nodes},
            {"shells", report.shells},
            {"patch", nullptr},
            {"figures", std::move(figures)}};
  if (report.patch_nodes > 0)
    json["patch"] = {
        {"centre", "node:" + std::to_string(report.patch_centre)}, {"nodes", report.patch_nodes}, {"shells", report.patch_shells}};
  return json.dump();
}

std::string findings_json(const std::vector<Finding>& findings) {
  Json listed = Json::array();
  for (const Finding& finding : findings)
    listed.push_back({{"what", finding.what},
                      {"grade", finding.grade == Grade::good   ? "good"
                                : finding.grade == Grade::note ? "note"
                                                               : "bad"},
                      {"says", printable(finding.says)},
                      {"to_do", finding.to_do}});
  return Json{{"findings", std::move(listed)}}.dump();
}

Json pen_json(const DeviceFigures& figures) {
  if (!figures.pen) return nullptr;
  const auto& [info, state, loop] = *figures.pen;
  return {{"kind", info.kind},
          {"where", printable(info.where)},
          {"simulated", info.simulated},
          {"state", info.state},
          {"trouble", printable(info.trouble)},
          {"age_ms", or_null(figures.age_ms(state.measured_ns))},
          {"position_mm", state.position_mm},
          {"newton", state.newton},
          {"touching", state.touching},
          {"buttons", state.buttons},
          {"field", state.field_number},
          {"ticks", loop.ticks},
          {"ticks_late", loop.ticks_late},
          {"worst_late_ns", loop.worst_late_ns},
          {"cpu_p99_ns", loop.cpu_p99_ns},
          {"guard_trips", loop.guard_trips},
          {"realtime", loop.realtime}};
}

std::string devices_json(const DeviceFigures& figures) {
  const ipc::EyesState& eyes = figures.eyes;
  const ipc::PrismState& mask = figures.mask;
  const ipc::DeviceHealth& loop = figures.loop;
  Json listed = Json::array();
  for (const ipc::DeviceInfo& device : figures.devices.devices)
    listed.push_back({{"role", device.role},
                      {"kind", device.kind},
                      {"where", printable(device.where)},
                      {"simulated", device.simulated},
                      {"state", device.state},
                      {"trouble", printable(device.trouble)}});
  return Json{{"profile", printable(figures.devices.profile)},
              {"pen", pen_json(figures)},
              {"devices", std::move(listed)},
              {"eyes",
               {{"age_ms", or_null(figures.age_ms(eyes.measured_ns))},
                {"between_eyes_mm", eyes.between_eyes_mm},
                {"velocity_mm_s", eyes.velocity_mm_s},
                {"toward_right", eyes.toward_right},
                {"eye_separation_mm", eyes.eye_separation_mm},
                {"records", eyes.records},
                {"bytes_skipped", eyes.bytes_skipped},
                {"resyncs", eyes.resyncs},
                {"times_lost", eyes.times_lost}}},
              {"mask",
               {{"age_ms", or_null(figures.age_ms(mask.measured_ns))},
                {"position_mm", mask.position_mm},
                {"velocity_mm_s", mask.velocity_mm_s},
                {"goal_mm", mask.goal_mm},
                {"half_periods", mask.half_periods},
                {"stereo_allowed", mask.stereo_allowed}}},
              {"loop",
               {{"age_ms", or_null(figures.age_ms(loop.heartbeat_ns))},
                {"pid", loop.pid},
                {"ticks", loop.ticks},
                {"ticks_late", loop.ticks_late},
                {"worst_late_ms", static_cast<double>(loop.worst_late_ns) * 1e-6},
                {"tick_cpu_us", static_cast<double>(loop.tick_cpu_ns) * 1e-3},
                {"realtime", loop.realtime},
                {"memory_locked", loop.memory_locked},
                {"simulated", loop.simulated}}}}
      .dump();
}

}  // namespace prismesh::cli
