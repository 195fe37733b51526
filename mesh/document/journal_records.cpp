#include "mesh/document/journal_records.h"

#include <algorithm>
#include <cstdio>

#include "base/hash.h"
#include "base/json/read.h"
#include "base/json/write.h"
#include "mesh/document/edit_fields.h"

namespace prismesh::mesh::document {

namespace {

constexpr std::string_view kMagic = "{\"prismesh_journal\":1,";
constexpr std::string_view kBeforeCheck = ",\"check\":\"";
constexpr std::string_view kAfterCheck = "\"}";
constexpr std::size_t kCheckDigits = 16;
constexpr std::size_t kSealSize = kBeforeCheck.size() + kCheckDigits + kAfterCheck.size();
constexpr std::string_view kRecordBegins = "{\"n\":";

std::string hex(std::uint64_t word) {
  char text[kCheckDigits + 1];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(word));
  return text;
}

std::string check_of(std::string_view before, std::string_view open_line) {
  std::string all(before);
  all += open_line;
  return hex(hash64(std::as_bytes(std::span(all))));
}

std::string check_of_delta(std::string_view delta) { return hex(hash64(std::as_bytes(std::span(delta)))); }

/// Adds the check and the brace to an object whose other fields are written.
std::string sealed(std::string open_line, std::string_view before) {
  const std::string check = check_of(before, open_line);
  open_line += kBeforeCheck;
  open_line += check;
  open_line += kAfterCheck;
  return open_line;
}

std::string_view step_name(Prepared::Step step) {
  switch (step) {
    case Prepared::Step::undo: return "undo";
    case Prepared::Step::redo: return "redo";
    case Prepared::Step::branch: return "branch";
    case Prepared::Step::push: break;
  }
  return "push";
}

/// Walks over the lines and verifies their checks.
class Walker {
 public:
  Walker(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  std::string_view rest() const { return text_.substr(end_.bytes); }
  const JournalEnd& end() const { return end_; }
  void set_torn() { end_.torn_tail = true; }
  void set_damaged(Error damage, bool only_last) {
    end_.damage = std::move(damage);
    end_.only_last = only_last;
  }

  tl::unexpected<Error> damaged(long lines_on, const std::string& what) const {
    return fail(file_, end_.lines + 1 + lines_on,
                "the journal is damaged here: " + what + "; nothing after line " + std::to_string(end_.lines) + " can be trusted");
  }

  /// The line without its seal, if the seal is right. `line` has no line feed.
  std::optional<std::string_view> unsealed(std::string_view line) const {
    if (line.size() < kSealSize) return std::nullopt;
    const std::string_view open_line = line.substr(0, line.size() - kSealSize);
    const std::string_view seal = line.substr(open_line.size());
    const std::string expected = std::string(kBeforeCheck) + check_of(end_.check, open_line) + std::string(kAfterCheck);
    return seal == expected ? std::optional(open_line) : std::nullopt;
  }

  void advance(std::size_t bytes, long lines, std::string check, bool is_record) {
    end_.bytes += bytes;
    end_.lines += lines;
    end_.check = std::move(check);
    if (is_record) ++end_.records;
  }

 private:
  std::string_view text_;
  const std::string& file_;
  JournalEnd end_;
};

/// The fields of a record's line, without the intent, which is taken from the text as it is.
struct RecordFields {
  std::uint64_t number = 0;
  Prepared::Step step = Prepared::Step::push;
  std::size_t drop_oldest = 0;
  std::size_t drop_branches = 0;
  std::uint64_t branch = 0;
  std::size_t delta_size = 0;
  std::string delta_check;
};

}  // namespace

}  // namespace prismesh::mesh::document

