#include "mesh/document/edit_json.h"
#include "mesh/document/edit_kinds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/nearest_name.h"
#include "mesh/document/edit_fields.h"

namespace prismesh::mesh::document {

namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxOutlineLength = 100'000;
constexpr int kMaxRings = 1'000'000;

// --- enumerations: one table each ---

template <class E>
using Names = std::vector<std::pair<std::string_view, E>>;

const Names<select::EntityKind>& names(select::EntityKind) {
  static const Names<select::EntityKind> table{
      {"node", select::EntityKind::node}, {"element", select::EntityKind::element}, {"part", select::EntityKind::part}};
  return table;
}
const Names<SelectMode>& names(SelectMode) {
  static const Names<SelectMode> table{
      {"set", SelectMode::set}, {"add", SelectMode::add}, {"subtract", SelectMode::subtract}, {"intersect", SelectMode::intersect}};
  return table;
}
const Names<RegionBy>& names(RegionBy) {
  static const Names<RegionBy> table{
      {"features", RegionBy::features}, {"part", RegionBy::part}, {"piece", RegionBy::piece}, {"free_edge", RegionBy::free_edge}};
  return table;
}
const Names<Scope>& names(Scope) {
  static const Names<Scope> table{
      {"selection", Scope::selection}, {"part", Scope::part}, {"all", Scope::all}, {"damaged", Scope::damaged}, {"failed", Scope::failed}};
  return table;
}
const Names<RelaxMode>& names(RelaxMode) {
  static const Names<RelaxMode> table{{"full", RelaxMode::full}, {"from", RelaxMode::from}};
  return table;
}
const Names<shape::Origin>& names(shape::Origin) {
  static const Names<shape::Origin> table{{"grab", shape::Origin::grab}, {"free_edge", shape::Origin::free_edge}};
  return table;
}
const Names<shape::Profile>& names(shape::Profile) {
  static const Names<shape::Profile> table = [] {
    Names<shape::Profile> all;
    for (const shape::Profile profile :
         {shape::Profile::constant, shape::Profile::linear, shape::Profile::smooth, shape::Profile::sharp, shape::Profile::root,
          shape::Profile::sphere, shape::Profile::inverse_square, shape::Profile::gaussian})
      all.emplace_back(shape::name(profile), profile);
    return all;
  }();
  return table;
}

/// Edits that the command line's contract names and this version lacks.
constexpr std::string_view kNotBuilt[] = {"separate", "weld", "bond", "replace_part"};

// --- words for errors ---

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kMaxLength = 60;
  const bool cut = text.size() > kMaxLength;
  return "\"" + std::string(text.substr(0, kMaxLength)) + (cut ? "..." : "") + "\"";
}

std::string list(const std::vector<std::string_view>& words) {
  std::string all;
  for (const std::string_view word : words) all += (all.empty() ? "" : ", ") + std::string(word);
  return all;
}

std::string what_it_is(const Json& value) {
  if (value.is_null()) return "null";
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_number_float()) return "the number " + std::to_string(value.get<double>());
  if (value.is_number()) return "the number " + value.dump();
  if (value.is_string()) return "the text " + in_quotes(value.get_ref<const std::string&>());
  return value.is_array() ? "a list of " + std::to_string(value.size()) : "an object";
}

using Problem = std::optional<std::string>;  ///< "must be ..., not ..."; nothing if the value was read

Problem must_be(const std::string& what, const Json& value) { return "must be " + what + ", not " + what_it_is(value); }

// --- reading one value ---

Problem read(const Json& json, double& value, const Limit& limit) {
  const std::string range = limit.low <= -kMax && limit.high >= kMax ? "a number"
                            : limit.high >= kMax                     ? "a number greater than 0"
                                                 : "a number between " + Json(limit.low).dump() + " and " + Json(limit.high).dump();
  if (!json.is_number()) return must_be(range, json);
  const double number = json.get<double>();
  if (!std::isfinite(number) || number < limit.low || number > limit.high || (limit.low_open && number <= limit.low))
    return must_be(range, json);
  value = number;
  return std::nullopt;
}

Problem read(const Json& json, std::string& value) {
  if (!json.is_string()) return must_be("a text in quotes", json);
  value = json.get<std::string>();
  return std::nullopt;
}

Problem read(const Json& json, bool& value) {
  if (!json.is_boolean()) return must_be("true or false", json);
  value = json.get<bool>();
  return std::nullopt;
}

