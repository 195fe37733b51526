#include "mesh/document/edit_json.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/nearest_name.h"
#include "mesh/document/edit_fields.h"
#include "mesh/document/edit_kinds.h"

namespace prismesh::mesh::document {

namespace {

using json::Author;
using json::in_quotes;
using json::Json;
using json::listed;
using json::must_be;

/// The edit that the field "edit" names, with its defaults.
Result<Edit> blank_edit(const Json& json) {
  if (!json.is_object())
    return fail("", "an edit is an object like {\"edit\": \"select\", \"expr\": \"1-100\"}, not " + json::description(json));
  const auto found = json.find("edit");
  if (found == json.end()) return fail("", "the field \"edit\" is missing: it says which edit this is");
  if (!found->is_string()) return fail("", "\"edit\" " + *must_be("the name of an edit", *found, Author::person));
  const std::string& wanted = found->get_ref<const std::string&>();
  std::vector<std::string_view> known;
  for (const EditKind& entry : edit_kinds()) {
    if (entry.name == wanted) return entry.blank;
    known.push_back(entry.name);
  }
  return fail("", "there is no edit " + in_quotes(wanted) + "; the nearest is " + in_quotes(nearest_name(wanted, known)) +
                      " (known: " + listed(known) + ")");
}

}  // namespace

Result<Edit> edit_from_json(const Json& json) {
  Result<Edit> edit = blank_edit(json);
  if (!edit) return edit;
  json::FieldReader reader(json, Author::person);
  reader.also_known("edit");
  std::visit([&]<class Each>(Each& each) { json::Definition<Each>::fields(each, reader); }, *edit);
  if (const json::Problem problem = reader.problem()) return fail("", json::sentence(std::string(name(*edit)), *problem));
  return edit;
}

Json edit_to_json(const Edit& edit) {
  Json object = std::visit([](const auto& each) { return json::to_json(each); }, edit);
  object["edit"] = name(edit);
  return object;
}

Result<Edit> parse_edit(std::string_view text, bool* syntax_error) {
  if (syntax_error != nullptr) *syntax_error = false;
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::exception& error) {
    if (syntax_error != nullptr) *syntax_error = true;
    const std::string_view what = error.what();  // "[json.exception.parse_error.101] parse error at ...": users don't need the code
    const std::size_t end = what.find("] ");
    return fail("", "this is not JSON: " + std::string(end == std::string_view::npos ? what : what.substr(end + 2)));
  }
  return edit_from_json(json);
}

}  // namespace prismesh::mesh::document

