#include "mesh/report/check_figures.h"

#include <algorithm>
#include <cmath>

#include "mesh/quality/chordal.h"
#include "mesh/relax/reference_surface.h"

namespace prismesh::mesh::report {

namespace {

constexpr double kFeatureAngle = 30;     ///< degrees; the default of edits
constexpr std::size_t kPartsNamed = 10;  ///< max in a sentence

ChordalFigures chordal_figures(const mesh::Model& model, const mesh::ShellSet* shells) {
  mesh::ShellSet listed;
  if (shells == nullptr)
    for (std::size_t s = 0; s < model.shell_count(); ++s)
      if (!model.is_removed(mesh::ShellIndex(s))) listed.emplace_back(s);
  const mesh::ShellSet& of = shells != nullptr ? *shells : listed;
  const mesh::relax::ReferenceSurface surface(model, of, kFeatureAngle);
  const std::vector<float> deviations = quality::chordal_deviations(
      model, &of, [&](mesh::ShellIndex shell, const mesh::Vec3& point) { return std::optional(surface.follow(shell, point).point); });
  ChordalFigures figures;
  for (std::size_t i = 0; i < of.size(); ++i) {
    if (std::isnan(deviations[i])) continue;
    if (figures.measured == 0 || deviations[i] > figures.max) figures.max = deviations[i], figures.worst = of[i];
    figures.mean += deviations[i];
    ++figures.measured;
  }
  if (figures.measured > 0) figures.mean /= static_cast<double>(figures.measured);
  return figures;
}

/// "Parts 1, 2 and 3 have no thickness or density: their mass isn't known."
std::string sentence(const std::vector<std::int64_t>& parts, const char* what, const char* consequence) {
  std::string text = parts.size() == 1 ? "part " : "parts ";
  for (std::size_t i = 0; i < std::min(parts.size(), kPartsNamed); ++i) text += (i > 0 ? ", " : "") + std::to_string(parts[i]);
  if (parts.size() > kPartsNamed) text += " and " + std::to_string(parts.size() - kPartsNamed) + " more";
  return text + (parts.size() == 1 ? " has " : " have ") + what + ": " + (parts.size() == 1 ? "its " : "their ") + consequence;
}

std::vector<std::string> unknown_of(const mesh::Model& model, const std::vector<quality::PartReport>& parts) {
  std::vector<std::int64_t> without_mass, without_step;
  for (const quality::PartReport& each : parts) {
    const mesh::Part& part = (*model.parts)[each.part.value];
    if (!each.report.mass) without_mass.push_back(part.id);
    const bool has_material = part.density && part.youngs_modulus && part.poissons_ratio;
    if (!each.report.time_step && part.limits_time_step && !has_material) without_step.push_back(part.id);
  }
  std::vector<std::string> said;
  if (!without_mass.empty()) said.push_back(sentence(without_mass, "no thickness or no density", "mass isn't known"));
  if (!without_step.empty()) said.push_back(sentence(without_step, "no elastic material", "time step isn't known"));
  return said;
}

}  // namespace

quality::Grade grade_of_triangles(double percent, const quality::Criteria& criteria) {
  if (percent > criteria.fail_triangles_percent) return quality::Grade::fail;
  return percent > criteria.warn_triangles_percent ? quality::Grade::warn : quality::Grade::ok;
}

CheckFigures check_figures(const document::Document& document, const mesh::ShellSet* shells, bool chordal) {
  const mesh::Model& model = document.current().model;
  const quality::Criteria& criteria = *document.current().judging->criteria.criteria;
  const quality::SizedCriteria sized = document::judged_by(document);
  const mesh::TimeStepControl& control = document.deck->time_step;
  CheckFigures figures;
  figures.report = quality::report(model, sized, control, shells);
  figures.parts = quality::report_by_part(model, sized, control, shells);
  quality::StructureOptions options;
  options.triangles_at_node = criteria.warn_triangles_at_node;
  figures.structure = quality::check_structure(model, options, shells);
  if (chordal) figures.chordal = chordal_figures(model, shells);
  figures.triangles = grade_of_triangles(figures.report.triangles_percent, criteria);
  figures.unknown = unknown_of(model, figures.parts);
  return figures;
}

}  // namespace prismesh::mesh::report
