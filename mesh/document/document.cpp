#include "mesh/document/document.h"

#include <algorithm>

#include "base/clock.h"
#include "base/counted.h"
#include "mesh/deck/text_changes.h"
#include "mesh/document/apply.h"
#include "mesh/document/history.h"
#include "mesh/document/surroundings.h"
#include "mesh/model/node_set.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::document {

namespace {

Result<Settings> find_settings(const deck::Deck& deck, const Model& model, const OpenOptions& options) {
  Settings settings;
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

std::shared_ptr<const Generation> first_generation(const std::shared_ptr<const deck::Deck>& deck, Model model, const Settings& settings) {
  auto first = std::make_shared<Generation>();
  first->around = find_surroundings(deck, model);
  first->node_marks = ChunkedArray<std::uint8_t>::filled(model.node_count());
  first->shell_marks = ChunkedArray<std::uint8_t>::filled(model.shell_count());
  first->parts = std::make_shared<const std::vector<PartState>>(model.parts->size());
  first->quality = quality::judge_model(model, settings.criteria, settings.target_size);
  first->counts = quality::count(first->quality);
  first->weight = quality::weigh_model(model);
  first->surface = std::make_shared<const Model>(model);
  first->model = std::move(model);
  first->made_by = "open";
  return first;
}

}  // namespace

Result<Document> open(const std::filesystem::path& path, deck::OpenedDeck opened, const OpenOptions& options) {
  Result<Settings> settings = find_settings(*opened.deck, opened.model, options);
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

namespace {

Result<Prepared> prepare_step(const Document& document, bool back) {
  if (back ? !document.can_undo() : !document.can_redo()) {
    const bool dropped = back && document.generations.front()->made_by != "open";  // not `opened`: saving in place replaces that
    return fail("", std::string("there is nothing to ") + (back ? "undo" : "redo") +
                        (dropped ? " any more: the oldest steps went to keep the history within its size" : ""));
  }
  Prepared prepared;
  prepared.step = back ? Prepared::Step::undo : Prepared::Step::redo;
  prepared.next = document.generations[back ? document.cursor - 1 : document.cursor + 1];
  const Model &from = document.current().model, &to = prepared.next->model;
  const Changes changes = back ? changes_between(to, from) : changes_between(from, to);
  prepared.report.nodes_moved = moved_nodes(from, to).size();
  prepared.report.elements_added = (back ? changes.removed_shells : changes.added_shells).size();
  prepared.report.elements_removed = (back ? changes.added_shells : changes.removed_shells).size();
  prepared.report.notes.push_back((back ? "undid " : "did again: ") + (back ? document.current() : *prepared.next).made_by);
  return prepared;
}

template <class E>
Result<Prepared> prepare_push(const Document& document, const E& edit, std::string_view edit_name, const Progress& progress) {
  const Generation& current = document.current();
  auto next = std::make_shared<Generation>(current);
  Prepared prepared;
  const Result<void> applied = [&] {
    if constexpr (requires { apply_edit(document, edit, *next, prepared.report, progress); })
      return apply_edit(document, edit, *next, prepared.report, progress);
    else
      return apply_edit(document, edit, *next, prepared.report);
  }();
  if (!applied) return fail(applied.error());
  next->number = document.next_number;
  next->made_by = edit_name;
  next->own_bytes = own_bytes(current, *next);
  prepared.drop_oldest = generations_over_cap(document, *next);
  if (prepared.drop_oldest > 0)
    prepared.report.notes.push_back("the oldest " + counted(prepared.drop_oldest, "step") +
                                    " can't be undone any more: the history is kept within " + counted(document.history_bytes, "byte"));
  prepared.next = std::move(next);
  return prepared;
}

void say_weights(const quality::Weight& before, const quality::Weight& after, EditReport& report) {
  const auto point = [](const quality::Weight& weight) {
    const std::optional<Vec3> at = weight.centre();
    return at ? std::optional<std::array<double, 3>>({at->x(), at->y(), at->z()}) : std::nullopt;
  };
  if (before.shells > 0) report.mass_before = before.mass;
  if (after.shells > 0) report.mass_after = after.mass;
  report.centre_before = point(before);
  report.centre_after = point(after);
}

}  // namespace

Result<Prepared> prepare(const Document& document, const Edit& edit, const Progress& progress) {
  MonotonicClock clock;
  const std::int64_t start_ns = clock.now_ns();
  Result<Prepared> prepared = std::visit(
      [&](const auto& each) -> Result<Prepared> {
        using E = std::decay_t<decltype(each)>;
        if constexpr (std::is_same_v<E, Undo> || std::is_same_v<E, Redo>)
          return prepare_step(document, std::is_same_v<E, Undo>);
        else
          return prepare_push(document, each, name(edit), progress);
      },
      edit);
  if (!prepared) return prepared;
  prepared->report.edit = name(edit);
  if (const EditReport& done = prepared->report; done.nodes_moved + done.elements_added + done.elements_removed > 0)
    say_weights(document.current().weight, prepared->next->weight, prepared->report);
  prepared->report.before = document.current().counts;
  prepared->report.after = prepared->next->counts;
  prepared->report.milliseconds = static_cast<double>(clock.now_ns() - start_ns) * 1e-6;
  return prepared;
}

void commit(Document& document, Prepared prepared) {
  switch (prepared.step) {
    case Prepared::Step::undo: --document.cursor; return;
    case Prepared::Step::redo: ++document.cursor; return;
    case Prepared::Step::push: break;
  }
  auto& generations = document.generations;
  generations.resize(document.cursor + 1);
  document.next_number = prepared.next->number + 1;
  generations.push_back(std::move(prepared.next));
  generations.erase(generations.begin(),
                    generations.begin() + static_cast<std::ptrdiff_t>(std::min(prepared.drop_oldest, generations.size() - 1)));
  document.cursor = generations.size() - 1;
}

Result<EditReport> apply(Document& document, const Edit& edit, const Progress& progress) {
  Result<Prepared> prepared = prepare(document, edit, progress);
  if (!prepared) return fail(prepared.error());
  EditReport report = prepared->report;
  commit(document, std::move(*prepared));
  return report;
}

namespace {

/// What rounded places make of the judgement of the shells about them; empty: nothing.
std::string rounding_note(const Document& document, const deck::Rounding& rounding) {
  if (rounding.nodes.empty()) return "";
  const Generation& current = document.current();
  Model as_read = current.model;
  NodeSet nodes;
  for (const auto& [node, at] : rounding.nodes) {
    as_read.positions.set(node.value, at);
    nodes.push_back(node);
  }
  std::sort(nodes.begin(), nodes.end());
  ChunkedArray<quality::ShellState> states = current.quality;
  quality::Counts counts = current.counts;
  quality::rejudge(as_read, document.settings.criteria, document.settings.target_size, shells_touching(as_read, nodes), states, counts);
  if (counts == current.counts) return "";
  const auto said = [](const quality::Counts& c) { return counted(c.warn, "element") + " warn and " + std::to_string(c.fail) + " fail"; };
  return "with the rounded numbers, as the deck is read again, " + said(counts) + "; before, " + said(current.counts);
}

}  // namespace

Result<deck::SaveReport> save(const Document& document, const std::filesystem::path& target, const Progress& progress) {
  Result<deck::StagedSave> staged = stage_save(document, target, progress);
  if (!staged) return fail(std::move(staged.error()));
  if (Result<void> placed = staged->put_in_place(); !placed) return fail(std::move(placed.error()));
  return staged->report();
}

Result<deck::StagedSave> stage_save(const Document& document, const std::filesystem::path& target, const Progress& progress) {
  Result<deck::StagedSave> staged =
      deck::StagedSave::write(*document.deck, document.opened->model, document.current().model, target, progress);
  if (staged)
    if (std::string note = rounding_note(document, staged->rounding()); !note.empty()) staged->add_note(std::move(note));
  return staged;
}

}  // namespace prismesh::mesh::document