Problem read(const Json& json, int& value) {
  const std::string what = "a whole number between 1 and " + std::to_string(kMaxRings);
  if (!json.is_number_integer()) return must_be(what, json);
  const bool fits = json.is_number_unsigned() ? json.get<std::uint64_t>() <= kMaxRings : json.get<std::int64_t>() >= 1;
  if (!fits || json.get<std::int64_t>() < 1) return must_be(what, json);
  value = json.get<int>();
  return std::nullopt;
}

template <std::size_t N>
Problem read(const Json& json, std::array<double, N>& value) {
  const std::string what = "a list of " + std::to_string(N) + " numbers";
  if (!json.is_array() || json.size() != N) return must_be(what, json);
  for (std::size_t i = 0; i < N; ++i)
    if (Problem problem = read(json[i], value[i], kAnyLength))
      return "must be " + what + "; number " + std::to_string(i + 1) + " " + *problem;
  return std::nullopt;
}

Problem read(const Json& json, Vec3& value) {
  std::array<double, 3> numbers{};
  if (Problem problem = read(json, numbers)) return problem;
  value = Vec3(numbers[0], numbers[1], numbers[2]);
  return std::nullopt;
}

Problem read(const Json& json, std::vector<std::array<double, 2>>& value) {
  if (!json.is_array() || json.size() < 3 || json.size() > kMaxOutlineLength)
    return must_be("a list of 3 to " + std::to_string(kMaxOutlineLength) + " points [x, y]", json);
  value.resize(json.size());
  for (std::size_t i = 0; i < json.size(); ++i)
    if (Problem problem = read(json[i], value[i])) return "has a wrong point " + std::to_string(i + 1) + ": it " + *problem;
  return std::nullopt;
}

Problem read(const Json& json, std::vector<std::string>& value) {
  constexpr std::size_t kMax = 1000;
  const std::string what = "a list of 1 to " + std::to_string(kMax) + " entities like [\"shell:12\", \"shell:40\"]";
  if (!json.is_array() || json.empty() || json.size() > kMax) return must_be(what, json);
  value.clear();
  for (const Json& each : json) {
    if (!each.is_string()) return must_be(what, each);
    value.push_back(each.get<std::string>());
  }
  return std::nullopt;
}

Problem read(const Json& json, Place& value) {
  if (json.is_array()) {
    std::array<double, 3> point{};
    if (Problem problem = read(json, point)) return problem;
    value = point;
    return std::nullopt;
  }
  const bool fits =
      json.is_number_integer() &&
      (!json.is_number_unsigned() || json.get<std::uint64_t>() <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()));
  if (!fits) return must_be("a node's id or its coordinates [x, y, z]", json);
  value = json.get<std::int64_t>();
  return std::nullopt;
}

template <class E>
requires std::is_enum_v<E> Problem read(const Json& json, E& value) {
  std::vector<std::string_view> known;
  for (const auto& [word, each] : names(E{})) {
    known.push_back(word);
    if (json.is_string() && json.get_ref<const std::string&>() == word) {
      value = each;
      return std::nullopt;
    }
  }
  Problem problem = must_be("one of " + list(known), json);
  if (json.is_string()) *problem += "; the nearest is " + in_quotes(nearest_name(json.get_ref<const std::string&>(), known));
  return problem;
}

Problem read(const Json& json, Where& value);
Result<Edit> blank_edit(const Json& json);

template <class T, class... More>
Problem read(const Json& json, std::optional<T>& value, const More&... more) {
  T inner{};
  if (Problem problem = read(json, inner, more...)) return problem;
  value = std::move(inner);
  return std::nullopt;
}

// --- reading an object ---

class FieldReader {
 public:
  FieldReader(const Json& object, std::string what) : object_(object), what_(std::move(what)) {}

