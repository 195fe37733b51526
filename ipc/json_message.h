// How messages become lines of JSON and come back: what the files that define messages (messages_json.cpp, device_messages_json.cpp)
// share. Only they include this; nlohmann's header is heavy.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/nearest_name.h"
#include "ipc/envelope.h"
#include "ipc/messages.h"

namespace prismesh::ipc::json_message {

using Json = nlohmann::json;
/// What is wrong, or nothing.
using Problem = std::optional<std::string>;

/// A message's or a part's definition, by specialisation: `kTag` is a message's kind, `fields(m, f)` calls f with each field's name and
/// value, for reading and writing alike (m is const when it is written). A part that isn't an object of fields has `write(json, value)`
/// and `read(json, value)` instead.
template <class T>
struct Message;

#define PRISMESH_MESSAGE(Type, tag, ...)                                                    \
  template <>                                                                               \
  struct Message<Type> {                                                                    \
    static constexpr std::string_view kTag = tag;                                           \
    static void fields([[maybe_unused]] auto& m, [[maybe_unused]] auto& f) { __VA_ARGS__; } \
  }
#define PRISMESH_PART(Type, ...) PRISMESH_MESSAGE(Type, "", __VA_ARGS__)

// Answers that every daemon gives.
PRISMESH_MESSAGE(Failed, "failed", f("file", m.file), f("line", m.line), f("message", m.message));
PRISMESH_MESSAGE(Done, "done", );

// --- writing ---

inline void write(Json& json, bool value) { json = value; }
inline void write(Json& json, double value) { json = value; }
inline void write(Json& json, const std::string& value) { json = value; }
template <class T>
requires std::is_integral_v<T>
void write(Json& json, T value) { json = value; }
template <class T>
void write_object(Json& json, const T& value);
template <class T>
requires(std::is_class_v<T> || std::is_enum_v<T>) void write(Json& json, const T& value) {
  if constexpr (requires { Message<T>::write(json, value); })
    Message<T>::write(json, value);
  else
    write_object(json, value);
}
inline void write(Json& json, const std::array<double, 3>& value) { json = value; }
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
  Message<T>::fields(value, writer);
}

// --- reading ---

inline Problem read(const Json& json, bool& value) {
  if (!json.is_boolean()) return "must be true or false";
  value = json.get<bool>();
  return std::nullopt;
}
inline Problem read(const Json& json, double& value) {
  if (!json.is_number()) return "must be a number";
  value = json.get<double>();
  if (!std::isfinite(value)) return "must be a finite number";
  return std::nullopt;
}
inline Problem read(const Json& json, std::string& value) {
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
inline Problem read(const Json& json, std::array<double, 3>& value) {
  if (!json.is_array() || json.size() != 3) return "must be a list of three numbers";
  for (std::size_t i = 0; i < 3; ++i)
    if (Problem problem = read(json[i], value[i])) return "must be a list of three numbers: one " + *problem;
  return std::nullopt;
}
template <class T>
Problem read_object(const Json& json, T& value);
template <class T>
requires(std::is_class_v<T> || std::is_enum_v<T>) Problem read(const Json& json, T& value) {
  if constexpr (requires { Message<T>::read(json, value); }) {
    return Message<T>::read(json, value);
  } else {
    if (!json.is_object()) return "must be an object";
    return read_object(json, value);
  }
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
  Message<T>::fields(value, reader);
  return reader.problem;
}

template <class T>
Problem unknown_field(const Json& json, T& value) {
  Reader reader{json, std::nullopt, {}};
  Message<T>::fields(value, reader);
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
    using Kind = std::variant_alternative_t<I, Variant>;
    if (tag != Message<Kind>::kTag) {
      known.push_back(Message<Kind>::kTag);
      return read_kind<Variant, I + 1>(json, tag, unknown, message, known);
    }
    Problem problem = read_object(json, message.template emplace<I>());
    if (!problem && unknown == Unknown::refused) problem = unknown_field(json, std::get<I>(message));
    if (problem) problem = "\"" + std::string(tag) + "\": " + *problem;
    return problem;
  }
}

