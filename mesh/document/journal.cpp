#include "mesh/document/journal.h"

#include <nlohmann/json.hpp>

#include "base/base64.h"
#include "mesh/document/delta.h"
#include "mesh/document/edit_json.h"
#include "mesh/document/edit_kinds.h"
#include "mesh/document/history.h"
#include "mesh/document/journal_file.h"
#include "mesh/document/journal_records.h"
#include "mesh/document/restructure.h"

namespace prismesh::mesh::document {

struct Journal::State {
  JournalFile file;
  std::uint64_t records = 0;
  std::string check;  ///< what the next record chains to
  bool cut_torn_tail = false;
  std::optional<Error> damage;
  bool takes_edits = true;
};

namespace {

std::string intent_text(const Edit& edit) { return edit_to_json(edit).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace); }

bool is_fresh(const Document& document) { return document.generations.size() == 1 && document.generations.front() == document.opened; }

JournalHeader header_of(const Document& document) {
  const Model& model = document.opened->model;
  return {PRISMESH_VERSION,
          document.path.string(),
          document.deck->content.hex(),
          model.node_count(),
          model.shell_count(),
          model.parts->size(),
          document.settings.length_unit,
          document.settings.target_size,
          document.settings.criteria.name};
}

Result<void> check_deck(const JournalHeader& header, const Document& document, const std::string& file) {
  const std::string hash = document.deck->content.hex();
  if (header.deck_hash != hash)
    return fail(file, 1,
                "this is the journal of another deck or of another state of it: it belongs to " + header.deck_path + " with content " +
                    header.deck_hash + ", while " + document.path.string() + " has content " + hash);
  const Model& model = document.opened->model;
  if (header.nodes != model.node_count() || header.shells != model.shell_count() || header.parts != model.parts->size())
    return fail(file, 1, "the journal was written by version " + header.program + ", which read this deck differently; replay it instead");
  return {};
}

/// What was only guessed this time is what it was then; what the user says now counts.
void take_settings(const JournalHeader& header, Document& document) {
  Settings& settings = document.settings;
  if (settings.length_unit_guessed) settings.length_unit = header.length_unit;
  if (!settings.target_size_guessed || settings.target_size == header.target_size || !(header.target_size > 0)) return;
  settings.target_size = header.target_size;
  auto judged = std::make_shared<Generation>(*document.opened);
  judged->quality = quality::judge_model(judged->model, {settings.criteria, settings.target_size});
  judged->counts = quality::count(judged->quality);
  document.opened = judged;
  document.generations = {document.opened};
}

std::string edit_name(std::string_view intent) {
  const nlohmann::json json = nlohmann::json::parse(intent, nullptr, false);
  if (!json.is_object()) return "edit";
  const auto found = json.find("edit");
  return found != json.end() && found->is_string() ? found->get<std::string>() : "edit";
}

/// Whether the edit gave the model a new shape to relax and repair towards. A step back or forth beyond a save stands as an edit of its
/// own.
bool reshapes(std::string_view intent) {
  const Result<Edit> edit = parse_edit(intent);
  if (!edit) return false;
  const EditGroup group = kind_of(*edit).group;
  return group == EditGroup::shaping || group == EditGroup::step;
}

/// The generation that the record's delta makes out of the current one.
Result<std::shared_ptr<const Generation>> rebuilt(const Document& document, const JournalRecord& record) {
  const std::optional<std::vector<std::byte>> delta = base64_decode(record.delta);
  if (!delta) return fail("", "its delta isn't base64");
  auto next = std::make_shared<Generation>(document.current());
  const Result<NodeSet> moved = apply_delta(*delta, *next);
  if (!moved) return fail(moved.error());
  settle_growth(document.settings, document.current(), *moved, *next);
  if (reshapes(record.intent)) next->surface = std::make_shared<const Model>(next->model);
  next->number = document.next_number;
  next->made_by = edit_name(record.intent);
  next->own_bytes = own_bytes(document.current(), *next);
  return std::shared_ptr<const Generation>(std::move(next));
}

Result<void> take_record(const JournalRecord& record, Document& document, const std::string& file) {
  const auto wrong = [&](const std::string& what) {
    return fail(file, record.line, "edit " + std::to_string(record.number) + " can't be brought back: " + what);
  };
  Prepared prepared;
  prepared.step = record.step;
  prepared.drop_oldest = record.drop_oldest;
  if (record.step == Prepared::Step::push) {
    Result<std::shared_ptr<const Generation>> next = rebuilt(document, record);
    if (!next) return wrong(next.error().message);
    prepared.next = std::move(*next);
  } else if (record.step == Prepared::Step::undo ? !document.can_undo() : !document.can_redo()) {
    return wrong("there is nothing to " + std::string(record.step == Prepared::Step::undo ? "undo" : "redo"));
  }
  commit(document, std::move(prepared));
  return {};
}

}  // namespace

Journal::Journal(std::unique_ptr<State> state) : state_(std::move(state)) {}
Journal::Journal(Journal&&) noexcept = default;
Journal& Journal::operator=(Journal&&) noexcept = default;
Journal::~Journal() = default;

const std::filesystem::path& Journal::path() const { return state_->file.path(); }
std::uint64_t Journal::records() const { return state_->records; }
bool Journal::cut_torn_tail() const { return state_->cut_torn_tail; }
const std::optional<Error>& Journal::damage() const { return state_->damage; }
bool Journal::takes_edits() const { return state_->takes_edits; }

Result<Journal> Journal::create(const std::filesystem::path& path, const Document& document) {
  if (!is_fresh(document)) return fail(path.string(), "a journal is started before the first edit; this document has been edited");
  const std::string text = header_text(header_of(document));
  Result<JournalFile> file = JournalFile::create(path, text);
  if (!file) return fail(file.error());
  return Journal(std::make_unique<State>(State{std::move(*file), 0, check_in(text), false, std::nullopt, true}));
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
    take_settings(header, rebuilt_document);
    return {};
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
      std::make_unique<State>(State{std::move(*file), end->records, end->check, end->torn_tail, std::move(damage), cut || !end->damage}));
}

Result<void> Journal::append(const Document& document, const Edit& edit, const Prepared& prepared) {
  if (!state_->takes_edits)
    return fail(
        state_->damage->file, state_->damage->line,
        "the journal is damaged here, so edits can't be kept: save the deck to go on with what is shown, or close it and give up its "
        "edits (prismesh session close --discard)");
  const bool push = prepared.step == Prepared::Step::push;
  const std::string delta = push ? base64_encode(encode_delta(document.current(), *prepared.next)) : "";
  const std::string text = record_text(state_->records + 1, intent_text(edit), prepared.step, prepared.drop_oldest, delta, state_->check);
  if (const Result<void> appended = state_->file.append(text); !appended) return appended;
  ++state_->records;
  state_->check = check_in(text);
  return {};
}

}  // namespace prismesh::mesh::document
