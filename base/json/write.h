// Writes values as JSON by their definitions (base/json/definition.h). nlohmann's header is heavy: only sources that define or write JSON
// include this.
#pragma once

#include <array>
#include <concepts>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/json/definition.h"

namespace prismesh::json {

using Json = nlohmann::json;

template <class T>
requires std::is_arithmetic_v<T>
void write(Json& json, T value) { json = value; }
inline void write(Json& json, const std::string& value) { json = value; }
template <std::size_t N>
void write(Json& json, const std::array<double, N>& values) {
  json = values;
}
template <class T>
requires requires { sizeof(Definition<T>); }
void write(Json& json, const T& value);
template <class T>
void write(Json& json, const std::vector<T>& values) {
  json = Json::array();
  for (const T& value : values) write(json.emplace_back(), value);
}

/// The visitor that writes an object's fields. Defaults are written too: a journal must mean the same when defaults change.
class FieldWriter {
 public:
  explicit FieldWriter(Json& object) : object_(object) {}

  template <class T, class... Limits>
  void operator()(std::string_view name, const T& value, const Limits&...) {
    if constexpr (requires { Definition<T>::is_absent(value); })
      if (Definition<T>::is_absent(value)) return;
    write(object_[std::string(name)], value);
  }
  template <class T, class... Limits>
  void operator()(std::string_view name, const std::optional<T>& value, const Limits&... limits) {
    if (value) (*this)(name, *value, limits...);
  }
  void operator()(std::string_view name, bool value, const TwoWords& words) {
    object_[std::string(name)] = value ? words.if_true : words.if_false;
  }
  template <class T, class... Limits>
  void required(std::string_view name, const T& value, const Limits&... limits) {
    (*this)(name, value, limits...);
  }

 private:
  Json& object_;
};

template <class T>
requires requires { sizeof(Definition<T>); }
void write(Json& json, const T& value) {
  if constexpr (requires { Definition<T>::names(); }) {
    for (const auto& [name, each] : Definition<T>::names())
      if (each == value) json = name;
  } else if constexpr (requires { Definition<T>::write(json, value); }) {
    Definition<T>::write(json, value);
  } else {
    json = Json::object();
    FieldWriter writer(json);
    Definition<T>::fields(value, writer);
  }
}

template <class T>
Json to_json(const T& value) {
  Json json;
  write(json, value);
  return json;
}

/// In one line, without its end. Bytes that aren't UTF-8 (names in decks) become replacement characters.
std::string to_line(const Json& json);

}  // namespace prismesh::json