namespace prismesh::json {

PRISMESH_JSON_NAMES(LengthUnit,
                    {{name(LengthUnit::mm), LengthUnit::mm}, {name(LengthUnit::m), LengthUnit::m}, {name(LengthUnit::in), LengthUnit::in}});
PRISMESH_JSON_OBJECT(mesh::document::JournalHeader, f.required("program", m.program), f.required("deck", m.deck),
                     f.required("settings", m.settings));
PRISMESH_JSON_OBJECT(mesh::document::JournalHeader::Deck, f.required("path", m.path), f.required("hash", m.hash),
                     f.required("nodes", m.nodes), f.required("shells", m.shells), f.required("parts", m.parts));
PRISMESH_JSON_OBJECT(mesh::document::JournalHeader::Settings, f.required("length_unit", m.length_unit),
                     f.required("target_size", m.target_size), f.required("criteria", m.criteria), f("size_of_all", m.size_of_all),
                     f("guessed_size", m.guessed_size), f("parts", m.parts), f("chosen_criteria", m.chosen_criteria));
PRISMESH_JSON_OBJECT(mesh::document::JournalHeader::ChosenOn, f("on", m.on), f.required("name", m.name), f("text", m.text));
PRISMESH_JSON_OBJECT(mesh::document::JournalHeader::PartSizes, f.required("on", m.on), f.required("guessed", m.guessed),
                     f.required("from", m.from), f("own", m.own));
PRISMESH_JSON_NAMES(mesh::document::Prepared::Step,
                    {{mesh::document::step_name(mesh::document::Prepared::Step::push), mesh::document::Prepared::Step::push},
                     {mesh::document::step_name(mesh::document::Prepared::Step::undo), mesh::document::Prepared::Step::undo},
                     {mesh::document::step_name(mesh::document::Prepared::Step::redo), mesh::document::Prepared::Step::redo},
                     {mesh::document::step_name(mesh::document::Prepared::Step::branch), mesh::document::Prepared::Step::branch}});
PRISMESH_JSON_OBJECT(mesh::document::RecordFields, f.required("n", m.number), f.required("step", m.step),
                     f.required("dropped", m.drop_oldest), f("dropped_branches", m.drop_branches), f("branch", m.branch),
                     f.required("delta", m.delta_size), f.required("delta_check", m.delta_check));

}  // namespace prismesh::json

namespace prismesh::mesh::document {

namespace {

/// The fields of a line without its seal. A forged line, with a right check, may still have wrong fields.
template <class Fields>
std::optional<Fields> read_fields(std::string_view open_line) {
  Fields fields;
  const json::Json object = json::Json::parse(std::string(open_line) + "}", nullptr, false);
  if (json::read(object, fields, json::Author::program)) return std::nullopt;
  return fields;
}

Result<void> read_header(Walker& walker, const std::function<Result<void>(const JournalHeader&)>& on_header) {
  const std::string_view text = walker.rest();
  const std::size_t newline = text.find('\n');
  if (newline == std::string_view::npos) return walker.damaged(0, "its first line is incomplete");
  const std::string_view line = text.substr(0, newline);
  const std::optional<std::string_view> open_line = walker.unsealed(line);
  if (!open_line) return walker.damaged(0, "its first line isn't as it was written");
  const std::optional<JournalHeader> header = read_fields<JournalHeader>(*open_line);
  if (!header) return walker.damaged(0, "its first line doesn't say which deck it belongs to");
  walker.advance(newline + 1, 1, check_in(line), false);
  return on_header(*header);
}

/// The edit's JSON within a record's line, as it is written: {"n":..,"edit":{...},"step":...
std::optional<std::string_view> intent_in(std::string_view open_line) {
  constexpr std::string_view kBefore = ",\"edit\":";
  constexpr std::string_view kAfter = ",\"step\":\"";
  const std::size_t begin = open_line.find(kBefore);
  const std::size_t end = open_line.rfind(kAfter);
  if (begin == std::string_view::npos || end == std::string_view::npos || end < begin + kBefore.size()) return std::nullopt;
  return open_line.substr(begin + kBefore.size(), end - begin - kBefore.size());
}

/// Whether another record follows the one that the text begins with. Only the beginning of a record looks like one: a delta is base64, and
/// quotes within an intent are escaped.
bool another_record_in(std::string_view text) { return text.find(kRecordBegins, 1) != std::string_view::npos; }

/// Whether the text is the beginning of a record's first line, as a write that was cut off leaves it. Anything else is damage: blocks of
/// zeros may stand where acknowledged records stood.
bool begins_a_record(std::string_view text, std::uint64_t number) {
  const std::string begin = std::string(kRecordBegins) + std::to_string(number) + ",";
  const std::size_t common = std::min(text.size(), begin.size());
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20; };
  return text.substr(0, common) == begin.substr(0, common) && std::none_of(text.begin(), text.end(), is_control);
}

enum class RecordState : std::uint8_t { complete, torn };

/// Reads one record. It is torn if the text ends before the record does, by the length in its sealed line. Everything else that is wrong
/// is damage.
Result<RecordState> read_record(Walker& walker, const std::function<Result<void>(const JournalRecord&)>& on_record) {
  const std::string_view text = walker.rest();
  const std::size_t newline = text.find('\n');
  if (newline == std::string_view::npos) {
    if (begins_a_record(text, walker.end().records + 1)) return RecordState::torn;
    return walker.damaged(0, "this isn't the beginning of a record");
  }
  const std::string_view line = text.substr(0, newline);
  const std::optional<std::string_view> open_line = walker.unsealed(line);
  if (!open_line) return walker.damaged(0, "this line isn't as it was written");
  const std::optional<RecordFields> fields = read_fields<RecordFields>(*open_line);
  const std::optional<std::string_view> intent = intent_in(*open_line);
  if (!fields || !intent || fields->number != walker.end().records + 1) return walker.damaged(0, "this line is no record of an edit");
  if (text.size() - newline - 1 < fields->delta_size || text.size() - newline - 1 - fields->delta_size < 1) return RecordState::torn;
  const std::string_view delta = text.substr(newline + 1, fields->delta_size);
  if (text[newline + 1 + fields->delta_size] != '\n' || check_of_delta(delta) != fields->delta_check)
    return walker.damaged(1, "the changes of edit " + std::to_string(fields->number) + " aren't as they were written");
  const JournalRecord record{fields->number,        *intent,       fields->step, fields->drop_oldest, delta, walker.end().lines + 1,
                             fields->drop_branches, fields->branch};
  walker.advance(newline + 1 + fields->delta_size + 1, 2, check_in(line), true);
  if (const Result<void> taken = on_record(record); !taken) return fail(taken.error());
  return RecordState::complete;
}

}  // namespace

