#include "mesh/batch/work.h"

#include <algorithm>

#include <sys/resource.h>

#include "mesh/document/contacts.h"
#include "mesh/document/open.h"
#include "mesh/document/prepare.h"
#include "mesh/document/save.h"
#include "mesh/report/change_report.h"

namespace prismesh::mesh::batch {

namespace {

using document::Document;

double peak_megabytes() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return static_cast<double>(used.ru_maxrss) / 1024;  // Linux tells kilobytes
}

Result<Document> open_frozen(const Study& study, const FrozenDeck& deck, const Progress& progress) {
  const Plan& plan = study.plan;
  document::OpenOptions options;
  options.progress = progress;
  options.length_unit = plan.length_unit;
  options.target_size = plan.target_size;
  if (plan.criteria) options.criteria = *plan.criteria;
  Result<Document> document = document::open(deck.path, options);
  if (!document && document.error().file.empty()) document.error().file = deck.path.string();
  if (document && document->deck->content.hex() != deck.hash)
    return fail(deck.path.string(), "the deck has changed since the plan was started; start the plan again to work with the new one");
  return document;
}

Result<Measured> measured(const Document& document, document::ContactSearch* search) {
  Measured figures;
  const document::Generation& current = document.current();
  const quality::Report report = quality::report(current.model, judged_by(document), document.deck->time_step);
  figures.shells = report.elements;
  figures.warn = report.counts.warn;
  figures.fail = report.counts.fail;
  figures.triangles_percent = report.triangles_percent;
  figures.composite_min = report.min_composite;
  figures.composite_mean = report.mean_composite;
  figures.mass = report.mass;
  if (report.time_step) figures.time_step = report.time_step->seconds;
  if (search == nullptr) return figures;
  const Result<document::Contacts> contacts = document::find_contacts(current, *search, {});
  if (!contacts) return fail(contacts.error());
  figures.perforations = contacts->perforations;
  figures.penetrations = contacts->penetrations;
  for (const document::ContactRegion& region : contacts->regions)
    if (region.max_depth) figures.depth = std::max(figures.depth.value_or(0), *region.max_depth);
  return figures;
}

/// The script's edits, then the repair. Returns the reason of a refusal; empty: none.
Result<std::string> apply_edits(const Study& study, const Variant& variant, const std::vector<ScriptEdit>& edits, Document& document,
                                VariantResult& result, const Progress& progress) {
  const auto refusal = [&](const Error& error, const std::string& place) -> Result<std::string> {
    if (is_cancelled(error)) return fail(error);
    return place + error.text();
  };
  const std::string script = study.scripts[variant.script].file.filename().string();
  for (const ScriptEdit& edit : edits) {
    const Result<document::EditReport> report = document::apply(document, edit.edit, progress);
    if (!report) return refusal(report.error(), script + ":" + std::to_string(edit.line) + ": ");
    result.notes.insert(result.notes.end(), report->notes.begin(), report->notes.end());
  }
  if (study.plan.repair == RepairScope::none) return std::string();
  document::Repair repair;
  repair.scope = study.plan.repair == RepairScope::all ? document::Scope::all : document::Scope::damaged;
  const Result<document::EditReport> report = document::apply(document, repair, progress);
  if (!report) return refusal(report.error(), "the repair after the script: ");
  result.notes.insert(result.notes.end(), report->notes.begin(), report->notes.end());
  return std::string();
}

/// About the nodes that moved.
std::optional<report::PartFigures::Box> box_to_draw(const Document& document) {
  const Model &before = document.opened->model, &after = document.current().model;
  std::vector<Vec3> places;
  for (const NodeIndex node : moved_nodes(before, after)) places.push_back(after.position(node));
  return report::picture_box(after, places);
}

void compare_states(const Document& document, VariantResult& result) {
  const Model &before = document.opened->model, &after = document.current().model;
  const std::vector<NodeIndex> moved = moved_nodes(before, after);
  result.nodes_moved = moved.size();
  result.max_displacement = largest_move(before, after, moved);
}

constexpr std::size_t kMaxNotes = 20;

}  // namespace

Result<VariantResult> work_variant(const Study& study, const Variants& variants, const Variant& variant,
                                   const std::filesystem::path& folder, const Painter& painter, Clock& clock, const Progress& progress) {
  const std::int64_t begun = clock.now_ns();
  const FrozenDeck& deck = study.decks[variant.deck];
  VariantResult result;
  Result<std::string> key = variants.key(variant);
  if (!key) return fail(key.error());
  const Result<std::vector<ScriptEdit>> edits = variants.edits(variant);
  if (!edits) return fail(edits.error());
  result.key = std::move(*key);
  result.version = PRISMESH_VERSION;
  result.deck = deck.path.filename().string();
  result.script = study.scripts[variant.script].file.filename().string();
  for (std::size_t p = 0; p < variant.values.size(); ++p) result.values.push_back({study.plan.parameters[p].name, variant.values[p]});

  Result<Document> document = open_frozen(study, deck, progress);
  if (!document) return fail(document.error());
  result.length_unit = std::string(name(document->settings.length_unit));
  document::ContactSearch search;
  document::ContactSearch* const searched = study.plan.penetrations ? &search : nullptr;
  Result<Measured> before = measured(*document, searched);
  if (!before) return fail(before.error());
  result.before = *before;
  Result<std::string> refused = apply_edits(study, variant, *edits, *document, result, progress);
  if (!refused) return fail(refused.error());
  if (result.notes.size() > kMaxNotes) result.notes.resize(kMaxNotes);
  if (refused->empty()) {
    Result<Measured> after = measured(*document, searched);
    if (!after) return fail(after.error());
    result.after = *after;
    compare_states(*document, result);
    const Result<deck::SaveReport> saved = document::save(*document, folder / deck.path.filename(), progress);
    if (!saved) return fail(saved.error());
    result.lines_changed = saved->lines_changed;
    result.elements_added = saved->shells_added;
    result.elements_removed = saved->shells_removed;
    result.written = deck.path.filename().string();
    if (painter) {
      const Result<void> drawn = painter(*document, folder / "picture.png", box_to_draw(*document));
      if (drawn)
        result.picture = "picture.png";
      else
        result.notes.push_back("no picture: " + drawn.error().text());
    }
  } else {
    result.outcome = Outcome::refused;
    result.reason = std::move(*refused);
  }
  result.seconds = static_cast<double>(clock.now_ns() - begun) * 1e-9;
  result.peak_mb = peak_megabytes();
  return result;
}

}  // namespace prismesh::mesh::batch
