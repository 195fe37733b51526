#include <map>
#include <ostream>
#include <string>

#include "base/counted.h"
#include "cli/commands.h"
#include "cli/json_output.h"
#include "cli/open_deck.h"
#include "cli/report_text.h"
#include "mesh/document/weld_checks.h"

namespace prismesh::cli {

int welds(const WeldsOptions& options, const Common& common, const Context& context) {
  const Result<mesh::document::Document> document = open_deck(options.deck, common, context);
  if (!document) {
    say(context, document.error());
    return kFailed;
  }
  const mesh::document::WeldChecks checks = mesh::document::check_welds(*document, {options.edge_distance, options.pitch});
  say_warnings(context, *document);
  if (common.json) {
    context.out << welds_json(checks) << '\n';
    return kDone;
  }
  context.out << counted(checks.welds, "weld") << ", " << counted(checks.findings.size(), "finding") << '\n';
  std::map<std::string, std::size_t> kinds;
  for (const mesh::document::WeldFinding& finding : checks.findings) ++kinds[finding.kind];
  for (const auto& [kind, count] : kinds) context.out << kind << ' ' << count << '\n';
  for (const mesh::document::WeldFinding& finding : checks.findings)
    context.out << finding.words << "  at (" << rounded(finding.at.x()) << ", " << rounded(finding.at.y()) << ", "
                << rounded(finding.at.z()) << ")\n";
  return kDone;
}

}  // namespace prismesh::cli