  template <class T, class... More>
  void required(std::string_view field, T& value, const More&... more) {
    if (!take(field, value, more...) && !missing_) missing_ = field;
  }
  template <class T, class... More>
  void optional(std::string_view field, T& value, const More&... more) {
    take(field, value, more...);
  }
  void nested(std::string_view field, shape::Falloff& value) {
    const Json* json = find(field);
    if (json == nullptr) return;
    if (!json->is_object()) return complain(field, must_be("an object like {\"profile\": \"smooth\"}", *json));
    FieldReader inner(*json, what_ + ": " + in_quotes(field));
    fields(inner, value, static_cast<const shape::Falloff*>(nullptr));
    if (value.along && !(value.along->squaredNorm() > 0)) inner.complain("along", "must be a direction, not [0, 0, 0]");
    if (!error_) error_ = inner.finish();
  }
  void nested(std::string_view field, std::optional<Symmetry>& value) {
    const Json* json = find(field);
    if (json == nullptr) return;
    if (!json->is_object()) return complain(field, must_be("an object like {\"point\": [0, 0, 0], \"normal\": [0, 1, 0]}", *json));
    value.emplace();
    FieldReader inner(*json, what_ + ": " + in_quotes(field));
    fields(inner, *value, static_cast<const Symmetry*>(nullptr));
    if (!error_) error_ = inner.finish();
  }
  void nested(std::string_view field, MoveLimits& value) {
    const Json* json = find(field);
    if (json == nullptr) return;
    if (!json->is_object()) return complain(field, must_be("an object like {\"free\": 2, \"line\": 0.5}", *json));
    FieldReader inner(*json, what_ + ": " + in_quotes(field));
    fields(inner, value, static_cast<const MoveLimits*>(nullptr));
    if (!error_) error_ = inner.finish();
  }
  void direction(std::string_view field, Vec3& value) {
    required(field, value);
    if (object_.contains(std::string(field)) && !(value.squaredNorm() > 0)) complain(field, "must be a direction, not [0, 0, 0]");
  }
  void normals(std::string_view field, bool& each) {
    const Json* json = find(field);
    if (json == nullptr) return;
    const bool known = *json == "each" || *json == "grab";
    if (!known) return complain(field, must_be("\"grab\" (all nodes along the normal at the grab) or \"each\"", *json));
    each = *json == "each";
  }
  void also_known(std::string_view field) { known_.push_back(field); }

  /// What is wrong with the object as a whole: an unknown field first (a mistyped name also leaves its field missing).
  std::optional<Error> finish() const {
    for (const auto& [key, value] : object_.items()) {
      const auto in = [&key = key](const std::vector<std::string_view>& all) {
        return std::find(all.begin(), all.end(), key) != all.end();
      };
      if (in(known_)) continue;
      return Error{"", 0,
                   what_ + " has no field " + in_quotes(key) + "; the nearest is " + in_quotes(nearest_name(key, known_)) +
                       " (known: " + list(known_) + ")"};
    }
    if (error_) return error_;
    if (missing_) return Error{"", 0, what_ + " needs the field " + in_quotes(*missing_)};
    return std::nullopt;
  }

 private:
  const Json* find(std::string_view field) {
    known_.push_back(field);
    const auto found = object_.find(std::string(field));
    return found == object_.end() ? nullptr : &*found;
  }
  template <class T, class... More>
  bool take(std::string_view field, T& value, const More&... more) {
    const Json* json = find(field);
    if (json == nullptr) return false;
    complain(field, read(*json, value, more...));
    return true;
  }
  void complain(std::string_view field, const Problem& problem) {
    if (problem && !error_) error_ = Error{"", 0, what_ + ": " + in_quotes(field) + " " + *problem};
  }

  const Json& object_;
  std::string what_;
  std::vector<std::string_view> known_;
  std::optional<std::string_view> missing_;
  std::optional<Error> error_;
};

Problem read(const Json& json, Where& value) {
  if (json.is_string()) {
    value = json.get<std::string>();
    return std::nullopt;
  }
  if (!json.is_object()) return must_be("an expression in quotes or a recipe like {\"edit\": \"select_region\", ...}", json);
  // Checked before the recipe is read, so that recipes can't nest and no input can exhaust the stack.
  const Result<Edit> blank = blank_edit(json);
  if (!blank) return "has a wrong recipe: " + blank.error().message;
  const bool selects =
      std::holds_alternative<Select>(*blank) || std::holds_alternative<SelectRegion>(*blank) || std::holds_alternative<SelectLasso>(*blank);
  if (!selects) return "must be a recipe that selects: select, select_region or select_lasso, not " + std::string(name(*blank));
  Result<Edit> recipe = edit_from_json(json);
  if (!recipe) return "has a wrong recipe: " + recipe.error().message;
  if (auto* select = std::get_if<Select>(&*recipe)) value = std::move(*select);
  if (auto* region = std::get_if<SelectRegion>(&*recipe)) value = *region;
  if (auto* lasso = std::get_if<SelectLasso>(&*recipe)) value = std::move(*lasso);
  return std::nullopt;
}

// --- writing ---

Json object_of(const Edit& edit);

Json written(const std::string& value) { return value; }
Json written(bool value) { return value; }
Json written(int value) { return value; }
Json written(double value) { return value; }
Json written(const Vec3& value) { return Json::array({value.x(), value.y(), value.z()}); }
template <std::size_t N>
Json written(const std::array<double, N>& value) {
  return value;
}
Json written(const std::vector<std::array<double, 2>>& value) { return value; }
Json written(const std::vector<std::string>& value) { return value; }
Json written(const Place& value) {
  return std::visit([](const auto& place) { return Json(place); }, value);
}
Json written(const Where& value) {
  if (const auto* expression = std::get_if<std::string>(&value)) return *expression;
  return std::visit(
      [](const auto& recipe) -> Json {
        if constexpr (std::is_same_v<std::decay_t<decltype(recipe)>, std::string>)
          return recipe;
        else
          return object_of(Edit(recipe));
      },
      value);
}
template <class E>
requires std::is_enum_v<E> Json written(E value) {
  for (const auto& [word, each] : names(E{}))
    if (each == value) return std::string(word);
  return nullptr;
}

