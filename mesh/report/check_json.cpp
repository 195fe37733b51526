// The object of `check`.
#include <algorithm>

#include <nlohmann/json.hpp>

#include "mesh/report/json.h"
#include "mesh/report/json_values.h"
#include "mesh/report/printable.h"
#include "mesh/report/shell_name.h"

namespace prismesh::mesh::report {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kNamed = 100;  ///< of each list; the count is of all

std::string node_name(const mesh::Model& model, mesh::NodeIndex node) { return "node:" + std::to_string(model.node_ids[node.value]); }

const char* text_of(quality::Grade grade) { return grade == quality::Grade::fail ? "fail" : grade == quality::Grade::warn ? "warn" : "ok"; }

Json summary(const mesh::Model& model, const quality::MetricSummary& s) {
  const bool measured = s.measured > 0;
  const auto figure = [measured](double value) { return measured ? Json(value) : Json(nullptr); };
  return {{"min", figure(as_written(static_cast<float>(s.min)))},
          {"mean", figure(s.mean)},
          {"max", figure(as_written(static_cast<float>(s.max)))},
          {"warn", s.warn},
          {"fail", s.fail},
          {"worst", s.worst ? Json(shell_name(model, *s.worst)) : Json(nullptr)},
          {"measured", s.measured}};
}

Json centre(const quality::Report& report) {
  if (!report.centre_of_gravity) return nullptr;
  const mesh::Vec3& c = *report.centre_of_gravity;
  return Json::array({c.x(), c.y(), c.z()});
}

Json time_step(const mesh::Model& model, const quality::Report& report) {
  if (!report.time_step) return nullptr;
  return {{"min", report.time_step->seconds}, {"element", shell_name(model, report.time_step->shell)}};
}

Json composite(const quality::Report& report) {
  if (report.elements == 0) return {{"min", nullptr}, {"mean", nullptr}};
  return {{"min", as_written(static_cast<float>(report.min_composite))}, {"mean", report.mean_composite}};
}

Json defects(const quality::Report& report) {
  Json counts = Json::object();
  for (std::size_t d = 0; d < quality::kDefectCount; ++d) counts[std::string(name(quality::kDefects[d]))] = report.defects[d];
  return counts;
}

/// How many there are, and the first of them by name.
template <class List, class Name>
Json named(const List& list, const Name& name) {
  Json first = Json::array();
  for (std::size_t i = 0; i < std::min(list.size(), kNamed); ++i) first.push_back(name(list[i]));
  return {{"count", list.size()}, {"first", std::move(first)}};
}

Json structure(const mesh::Model& model, const quality::Structure& found) {
  const auto shell = [&](mesh::ShellIndex s) { return Json(shell_name(model, s)); };
  const auto node = [&](mesh::NodeIndex n) { return Json(node_name(model, n)); };
  const auto edge = [&](mesh::EdgeIndex e) {
    const mesh::Edge ends = model.adjacency->edge(e);
    return Json::array({node_name(model, ends.low), node_name(model, ends.high)});
  };
  return {{"duplicates", named(found.duplicates, shell)},
          {"normals_not_aligned", named(found.opposed, edge)},
          {"multiply_connected_edges", named(found.multiple, edge)},
          {"unjoined_edges", named(found.unjoined, edge)},
          {"free_edges_inside", named(found.free_inside, edge)},
          {"triangle_clusters", named(found.clusters, node)},
          {"most_triangles_at_node", found.max_triangles},
          {"most_triangles_at", found.max_triangles > 0 ? node(found.max_triangles_at) : Json(nullptr)}};
}

Json part(const document::Document& document, const quality::PartReport& each) {
  const mesh::Model& model = document.current().model;
  const quality::SizedCriteria judged = judged_by(document).of(each.part);
  const mesh::Part& its = (*model.parts)[each.part.value];
  const quality::Report& report = each.report;
  return {{"id", its.id},
          {"name", printable(its.name)},
          {"target_size", judged.target_size},
          {"target_size_from", name(document.current().judging->by_part.of(each.part).size_from)},
          {"criteria", printable(judged.criteria.name)},
          {"elements", report.elements},
          {"ok", report.counts.ok},
          {"warn", report.counts.warn},
          {"fail", report.counts.fail},
          {"triangles_percent", report.triangles_percent},
          {"triangles", text_of(grade_of_triangles(report.triangles_percent, judged.criteria))},
          {"composite", composite(report)},
          {"defects", defects(report)},
          {"mass", or_null(report.mass)},
          {"cog", centre(report)},
          {"time_step", time_step(model, report)}};
}

}  // namespace

Json check_object(const document::Document& document, const CheckFigures& figures) {
  const mesh::Model& model = document.current().model;
  const quality::Report& report = figures.report;
  Json metrics = Json::object();
  for (int m = 0; m < quality::kMetricCount; ++m)
    metrics[std::string(name(static_cast<quality::Metric>(m)))] = summary(model, report.metrics[m]);
  Json parts = Json::array();
  for (const quality::PartReport& each : figures.parts) parts.push_back(part(document, each));
  Json unknown = Json::array();
  for (const std::string& sentence : figures.unknown) unknown.push_back(sentence);
  Json json = {{"elements", report.elements},
               {"ok", report.counts.ok},
               {"warn", report.counts.warn},
               {"fail", report.counts.fail},
               {"triangles_percent", report.triangles_percent},
               {"triangles", text_of(figures.triangles)},
               {"metrics", std::move(metrics)},
               {"composite", composite(report)},
               {"defects", defects(report)},
               {"mass", or_null(report.mass)},
               {"cog", centre(report)},
               {"time_step", time_step(model, report)},
               {"added_mass", or_null(report.added_mass)},
               {"structure", structure(model, figures.structure)},
               {"parts", std::move(parts)},
               {"unknown", std::move(unknown)},
               {"length_unit", name(document.settings.length_unit)},
               {"target_size", document.current().judging->deck_size},
               {"target_size_guessed", is_guessed(document.current().judging->target_size)},
               {"criteria", printable(document.current().judging->criteria.criteria->name)}};
  if (const auto& chordal = figures.chordal) {
    const auto figure = [&](double value) { return chordal->measured > 0 ? Json(value) : Json(nullptr); };
    json["chordal_deviation"] = {{"mean", figure(chordal->mean)},
                                 {"max", figure(as_written(static_cast<float>(chordal->max)))},
                                 {"worst", chordal->worst ? Json(shell_name(model, *chordal->worst)) : Json(nullptr)},
                                 {"measured", chordal->measured}};
  }
  return json;
}

}  // namespace prismesh::mesh::report
