#include "mesh/document/open.h"

#include "mesh/deck/data/deck.h"
#include "mesh/deck/data/length_unit.h"
#include "mesh/deck/open.h"
#include "mesh/document/chosen_criteria.h"
#include "mesh/document/clusters.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/deck_settings.h"
#include "mesh/document/find_deck_relations.h"
#include "mesh/model/node_set.h"
#include "mesh/quality/mass.h"
#include "mesh/quality/report.h"
#include "mesh/quality/target_size.h"

namespace prismesh::mesh::document {

namespace {

/// What was guessed for the parts, before anything is chosen.
Judging guesses_for(const Model& model) {
  Judging judging;
  judging.guessed_size = quality::guess_target_size(model);
  judging.guessed = quality::guess_part_sizes(model, judging.guessed_size);
  judging.parts.resize(model.parts->size());
  return judging;
}

/// The rules of the settings file, then those of the options.
Result<std::vector<JudgingRule>> rules_of(const std::filesystem::path& deck, const OpenOptions& options) {
  std::vector<JudgingRule> rules;
  if (options.read_settings_file) {
    Result<std::vector<JudgingRule>> beside = read_deck_settings(deck_settings_path(deck));
    if (!beside) return fail(std::move(beside.error()));
    rules = std::move(*beside);
  }
  if (options.target_size) rules.push_back({std::nullopt, options.target_size, std::nullopt, "", 0});
  if (options.criteria) rules.push_back({std::nullopt, std::nullopt, options.criteria->string(), "", 0});
  rules.insert(rules.end(), options.rules.begin(), options.rules.end());
  return rules;
}

struct Settled {
  DocumentSettings settings;
  std::shared_ptr<const Judging> judging;
};

Result<Settled> find_settings(const std::filesystem::path& path, const deck::Deck& deck, const Model& model, const select::Names& names,
                              const OpenOptions& options) {
  DocumentSettings settings = options.settings.value_or(DocumentSettings{});
  const std::optional<LengthUnit> known = options.length_unit ? options.length_unit : deck.length_unit;
  settings.length_unit_guessed = !known;
  settings.length_unit = known ? *known : deck::guess_length_unit(model);
  if (options.judged_by && options.judged_by->parts.size() == model.parts->size()) return Settled{settings, options.judged_by};

  Judging judging = guesses_for(model);
  judging.criteria = options.judged_by ? options.judged_by->criteria : default_choice(deck.time_step.scale);
  std::error_code failed;
  settings.has_file = options.read_settings_file && std::filesystem::exists(deck_settings_path(path), failed);
  const Result<std::vector<JudgingRule>> rules = rules_of(path, options);
  if (!rules) return fail(rules.error());
  if (Result<void> applied = apply_rules(*rules, model, names, judging, options.unread_criteria); !applied)
    return fail(std::move(applied.error()));
  settle(judging);
  settings.target_size = judging.deck_size;
  const auto is_given = [&](const auto& of_rule) { return std::any_of(options.rules.begin(), options.rules.end(), of_rule); };
  settings.sizes_given = options.target_size || is_given([](const JudgingRule& rule) { return rule.target_size.has_value(); });
  const bool all_read = options.unread_criteria == nullptr || options.unread_criteria->empty();
  settings.criteria_given = all_read && (options.criteria || is_given([](const JudgingRule& rule) { return rule.criteria.has_value(); }));
  settings.target_size_guessed = !std::holds_alternative<double>(judging.target_size);
  return Settled{std::move(settings), std::make_shared<const Judging>(std::move(judging))};
}

void judge(const Model& model, const Judging& judging, const Generation* like, Generation& first) {
  if (like == nullptr) {
    first.quality = quality::judge_model(model, sized(judging));
    first.counts = quality::count(first.quality);
    return;
  }
  first.quality = like->quality;
  first.counts = like->counts;
  quality::rejudge(model, sized(judging), shells_touching(model, moved_nodes(like->model, model)), first.quality, first.counts);
}

std::shared_ptr<const Generation> first_generation(std::shared_ptr<const DeckRelations> relations, Model model, const Settled& settled,
                                                   const Generation* like) {
  auto first = std::make_shared<Generation>();
  first->relations = std::move(relations);
  first->node_marks = ChunkedArray<std::uint8_t>::filled(model.node_count());
  first->shell_marks = ChunkedArray<std::uint8_t>::filled(model.shell_count());
  first->parts = std::make_shared<const std::vector<PartState>>(model.parts->size());
  first->judging = settled.judging;
  judge(model, *settled.judging, like != nullptr && like->judging == settled.judging ? like : nullptr, *first);
  first->clusters = clusters_of(*settled.judging, model);
  first->weight = quality::mass_properties(model);
  first->surface = std::make_shared<const Model>(model);
  first->model = std::move(model);
  first->made_by = "open";
  return first;
}

}  // namespace

Result<Document> open(const std::filesystem::path& path, deck::OpenedDeck opened, const OpenOptions& options) {
  const bool same_cards = options.like != nullptr && options.like->relations->deck->references == opened.deck->references;
  const std::shared_ptr<const DeckRelations> relations =
      same_cards ? carry_deck_relations(opened.deck, *options.like->relations) : find_deck_relations(opened.deck, opened.model);
  Result<Settled> settled = find_settings(path, *opened.deck, opened.model, relations->names, options);
  if (!settled) return fail(std::move(settled.error()));
  Document document;
  document.path = path;
  document.deck = std::move(opened.deck);
  document.settings = settled->settings;
  document.history_bytes = options.history_bytes;
  document.opened = first_generation(relations, std::move(opened.model), *settled, options.like);
  document.generations = {document.opened};
  return document;
}

Result<Document> open(const std::filesystem::path& path, const OpenOptions& options) {
  Result<deck::OpenedDeck> opened = deck::open(path, options.progress);
  if (!opened) return fail(opened.error());
  return open(path, std::move(*opened), options);
}

}  // namespace prismesh::mesh::document
