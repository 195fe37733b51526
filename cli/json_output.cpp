#include "cli/json_output.h"

#include <nlohmann/json.hpp>

#include "cli/report_text.h"
#include "mesh/report/json.h"
#include "mesh/report/json_values.h"

namespace prismesh::cli {

namespace {

using Json = nlohmann::ordered_json;
namespace document = mesh::document;
using mesh::report::edit_object;
using mesh::report::field_object;
using mesh::report::or_null;

Json point(const mesh::Vec3& p) { return Json::array({p.x(), p.y(), p.z()}); }

}  // namespace

std::string info_json(const document::Document& document) { return mesh::report::info_object(document).dump(); }

std::string check_json(const document::Document& document, const mesh::report::CheckFigures& figures) {
  return mesh::report::check_object(document, figures).dump();
}

std::string diff_json(const mesh::report::Difference& difference) { return mesh::report::diff_object(difference).dump(); }

std::string report_json(const std::string& file, std::size_t bytes, const std::string& missing) {
  return Json{
      {"report", printable(file)}, {"bytes", bytes}, {"picture_missing", missing.empty() ? Json(nullptr) : Json(printable(missing))}}
      .dump();
}

std::string batch_json(const mesh::batch::Table& table, const std::string& page) {
  using mesh::batch::RowState;
  return Json{
      {"variants", table.rows.size()},           {"done", table.count(RowState::done)},       {"refused", table.count(RowState::refused)},
      {"failed", table.count(RowState::failed)}, {"missing", table.count(RowState::missing)}, {"page", printable(page)}}
      .dump();
}

std::string submitted_json(std::size_t variants, const std::string& job, const std::string& collector) {
  return Json{{"submitted", variants}, {"job", job}, {"collector", collector.empty() ? Json(nullptr) : Json(collector)}}.dump();
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

std::string distance_json(const Gap& gap) {
  return Json{{"distance", gap.distance},
              {"from", {{"entity", gap.from.entity}, {"point", point(gap.from.point)}}},
              {"to", {{"entity", gap.to.entity}, {"point", point(gap.to.point)}}},
              {"nodes", field_object(gap.nodes)}}
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
