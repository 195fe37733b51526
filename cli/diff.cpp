#include <ostream>

#include "cli/commands.h"
#include "cli/figures.h"
#include "cli/json_output.h"
#include "cli/progress_bar.h"
#include "cli/report_text.h"
#include "mesh/deck/open.h"
#include "mesh/report/comparison.h"

namespace prismesh::cli {

namespace {

using mesh::deck::OpenedDeck;
using mesh::report::Difference;

Result<OpenedDeck> open_one(const std::filesystem::path& path, const Context& context) {
  MonotonicClock clock;
  ProgressBar bar(context, "reading " + path.filename().string(), clock);
  Result<OpenedDeck> opened = mesh::deck::open(path, bar.progress());
  if (!opened && opened.error().file.empty()) opened.error().file = path.string();
  return opened;
}

}  // namespace

int diff(const DiffOptions& options, const Common& common, const Context& context) {
  const Result<OpenedDeck> a = open_one(options.a, context);
  const Result<OpenedDeck> b = a ? open_one(options.b, context) : a;
  if (!b) {
    say(context, b.error());
    return kFailed;
  }
  const Difference d = mesh::report::compare(*a, *b);
  if (common.json) {
    context.out << diff_json(d) << '\n';
    return kDone;
  }
  context.out << "nodes: " << d.nodes_moved << " moved (max " << rounded(d.max_displacement) << "), " << d.nodes_added << " added, "
              << d.nodes_removed << " removed\n"
              << "elements: " << d.elements_added << " added, " << d.elements_removed << " removed, " << d.elements_changed << " changed\n"
              << "lines: " << d.lines_changed << " changed\n";
  const auto say_field = [&](const char* what, const std::optional<FieldFigures>& field) {
    if (field && field->max > 0)
      context.out << what << ": max " << rounded(field->max) << " (" << field->max_at << "), mean " << rounded(field->mean) << " over "
                  << field->measured << " nodes\n";
  };
  if (!d.displacement) context.out << "displacement: the two decks have no node in common\n";
  say_field("displacement", d.displacement);
  say_field("distance of the second deck's shells from the first's", d.surface_distance);
  return kDone;
}

}  // namespace prismesh::cli
