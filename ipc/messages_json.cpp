#include "ipc/messages_json.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/nearest_name.h"
#include "mesh/document/edit_json.h"

namespace prismesh::ipc {

namespace {

using Json = nlohmann::json;

// --- the definitions: each message's tag and its fields, for reading and writing alike ---

template <class T>
constexpr std::string_view kTag = "";
template <>
constexpr std::string_view kTag<Hello> = "hello";
template <>
constexpr std::string_view kTag<Open> = "open";
template <>
constexpr std::string_view kTag<Save> = "save";
template <>
constexpr std::string_view kTag<Close> = "close";
template <>
constexpr std::string_view kTag<ApplyEdit> = "apply_edit";
template <>
constexpr std::string_view kTag<BeginDrag> = "begin_drag";
template <>
constexpr std::string_view kTag<DragStep> = "drag_step";
template <>
constexpr std::string_view kTag<CommitDrag> = "commit_drag";
template <>
constexpr std::string_view kTag<CancelDrag> = "cancel_drag";
template <>
constexpr std::string_view kTag<GetState> = "get_state";
template <>
constexpr std::string_view kTag<GetSnapshot> = "get_snapshot";
template <>
constexpr std::string_view kTag<ReturnSnapshot> = "return_snapshot";
template <>
constexpr std::string_view kTag<Failed> = "failed";
template <>
constexpr std::string_view kTag<Done> = "done";
template <>
constexpr std::string_view kTag<Welcome> = "welcome";
template <>
constexpr std::string_view kTag<State> = "state";
template <>
constexpr std::string_view kTag<Saved> = "saved";
template <>
constexpr std::string_view kTag<Edited> = "edited";
template <>
constexpr std::string_view kTag<DragBegun> = "drag_begun";
template <>
constexpr std::string_view kTag<Snapshot> = "snapshot";
template <>
constexpr std::string_view kTag<GenerationPublished> = "generation_published";
template <>
constexpr std::string_view kTag<DocumentOpened> = "document_opened";
template <>
constexpr std::string_view kTag<DocumentClosed> = "document_closed";
template <>
constexpr std::string_view kTag<ProgressMade> = "progress_made";
template <>
constexpr std::string_view kTag<DragEnded> = "drag_ended";

// `m` is a message (const when it is written), `f` is called with each field's name and value.
#define PRISMESH_FIELDS(Type, ...)                                                                                              \
  template <class F>                                                                                                            \
  void fields([[maybe_unused]] auto& m,                                                                                         \
              [[maybe_unused]] F& f) requires std::is_same_v<std::remove_const_t<std::remove_reference_t<decltype(m)>>, Type> { \
    __VA_ARGS__;                                                                                                                \
  }
PRISMESH_FIELDS(Hello, f("protocol", m.protocol), f("program", m.program))
PRISMESH_FIELDS(Open, f("path", m.path), f("length_unit", m.length_unit), f("target_size", m.target_size), f("criteria", m.criteria))
PRISMESH_FIELDS(Save, f("path", m.path))
PRISMESH_FIELDS(Close, f("discard", m.discard))
PRISMESH_FIELDS(ApplyEdit, f("edit", m.edit))
PRISMESH_FIELDS(BeginDrag, f("edit", m.edit))
PRISMESH_FIELDS(DragStep, f("drag", m.drag), f("sequence", m.sequence), f("by", m.by), f("distance", m.distance))
PRISMESH_FIELDS(CommitDrag, f("drag", m.drag))
PRISMESH_FIELDS(CancelDrag, f("drag", m.drag))
PRISMESH_FIELDS(GetState, )
PRISMESH_FIELDS(GetSnapshot, f("have_segments", m.have_segments))
PRISMESH_FIELDS(ReturnSnapshot, f("lease", m.lease))
PRISMESH_FIELDS(Failed, f("file", m.file), f("line", m.line), f("message", m.message))
PRISMESH_FIELDS(Done, )
PRISMESH_FIELDS(Welcome, f("protocol", m.protocol), f("version", m.version), f("client", m.client))
PRISMESH_FIELDS(State, f("open", m.open), f("busy", m.busy), f("path", m.path), f("length_unit", m.length_unit),
                f("length_unit_guessed", m.length_unit_guessed), f("target_size", m.target_size),
                f("target_size_guessed", m.target_size_guessed), f("generation", m.generation), f("nodes", m.nodes), f("shells", m.shells),
                f("parts", m.parts), f("selected_nodes", m.selected_nodes), f("counts", m.counts), f("can_undo", m.can_undo),
                f("can_redo", m.can_redo), f("changed", m.changed), f("recovered_edits", m.recovered_edits),
                f("journalled_edits", m.journalled_edits), f("warnings", m.warnings))
PRISMESH_FIELDS(Saved, f("path", m.path), f("nodes_written", m.nodes_written), f("lines_changed", m.lines_changed), f("notes", m.notes))
PRISMESH_FIELDS(Edited, f("report", m.report), f("generation", m.generation))
PRISMESH_FIELDS(DragBegun, f("drag", m.drag), f("base_generation", m.base_generation), f("nodes", m.nodes), f("grab", m.grab),
                f("grab_position", m.grab_position), f("normal", m.normal))
PRISMESH_FIELDS(Snapshot, f("lease", m.lease), f("generation", m.generation), f("segments", m.segments), f("new_segments", m.new_segments))
PRISMESH_FIELDS(GenerationPublished, f("generation", m.generation), f("made_by", m.made_by))
PRISMESH_FIELDS(DocumentOpened, f("path", m.path))
PRISMESH_FIELDS(DocumentClosed, )
PRISMESH_FIELDS(ProgressMade, f("what", m.what), f("fraction", m.fraction))
PRISMESH_FIELDS(DragEnded, f("drag", m.drag), f("committed", m.committed), f("why", m.why))
PRISMESH_FIELDS(mesh::quality::Counts, f("ok", m.ok), f("warn", m.warn), f("fail", m.fail))
PRISMESH_FIELDS(mesh::deck::Warning, f("file", m.file), f("line", m.line), f("kind", m.kind), f("message", m.message), f("count", m.count))
PRISMESH_FIELDS(mesh::document::EditReport, f("edit", m.edit), f("nodes_moved", m.nodes_moved), f("elements_added", m.elements_added),
                f("elements_removed", m.elements_removed), f("before", m.before), f("after", m.after), f("notes", m.notes),
                f("ms", m.milliseconds))
#undef PRISMESH_FIELDS

// --- writing ---

void write(Json& json, bool value) { json = value; }
void write(Json& json, double value) { json = value; }
void write(Json& json, const std::string& value) { json = value; }
void write(Json& json, const mesh::document::Edit& value) { json = mesh::document::edit_to_json(value); }
template <class T>
requires std::is_integral_v<T>
void write(Json& json, T value) { json = value; }
template <class T>
void write_object(Json& json, const T& value);
template <class T>
requires std::is_class_v<T>
void write(Json& json, const T& value) { write_object(json, value); }
void write(Json& json, const std::array<double, 3>& value) { json = value; }
template <class T>
void write(Json& json, const std::vector<T>& values) {
  json = Json::array();
  for (const T& value : values) write(json.emplace_back(), value);
}

struct Writer {
  Json& json;
  template <class T>
  void operator()(const char* name, const T& value) {
    write(json[name], value);
  }
  template <class T>
  void operator()(const char* name, const std::optional<T>& value) {
    if (value) write(json[name], *value);
  }
};

template <class T>
void write_object(Json& json, const T& value) {
  json = Json::object();
  Writer writer{json};
  fields(value, writer);
}

// --- reading: every function returns what is wrong, or nothing ---

using Problem = std::optional<std::string>;

Problem read(const Json& json, bool& value) {
  if (!json.is_boolean()) return "must be true or false";
  value = json.get<bool>();
  return std::nullopt;
}
Problem read(const Json& json, double& value) {
  if (!json.is_number()) return "must be a number";
  value = json.get<double>();
  if (!std::isfinite(value)) return "must be a finite number";
  return std::nullopt;
}
Problem read(const Json& json, std::string& value) {
  if (!json.is_string()) return "must be a text in quotes";
  value = json.get<std::string>();
  return std::nullopt;
}
template <class T>
requires std::is_integral_v<T> Problem read(const Json& json, T& value) {
  if (!json.is_number_integer()) return "must be a whole number";
  if (json.is_number_unsigned()) {
    const auto number = json.get<std::uint64_t>();
    if (number > static_cast<std::uint64_t>(std::numeric_limits<T>::max())) return "is too large";
    value = static_cast<T>(number);
    return std::nullopt;
  }
  const auto number = json.get<std::int64_t>();
  if (std::is_unsigned_v<T> && number < 0) return "must not be negative";
  if (number < static_cast<std::int64_t>(std::numeric_limits<T>::min())) return "is too small";
  value = static_cast<T>(number);
  return std::nullopt;
}
Problem read(const Json& json, std::array<double, 3>& value) {
  if (!json.is_array() || json.size() != 3) return "must be a list of three numbers";
  for (std::size_t i = 0; i < 3; ++i)
    if (Problem problem = read(json[i], value[i])) return "must be a list of three numbers: one " + *problem;
  return std::nullopt;
}
Problem read(const Json& json, mesh::document::Edit& value) {
  Result<mesh::document::Edit> edit = mesh::document::edit_from_json(json);
  if (!edit) return "can't be used: " + edit.error().text();
  value = std::move(*edit);
  return std::nullopt;
}
template <class T>
Problem read_object(const Json& json, T& value);
template <class T>
requires std::is_class_v<T> Problem read(const Json& json, T& value) {
  if (!json.is_object()) return "must be an object";
  return read_object(json, value);
}
template <class T>
Problem read(const Json& json, std::vector<T>& values) {
  if (!json.is_array()) return "must be a list";
  values.clear();
  values.reserve(json.size());
  for (const Json& item : json)
    if (Problem problem = read(item, values.emplace_back())) return "has an item that " + *problem;
  return std::nullopt;
}

struct Reader {
  const Json& json;
  Problem problem;
  std::vector<std::string_view> known;

