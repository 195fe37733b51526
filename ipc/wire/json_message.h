// How messages become lines of JSON and come back: what the sources that define messages (messages_json.cpp of each daemon)
// share. Only they include this; nlohmann's header is heavy.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/json/nesting.h"
#include "base/json/read.h"
#include "base/json/write.h"
#include "base/nearest_name.h"
#include "ipc/wire/answers.h"
#include "ipc/wire/envelope.h"

namespace prismesh::json {

/// The definition of a message: its kind, as the line names it, and its fields.
#define PRISMESH_MESSAGE(Type, kind, ...)                                                   \
  template <>                                                                               \
  struct Definition<Type> {                                                                 \
    static constexpr std::string_view kKind = kind;                                         \
    static void fields([[maybe_unused]] auto& m, [[maybe_unused]] auto& f) { __VA_ARGS__; } \
  }

// Answers that every daemon gives.
PRISMESH_MESSAGE(ipc::Failed, "failed", f("file", m.file), f("line", m.line), f("message", m.message), f("unsaved_edits", m.unsaved_edits));
PRISMESH_MESSAGE(ipc::Done, "done", );

}  // namespace prismesh::json

namespace prismesh::ipc::json_message {

using json::Author;
using json::Definition;
using json::Json;
using json::Problem;

enum class UnknownFields : bool { refused, ignored };

/// Reads the message of the kind named; `known` collects the names of the other kinds.
template <class Variant, std::size_t I = 0>
Problem read_kind(const Json& object, std::string_view kind, UnknownFields unknown, Variant& message,
                  std::vector<std::string_view>& known) {
  if constexpr (I == std::variant_size_v<Variant>) {
    return "unknown kind \"" + std::string(kind) + "\"; the nearest is \"" + std::string(nearest_name(kind, known)) + "\"";
  } else {
    using Each = std::variant_alternative_t<I, Variant>;
    if (kind != Definition<Each>::kKind) {
      known.push_back(Definition<Each>::kKind);
      return read_kind<Variant, I + 1>(object, kind, unknown, message, known);
    }
    json::FieldReader reader(object, Author::program);
    Definition<Each>::fields(message.template emplace<I>(), reader);
    Problem problem = reader.problem();
    if (!problem && unknown == UnknownFields::refused) problem = reader.unknown_field();
    if (problem) problem = "\"" + std::string(kind) + "\": " + *problem;
    return problem;
  }
}

/// Reads a field and takes it out of the object, so that it is none of the message's own.
template <class T>
Problem take_field(Json& object, std::string_view name, T& value) {
  json::FieldReader reader(object, Author::program);
  reader(name, value);
  Problem problem = reader.problem();
  if (!problem) object.erase(std::string(name));
  return problem;
}
template <class T>
Problem take_required_field(Json& object, std::string_view name, T& value) {
  json::FieldReader reader(object, Author::program);
  reader.required(name, value);
  Problem problem = reader.problem();
  if (!problem) object.erase(std::string(name));
  return problem;
}

/// No message nests deeper than a state with its warnings or an edit with its outline.
inline constexpr int kMaxDepth = 12;

inline Result<Json> parse(std::string_view line) {
  if (json::is_nested_deeper(line, kMaxDepth)) return fail("message", "it is nested too deeply");
  Json object = Json::parse(line.begin(), line.end(), nullptr, false);
  if (object.is_discarded()) return fail("message", "it isn't JSON");
  if (!object.is_object()) return fail("message", "it isn't a JSON object");
  return object;
}

/// The message's fields, and its kind in the field `which`: "request", "answer" or "event".
template <class Variant>
Json object_of(const char* which, const Variant& message) {
  return std::visit(
      [&]<class Each>(const Each& each) {
        Json object = json::to_json(each);
        object[which] = Definition<Each>::kKind;
        return object;
      },
      message);
}

// --- whole lines ---

template <class Request>
Result<std::string> encode_request(std::uint64_t number, const Request& request) {
  Json object = object_of("request", request);
  object["number"] = number;
  try {
    return object.dump();
  } catch (const Json::type_error&) {
    return fail("request", "a path or text in it isn't UTF-8; it can't be sent");
  }
}

template <class Answer>
std::string encode_answer(std::uint64_t to, const Answer& answer, std::size_t descriptors) {
  Json object = object_of("answer", answer);
  object["to"] = to;
  if (descriptors > 0) object["descriptors"] = descriptors;
  return json::to_line(object);
}

template <class Answer>
std::string answer_fields(const Answer& answer) {
  return std::visit([](const auto& each) { return json::to_line(json::to_json(each)); }, answer);
}

template <class Event>
std::string encode_event(const Event& event) {
  return json::to_line(object_of("event", event));
}

template <class Request>
tl::expected<Numbered<Request>, BadRequest> decode_request(std::string_view line) {
  Result<Json> object = parse(line);
  if (!object) return tl::unexpected(BadRequest{0, object.error().message});
  Numbered<Request> result;
  std::string kind;
  Problem problem = take_field(*object, "number", result.number);
  if (!problem) problem = take_required_field(*object, "request", kind);
  std::vector<std::string_view> known;
  if (!problem) problem = read_kind(*object, kind, UnknownFields::refused, result.request, known);
  if (problem) return tl::unexpected(BadRequest{result.number, *problem});
  return result;
}

template <class Answer, class Event>
Result<Said<Answer, Event>> decode_said(std::string_view line) {
  Result<Json> object = parse(line);
  if (!object) return fail(std::move(object.error()));
  Said<Answer, Event> result;
  std::string kind;
  std::vector<std::string_view> known;
  Problem problem = take_field(*object, "descriptors", result.descriptors);
  if (object->contains("event")) {
    if (!problem) problem = take_required_field(*object, "event", kind);
    if (!problem) problem = read_kind(*object, kind, UnknownFields::ignored, result.message.template emplace<Event>(), known);
  } else {
    if (!problem) problem = take_field(*object, "to", result.to);
    if (!problem) problem = take_required_field(*object, "answer", kind);
    if (!problem) problem = read_kind(*object, kind, UnknownFields::ignored, result.message.template emplace<Answer>(), known);
  }
  if (problem) return fail("message from the daemon", *problem);
  return result;
}

}  // namespace prismesh::ipc::json_message
