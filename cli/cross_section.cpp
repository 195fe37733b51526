#include <cstdint>
#include <filesystem>
#include <map>
#include <ostream>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "base/counted.h"
#include "base/file.h"
#include "cli/commands.h"
#include "cli/json_output.h"
#include "cli/open_deck.h"
#include "cli/report_text.h"
#include "mesh/document/deck_relations.h"
#include "mesh/measure/cross_section.h"
#include "mesh/select/expression.h"

namespace prismesh::cli {

namespace {

using mesh::measure::CrossSection;
using mesh::measure::SectionCurve;

std::string part_id_of(const mesh::Model& model, const SectionCurve& curve) {
  return curve.part.valid() ? std::to_string((*model.parts)[curve.part.value].id) : "none";
}

std::string csv_of(const mesh::Model& model, const CrossSection& section) {
  std::string text = "curve,part,closed,x,y,z\n";
  for (std::size_t c = 0; c < section.curves.size(); ++c) {
    const SectionCurve& curve = section.curves[c];
    const std::string begin = std::to_string(c + 1) + "," + part_id_of(model, curve) + (curve.closed ? ",1," : ",0,");
    for (const mesh::Vec3& at : curve.points) text += begin + shortest(at.x()) + "," + shortest(at.y()) + "," + shortest(at.z()) + "\n";
  }
  return text;
}

void print_section(std::ostream& out, const mesh::Model& model, const CrossSection& section, const std::string& unit) {
  if (section.curves.empty()) {
    out << "the plane cuts no shell\n";
    return;
  }
  struct Sum {
    std::size_t curves = 0;
    double length = 0;
  };
  std::map<mesh::PartIndex, Sum> of_part;
  for (const SectionCurve& curve : section.curves) {
    Sum& sum = of_part[curve.part];
    ++sum.curves;
    sum.length += curve.length;
  }
  out << counted(section.shells, "shell") << ", " << counted(section.curves.size(), "curve") << ", " << rounded(section.length) << ' '
      << unit << '\n';
  for (const auto& [part, sum] : of_part)
    out << (part.valid() ? "part:" + std::to_string((*model.parts)[part.value].id) : "no part") << "  " << counted(sum.curves, "curve")
        << ", " << rounded(sum.length) << ' ' << unit << '\n';
}

}  // namespace

int cross_section(const CrossSectionOptions& options, const Common& common, const Context& context) {
  const auto refuse = [&](const Error& error) {
    say(context, error);
    return kFailed;
  };
  const Result<mesh::document::Document> document = open_deck(options.deck, common, context);
  if (!document) return refuse(document.error());
  const mesh::Model& model = document->current().model;
  std::vector<std::uint8_t> left_out;
  if (options.parts) {
    const auto chosen = mesh::select::evaluate(model, *options.parts, mesh::select::EntityKind::part, document->current().relations->names);
    if (!chosen) return refuse(chosen.error());
    left_out.assign(model.parts->size(), 1);
    for (const mesh::PartIndex part : chosen->parts) left_out[part.value] = 0;
  }
  if (options.output)
    for (const mesh::deck::SourceFile& file : document->deck->files)
      if (std::error_code failed; std::filesystem::equivalent(file.path, *options.output, failed))
        return refuse({options.output->string(), 0, "is a file of the deck; the curves need another one"});
  const Result<CrossSection> section = mesh::measure::cross_section(model, options.plane, left_out);
  if (!section) return refuse({"--plane", 0, section.error().message});
  say_warnings(context, *document);
  say_unit_guess(context, *document);
  if (common.json)
    context.out << cross_section_json(model, *section) << '\n';
  else
    print_section(context.out, model, *section, std::string(name(document->settings.length_unit)));
  if (!options.output) return kDone;
  if (!output_is_good(context)) return kFailed;
  const std::string csv = csv_of(model, *section);
  const PendingFile file{*options.output, {csv}};
  const Result<void> written = replace_files(std::span(&file, 1));
  return written ? kDone : refuse(written.error());
}

}  // namespace prismesh::cli