  template <class T>
  void operator()(const char* name, T& value) {
    known.push_back(name);
    const auto found = json.find(name);
    if (problem || found == json.end()) return;
    if (Problem wrong = read(*found, value)) problem = "field \"" + std::string(name) + "\" " + *wrong;
  }
  template <class T>
  void operator()(const char* name, std::optional<T>& value) {
    const auto found = json.find(name);
    if (found == json.end() || found->is_null()) {
      known.push_back(name);
      return;
    }
    (*this)(name, value.emplace());
  }
};

/// Fields that are absent keep their defaults.
template <class T>
Problem read_object(const Json& json, T& value) {
  Reader reader{json, std::nullopt, {}};
  fields(value, reader);
  return reader.problem;
}

template <class T>
Problem unknown_field(const Json& json, T& value) {
  Reader reader{json, std::nullopt, {}};
  fields(value, reader);
  for (const auto& item : json.items()) {
    const std::string& name = item.key();
    if (std::find(reader.known.begin(), reader.known.end(), name) != reader.known.end()) continue;
    if (reader.known.empty()) return "has no field \"" + name + "\": it has none";
    return "has no field \"" + name + "\"; the nearest is \"" + std::string(nearest_name(name, reader.known)) + "\"";
  }
  return std::nullopt;
}

enum class Unknown : bool { refused, passed_over };

template <class Variant, std::size_t I = 0>
Problem read_kind(const Json& json, std::string_view tag, Unknown unknown, Variant& message, std::vector<std::string_view>& known) {
  if constexpr (I == std::variant_size_v<Variant>) {
    return "unknown kind \"" + std::string(tag) + "\"; the nearest is \"" + std::string(nearest_name(tag, known)) + "\"";
  } else {
    using Message = std::variant_alternative_t<I, Variant>;
    if (tag != kTag<Message>) {
      known.push_back(kTag<Message>);
      return read_kind<Variant, I + 1>(json, tag, unknown, message, known);
    }
    Problem problem = read_object(json, message.template emplace<I>());
    if (!problem && unknown == Unknown::refused) problem = unknown_field(json, std::get<I>(message));
    if (problem) problem = "\"" + std::string(tag) + "\": " + *problem;
    return problem;
  }
}

/// The tag's text, taken out of the object; empty if it isn't there.
Problem take_tag(Json& json, const char* name, std::string& tag) {
  const auto found = json.find(name);
  if (found == json.end()) return "field \"" + std::string(name) + "\" is missing";
  if (!found->is_string()) return "field \"" + std::string(name) + "\" must be a text in quotes";
  tag = found->get<std::string>();
  json.erase(found);
  return std::nullopt;
}

Problem take_number(Json& json, const char* name, std::uint64_t& number) {
  const auto found = json.find(name);
  if (found == json.end()) return std::nullopt;
  if (Problem problem = read(*found, number)) return "field \"" + std::string(name) + "\" " + *problem;
  json.erase(found);
  return std::nullopt;
}

/// No message nests deeper than a state with its warnings or an edit with its outline. Asked before parsing, so that a line of
/// brackets can't take memory a hundred times its size.
bool too_deep(std::string_view line) {
  constexpr int kDeepest = 12;
  int depth = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (in_text) {
      if (c == '\\') ++i;
      if (c == '"') in_text = false;
    } else if (c == '"') {
      in_text = true;
    } else if (c == '[' || c == '{') {
      if (++depth > kDeepest) return true;
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return false;
}

Result<Json> parse(std::string_view line) {
  if (too_deep(line)) return fail("message", "it is nested too deeply");
  Json json = Json::parse(line.begin(), line.end(), nullptr, false);
  if (json.is_discarded()) return fail("message", "it isn't JSON");
  if (!json.is_object()) return fail("message", "it isn't a JSON object");
  return json;
}

template <class Variant>
Json to_json(const char* kind, const Variant& message) {
  return std::visit(
      [&](const auto& each) {
        Json json;
        write_object(json, each);
        json[kind] = kTag<std::remove_cvref_t<decltype(each)>>;
        return json;
      },
      message);
}

std::string to_line(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace

Result<std::string> encode_request(std::uint64_t number, const Request& request) {
  Json json = to_json("request", request);
  json["number"] = number;
  try {
    return json.dump();
  } catch (const Json::type_error&) {
    return fail("request", "a path or text in it isn't UTF-8; it can't be sent");
  }
}

std::string encode_answer(std::uint64_t to, const Answer& answer, std::size_t descriptors) {
  Json json = to_json("answer", answer);
  json["to"] = to;
  if (descriptors > 0) json["descriptors"] = descriptors;
  return to_line(json);
}

std::string answer_fields(const Answer& answer) {
  Json json = to_json("answer", answer);
  json.erase("answer");
  return to_line(json);
}

std::string encode_event(const Event& event) { return to_line(to_json("event", event)); }

tl::expected<NumberedRequest, BadRequest> decode_request(std::string_view line) {
  Result<Json> json = parse(line);
  if (!json) return tl::unexpected(BadRequest{0, json.error().message});
  NumberedRequest result;
  std::string tag;
  Problem problem = take_number(*json, "number", result.number);
  if (!problem) problem = take_tag(*json, "request", tag);
  std::vector<std::string_view> known;
  if (!problem) problem = read_kind(*json, tag, Unknown::refused, result.request, known);
  if (problem) return tl::unexpected(BadRequest{result.number, *problem});
  return result;
}

Result<FromDaemon> decode_from_daemon(std::string_view line) {
  Result<Json> json = parse(line);
  if (!json) return fail(std::move(json.error()));
  FromDaemon result;
  std::uint64_t descriptors = 0;
  std::string tag;
  std::vector<std::string_view> known;
  Problem problem = take_number(*json, "descriptors", descriptors);
  result.descriptors = static_cast<std::size_t>(descriptors);
  if (json->contains("event")) {
    if (!problem) problem = take_tag(*json, "event", tag);
    if (!problem) problem = read_kind(*json, tag, Unknown::passed_over, result.message.emplace<Event>(), known);
  } else {
    if (!problem) problem = take_number(*json, "to", result.to);
    if (!problem) problem = take_tag(*json, "answer", tag);
    if (!problem) problem = read_kind(*json, tag, Unknown::passed_over, result.message.emplace<Answer>(), known);
  }
  if (problem) return fail("message from the daemon", *problem);
  return result;
}

}  // namespace prismesh::ipc
