// Reads values out of JSON by their definitions (base/json/definition.h). nlohmann's header is heavy: only sources that define or read
// JSON include this.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/json/definition.h"

namespace prismesh::json {

using Json = nlohmann::json;

/// What is wrong with a value, to stand behind its name ("must be a number"); empty if the value could be read.
using Problem = std::optional<std::string>;

/// Who wrote the JSON: how strictly it is read, and how errors are worded.
enum class Author : std::uint8_t {
  person,   ///< errors quote what was written; unknown fields and null are errors
  program,  ///< errors are short; unknown fields, of a newer program, are ignored; null stands for an absent value
};

// --- words of errors ---

/// The text in quotes, shortened.
std::string in_quotes(std::string_view text);
/// What stands there, in words: "the number 7", "a list of 2".
std::string description(const Json& value);
/// "a, b, c"
std::string listed(const std::vector<std::string_view>& words);
/// "must be `what`", and for a person what stands there instead.
Problem must_be(const std::string& what, const Json& found, Author author);
/// A value's name and what is wrong with it, as one sentence.
std::string sentence(const std::string& name, const std::string& problem);

// --- values ---

Problem read(const Json& json, bool& value, Author author);
Problem read(const Json& json, bool& value, Author author, const TwoWords& words);
Problem read(const Json& json, double& value, Author author);
Problem read(const Json& json, double& value, Author author, const NumberLimits& limits);
Problem read(const Json& json, std::string& value, Author author);

template <std::integral T>
Problem read(const Json& json, T& value, Author author) {
  if (!json.is_number_integer()) return must_be("a whole number", json, author);
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
template <std::integral T>
Problem read(const Json& json, T& value, Author author, const WholeNumberLimits& limits) {
  T number{};
  if (!read(json, number, author) && limits.min <= static_cast<std::int64_t>(number) && static_cast<std::int64_t>(number) <= limits.max) {
    value = number;
    return std::nullopt;
  }
  return must_be("a whole number between " + std::to_string(limits.min) + " and " + std::to_string(limits.max), json, author);
}

/// A list of as many numbers as there are values.
Problem read_numbers(const Json& json, std::span<double> values, Author author);
template <std::size_t N>
Problem read(const Json& json, std::array<double, N>& values, Author author) {
  return read_numbers(json, values, author);
}

template <class T, class... Limits>
Problem read(const Json& json, std::optional<T>& value, Author author, const Limits&... limits) {
  value.reset();
  if (author == Author::program && json.is_null()) return std::nullopt;
  T inner{};
  if (Problem problem = read(json, inner, author, limits...)) return problem;
  value = std::move(inner);
  return std::nullopt;
}

template <class T>
Problem read(const Json& json, std::vector<T>& values, Author author) {
  if (!json.is_array()) return must_be("a list", json, author);
  values.clear();
  values.reserve(json.size());
  for (const Json& item : json)
    if (Problem problem = read(item, values.emplace_back(), author)) return "has an item that " + *problem;
  return std::nullopt;
}
template <class T>
Problem read(const Json& json, std::vector<T>& values, Author author, const ListLimits& limits) {
  const std::string what =
      "a list of " + std::to_string(limits.min_count) + " to " + std::to_string(limits.max_count) + " " + std::string(limits.items);
  if (!json.is_array() || json.size() < limits.min_count || json.size() > limits.max_count) return must_be(what, json, author);
  values.clear();
  values.reserve(json.size());
  for (const Json& item : json) {
    const Problem problem = read(item, values.emplace_back(), author);
    if (problem && limits.item.empty()) return must_be(what, item, author);
    if (problem) return "has a wrong " + std::string(limits.item) + " " + std::to_string(values.size()) + ": it " + *problem;
  }
  return std::nullopt;
}

// --- objects ---

/// The visitor that reads an object's fields. A missing field keeps its default.
class FieldReader {
 public:
  FieldReader(const Json& object, Author author) : object_(object), author_(author) {}

  template <class T, class... Limits>
  void operator()(std::string_view name, T& value, const Limits&... limits) {
    if (const Json* json = find(name)) note(name, read(*json, value, author_, limits...));
  }
  template <class T, class... Limits>
  void required(std::string_view name, T& value, const Limits&... limits) {
    (*this)(name, value, limits...);
    if (!missing_ && !object_.contains(std::string(name))) missing_ = name;
  }
  /// A field that isn't read.
  void also_known(std::string_view name) { known_.push_back(name); }

  /// What is wrong with the object, once all its fields have been visited. A person's unknown fields are told first: a mistyped name also
  /// leaves its field missing.
  Problem problem() const;
  /// The first field that was not visited, and the nearest that was.
  Problem unknown_field() const;

 private:
  const Json* find(std::string_view name);
  void note(std::string_view name, const Problem& problem);

  const Json& object_;
  Author author_;
  std::vector<std::string_view> known_;
  std::optional<std::string_view> missing_;
  Problem problem_;
};

// --- what has a definition ---

/// "must be one of ...", with the nearest name.
Problem must_be_named(const Json& found, const std::vector<std::string_view>& names, Author author);

template <class E>
Problem read_name(const Json& json, E& value, Author author) {
  std::vector<std::string_view> known;
  for (const auto& [name, each] : Definition<E>::names()) {
    known.push_back(name);
    if (!json.is_string() || json.get_ref<const std::string&>() != name) continue;
    value = each;
    return std::nullopt;
  }
  return must_be_named(json, known, author);
}

template <class T>
Problem read_object(const Json& json, T& value, Author author) {
  if (!json.is_object()) {
    if constexpr (requires { Definition<T>::kExample; })
      return must_be("an object like " + std::string(Definition<T>::kExample), json, author);
    else
      return must_be("an object", json, author);
  }
  FieldReader reader(json, author);
  Definition<T>::fields(value, reader);
  return reader.problem();
}

template <class T, class... Limits>
requires requires { sizeof(Definition<T>); }
Problem read(const Json& json, T& value, Author author, const Limits&... limits) {
  if constexpr (requires { Definition<T>::names(); })
    return read_name(json, value, author);
  else if constexpr (requires { Definition<T>::read(json, value, author, limits...); })
    return Definition<T>::read(json, value, author, limits...);
  else
    return read_object(json, value, author);
}

}  // namespace prismesh::json
