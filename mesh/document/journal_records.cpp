#include "mesh/document/journal_records.h"

#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "base/hash.h"

namespace prismesh::mesh::document {

namespace {

using Json = nlohmann::json;

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

/// Closes an object whose fields are written but for the brace.
std::string sealed(std::string open_line, std::string_view before) {
  const std::string check = check_of(before, open_line);
  open_line += kBeforeCheck;
  open_line += check;
  open_line += kAfterCheck;
  return open_line;
}

std::string dumped(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

std::string_view step_name(Prepared::Step step) {
  switch (step) {
    case Prepared::Step::undo: return "undo";
    case Prepared::Step::redo: return "redo";
    case Prepared::Step::push: break;
  }
  return "push";
}

std::optional<Prepared::Step> step_from(const std::string& text) {
  for (const Prepared::Step step : {Prepared::Step::push, Prepared::Step::undo, Prepared::Step::redo})
    if (text == step_name(step)) return step;
  return std::nullopt;
}

/// Reads lines and their checks one after the other.
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

/// What a sealed line says; it was written by record_text, but a forger's is a typed error all the same.
struct RecordFields {
  std::uint64_t number = 0;
  Prepared::Step step = Prepared::Step::push;
  std::size_t drop_oldest = 0;
  std::size_t delta_size = 0;
  std::string delta_check;
};

std::optional<RecordFields> record_fields(const Json& json) {
  RecordFields fields;
  const auto whole = [&](const char* field, auto& into) {
    const auto at = json.find(field);
    if (at == json.end() || !at->is_number_unsigned()) return false;
    into = at->get<std::uint64_t>();
    return true;
  };
  if (!json.is_object() || !whole("n", fields.number) || !whole("dropped", fields.drop_oldest) || !whole("delta", fields.delta_size))
    return std::nullopt;
  const auto step = json.find("step");
  const auto check = json.find("delta_check");
  if (step == json.end() || !step->is_string() || check == json.end() || !check->is_string()) return std::nullopt;
  const std::optional<Prepared::Step> known = step_from(step->get<std::string>());
  if (!known) return std::nullopt;
  fields.step = *known;
  fields.delta_check = check->get<std::string>();
  return fields;
}

std::optional<JournalHeader> header_fields(const Json& json) {
  if (!json.is_object()) return std::nullopt;
  try {
    JournalHeader header;
    header.program = json.at("program").get<std::string>();
    header.deck_path = json.at("deck").at("path").get<std::string>();
    header.deck_hash = json.at("deck").at("hash").get<std::string>();
    header.nodes = json.at("deck").at("nodes").get<std::size_t>();
    header.shells = json.at("deck").at("shells").get<std::size_t>();
    header.parts = json.at("deck").at("parts").get<std::size_t>();
    const auto unit = length_unit_from(json.at("settings").at("length_unit").get<std::string>());
    if (!unit) return std::nullopt;
    header.length_unit = *unit;
    header.target_size = json.at("settings").at("target_size").get<double>();
    header.criteria = json.at("settings").at("criteria").get<std::string>();
    return header;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

Json parsed(std::string_view open_line) { return Json::parse(std::string(open_line) + "}", nullptr, false); }

Result<void> read_header(Walker& walker, const std::function<Result<void>(const JournalHeader&)>& on_header) {
  const std::string_view text = walker.rest();
  const std::size_t newline = text.find('\n');
  if (newline == std::string_view::npos) return walker.damaged(0, "its first line is incomplete");
  const std::string_view line = text.substr(0, newline);
  const std::optional<std::string_view> open_line = walker.unsealed(line);
  if (!open_line) return walker.damaged(0, "its first line isn't as it was written");
  const std::optional<JournalHeader> header = header_fields(parsed(*open_line));
  if (!header) return walker.damaged(0, "its first line doesn't say which deck it belongs to");
  walker.advance(newline + 1, 1, check_in(line), false);
  return on_header(*header);
}

/// The edit's JSON within a record's line, word for word: {"n":..,"edit":{...},"step":...
std::optional<std::string_view> intent_in(std::string_view open_line) {
  constexpr std::string_view kBefore = ",\"edit\":";
  constexpr std::string_view kAfter = ",\"step\":\"";
  const std::size_t begin = open_line.find(kBefore);
  const std::size_t end = open_line.rfind(kAfter);
  if (begin == std::string_view::npos || end == std::string_view::npos || end < begin + kBefore.size()) return std::nullopt;
  return open_line.substr(begin + kBefore.size(), end - begin - kBefore.size());
}

/// Whether another record follows the one that the text begins with. A delta is base64, and quotes within an intent are escaped, so that
/// nothing else looks so.
bool another_record_in(std::string_view text) { return text.find(kRecordBegins, 1) != std::string_view::npos; }

enum class Found : std::uint8_t { record, torn };

/// One record. A record is torn if the text ends before it does, by its own sealed word for its length. Everything else that is wrong is
/// damage.
Result<Found> read_record(Walker& walker, const std::function<Result<void>(const JournalRecord&)>& on_record) {
  const std::string_view text = walker.rest();
  const std::size_t newline = text.find('\n');
  if (newline == std::string_view::npos) return Found::torn;
  const std::string_view line = text.substr(0, newline);
  const std::optional<std::string_view> open_line = walker.unsealed(line);
  if (!open_line) return walker.damaged(0, "this line isn't as it was written");
  const std::optional<RecordFields> fields = record_fields(parsed(*open_line));
  const std::optional<std::string_view> intent = intent_in(*open_line);
  if (!fields || !intent || fields->number != walker.end().records + 1) return walker.damaged(0, "this line is no record of an edit");
  if (text.size() - newline - 1 < fields->delta_size || text.size() - newline - 1 - fields->delta_size < 1) return Found::torn;
  const std::string_view delta = text.substr(newline + 1, fields->delta_size);
  if (text[newline + 1 + fields->delta_size] != '\n' || check_of_delta(delta) != fields->delta_check)
    return walker.damaged(1, "the changes of edit " + std::to_string(fields->number) + " aren't as they were written");
  const JournalRecord record{walker.end().lines + 1, fields->number, *intent, fields->step, fields->drop_oldest, delta};
  walker.advance(newline + 1 + fields->delta_size + 1, 2, check_in(line), true);
  if (const Result<void> taken = on_record(record); !taken) return fail(taken.error());
  return Found::record;
}

}  // namespace

std::string header_text(const JournalHeader& header) {
  std::string line(kMagic);
  line += "\"program\":" + dumped(header.program);
  line += ",\"deck\":" + dumped({{"path", header.deck_path},
                                 {"hash", header.deck_hash},
                                 {"nodes", header.nodes},
                                 {"shells", header.shells},
                                 {"parts", header.parts}});
  line +=
      ",\"settings\":" +
      dumped({{"length_unit", std::string(name(header.length_unit))}, {"target_size", header.target_size}, {"criteria", header.criteria}});
  return sealed(std::move(line), "") + "\n";
}

std::string record_text(std::uint64_t number, std::string_view intent, Prepared::Step step, std::size_t drop_oldest, std::string_view delta,
                        std::string_view check) {
  std::string line = "{\"n\":" + std::to_string(number) + ",\"edit\":";
  line += intent;
  line += ",\"step\":\"";
  line += step_name(step);
  line += "\",\"dropped\":" + std::to_string(drop_oldest) + ",\"delta\":" + std::to_string(delta.size());
  line += ",\"delta_check\":\"" + check_of_delta(delta) + "\"";
  std::string text = sealed(std::move(line), check) + "\n";
  text.reserve(text.size() + delta.size() + 1);
  text += delta;
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
    const Result<Found> found = read_record(walker, taking);
    if (!found && !refused.message.empty()) return fail(std::move(refused));
    if (found && *found == Found::record) continue;
    // Records are written one at a time and flushed, so a power cut leaves the last one only in pieces.
    if (found)
      walker.set_torn();
    else
      walker.set_damaged(found.error(), !another_record_in(walker.rest()));
    break;
  }
  return walker.end();
}

}  // namespace prismesh::mesh::document
