#include "base/json/read.h"

#include <algorithm>
#include <cmath>

#include "base/nearest_name.h"

namespace prismesh::json {

namespace {

std::string words_of(const NumberLimits& limits) {
  if (limits.max < kMaxNumber) return "a number between " + Json(limits.min).dump() + " and " + Json(limits.max).dump();
  return limits.min <= -kMaxNumber ? "a number" : "a number greater than 0";
}

std::string in_whole_quotes(std::string_view text) { return "\"" + std::string(text) + "\""; }

}  // namespace

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kMaxLength = 60;
  const bool cut = text.size() > kMaxLength;
  return "\"" + std::string(text.substr(0, kMaxLength)) + (cut ? "..." : "") + "\"";
}

std::string description(const Json& value) {
  if (value.is_null()) return "null";
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_number_float()) return "the number " + std::to_string(value.get<double>());
  if (value.is_number()) return "the number " + value.dump();
  if (value.is_string()) return "the text " + in_quotes(value.get_ref<const std::string&>());
  return value.is_array() ? "a list of " + std::to_string(value.size()) : "an object";
}

std::string listed(const std::vector<std::string_view>& words) {
  std::string all;
  for (const std::string_view word : words) all += (all.empty() ? "" : ", ") + std::string(word);
  return all;
}

Problem must_be(const std::string& what, const Json& found, Author author) {
  return "must be " + what + (author == Author::person ? ", not " + description(found) : "");
}

std::string sentence(const std::string& name, const std::string& problem) { return name + (problem.starts_with(':') ? "" : " ") + problem; }

Problem must_be_named(const Json& found, const std::vector<std::string_view>& names, Author author) {
  if (author == Author::program) {
    std::string all;
    for (std::size_t i = 0; i < names.size(); ++i) all += (i == 0 ? "" : i + 1 < names.size() ? ", " : " or ") + in_whole_quotes(names[i]);
    return "must be " + all;
  }
  Problem problem = must_be("one of " + listed(names), found, author);
  if (found.is_string()) *problem += "; the nearest is " + in_quotes(nearest_name(found.get_ref<const std::string&>(), names));
  return problem;
}

Problem read(const Json& json, bool& value, Author author) {
  if (!json.is_boolean()) return must_be("true or false", json, author);
  value = json.get<bool>();
  return std::nullopt;
}

Problem read(const Json& json, bool& value, Author author, const TwoWords& words) {
  if (json != words.if_false && json != words.if_true) return must_be(std::string(words.choice), json, author);
  value = json == words.if_true;
  return std::nullopt;
}

Problem read(const Json& json, double& value, Author author) {
  constexpr double kMaxFinite = std::numeric_limits<double>::max();
  return read(json, value, author, author == Author::person ? NumberLimits{} : NumberLimits{-kMaxFinite, kMaxFinite});
}

Problem read(const Json& json, double& value, Author author, const NumberLimits& limits) {
  const double number = json.is_number() ? json.get<double>() : std::numeric_limits<double>::quiet_NaN();
  const bool fits = std::isfinite(number) && limits.min <= number && number <= limits.max && !(limits.above_min && number <= limits.min);
  if (!fits) return must_be(words_of(limits), json, author);
  value = number;
  return std::nullopt;
}

Problem read(const Json& json, std::string& value, Author author) {
  if (!json.is_string()) return must_be("a text in quotes", json, author);
  value = json.get<std::string>();
  return std::nullopt;
}

Problem read_numbers(const Json& json, std::span<double> values, Author author) {
  const bool by_person = author == Author::person;
  const std::string what = "a list of " + (!by_person && values.size() == 3 ? "three" : std::to_string(values.size())) + " numbers";
  if (!json.is_array() || json.size() != values.size()) return must_be(what, json, author);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (const Problem problem = read(json[i], values[i], author))
      return "must be " + what + (by_person ? "; number " + std::to_string(i + 1) + " " : ": one ") + *problem;
  return std::nullopt;
}

const Json* FieldReader::find(std::string_view name) {
  known_.push_back(name);
  const auto found = object_.find(std::string(name));
  return found == object_.end() ? nullptr : &*found;
}

void FieldReader::note(std::string_view name, const Problem& problem) {
  if (!problem || problem_) return;
  const std::string which = author_ == Author::person ? ": " + in_quotes(name) : "field " + in_whole_quotes(name);
  problem_ = sentence(which, *problem);
}

Problem FieldReader::problem() const {
  if (author_ == Author::person)
    if (Problem unknown = unknown_field()) return unknown;
  if (problem_ || !missing_) return problem_;
  return author_ == Author::person ? "needs the field " + in_quotes(*missing_) : "field " + in_whole_quotes(*missing_) + " is missing";
}

Problem FieldReader::unknown_field() const {
  for (const auto& item : object_.items()) {
    const std::string& name = item.key();
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    const std::string_view nearest = nearest_name(name, known_);
    if (author_ == Author::person)
      return "has no field " + in_quotes(name) + "; the nearest is " + in_quotes(nearest) + " (known: " + listed(known_) + ")";
    if (known_.empty()) return "has no field " + in_whole_quotes(name) + ": it has none";
    return "has no field " + in_whole_quotes(name) + "; the nearest is " + in_whole_quotes(nearest);
  }
  return std::nullopt;
}

}  // namespace prismesh::json
