#include "mesh/batch/script.h"

#include <cmath>
#include <functional>
#include <set>
#include <string_view>

#include <nlohmann/json.hpp>

#include "base/json/nesting.h"
#include "base/nearest_name.h"
#include "mesh/document/edit_json.h"

namespace prismesh::mesh::batch {

namespace {

using Json = nlohmann::json;
constexpr int kMaxDepth = 64;
/// The value of a name; an error's message where there is none.
using Values = std::function<tl::expected<ParameterValue, std::string>(std::string_view name)>;
using Problem = std::optional<std::string>;

/// A whole number is written as one: fields like rings take no other.
Json as_json(double number) {
  const bool is_whole = std::abs(number) < 1e15 && number == std::floor(number);
  return is_whole ? Json(static_cast<std::int64_t>(number)) : Json(number);
}

Problem put_into_text(Json& json, const Values& values) {
  const std::string text = json.get<std::string>();
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t begin = text.find("${", at);
    out += text.substr(at, begin - at);
    if (begin == std::string::npos) break;
    const std::size_t end = text.find('}', begin);
    if (end == std::string::npos) return "\"" + text + "\" has a ${ without its }";
    const auto value = values(std::string_view(text).substr(begin + 2, end - begin - 2));
    if (!value) return value.error();
    if (begin == 0 && end + 1 == text.size()) {
      if (const double* number = std::get_if<double>(&*value))
        json = as_json(*number);
      else
        json = std::get<std::string>(*value);
      return std::nullopt;
    }
    out += words(*value);
    at = end + 1;
  }
  json = out;
  return std::nullopt;
}

Problem put_into(Json& json, const Values& values) {
  if (json.is_string()) return put_into_text(json, values);
  if (!json.is_structured()) return std::nullopt;
  for (Json& each : json)
    if (Problem problem = put_into(each, values)) return problem;
  return std::nullopt;
}

/// Calls `each(line's JSON, line)` with the values in place.
template <class Each>
Result<void> for_lines(const Script& script, const Values& values, const Each& each) {
  std::string_view rest = script.text;
  for (long line = 1; !rest.empty(); ++line) {
    const std::size_t end = rest.find('\n');
    const std::string_view text = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (text.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    if (json::is_nested_deeper(text, kMaxDepth)) return fail(script.file.string(), line, "the edit is nested too deeply");
    Json json = Json::parse(text, nullptr, false);
    if (json.is_discarded()) {
      // says where
      const Result<document::Edit> refused = document::parse_edit(text);
      return fail(script.file.string(), line, refused ? "not JSON" : refused.error().message);
    }
    if (const Problem problem = put_into(json, values)) return fail(script.file.string(), line, *problem);
    if (Result<void> done = each(json, line); !done) return done;
  }
  return {};
}

}  // namespace

Result<std::vector<ScriptEdit>> edits_with(const Script& script, const std::vector<Parameter>& parameters,
                                           const std::vector<ParameterValue>& values) {
  std::vector<ScriptEdit> edits;
  const auto value_of = [&](std::string_view name) -> tl::expected<ParameterValue, std::string> {
    std::vector<std::string_view> known;
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      if (parameters[p].name == name) return values[p];
      known.push_back(parameters[p].name);
    }
    std::string message = "the plan has no parameter \"" + std::string(name) + "\"";
    if (!known.empty()) message += "; the nearest known is \"" + std::string(nearest_name(name, known)) + "\"";
    return tl::unexpected(std::move(message));
  };
  const auto take = [&](const Json& json, long line) -> Result<void> {
    Result<document::Edit> edit = document::edit_from_json(json);
    if (!edit) return fail(script.file.string(), line, edit.error().message);
    edits.push_back({std::move(*edit), json.dump(), line});
    return {};
  };
  if (Result<void> done = for_lines(script, value_of, take); !done) return fail(done.error());
  return edits;
}

Result<std::vector<std::string>> parameters_named(const Script& script) {
  std::set<std::string> names;
  const auto note = [&](std::string_view name) -> tl::expected<ParameterValue, std::string> {
    names.emplace(name);
    return ParameterValue(0.0);
  };
  if (Result<void> done = for_lines(script, note, [](const Json&, long) { return Result<void>(); }); !done) return fail(done.error());
  return std::vector<std::string>(names.begin(), names.end());
}

}  // namespace prismesh::mesh::batch
