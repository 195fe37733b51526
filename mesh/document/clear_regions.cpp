#include "mesh/document/clear_regions.h"

#include <algorithm>
#include <string>
#include <utility>

#include "mesh/contact/try_regions.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/separation_setting.h"

namespace prismesh::mesh::document {

namespace {

constexpr std::size_t kMaxTried = 20;  ///< each costs an edit

contact::ContactThickness wished_thickness(const Generation& generation, const ContactWish& wish) {
  if (wish.thickness) return contact::given_thickness(generation.model, *wish.thickness);
  return wish.by_contacts ? contact_thickness(generation) : contact::section_thickness(generation.model);
}

bool within(const ShellSet& some, const ShellSet& all) { return std::includes(all.begin(), all.end(), some.begin(), some.end()); }

/// Of a selection a region may list a part of what is tried.
bool is_of(const ContactRegion& region, const contact::RegionTrial& trial) {
  if (trial.perforation != (region.kind == "perforation")) return false;
  return (within(region.shells_a, trial.shells[0]) && within(region.shells_b, trial.shells[1])) ||
         (within(region.shells_a, trial.shells[1]) && within(region.shells_b, trial.shells[0]));
}

}  // namespace

Result<void> find_clear(const Document& document, const ContactWish& wish, Contacts& contacts, const Progress& progress) {
  if (contacts.regions.empty()) return {};
  const Generation& current = document.current();
  ShellSet selected;
  if (wish.select) {
    Result<select::Chosen> chosen =
        select::evaluate(current.model, *wish.select, select::EntityKind::element, current.relations->names, progress);
    if (!chosen) return fail(chosen.error());
    selected = std::move(chosen->shells);
    std::sort(selected.begin(), selected.end());
  }
  const SeparationSetting setting(document, wished_thickness(current, wish));
  contact::SeparationWish separation;
  separation.on = wish.select ? &selected : nullptr;
  separation.joined = true;
  separation.gap = wish.gap;
  const Result<std::vector<contact::RegionTrial>> trials = contact::try_regions(setting.input(), separation, kMaxTried, progress);
  if (!trials) return fail(trials.error());
  for (ContactRegion& region : contacts.regions) {
    const auto trial = std::find_if(trials->begin(), trials->end(), [&](const auto& each) { return is_of(region, each); });
    region.clear = trial != trials->end() && trial->why.empty();
    region.why = trial != trials->end() ? trial->why : "it wasn't tried: more than " + std::to_string(kMaxTried) + " others are worse";
  }
  return {};
}

}  // namespace prismesh::mesh::document
