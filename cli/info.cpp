#include <optional>
#include <ostream>

#include "base/counted.h"
#include "cli/commands.h"
#include "cli/figures.h"
#include "cli/json_output.h"
#include "cli/open_deck.h"
#include "cli/report_text.h"

namespace prismesh::cli {

namespace {

/// What stands behind a part's target size.
const char* size_source(mesh::quality::SizeFrom from) {
  return from == mesh::quality::SizeFrom::given ? "" : from == mesh::quality::SizeFrom::part ? " (guessed)" : " (guessed, the deck's)";
}

void print_text(std::ostream& out, const mesh::document::Document& document) {
  const mesh::deck::Deck& deck = *document.deck;
  const mesh::deck::ElementCounts n = deck.element_cards.without(deck.left_out_cards);
  const mesh::deck::ElementCounts& left_out = deck.left_out_cards;
  const mesh::document::DocumentSettings& settings = document.settings;
  const std::string unit(name(settings.length_unit));
  const auto guessed = [](bool is) { return is ? " (guessed)" : ""; };
  out << printable(document.path.string()) << ": " << name(deck.format) << ", " << counted(deck.files.size(), "file") << '\n';
  for (const mesh::deck::SourceFile& file : deck.files) out << "  " << printable(file.path.string()) << '\n';
  for (const mesh::deck::CompanionFile& file : deck.companions) out << "  " << printable(file.path.string()) << " (named, not read)\n";
  out << "length unit  " << unit << guessed(settings.length_unit_guessed) << '\n';
  const mesh::document::Judging& judging = *document.current().judging;
  out << "target size  " << target_sizes(document) << ' ' << unit << guessed(is_guessed(judging.target_size)) << '\n';
  out << "criteria     " << criteria_names(document) << '\n';
  out << "nodes        " << document.current().model.node_index->size() << '\n';
  out << "shells       " << n.quad << " quads, " << n.tri << " triangles, " << n.quad8 << " 8-node quads, " << n.tri6
      << " 6-node triangles\n";
  out << "others       " << n.beam << " beams, " << n.solid << " solids, " << n.tshell << " thick shells, " << n.other << " more\n";
  if (left_out.all() > 0)
    out << "left out     " << counted(left_out.shells(), "shell") << ", " << left_out.beam << " beams, " << left_out.solid << " solids, "
        << left_out.tshell << " thick shells, " << left_out.other << " more: see the warnings\n";
  if (!deck.element_kinds.empty()) {
    out << "by card     ";
    for (const auto& [kind, count] : deck.element_kinds) out << ' ' << printable(kind) << ' ' << count;
    out << '\n';
  }
  const std::vector<PartFigures> parts = mesh::report::part_figures(document.current().model);
  out << "parts        " << parts.size() << '\n';
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const PartFigures& part = parts[p];
    out << "  part:" << part.id << "  " << printable(part.name) << "  " << part.quads << " quads, " << part.tris << " triangles";
    if (part.thickness) out << ", " << shortest(*part.thickness) << ' ' << unit << " thick";
    const mesh::quality::PartCriteria& judged = judging.by_part.of(mesh::PartIndex(p));
    if (part.quads + part.tris > 0) out << ", target size " << shortest(judged.target_size) << ' ' << unit << size_source(judged.size_from);
    if (judged.criteria) out << ", criteria " << printable(judged.criteria->name);
    out << '\n';
  }
  out << "warnings     " << deck.warnings.size() << '\n';
  for (const mesh::deck::Warning& warning : deck.warnings) {
    out << "  " << printable(Error{warning.file, warning.line, warning.message}.text());
    if (warning.count > 1) out << " (" << warning.count << " times)";
    out << '\n';
  }
}

}  // namespace

int info(const InfoOptions& options, const Common& common, const Context& context) {
  const Result<mesh::document::Document> document =
      options.sandboxed ? open_sandboxed(options.deck, common, context) : open_deck(options.deck, common, context);
  if (!document) {
    say(context, document.error());
    return kFailed;
  }
  if (common.json)
    context.out << info_json(*document) << '\n';
  else
    print_text(context.out, *document);
  return options.save_settings && !save_settings(*document, context) ? kFailed : kDone;
}

}  // namespace prismesh::cli
