#include <algorithm>
#include <array>
#include <ostream>
#include <string>
#include <tuple>
#include <vector>

#include "base/counted.h"
#include "cli/commands.h"
#include "cli/json_output.h"
#include "cli/open_deck.h"
#include "cli/progress_bar.h"
#include "cli/report_text.h"
#include "mesh/document/flanges.h"

namespace prismesh::cli {

namespace {

using mesh::connections::Flange;
using mesh::connections::Flanges;

/// parts, sheets, length, width mean and min, distance, where
using Row = std::array<std::string, 7>;

Row row_of(const mesh::Model& model, const Flange& flange) {
  std::string parts;
  for (const mesh::PartIndex part : flange.parts)
    parts += (parts.empty() ? "" : ", ") + (part.valid() ? std::to_string((*model.parts)[part.value].id) : "none");
  const mesh::Vec3& at = flange.centre();
  const std::string place = "(" + rounded(at.x()) + ", " + rounded(at.y()) + ", " + rounded(at.z()) + ")";
  return {parts,
          std::to_string(flange.sheets()),
          rounded(flange.length),
          rounded(flange.mean_width),
          rounded(flange.min_width),
          rounded(flange.distance),
          place + " shell:" + std::to_string(model.shell_ids[flange.shells.front().value])};
}

void print_rows(std::ostream& out, const std::vector<Row>& rows) {
  std::array<std::size_t, std::tuple_size_v<Row>> width{};
  for (const Row& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
  for (const Row& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string padding(width[c] - row[c].size(), ' ');
      const bool left = c == 0 || c + 1 == row.size();
      out << (c == 0 ? "" : "  ") << (left ? row[c] : padding + row[c]) << (left && c + 1 < row.size() ? padding : "");
    }
    out << '\n';
  }
}

}  // namespace

int flanges(const FlangesOptions& options, const Common& common, const Context& context) {
  const auto refuse = [&](const Error& error) {
    say(context, error);
    return kFailed;
  };
  const Result<mesh::document::Document> document = open_deck(options.deck, common, context);
  if (!document) return refuse(document.error());
  const mesh::Model& model = document->current().model;
  const Result<Flanges> found = [&] {
    MonotonicClock clock;
    ProgressBar bar(context, "looking for flanges", clock);
    return mesh::document::find_flanges(document->current(), {options.select, options.gap, options.max_width}, bar.progress());
  }();
  if (!found) return refuse(found.error());
  say_warnings(context, *document);
  if (common.json) {
    context.out << flanges_json(model, *found) << '\n';
    return kDone;
  }
  const std::string unit(name(document->settings.length_unit));
  std::vector<Row> rows{{"parts", "sheets", "length", "width", "min width", "distance", "at (" + unit + ")"}};
  for (const Flange& flange : found->all) rows.push_back(row_of(model, flange));
  if (found->all.empty())
    context.out << "no sheets run parallel in a band\n";
  else
    print_rows(context.out, rows);
  if (!found->without_thickness.empty())
    context.out << counted(found->without_thickness.size(), "part")
                << " without a thickness: their flanges need --gap, how far apart sheets may be\n";
  return kDone;
}

}  // namespace prismesh::cli