namespace prismesh::json {

namespace document = mesh::document;

const Names<mesh::shape::Profile>& Definition<mesh::shape::Profile>::names() {
  using mesh::shape::Profile;
  static const Names<Profile> table = [] {
    Names<Profile> all;
    for (const Profile profile : {Profile::constant, Profile::linear, Profile::smooth, Profile::sharp, Profile::root, Profile::sphere,
                                  Profile::inverse_square, Profile::gaussian})
      all.emplace_back(mesh::shape::name(profile), profile);
    return all;
  }();
  return table;
}

void Definition<mesh::shape::FreeEnds>::write(Json& json, const mesh::shape::FreeEnds& value) {
  using mesh::shape::FreeEnds;
  if (value == FreeEnds::weighted)
    json = "weighted";
  else
    json = value == FreeEnds::rigid;
}

Problem Definition<mesh::shape::FreeEnds>::read(const Json& json, mesh::shape::FreeEnds& value, Author author) {
  using mesh::shape::FreeEnds;
  if (json == true || json == "rigid")
    value = FreeEnds::rigid;
  else if (json == false || json == "held")
    value = FreeEnds::held;
  else if (json == "weighted")
    value = FreeEnds::weighted;
  else
    return must_be("true or false, or \"weighted\"", json, author);
  return std::nullopt;
}

void Definition<mesh::Vec3>::write(Json& json, const mesh::Vec3& value) { json = Json::array({value.x(), value.y(), value.z()}); }

Problem Definition<mesh::Vec3>::read(const Json& json, mesh::Vec3& value, Author author) {
  return read_numbers(json, std::span(value.data(), 3), author);
}

Problem Definition<mesh::Vec3>::read(const Json& json, mesh::Vec3& value, Author author, DirectionLimits) {
  if (Problem problem = read(json, value, author)) return problem;
  if (!(value.squaredNorm() > 0)) return "must be a direction, not [0, 0, 0]";
  return std::nullopt;
}

void Definition<document::NodeReference>::write(Json& json, const document::NodeReference& value) {
  std::visit([&](const auto& place) { json = place; }, value);
}

Problem Definition<document::NodeReference>::read(const Json& json, document::NodeReference& value, Author author) {
  if (json.is_array()) return json::read(json, value.emplace<std::array<double, 3>>(), author);
  if (!json::read(json, value.emplace<std::int64_t>(), author)) return std::nullopt;
  return must_be("a node's id or its coordinates [x, y, z]", json, author);
}

namespace {

/// Reads [id, number, ...] with `count` numbers behind the id.
bool read_row(const Json& json, std::size_t min_count, std::size_t max_count, std::int64_t& id) {
  if (!json.is_array() || json.size() < min_count + 1 || json.size() > max_count + 1) return false;
  return !json::read(json[0], id, Author::person) && id > 0;
}

}  // namespace

void Definition<document::VariantMesh::Node>::write(Json& json, const document::VariantMesh::Node& value) {
  json = Json::array({value.id, value.at[0], value.at[1], value.at[2]});
}

Problem Definition<document::VariantMesh::Node>::read(const Json& json, document::VariantMesh::Node& value, Author author) {
  bool sound = read_row(json, 3, 3, value.id);
  for (std::size_t k = 0; sound && k < 3; ++k) sound = !json::read(json[k + 1], value.at[k], author);
  return sound ? std::nullopt : must_be("a node [id, x, y, z]", json, author);
}

void Definition<document::VariantMesh::Shell>::write(Json& json, const document::VariantMesh::Shell& value) {
  json = Json::array({value.id, value.node[0], value.node[1], value.node[2]});
  if (value.node[3] != value.node[2]) json.push_back(value.node[3]);
}

Problem Definition<document::VariantMesh::Shell>::read(const Json& json, document::VariantMesh::Shell& value, Author author) {
  bool sound = read_row(json, 3, 4, value.id);
  for (std::size_t k = 0; sound && k < 4; ++k)
    sound = !json::read(json[std::min(k + 1, json.size() - 1)], value.node[k], author) && value.node[k] > 0;
  return sound ? std::nullopt : must_be("a shell [id, node, node, node, node]", json, author);
}

void Definition<document::Alignment>::write(Json& json, const document::Alignment& value) {
  if (value.from.empty()) {
    json = "as_it_stands";
    return;
  }
  json = Json::array();
  for (const auto* points : {&value.from, &value.to}) json::write(json.emplace_back(), *points);
}

Problem Definition<document::Alignment>::read(const Json& json, document::Alignment& value, Author author) {
  value = {};
  if (json == "as_it_stands") return std::nullopt;
  const auto is_three = [](const Json& points) { return points.is_array() && points.size() == 3; };
  if (!json.is_array() || json.size() != 2 || !is_three(json[0]) || !is_three(json[1]))
    return must_be(
        "\"as_it_stands\", or three points of the variant and three of the deck, like [[11, 12, 13], [[0, 0, 0], [90, 0, 0], 7]]", json,
        author);
  if (Problem problem = json::read(json[0], value.from, author)) return problem;
  return json::read(json[1], value.to, author);
}

void Definition<document::TargetSize>::write(Json& json, const document::TargetSize& value) {
  if (const double* length = std::get_if<double>(&value))
    json = *length;
  else
    json = std::get<document::SizeGuess>(value) == document::SizeGuess::part ? "part" : "deck";
}

Problem Definition<document::TargetSize>::read(const Json& json, document::TargetSize& value, Author author) {
  const std::string kExpected = "a length above 0, \"part\" (each part's median edge) or \"deck\" (the deck's)";
  if (json == "part" || json == "deck") {
    value = json == "part" ? document::SizeGuess::part : document::SizeGuess::deck;
    return std::nullopt;
  }
  double length = 0;
  if (json::read(json, length, author) || !(length > 0 && length <= kMaxNumber)) return must_be(kExpected, json, author);
  value = length;
  return std::nullopt;
}

void Definition<document::TargetNodes>::write(Json& json, const document::TargetNodes& value) {
  std::visit(
      [&]<class Each>(const Each& each) {
        if constexpr (std::is_same_v<Each, std::string>)
          json = each;
        else
          json = document::edit_to_json(each);
      },
      value);
}

Problem Definition<document::TargetNodes>::read(const Json& json, document::TargetNodes& value, Author author) {
  if (json.is_string()) return json::read(json, value.emplace<std::string>(), author);
  if (!json.is_object()) return must_be("an expression in quotes or a recipe like {\"edit\": \"select_region\", ...}", json, author);
  // Checked before the recipe is read, so that recipes can't nest and no input can exhaust the stack.
  const Result<document::Edit> blank = document::blank_edit(json);
  if (!blank) return "has a wrong recipe: " + blank.error().message;
  const bool selects = std::holds_alternative<document::Select>(*blank) || std::holds_alternative<document::SelectRegion>(*blank) ||
                       std::holds_alternative<document::SelectLasso>(*blank) || std::holds_alternative<document::SelectFlange>(*blank);
  if (!selects)
    return "must be a recipe that selects: select, select_region, select_lasso or select_flange, not " +
           std::string(document::name(*blank));
  Result<document::Edit> recipe = document::edit_from_json(json);
  if (!recipe) return "has a wrong recipe: " + recipe.error().message;
  if (auto* select = std::get_if<document::Select>(&*recipe)) value = std::move(*select);
  if (auto* region = std::get_if<document::SelectRegion>(&*recipe)) value = *region;
  if (auto* lasso = std::get_if<document::SelectLasso>(&*recipe)) value = std::move(*lasso);
  if (auto* flange = std::get_if<document::SelectFlange>(&*recipe)) value = std::move(*flange);
  return std::nullopt;
}

void Definition<document::Edit>::write(Json& json, const document::Edit& value) { json = document::edit_to_json(value); }

Problem Definition<document::Edit>::read(const Json& json, document::Edit& value, Author) {
  Result<document::Edit> edit = document::edit_from_json(json);
  if (!edit) return "can't be used: " + edit.error().text();
  value = std::move(*edit);
  return std::nullopt;
}

}  // namespace prismesh::json
