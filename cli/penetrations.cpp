#include <ostream>

#include "base/counted.h"
#include "cli/commands.h"
#include "cli/json_output.h"
#include "cli/open_deck.h"
#include "cli/report_text.h"
#include "mesh/document/clear_regions.h"
#include "mesh/document/contacts.h"

namespace prismesh::cli {

namespace {

using mesh::document::ContactRegion;
using mesh::document::Contacts;

/// In larger decks trying a single region can take a minute, many times what finding all of them does.
constexpr std::size_t kMaxShellsTried = 100'000;

void print_region(std::ostream& out, const ContactRegion& region, std::string_view unit) {
  const auto with_name = [](const std::string& part, const std::string& name) {
    return (part.empty() ? "no part" : part) + (name.empty() ? "" : " " + printable(name));
  };
  out << with_name(region.a, region.name_a) << " and " << with_name(region.b, region.name_b);
  if (region.kind == "perforation")
    out << " cross along " << rounded(region.length) << ' ' << unit << ", ";
  else
    out << (region.kind == "penetration" ? " are too close, " : " are apart by less than the gap, ");
  if (region.max_depth)
    out << rounded(*region.max_depth) << ' ' << unit << " deep";
  else
    out << "half through";
  out << ", at (" << region.at.transpose() << "): " << region.worst_a << ", " << region.worst_b;
  if (!region.contact.empty()) out << "; seen by " << printable(region.contact);
  if (region.joined) out << "; joined there";
  out << (region.clear ? "; clear: separate removes it" : "; separate leaves it: " + printable(region.why)) << '\n';
}

}  // namespace

int penetrations(const PenetrationsOptions& options, const Common& common, const Context& context) {
  const auto refuse = [&](const Error& error) {
    say(context, error);
    return kFailed;
  };
  const Result<mesh::document::Document> document = open_deck(options.deck, common, context);
  if (!document) return refuse(document.error());
  mesh::document::ContactSearch search;
  const mesh::document::ContactWish wish{options.select, options.gap, options.thickness, options.by_contacts};
  Result<Contacts> found = mesh::document::find_contacts(document->current(), search, wish);
  if (!found) return refuse(found.error());
  if (options.tries_clear || document->current().model.shell_nodes.size() <= kMaxShellsTried) {
    if (const Result<void> tried = mesh::document::find_clear(*document, wish, *found); !tried) return refuse(tried.error());
  } else {
    for (ContactRegion& region : found->regions)
      region.why = "it wasn't tried: that can take minutes in a deck of more than 100,000 shells; --clear tries it";
  }
  const Contacts& contacts = *found;
  say_warnings(context, *document);
  if (common.json) {
    context.out << penetrations_json(contacts) << '\n';
    return kDone;
  }
  if (contacts.regions.empty()) context.out << "no shells cross or are too close\n";
  for (const ContactRegion& region : contacts.regions) print_region(context.out, region, name(document->settings.length_unit));
  if (!contacts.without_thickness.empty())
    context.out << counted(contacts.without_thickness.size(), "part")
                << " without a thickness: what is too close to them isn't known (--thickness gives one)\n";
  return kDone;
}

}  // namespace prismesh::cli
