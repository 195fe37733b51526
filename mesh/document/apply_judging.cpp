// Edits that set what parts are judged by.
#include <algorithm>

#include "base/counted.h"
#include "base/file.h"
#include "base/readable_number.h"
#include "mesh/document/apply.h"
#include "mesh/document/chosen_criteria.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/judge_parts.h"
#include "mesh/document/judging_rules.h"
#include "mesh/document/parts_of_selection.h"
#include "mesh/document/read_variant.h"
#include "mesh/document/self_contained.h"
#include "mesh/document/weld_places.h"

namespace prismesh::mesh::document {

namespace {

constexpr std::size_t kMaxNamedParts = 10;

/// All parts, if the edit names none and nothing is selected.
Result<PartFlags> parts_to_judge(const Document& document, const std::optional<std::string>& on) {
  const Generation& current = document.current();
  if (on) {
    const Result<std::vector<PartIndex>> parts = parts_named_by(*on, current.model, current.relations->names);
    if (!parts) return fail(parts.error());
    PartFlags flags(current.model.parts->size(), 0);
    for (const PartIndex part : *parts) flags[part.value] = 1;
    return flags;
  }
  if (current.selected_nodes == 0 && current.selected_shells == 0) return PartFlags(current.model.parts->size(), 1);
  return parts_of_selection(document);
}

bool are_all(const PartFlags& named) {
  return std::all_of(named.begin(), named.end(), [](std::uint8_t flag) { return flag != 0; });
}

/// Notes the parts for which `difference` says something: "part 3: target size 5, before 10".
template <class Difference>
void note_parts(const Model& model, const char* unchanged, EditReport& report, const Difference& difference) {
  std::size_t changed = 0;
  for (std::size_t p = 0; p < model.parts->size(); ++p) {
    const std::string said = difference(PartIndex(p));
    if (said.empty() || ++changed > kMaxNamedParts) continue;
    report.notes.push_back("part " + std::to_string((*model.parts)[p].id) + ": " + said);
  }
  if (changed == 0) report.notes.emplace_back(unchanged);
  if (changed > kMaxNamedParts) report.notes.push_back("and of " + counted(changed - kMaxNamedParts, "more part"));
}

/// The sizes of the parts whose size changed.
void note_sizes(const Model& model, const Judging& before, const Judging& now, EditReport& report) {
  note_parts(model, "no part's target size changed", report, [&](PartIndex part) {
    const double was = before.by_part.of(part).target_size, is = now.by_part.of(part).target_size;
    return was == is ? std::string() : "target size " + readable(is, 6) + ", before " + readable(was, 6);
  });
}

const ChosenCriteria& criteria_of(const Judging& judging, PartIndex part) {
  const std::optional<ChosenCriteria>& own = judging.parts[part.value].criteria;
  return own ? *own : judging.criteria;
}

/// The criteria of the parts whose criteria changed, and of the deck.
void note_criteria(const Model& model, const Judging& before, const Judging& now, EditReport& report) {
  const auto difference = [](const ChosenCriteria& was, const ChosenCriteria& is) -> std::string {
    if (is.criteria == was.criteria) return "";
    if (is.criteria->name == was.criteria->name) return "criteria " + is.criteria->name + ", read again";
    return "criteria " + is.criteria->name + ", before " + was.criteria->name;
  };
  if (const std::string said = difference(before.criteria, now.criteria); !said.empty()) report.notes.push_back("deck: " + said);
  note_parts(model, "no part's criteria changed", report,
             [&](PartIndex part) { return difference(criteria_of(before, part), criteria_of(now, part)); });
}

/// Errors: a field that is wrong.
Result<void> check_fields(const SetCriteria& edit) {
  if (edit.criteria.empty()) return fail("", "criteria must be a built-in set like \"strict\", a file, or \"deck\"");
  if (edit.text && (edit.criteria == kDeckCriteria || quality::is_built_in_criteria(edit.criteria)))
    return fail("", "a text belongs to a criteria file, not to \"" + edit.criteria + "\"");
  return {};
}

Error no_such_criteria(const std::string& place) {
  std::string known;
  for (const std::string_view name : quality::built_in_criteria()) known += (known.empty() ? "" : ", ") + std::string(name);
  return {place, 0, "there is no such file, and no built-in criteria of this name; built in are " + known};
}

Result<ChosenCriteria> criteria_wanted(const Document& document, const SetCriteria& edit) {
  const std::string place = criteria_place(edit.criteria, folder_of(document.path));
  const double scale = document.current().judging->criteria.criteria->time_step_scale;
  std::error_code unknown;
  if (edit.text) return read_chosen_criteria(place, *edit.text, scale);
  if (!quality::is_built_in_criteria(place) && !std::filesystem::exists(place, unknown)) return fail(no_such_criteria(place));
  return load_chosen_criteria(place, scale);
}

}  // namespace

Result<void> apply_edit(const Document& document, const SetTargetSize& edit, Generation& next, EditReport& report) {
  if (const Result<void> sound = check_target_size(edit.size); !sound) return sound;
  const Result<PartFlags> named = parts_to_judge(document, edit.on);
  if (!named) return fail(named.error());
  auto judging = std::make_shared<Judging>(*next.judging);
  if (are_all(*named)) {
    judging->target_size = edit.size;
    for (PartChoice& choice : judging->parts) choice.target_size.reset();
  } else {
    for (std::size_t p = 0; p < named->size(); ++p)
      if ((*named)[p] != 0) judging->parts[p].target_size = edit.size;
  }
  settle(*judging);
  note_sizes(next.model, *next.judging, *judging, report);
  judge_by(std::move(judging), next);
  return {};
}

Result<void> apply_edit(const Document& document, const SetCriteria& edit, Generation& next, EditReport& report) {
  if (Result<void> sound = check_fields(edit); !sound) return sound;
  const Result<PartFlags> named = parts_to_judge(document, edit.on);
  if (!named) return fail(named.error());
  auto judging = std::make_shared<Judging>(*next.judging);
  std::optional<ChosenCriteria> chosen;  // none: the deck's
  if (edit.criteria != kDeckCriteria) {
    Result<ChosenCriteria> wanted = criteria_wanted(document, edit);
    if (!wanted) return fail(std::move(wanted.error()));
    chosen = shared_choice(*judging, std::move(*wanted));
  }
  const bool of_deck = are_all(*named) && chosen;
  if (of_deck) judging->criteria = *chosen;
  for (std::size_t p = 0; p < named->size(); ++p)
    if ((*named)[p] != 0) judging->parts[p].criteria = of_deck ? std::nullopt : chosen;
  settle(*judging);
  note_criteria(next.model, *next.judging, *judging, report);
  judge_by(std::move(judging), next);
  return {};
}

Result<Edit> self_contained(const Document& document, const Edit& edit) {
  if (const auto* weld = std::get_if<Weld>(&edit)) {
    Result<Weld> whole = with_points(document, *weld);
    return whole ? Result<Edit>(std::move(*whole)) : fail(whole.error());
  }
  if (const auto* replace = std::get_if<ReplacePart>(&edit)) {
    Result<ReplacePart> whole = with_mesh(document, *replace, {});
    return whole ? Result<Edit>(std::move(*whole)) : fail(whole.error());
  }
  const auto* set = std::get_if<SetCriteria>(&edit);
  if (set == nullptr) return edit;
  if (const Result<void> sound = check_fields(*set); !sound) return fail(sound.error());
  if (set->text || set->criteria == kDeckCriteria || quality::is_built_in_criteria(set->criteria)) return edit;
  const Result<ChosenCriteria> wanted = criteria_wanted(document, *set);
  if (!wanted) return fail(wanted.error());
  return Edit(SetCriteria{wanted->name, *wanted->text, set->on});
}

}  // namespace prismesh::mesh::document