std::string header_text(const JournalHeader& header) {
  std::string line(kMagic);
  line += "\"program\":" + json::to_line(header.program);
  line += ",\"deck\":" + json::to_line(json::to_json(header.deck));
  line += ",\"settings\":" + json::to_line(json::to_json(header.settings));
  return sealed(std::move(line), "") + "\n";
}

std::string record_text(const JournalRecord& record, std::string_view check) {
  std::string line = "{\"n\":" + std::to_string(record.number) + ",\"edit\":";
  line += record.intent;
  line += ",\"step\":\"";
  line += step_name(record.step);
  line += "\",\"dropped\":" + std::to_string(record.drop_oldest);
  if (record.drop_branches > 0) line += ",\"dropped_branches\":" + std::to_string(record.drop_branches);
  if (record.step == Prepared::Step::branch) line += ",\"branch\":" + std::to_string(record.branch);
  line += ",\"delta\":" + std::to_string(record.delta.size());
  line += ",\"delta_check\":\"" + check_of_delta(record.delta) + "\"";
  std::string text = sealed(std::move(line), check) + "\n";
  text.reserve(text.size() + record.delta.size() + 1);
  text += record.delta;
  text += '\n';
  return text;
}

std::string check_in(std::string_view text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  if (line.size() < kSealSize) return "";
  return std::string(line.substr(line.size() - kAfterCheck.size() - kCheckDigits, kCheckDigits));
}

bool looks_like_journal(std::string_view text) {
  constexpr std::string_view kStart = "{\"prismesh_journal\"";
  return text.substr(0, kStart.size()) == kStart;
}

Result<JournalEnd> read_journal(std::string_view text, const std::string& file,
                                const std::function<Result<void>(const JournalHeader&)>& on_header,
                                const std::function<Result<void>(const JournalRecord&)>& on_record) {
  Walker walker(text, file);
  if (const Result<void> header = read_header(walker, on_header); !header) return fail(header.error());
  while (!walker.rest().empty()) {
    Error refused;  // by the callback
    const auto taking = [&](const JournalRecord& record) {
      Result<void> taken = on_record(record);
      if (!taken) refused = taken.error();
      return taken;
    };
    const Result<RecordState> state = read_record(walker, taking);
    if (!state && !refused.message.empty()) return fail(std::move(refused));
    if (state && *state == RecordState::complete) continue;
    // Records are written one at a time and flushed, so a power cut damages only the last one.
    if (state)
      walker.set_torn();
    else
      walker.set_damaged(state.error(), !another_record_in(walker.rest()));
    break;
  }
  return walker.end();
}

}  // namespace prismesh::mesh::document