/// Writes every field that has a value, defaults too: a journal must mean the same when defaults change.
class FieldWriter {
 public:
  explicit FieldWriter(Json& object) : object_(object) {}

  template <class T, class... More>
  void required(std::string_view field, const T& value, const More&...) {
    object_[std::string(field)] = written(value);
  }
  template <class T, class... More>
  void optional(std::string_view field, const T& value, const More&...) {
    object_[std::string(field)] = written(value);
  }
  template <class T, class... More>
  void optional(std::string_view field, const std::optional<T>& value, const More&...) {
    if (value) object_[std::string(field)] = written(*value);
  }
  void nested(std::string_view field, const shape::Falloff& value) {
    Json inner = Json::object();
    FieldWriter writer(inner);
    fields(writer, value, static_cast<const shape::Falloff*>(nullptr));
    object_[std::string(field)] = std::move(inner);
  }
  void normals(std::string_view field, bool each) { object_[std::string(field)] = each ? "each" : "grab"; }
  void nested(std::string_view field, const std::optional<Symmetry>& value) {
    if (!value) return;
    Json inner = Json::object();
    FieldWriter writer(inner);
    fields(writer, *value, static_cast<const Symmetry*>(nullptr));
    object_[std::string(field)] = std::move(inner);
  }
  void nested(std::string_view field, const MoveLimits& value) {
    if (!value.free && !value.line) return;
    Json inner = Json::object();
    FieldWriter writer(inner);
    fields(writer, value, static_cast<const MoveLimits*>(nullptr));
    object_[std::string(field)] = std::move(inner);
  }
  void direction(std::string_view field, const Vec3& value) { required(field, value); }

 private:
  Json& object_;
};

Json object_of(const Edit& edit) {
  Json object = Json::object();
  object["edit"] = std::string(name(edit));
  FieldWriter writer(object);
  std::visit([&](const auto& each) { fields(writer, each, &each); }, edit);
  return object;
}

Result<Edit> blank_edit(const Json& json) {
  if (!json.is_object()) return fail("", "an edit is an object like {\"edit\": \"select\", \"expr\": \"1-100\"}, not " + what_it_is(json));
  const auto found = json.find("edit");
  if (found == json.end()) return fail("", "the field \"edit\" is missing: it says which edit this is");
  if (!found->is_string()) return fail("", "\"edit\" " + *must_be("the name of an edit", *found));
  const std::string& wanted = found->get_ref<const std::string&>();
  std::vector<std::string_view> known;
  for (const EditKind& entry : edit_kinds()) {
    if (entry.name == wanted) return entry.blank;
    known.push_back(entry.name);
  }
  if (std::find(std::begin(kNotBuilt), std::end(kNotBuilt), wanted) != std::end(kNotBuilt))
    return fail("", "the edit " + in_quotes(wanted) + " isn't there yet in this version, which has: " + list(known));
  return fail("", "there is no edit " + in_quotes(wanted) + "; the nearest is " + in_quotes(nearest_name(wanted, known)) +
                      " (known: " + list(known) + ")");
}

}  // namespace

Result<Edit> edit_from_json(const Json& json) {
  Result<Edit> edit = blank_edit(json);
  if (!edit) return edit;
  FieldReader reader(json, std::string(name(*edit)));
  reader.also_known("edit");
  std::visit([&](auto& each) { fields(reader, each, &each); }, *edit);
  if (const std::optional<Error> error = reader.finish()) return fail(*error);
  return edit;
}

Json edit_to_json(const Edit& edit) { return object_of(edit); }

Result<Edit> parse_edit(std::string_view text, bool* syntax_error) {
  if (syntax_error != nullptr) *syntax_error = false;
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::exception& error) {
    if (syntax_error != nullptr) *syntax_error = true;
    const std::string_view what = error.what();  // "[json.exception.parse_error.101] parse error at ...": the code helps nobody
    const std::size_t end = what.find("] ");
    return fail("", "this is not JSON: " + std::string(end == std::string_view::npos ? what : what.substr(end + 2)));
  }
  return edit_from_json(json);
}

}  // namespace prismesh::mesh::document