/// The tag's text, taken out of the object; empty if it isn't there.
inline Problem take_tag(Json& json, const char* name, std::string& tag) {
  const auto found = json.find(name);
  if (found == json.end()) return "field \"" + std::string(name) + "\" is missing";
  if (!found->is_string()) return "field \"" + std::string(name) + "\" must be a text in quotes";
  tag = found->get<std::string>();
  json.erase(found);
  return std::nullopt;
}

inline Problem take_number(Json& json, const char* name, std::uint64_t& number) {
  const auto found = json.find(name);
  if (found == json.end()) return std::nullopt;
  if (Problem problem = read(*found, number)) return "field \"" + std::string(name) + "\" " + *problem;
  json.erase(found);
  return std::nullopt;
}

/// No message nests deeper than a state with its warnings or an edit with its outline. Asked before parsing, so that a line of
/// brackets can't take memory a hundred times its size.
inline bool too_deep(std::string_view line) {
  constexpr int kMaxDepth = 12;
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
      if (++depth > kMaxDepth) return true;
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return false;
}

inline Result<Json> parse(std::string_view line) {
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
        json[kind] = Message<std::remove_cvref_t<decltype(each)>>::kTag;
        return json;
      },
      message);
}

inline std::string to_line(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

// --- whole lines ---

template <class Request>
Result<std::string> encode_request(std::uint64_t number, const Request& request) {
  Json json = to_json("request", request);
  json["number"] = number;
  try {
    return json.dump();
  } catch (const Json::type_error&) {
    return fail("request", "a path or text in it isn't UTF-8; it can't be sent");
  }
}

template <class Answer>
std::string encode_answer(std::uint64_t to, const Answer& answer, std::size_t descriptors) {
  Json json = to_json("answer", answer);
  json["to"] = to;
  if (descriptors > 0) json["descriptors"] = descriptors;
  return to_line(json);
}

template <class Answer>
std::string answer_fields(const Answer& answer) {
  Json json = to_json("answer", answer);
  json.erase("answer");
  return to_line(json);
}

template <class Event>
std::string encode_event(const Event& event) {
  return to_line(to_json("event", event));
}

template <class Request>
tl::expected<Numbered<Request>, BadRequest> decode_request(std::string_view line) {
  Result<Json> json = parse(line);
  if (!json) return tl::unexpected(BadRequest{0, json.error().message});
  Numbered<Request> result;
  std::string tag;
  Problem problem = take_number(*json, "number", result.number);
  if (!problem) problem = take_tag(*json, "request", tag);
  std::vector<std::string_view> known;
  if (!problem) problem = read_kind(*json, tag, Unknown::refused, result.request, known);
  if (problem) return tl::unexpected(BadRequest{result.number, *problem});
  return result;
}

template <class Answer, class Event>
Result<Said<Answer, Event>> decode_said(std::string_view line) {
  Result<Json> json = parse(line);
  if (!json) return fail(std::move(json.error()));
  Said<Answer, Event> result;
  std::uint64_t descriptors = 0;
  std::string tag;
  std::vector<std::string_view> known;
  Problem problem = take_number(*json, "descriptors", descriptors);
  result.descriptors = static_cast<std::size_t>(descriptors);
  if (json->contains("event")) {
    if (!problem) problem = take_tag(*json, "event", tag);
    if (!problem) problem = read_kind(*json, tag, Unknown::passed_over, result.message.template emplace<Event>(), known);
  } else {
    if (!problem) problem = take_number(*json, "to", result.to);
    if (!problem) problem = take_tag(*json, "answer", tag);
    if (!problem) problem = read_kind(*json, tag, Unknown::passed_over, result.message.template emplace<Answer>(), known);
  }
  if (problem) return fail("message from the daemon", *problem);
  return result;
}

}  // namespace prismesh::ipc::json_message
