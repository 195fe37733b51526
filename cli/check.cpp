#include <algorithm>
#include <cstring>
#include <iomanip>
#include <ostream>

#include "base/counted.h"
#include "base/readable_number.h"
#include "cli/commands.h"
#include "cli/json_output.h"
#include "cli/open_deck.h"
#include "cli/report_text.h"
#include "mesh/document/deck_relations.h"
#include "mesh/report/check_figures.h"
#include "mesh/select/expression.h"

namespace prismesh::cli {

namespace {

namespace quality = mesh::quality;
using mesh::report::check_figures;
using mesh::report::CheckFigures;

constexpr std::size_t kPartsShown = 40;

const char* in_brackets(quality::Grade grade) {
  return grade == quality::Grade::fail ? " (fail)" : grade == quality::Grade::warn ? " (warn)" : "";
}

void print_metrics(std::ostream& out, const mesh::Model& model, const quality::Report& report) {
  out << "metric                min        mean         max    warn    fail  worst\n";
  for (int m = 0; m < quality::kMetricCount; ++m) {
    const quality::MetricSummary& s = report.metrics[m];
    if (s.measured == 0) continue;
    out << std::left << std::setw(16) << name(static_cast<quality::Metric>(m)) << std::right;
    for (const double figure : {s.min, s.mean, s.max}) out << ' ' << std::setw(11) << figure;
    out << std::setw(8) << s.warn << std::setw(8) << s.fail;
    if (s.worst) out << "  shell:" << model.shell_ids[s.worst->value];
    out << '\n';
  }
}

/// Counts of degenerate shells, if there are any.
void print_defects(std::ostream& out, const quality::Report& report) {
  constexpr const char* kWhat[quality::kDefectCount] = {"with a coordinate that isn't a number", "with corners at one place",
                                                        "without area or folded"};
  for (std::size_t d = 0; d < quality::kDefectCount; ++d)
    if (report.defects[d] > 0) out << counted(report.defects[d], "shell") << ' ' << kWhat[d] << " (fail)\n";
}

void print_structure(std::ostream& out, const mesh::Model& model, const quality::Structure& found) {
  const auto say = [&](std::size_t count, const char* one, const char* more) {
    if (count > 0) out << count << ' ' << (count == 1 ? one : more) << '\n';
  };
  say(found.duplicates.size(), "shell duplicates another", "shells duplicate others");
  say(found.opposed.size(), "edge has shells with opposed normals", "edges have shells with opposed normals");
  say(found.multiple.size(), "edge has three shells or more", "edges have three shells or more");
  say(found.unjoined.size(), "free edge lies on another without being joined to it",
      "free edges lie on others without being joined to them");
  say(found.free_inside.size(), "free edge around a hole of one shell", "free edges around holes of one shell");
  say(found.clusters.size(), "node has a cluster of triangles", "nodes have a cluster of triangles");
  if (found.max_triangles > 0)
    out << "max triangles around a node " << found.max_triangles << " at node:" << model.node_ids[found.max_triangles_at.value] << '\n';
}

void print_parts(std::ostream& out, const mesh::document::Document& document, const std::vector<quality::PartReport>& parts) {
  const mesh::Model& model = document.current().model;
  const mesh::document::Judging& judging = *document.current().judging;
  if (parts.empty()) return;
  // Criteria have a column where parts have their own.
  const bool differ =
      std::any_of(judging.parts.begin(), judging.parts.end(), [](const mesh::document::PartChoice& choice) { return choice.criteria; });
  std::size_t width = 0;
  const auto criteria_of = [&](mesh::PartIndex of) { return printable(judged_by(document).of(of).criteria.name); };
  for (const quality::PartReport& each : parts) width = std::max({width, criteria_of(each.part).size(), std::strlen("criteria")});
  const auto column = [&](const std::string& text) { return differ ? "  " + text + std::string(width - text.size(), ' ') : ""; };
  out << "part          shells    warn    fail  tri %    composite min    mean    size" << column("criteria") << "  name\n";
  for (std::size_t i = 0; i < std::min(parts.size(), kPartsShown); ++i) {
    const quality::Report& report = parts[i].report;
    const mesh::Part& part = (*model.parts)[parts[i].part.value];
    out << std::left << std::setw(10) << part.id << std::right << std::setw(10) << report.elements << std::setw(8) << report.counts.warn
        << std::setw(8) << report.counts.fail << std::setw(7) << std::setprecision(3) << report.triangles_percent << std::setw(17)
        << report.min_composite << std::setw(8) << report.mean_composite << std::setprecision(6) << std::setw(8)
        << judging.by_part.of(parts[i].part).target_size << column(criteria_of(parts[i].part)) << "  " << printable(part.name) << '\n';
  }
  if (parts.size() > kPartsShown) out << "and " << parts.size() - kPartsShown << " more parts; all are in the JSON\n";
}

void print_text(std::ostream& out, const mesh::document::Document& document, const CheckFigures& figures) {
  const mesh::document::DocumentSettings& settings = document.settings;
  const mesh::Model& model = document.current().model;
  const quality::Report& report = figures.report;
  out << report.elements << " shells: " << report.counts.ok << " ok, " << report.counts.warn << " warn, " << report.counts.fail
      << " fail\n";
  out << "target size " << target_sizes(document) << ' ' << name(settings.length_unit)
      << (is_guessed(document.current().judging->target_size) ? " (guessed), criteria " : ", criteria ") << criteria_names(document)
      << '\n';
  out << "triangles " << report.triangles_percent << " %" << in_brackets(figures.triangles) << '\n';
  print_defects(out, report);
  if (report.elements > 0) {
    print_metrics(out, model, report);
    out << "composite: min " << report.min_composite << ", mean " << report.mean_composite << '\n';
  }
  print_structure(out, model, figures.structure);
  if (figures.chordal && figures.chordal->worst)
    out << "chordal deviation: mean " << figures.chordal->mean << ", max " << figures.chordal->max
        << " at shell:" << model.shell_ids[figures.chordal->worst->value] << '\n';
  print_parts(out, document, figures.parts);
  if (report.mass) out << "mass " << *report.mass << '\n';
  if (const auto& at = report.centre_of_gravity) out << "centre of gravity " << readable({at->x(), at->y(), at->z()}, 6) << '\n';
  if (report.time_step)
    out << "time step " << report.time_step->seconds << " at shell:" << model.shell_ids[report.time_step->shell.value] << '\n';
  if (report.added_mass) out << "mass added by mass scaling " << *report.added_mass << '\n';
}

}  // namespace

int check(const CheckOptions& options, const Common& common, const Context& context) {
  const auto refuse = [&](const Error& error) {
    say(context, error);
    return kFailed;
  };
  const Result<mesh::document::Document> document = open_deck(options.deck, common, context);
  if (!document) return refuse(document.error());
  const mesh::Model& model = document->current().model;
  mesh::ShellSet shells;
  if (options.select) {
    Result<mesh::select::Chosen> chosen =
        mesh::select::evaluate(model, *options.select, mesh::select::EntityKind::element, document->current().relations->names);
    if (!chosen) return refuse(chosen.error());
    shells = std::move(chosen->shells);
  }
  say_warnings(context, *document);
  const CheckFigures figures = check_figures(*document, options.select ? &shells : nullptr, options.chordal);
  for (const std::string& sentence : figures.unknown) say(context, Error{document->path.string(), 0, "note: " + sentence});
  if (common.json)
    context.out << check_json(*document, figures) << '\n';
  else
    print_text(context.out, *document, figures);
  return options.save_settings && !save_settings(*document, context) ? kFailed : kDone;
}

}  // namespace prismesh::cli
