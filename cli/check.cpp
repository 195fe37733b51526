#include <iomanip>
#include <ostream>

#include "cli/commands.h"
#include "cli/json_output.h"
#include "cli/open_deck.h"
#include "cli/report_text.h"
#include "mesh/document/surroundings.h"
#include "mesh/select/expression.h"

namespace prismesh::cli {

namespace {

namespace quality = mesh::quality;

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

void print_text(std::ostream& out, const mesh::document::Document& document, const quality::Report& report) {
  const mesh::document::Settings& settings = document.settings;
  const mesh::Model& model = document.current().model;
  out << report.elements << " shells: " << report.counts.ok << " ok, " << report.counts.warn << " warn, " << report.counts.fail
      << " fail\n";
  out << "target size " << shortest(settings.target_size) << ' ' << name(settings.length_unit)
      << (settings.target_size_guessed ? " (guessed), criteria " : ", criteria ") << printable(settings.criteria.name) << '\n';
  const double percent = report.triangles_percent;
  const char* grade = percent > settings.criteria.fail_triangles_percent   ? " (fail)"
                      : percent > settings.criteria.warn_triangles_percent ? " (warn)"
                                                                           : "";
  out << "triangles " << percent << " %" << grade << '\n';
  if (report.elements > 0) print_metrics(out, model, report);
  if (report.mass) out << "mass " << *report.mass << '\n';
  if (report.centre_of_gravity) out << "centre of gravity " << report.centre_of_gravity->transpose() << '\n';
  if (report.time_step)
    out << "time step " << report.time_step->seconds << " at shell:" << model.shell_ids[report.time_step->shell.value] << '\n';
  if (report.added_mass) out << "mass added by mass scaling " << *report.added_mass << '\n';
}

}  // namespace

int check(const CheckOptions& options, const Common& common, const Surroundings& surroundings) {
  const auto refuse = [&](const Error& error) {
    say(surroundings, error);
    return kFailed;
  };
  const Result<mesh::document::Document> document = open_deck(options.deck, common, surroundings);
  if (!document) return refuse(document.error());
  const mesh::Model& model = document->current().model;
  mesh::ShellSet shells;
  if (options.select) {
    Result<mesh::select::Chosen> chosen =
        mesh::select::evaluate(model, *options.select, mesh::select::Kind::element, document->current().around->names);
    if (!chosen) return refuse(chosen.error());
    shells = std::move(chosen->shells);
  }
  say_warnings(surroundings, *document);
  const quality::Report report = quality::report(model, document->settings.criteria, document->settings.target_size,
                                                 document->deck->time_step, options.select ? &shells : nullptr);
  if (common.json)
    surroundings.out << check_json(*document, report) << '\n';
  else
    print_text(surroundings.out, *document, report);
  return kDone;
}

}  // namespace prismesh::cli
