#include "mesh/document/journal.h"

#include <map>
#include <tuple>
#include <utility>

#include "base/base64.h"
#include "base/json/read.h"
#include "base/json/write.h"
#include "mesh/document/chosen_criteria.h"
#include "mesh/document/delta.h"
#include "mesh/document/edit_json.h"
#include "mesh/document/edit_kinds.h"
#include "mesh/document/history.h"
#include "mesh/document/journal_file.h"
#include "mesh/document/journal_rebuild.h"
#include "mesh/document/journal_records.h"
#include "mesh/document/judge_parts.h"
#include "mesh/document/judging_rules.h"
#include "mesh/select/expression.h"

namespace prismesh::mesh::document {

struct Journal::Impl {
  JournalFile file;
  std::uint64_t records = 0;
  std::string check;  ///< of the last record; the next record's check covers it
  bool cut_torn_tail = false;
  std::optional<Error> damage;
  bool takes_edits = true;
};

namespace {

std::string intent_text(const Edit& edit) { return json::to_line(edit_to_json(edit)); }

bool is_fresh(const Document& document) { return document.generations.size() == 1 && document.generations.front() == document.opened; }

/// The parts' sizes, those that are alike together.
std::vector<JournalHeader::PartSizes> part_sizes(const Model& model, const Judging& judging) {
  std::map<std::tuple<double, quality::SizeFrom, std::optional<TargetSize>>, std::vector<std::int64_t>> alike;
  for (std::size_t p = 0; p < judging.parts.size(); ++p)
    alike[{judging.guessed[p].target_size, judging.guessed[p].size_from, judging.parts[p].target_size}].push_back((*model.parts)[p].id);
  std::vector<JournalHeader::PartSizes> sizes;
  for (auto& [key, ids] : alike)
    sizes.push_back({select::to_expression(std::move(ids)), std::get<0>(key), std::get<1>(key), std::get<2>(key)});
  return sizes;
}

/// The deck's criteria, then those of parts, the parts that share them together.
std::vector<JournalHeader::ChosenOn> chosen_criteria(const Model& model, const Judging& judging) {
  std::vector<JournalHeader::ChosenOn> chosen{{std::nullopt, judging.criteria.name, *judging.criteria.text}};
  std::map<std::pair<std::string_view, std::string_view>, std::vector<std::int64_t>> alike;
  for (std::size_t p = 0; p < judging.parts.size(); ++p)
    if (const auto& own = judging.parts[p].criteria) alike[{own->name, *own->text}].push_back((*model.parts)[p].id);
  for (auto& [key, ids] : alike) chosen.push_back({select::to_expression(std::move(ids)), std::string(key.first), std::string(key.second)});
  return chosen;
}

JournalHeader header_of(const Document& document) {
  const Model& model = document.opened->model;
  const DocumentSettings& settings = document.settings;
  const Judging& judging = *document.opened->judging;
  return {PRISMESH_VERSION,
          {document.path.string(), document.deck->content.hex(), model.node_count(), model.shell_count(), model.parts->size()},
          {settings.length_unit, judging.deck_size, judging.criteria.criteria->name, judging.target_size, judging.guessed_size,
           part_sizes(model, judging), chosen_criteria(model, judging)}};
}

Result<void> check_deck(const JournalHeader& header, const Document& document, const std::string& file) {
  const std::string hash = document.deck->content.hex();
  if (header.deck.hash != hash)
    return fail(file, 1,
                "this is the journal of another deck or of another state of it: it belongs to " + header.deck.path + " with content " +
                    header.deck.hash + ", while " + document.path.string() + " has content " + hash);
  const Model& model = document.opened->model;
  if (header.deck.nodes != model.node_count() || header.deck.shells != model.shell_count() || header.deck.parts != model.parts->size())
    return fail(file, 1, "the journal was written by version " + header.program + ", which read this deck differently; replay it instead");
  return {};
}

/// Takes the target sizes as the journal's header has them: the guesses that its edits were made with, and what was chosen.
Result<void> take_sizes(const JournalHeader& header, const Model& model, const std::string& file, Judging& judging) {
  judging.guessed_size = header.settings.guessed_size.value_or(header.settings.target_size);
  judging.target_size = header.settings.size_of_all;
  for (std::size_t p = 0; p < judging.parts.size(); ++p) {
    judging.parts[p].target_size.reset();
    judging.guessed[p] = {judging.guessed_size, nullptr, quality::SizeFrom::deck};
  }
  for (const JournalHeader::PartSizes& sizes : header.settings.parts) {
    const Result<std::vector<PartIndex>> parts = parts_named_by(sizes.on, model, {});
    if (!parts || !(sizes.guessed > 0 && sizes.guessed < 1e300)) return fail(file, 1, "its target sizes of parts don't fit the deck");
    for (const PartIndex part : *parts) {
      judging.guessed[part.value] = {sizes.guessed, nullptr, sizes.from};
      judging.parts[part.value].target_size = sizes.own;
    }
  }
  return {};
}

/// Takes the criteria as the journal's header has them.
Result<void> take_criteria(const JournalHeader& header, const Model& model, const std::string& file, Judging& judging) {
  const double scale = judging.criteria.criteria->time_step_scale;
  for (PartChoice& choice : judging.parts) choice.criteria.reset();
  for (const JournalHeader::ChosenOn& chosen : header.settings.chosen_criteria) {
    const auto wrong = [&](const std::string& why) { return fail(file, 1, "its criteria can't be used: " + why); };
    Result<ChosenCriteria> read = chosen.name.empty() ? default_choice(scale) : read_chosen_criteria(chosen.name, chosen.text, scale);
    if (!read) return wrong(read.error().text());
    const ChosenCriteria shared = shared_choice(judging, std::move(*read));
    if (!chosen.on) {
      judging.criteria = shared;
      continue;
    }
    const Result<std::vector<PartIndex>> parts = parts_named_by(*chosen.on, model, {});
    if (!parts) return wrong(parts.error().text());
    for (const PartIndex part : *parts) judging.parts[part.value].criteria = shared;
  }
  return {};
}

/// Takes settings that were only guessed from the journal; settings that the user gave stay.
Result<void> take_settings(const JournalHeader& header, Document& document, const std::string& file) {
  DocumentSettings& settings = document.settings;
  if (settings.length_unit_guessed) settings.length_unit = header.settings.length_unit;
  Judging judging = *document.opened->judging;
  const Model& model = document.opened->model;
  if (!settings.sizes_given && header.settings.target_size > 0)
    if (Result<void> taken = take_sizes(header, model, file, judging); !taken) return taken;
  if (!settings.criteria_given && !header.settings.chosen_criteria.empty())
    if (Result<void> taken = take_criteria(header, model, file, judging); !taken) return taken;
  settle(judging);
  settings.target_size = judging.deck_size;
  settings.target_size_guessed = is_guessed(judging.target_size);
  auto judged = std::make_shared<Generation>(*document.opened);
  judge_by(std::make_shared<const Judging>(std::move(judging)), *judged);
  document.opened = judged;
  document.generations = {document.opened};
  return {};
}

}  // namespace

Journal::Journal(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Journal::Journal(Journal&&) noexcept = default;
Journal& Journal::operator=(Journal&&) noexcept = default;
Journal::~Journal() = default;

const std::filesystem::path& Journal::path() const { return impl_->file.path(); }
std::uint64_t Journal::records() const { return impl_->records; }
bool Journal::cut_torn_tail() const { return impl_->cut_torn_tail; }
const std::optional<Error>& Journal::damage() const { return impl_->damage; }
bool Journal::takes_edits() const { return impl_->takes_edits; }
Result<void> Journal::check_in_place() const { return impl_->file.check_untouched(); }
bool Journal::is_whole() const { return impl_->takes_edits && impl_->file.check_untouched().has_value(); }

Result<Journal> Journal::create(const std::filesystem::path& path, const Document& document) {
  if (!is_fresh(document)) return fail(path.string(), "a journal is started before the first edit; this document has been edited");
  const std::string text = header_text(header_of(document));
  Result<JournalFile> file = JournalFile::create(path, text);
  if (!file) return fail(file.error());
  return Journal(std::make_unique<Impl>(Impl{std::move(*file), 0, check_in(text), false, std::nullopt, true}));
}

Result<Journal> Journal::recover(const std::filesystem::path& path, Document& document) {
  if (!is_fresh(document)) return fail(path.string(), "a journal is recovered before the first edit; this document has been edited");
  std::string text;
  Result<JournalFile> file = JournalFile::open(path, text);
  if (!file) return fail(file.error());
  const std::string name = path.string();
  Document rebuilt_document = document;
  const auto on_header = [&](const JournalHeader& header) -> Result<void> {
    if (const Result<void> same = check_deck(header, rebuilt_document, name); !same) return same;
    return take_settings(header, rebuilt_document, name);
  };
  const auto on_record = [&](const JournalRecord& record) { return take_record(record, rebuilt_document, name); };
  const Result<JournalEnd> end = read_journal(text, name, on_header, on_record);
  if (!end) return fail(end.error());
  std::optional<Error> damage = end->damage;
  const bool cut = end->torn_tail || (damage && end->only_last);
  if (damage && cut) {
    const Result<std::filesystem::path> kept = file->keep_copy(text);
    if (!kept) return fail(kept.error());
    damage->message = "the last edit, " + std::to_string(end->records + 1) +
                      ", can't be read any more and is left out; it was being written when the power failed, or has been damaged since. "
                      "The journal as it was found is kept as " +
                      kept->string();
  }
  if (cut)
    if (const Result<void> done = file->truncate(end->bytes); !done) return fail(done.error());
  document = std::move(rebuilt_document);
  return Journal(
      std::make_unique<Impl>(Impl{std::move(*file), end->records, end->check, end->torn_tail, std::move(damage), cut || !end->damage}));
}

Result<void> Journal::append(const Document& document, const Edit& edit, const Prepared& prepared) {
  if (!impl_->takes_edits)
    return fail(
        impl_->damage->file, impl_->damage->line,
        "the journal is damaged here, so edits can't be kept: save the deck to go on with what is shown, or close it and give up its "
        "edits (prismesh session close --discard)");
  const bool push = prepared.step == Prepared::Step::push;
  const std::string delta = push ? base64_encode(encode_delta(document.current(), *prepared.next)) : "";
  const std::string intent = intent_text(prepared.as_done ? *prepared.as_done : edit);
  const std::string text = record_text(
      {impl_->records + 1, intent, prepared.step, prepared.drop_oldest, delta, 0, prepared.drop_branches, prepared.branch}, impl_->check);
  if (const Result<void> appended = impl_->file.append(text); !appended) return appended;
  ++impl_->records;
  impl_->check = check_in(text);
  return {};
}

}  // namespace prismesh::mesh::document
