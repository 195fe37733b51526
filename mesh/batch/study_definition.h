// The JSON definitions of a study and of the result of a variant. Heavy; private to mesh/batch.
#pragma once

#include "base/json/read.h"
#include "base/json/write.h"
#include "mesh/batch/result.h"
#include "mesh/batch/study.h"

namespace prismesh::json {

template <>
struct Definition<std::filesystem::path> {
  static void write(Json& json, const std::filesystem::path& path) { json = path.string(); }
  static Problem read(const Json& json, std::filesystem::path& path, Author author) {
    std::string text;
    if (Problem problem = json::read(json, text, author)) return problem;
    path = text;
    return std::nullopt;
  }
};

template <>
struct Definition<mesh::batch::ParameterValue> {
  static void write(Json& json, const mesh::batch::ParameterValue& value) {
    std::visit([&](const auto& either) { json = either; }, value);
  }
  static Problem read(const Json& json, mesh::batch::ParameterValue& value, Author author) {
    if (json.is_number()) return value = json.get<double>(), std::nullopt;
    if (json.is_string()) return value = json.get<std::string>(), std::nullopt;
    return must_be("a number or a text", json, author);
  }
};

PRISMESH_JSON_OBJECT(mesh::batch::FrozenDeck, f.required("path", m.path), f.required("hash", m.hash), f("settings", m.settings));
PRISMESH_JSON_OBJECT(mesh::batch::Script, f.required("file", m.file), f.required("text", m.text));
PRISMESH_JSON_OBJECT(mesh::batch::Study, f.required("plan_file", m.plan_file), f.required("plan", m.plan_text),
                     f.required("decks", m.decks), f.required("scripts", m.scripts), f("criteria", m.criteria));

PRISMESH_JSON_NAMES(mesh::batch::Outcome, {{"done", mesh::batch::Outcome::done}, {"refused", mesh::batch::Outcome::refused}});
PRISMESH_JSON_OBJECT(mesh::batch::NamedValue, f.required("name", m.name), f.required("value", m.value));
PRISMESH_JSON_OBJECT(mesh::batch::Measured, f("shells", m.shells), f("warn", m.warn), f("fail", m.fail),
                     f("triangles_percent", m.triangles_percent), f("composite_min", m.composite_min),
                     f("composite_mean", m.composite_mean), f("mass", m.mass), f("time_step", m.time_step),
                     f("perforations", m.perforations), f("penetrations", m.penetrations), f("depth", m.depth));
PRISMESH_JSON_OBJECT(mesh::batch::VariantResult, f.required("key", m.key), f.required("outcome", m.outcome), f("reason", m.reason),
                     f("version", m.version), f("deck", m.deck), f("script", m.script), f("values", m.values), f("before", m.before),
                     f("after", m.after), f("nodes_moved", m.nodes_moved), f("max_displacement", m.max_displacement),
                     f("elements_added", m.elements_added), f("elements_removed", m.elements_removed), f("lines_changed", m.lines_changed),
                     f("written", m.written), f("picture", m.picture), f("notes", m.notes), f("seconds", m.seconds),
                     f("peak_mb", m.peak_mb), f("length_unit", m.length_unit));
PRISMESH_JSON_OBJECT(mesh::batch::Failure, f.required("key", m.key), f.required("reason", m.reason), f("seconds", m.seconds));

}  // namespace prismesh::json
