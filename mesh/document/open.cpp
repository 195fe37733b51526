#include "mesh/document/open.h"

#include "mesh/deck/data/deck.h"
#include "mesh/deck/data/length_unit.h"
#include "mesh/deck/open.h"
#include "mesh/document/clusters.h"
#include "mesh/document/find_deck_relations.h"
#include "mesh/quality/mass.h"
#include "mesh/quality/report.h"

namespace prismesh::mesh::document {

namespace {

Result<DocumentSettings> find_settings(const deck::Deck& deck, const Model& model, const OpenOptions& options) {
  DocumentSettings settings;
  const std::optional<LengthUnit> known = options.length_unit ? options.length_unit : deck.length_unit;
  settings.length_unit_guessed = !known;
  settings.length_unit = known ? *known : deck::guess_length_unit(model);
  settings.target_size_guessed = !options.target_size;
  settings.target_size = options.target_size ? *options.target_size : quality::guess_target_size(model);
  if (!(settings.target_size > 0 && settings.target_size < 1e300)) return fail("", "the target size must be greater than 0");
  settings.criteria = quality::default_criteria();
  if (options.judged_by) {
    settings.criteria = *options.judged_by;
  } else if (options.criteria) {
    Result<quality::Criteria> criteria = quality::load_criteria(*options.criteria);
    if (!criteria) return fail(criteria.error());
    settings.criteria = std::move(*criteria);
  }
  settings.criteria.time_step_scale = deck.time_step.scale;
  return settings;
}

std::shared_ptr<const Generation> first_generation(const std::shared_ptr<const deck::Deck>& deck, Model model,
                                                   const DocumentSettings& settings) {
  auto first = std::make_shared<Generation>();
  first->relations = find_deck_relations(deck, model);
  first->node_marks = ChunkedArray<std::uint8_t>::filled(model.node_count());
  first->shell_marks = ChunkedArray<std::uint8_t>::filled(model.shell_count());
  first->parts = std::make_shared<const std::vector<PartState>>(model.parts->size());
  first->quality = quality::judge_model(model, {settings.criteria, settings.target_size});
  first->counts = quality::count(first->quality);
  first->clusters = clusters_of(settings, model);
  first->weight = quality::mass_properties(model);
  first->surface = std::make_shared<const Model>(model);
  first->model = std::move(model);
  first->made_by = "open";
  return first;
}

}  // namespace

Result<Document> open(const std::filesystem::path& path, deck::OpenedDeck opened, const OpenOptions& options) {
  Result<DocumentSettings> settings = find_settings(*opened.deck, opened.model, options);
  if (!settings) return fail(settings.error());
  Document document;
  document.path = path;
  document.deck = std::move(opened.deck);
  document.settings = std::move(*settings);
  document.history_bytes = options.history_bytes;
  document.opened = first_generation(document.deck, std::move(opened.model), document.settings);
  document.generations = {document.opened};
  return document;
}

Result<Document> open(const std::filesystem::path& path, const OpenOptions& options) {
  Result<deck::OpenedDeck> opened = deck::open(path, options.progress);
  if (!opened) return fail(opened.error());
  return open(path, std::move(*opened), options);
}

}  // namespace prismesh::mesh::document
