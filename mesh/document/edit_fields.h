// The JSON definitions of edits: the fields of each, named once for reading and writing. For sources that turn edits, or messages that
// hold edits, into JSON and back.
#pragma once

#include "base/json/read.h"
#include "base/json/write.h"
#include "mesh/document/edit.h"
#include "mesh/document/judging.h"

namespace prismesh::json {

// --- enumerations ---

PRISMESH_JSON_NAMES(mesh::select::EntityKind, {{"node", mesh::select::EntityKind::node},
                                               {"element", mesh::select::EntityKind::element},
                                               {"part", mesh::select::EntityKind::part}});
PRISMESH_JSON_NAMES(mesh::document::SelectMode, {{"set", mesh::document::SelectMode::set},
                                                 {"add", mesh::document::SelectMode::add},
                                                 {"subtract", mesh::document::SelectMode::subtract},
                                                 {"intersect", mesh::document::SelectMode::intersect}});
PRISMESH_JSON_NAMES(mesh::document::RegionBy, {{"features", mesh::document::RegionBy::features},
                                               {"creases", mesh::document::RegionBy::creases},
                                               {"part", mesh::document::RegionBy::part},
                                               {"piece", mesh::document::RegionBy::piece},
                                               {"free_edge", mesh::document::RegionBy::free_edge}});
PRISMESH_JSON_NAMES(mesh::document::Scope, {{"selection", mesh::document::Scope::selection},
                                            {"part", mesh::document::Scope::part},
                                            {"all", mesh::document::Scope::all},
                                            {"damaged", mesh::document::Scope::damaged},
                                            {"failed", mesh::document::Scope::failed}});
PRISMESH_JSON_NAMES(mesh::document::OnCancel, {{"discard", mesh::document::OnCancel::discard}, {"keep", mesh::document::OnCancel::keep}});
PRISMESH_JSON_NAMES(mesh::document::ContactRule, {{"allow", mesh::document::ContactRule::allow},
                                                  {"refuse", mesh::document::ContactRule::refuse},
                                                  {"keep_apart", mesh::document::ContactRule::keep_apart}});
PRISMESH_JSON_NAMES(mesh::document::ContactKind,
                    {{"perforation", mesh::document::ContactKind::perforation}, {"penetration", mesh::document::ContactKind::penetration}});
PRISMESH_JSON_NAMES(mesh::contact::MovingSide, {{"both", mesh::contact::MovingSide::both},
                                                {"on", mesh::contact::MovingSide::on},
                                                {"against", mesh::contact::MovingSide::against}});
PRISMESH_JSON_NAMES(mesh::document::FollowUp, {{"none", mesh::document::FollowUp::none},
                                               {"relax", mesh::document::FollowUp::relax},
                                               {"repair", mesh::document::FollowUp::repair}});
PRISMESH_JSON_NAMES(mesh::document::RelaxMode, {{"full", mesh::document::RelaxMode::full}, {"from", mesh::document::RelaxMode::from}});
PRISMESH_JSON_NAMES(mesh::quality::SizeFrom, {{name(mesh::quality::SizeFrom::part), mesh::quality::SizeFrom::part},
                                              {name(mesh::quality::SizeFrom::deck), mesh::quality::SizeFrom::deck},
                                              {name(mesh::quality::SizeFrom::given), mesh::quality::SizeFrom::given}});
PRISMESH_JSON_NAMES(mesh::shape::Origin, {{"grab", mesh::shape::Origin::grab}, {"free_edge", mesh::shape::Origin::free_edge}});
/// true (rigid), false (held) or "weighted".
template <>
struct Definition<mesh::shape::FreeEnds> {
  static void write(Json& json, const mesh::shape::FreeEnds& value);
  static Problem read(const Json& json, mesh::shape::FreeEnds& value, Author author);
};
template <>
struct Definition<mesh::shape::Profile> {
  static const Names<mesh::shape::Profile>& names();
};

// --- values ---

/// The limit of a vector that must not be zero.
struct DirectionLimits {};

template <>
struct Definition<mesh::Vec3> {
  static void write(Json& json, const mesh::Vec3& value);
  static Problem read(const Json& json, mesh::Vec3& value, Author author);
  static Problem read(const Json& json, mesh::Vec3& value, Author author, DirectionLimits);
};
template <>
struct Definition<mesh::document::NodeReference> {
  static void write(Json& json, const mesh::document::NodeReference& value);
  static Problem read(const Json& json, mesh::document::NodeReference& value, Author author);
};
template <>
struct Definition<mesh::document::TargetNodes> {
  static void write(Json& json, const mesh::document::TargetNodes& value);
  static Problem read(const Json& json, mesh::document::TargetNodes& value, Author author);
};
template <>
struct Definition<mesh::document::TargetSize> {
  static void write(Json& json, const mesh::document::TargetSize& value);
  static Problem read(const Json& json, mesh::document::TargetSize& value, Author author);
};
template <>
struct Definition<mesh::document::VariantMesh::Node> {
  static void write(Json& json, const mesh::document::VariantMesh::Node& value);
  static Problem read(const Json& json, mesh::document::VariantMesh::Node& value, Author author);
};
template <>
struct Definition<mesh::document::VariantMesh::Shell> {
  static void write(Json& json, const mesh::document::VariantMesh::Shell& value);
  static Problem read(const Json& json, mesh::document::VariantMesh::Shell& value, Author author);
};
/// "as_it_stands" or [[3 points], [3 points]].
template <>
struct Definition<mesh::document::Alignment> {
  static void write(Json& json, const mesh::document::Alignment& value);
  static Problem read(const Json& json, mesh::document::Alignment& value, Author author);
};
/// An edit within another object. edit_from_json reads one that stands by itself.
template <>
struct Definition<mesh::document::Edit> {
  static void write(Json& json, const mesh::document::Edit& value);
  static Problem read(const Json& json, mesh::document::Edit& value, Author author);
};

// --- parts of edits ---

inline constexpr NumberLimits kPositive{0, kMaxNumber, true};
inline constexpr NumberLimits kNotNegative{0, kMaxNumber};
inline constexpr NumberLimits kEdgeAngles{0, 180};
inline constexpr NumberLimits kTurns{-36000, 36000};  ///< degrees: a hundred turns either way
inline constexpr WholeNumberLimits kRings{1, 1'000'000};
inline constexpr WholeNumberLimits kAttempts{1, 1000};  ///< of a repair, over its passes
inline constexpr ListLimits kSteps{1, 1'000'000, "whole numbers like [532, 0]", ""};
inline constexpr ListLimits kOutline{3, 100'000, "points [x, y]", "point"};
inline constexpr ListLimits kEntities{1, 1000, "entities like [\"shell:12\", \"shell:40\"]", ""};
inline constexpr ListLimits kLinePoints{2, 100'000, "points [x, y, z]", "point"};
inline constexpr ListLimits kWeldPoints{1, 1'000'000, "points [x, y, z]", "point"};
inline constexpr ListLimits kWelds{1, 100'000, "welds like [\"beam:9\", \"spring:4\"]", ""};
inline constexpr WholeNumberLimits kSheetsOfWeld{2, 6};
inline constexpr WholeNumberLimits kPartIds{1, 1'000'000'000'000'000'000};
inline constexpr ListLimits kVariantNodes{3, 100'000'000, "nodes [id, x, y, z]", "node"};
inline constexpr ListLimits kVariantShells{1, 100'000'000, "shells [id, node, node, node, node]", "shell"};
inline constexpr ListLimits kContactKinds{1, 2, "kinds of contact like [\"perforation\", \"penetration\"]", ""};
inline constexpr TwoWords kBondedSurfaces{"faces", "middles",
                                          "\"faces\" (of the sheets, by their thickness) or \"middles\" (their middle surfaces)"};
inline constexpr TwoWords kNormals{"grab", "each", "\"grab\" (all nodes along the normal at the grab) or \"each\""};

template <>
struct Definition<mesh::shape::Falloff> {
  static constexpr std::string_view kExample = R"({"profile": "smooth"})";
  static void fields(auto& m, auto& f) {
    f("profile", m.profile);
    f("flat", m.flat, NumberLimits{0, 1});
    f("along", m.along, DirectionLimits{});
  }
};
template <>
struct Definition<mesh::document::Symmetry> {
  static constexpr std::string_view kExample = R"({"point": [0, 0, 0], "normal": [0, 1, 0]})";
  static void fields(auto& m, auto& f) {
    f.required("point", m.point);
    f.required("normal", m.normal, DirectionLimits{});
  }
};
template <>
struct Definition<mesh::document::MoveLimits> {
  static constexpr std::string_view kExample = R"({"free": 2, "line": 0.5})";
  static bool is_absent(const mesh::document::MoveLimits& m) { return !m.free && !m.line; }
  static void fields(auto& m, auto& f) {
    f("free", m.free, kPositive);
    f("line", m.line, kNotNegative);
  }
};
template <>
struct Definition<mesh::document::StopPoint> {
  static constexpr std::string_view kExample = R"({"attempt": 1, "steps": [532]})";
  static void fields(auto& m, auto& f) {
    f.required("attempt", m.attempt, kAttempts);
    f.required("steps", m.steps, kSteps);
  }
};
PRISMESH_JSON_OBJECT(mesh::document::Shaping, f("on", m.on), f("grab", m.grab), f("grab_at", m.grab_at), f("falloff", m.weights.falloff),
                     f("free_ends", m.weights.free_ends), f("origin", m.weights.origin), f("origin_at", m.origin_at),
                     f("across_welds", m.weights.across_welds), f("symmetry", m.symmetry), f("max_move", m.max_move, kPositive),
                     f("contact", m.contact));

// --- edits; the field "edit" tells which it is ---

PRISMESH_JSON_OBJECT(mesh::document::Select, f.required("expr", m.expr), f("kind", m.kind), f("mode", m.mode));
PRISMESH_JSON_OBJECT(mesh::document::SelectRegion, f.required("at", m.at), f("angle", m.angle, kEdgeAngles), f("by", m.by),
                     f("across_welds", m.across_welds), f("mode", m.mode));
PRISMESH_JSON_OBJECT(mesh::document::SelectLasso, f.required("outline", m.outline, kOutline), f.required("view", m.view),
                     f("visible", m.visible), f("mode", m.mode));
PRISMESH_JSON_OBJECT(mesh::document::SelectFlange, f("at", m.at), f("between", m.between), f("gap", m.gap, kNotNegative),
                     f("max_width", m.max_width, kPositive), f("mode", m.mode));
PRISMESH_JSON_OBJECT(mesh::document::Grow, f("rings", m.rings, kRings));
PRISMESH_JSON_OBJECT(mesh::document::Shrink, f("rings", m.rings, kRings));
PRISMESH_JSON_OBJECT(mesh::document::Invert, );
PRISMESH_JSON_OBJECT(mesh::document::SetParts, f("on", m.on));
PRISMESH_JSON_OBJECT(mesh::document::SetTargetSize, f.required("size", m.size), f("on", m.on));
PRISMESH_JSON_OBJECT(mesh::document::SetCriteria, f.required("criteria", m.criteria), f("text", m.text), f("on", m.on));
PRISMESH_JSON_OBJECT(mesh::document::Translate, f.required("by", m.by), Definition<mesh::document::Shaping>::fields(m.shaping, f));
PRISMESH_JSON_OBJECT(mesh::document::Lift, f.required("distance", m.distance), f("normals", m.each_normal, kNormals),
                     Definition<mesh::document::Shaping>::fields(m.shaping, f));
PRISMESH_JSON_OBJECT(mesh::document::Slide, f.required("by", m.by), Definition<mesh::document::Shaping>::fields(m.shaping, f));
PRISMESH_JSON_OBJECT(mesh::document::Rotate, f.required("point", m.point), f.required("axis", m.axis, DirectionLimits{}),
                     f.required("degrees", m.degrees, kTurns), Definition<mesh::document::Shaping>::fields(m.shaping, f));
PRISMESH_JSON_OBJECT(mesh::document::Move, f("by", m.by), f("point", m.point), f("axis", m.axis, DirectionLimits{}),
                     f("degrees", m.degrees, kTurns), Definition<mesh::document::Shaping>::fields(m.shaping, f));
PRISMESH_JSON_OBJECT(mesh::document::Relax, f("mode", m.mode), f("at", m.at), f("threshold", m.threshold, kPositive), f("scope", m.scope),
                     f("angle", m.angle, kEdgeAngles), f("max_move", m.max_move), f("contact", m.contact));
PRISMESH_JSON_OBJECT(mesh::document::Repair, f("scope", m.scope), f("angle", m.angle, kEdgeAngles), f("max_move", m.max_move),
                     f("on_cancel", m.on_cancel), f("stop_at", m.stop_at), f("contact", m.contact));
PRISMESH_JSON_OBJECT(mesh::document::Restructure, f.required("at", m.at, kEntities));
PRISMESH_JSON_OBJECT(mesh::document::Separate, f("on", m.on), f("against", m.against), f("at", m.at), f("kinds", m.kinds, kContactKinds),
                     f("joined", m.joined), f("gap", m.gap, kNotNegative), f("move", m.move),
                     f("direction", m.direction, DirectionLimits{}), f("max_move", m.max_move, kPositive),
                     f("allowed_depth", m.allowed_depth, kNotNegative), f("follow", m.follow));
PRISMESH_JSON_OBJECT(mesh::document::Weld, f("flange", m.flange), f("along", m.along, kLinePoints), f("points", m.points, kWeldPoints),
                     f("points_file", m.points_file), f("pitch", m.pitch, kPositive), f("end_distance", m.end_distance, kNotNegative),
                     f("edge_distance", m.edge_distance, kNotNegative), f("sheets", m.sheets, kSheetsOfWeld), f("parts", m.parts),
                     f("gap", m.gap, kNotNegative), f("like", m.like), f("diameter", m.diameter, kPositive),
                     f("density", m.density, kPositive), f("youngs_modulus", m.youngs_modulus, kPositive),
                     f("poissons_ratio", m.poissons_ratio, NumberLimits{0, 0.5}), f("yield_stress", m.yield_stress, kPositive),
                     f("as", m.as));
PRISMESH_JSON_OBJECT(mesh::document::Bond, f.required("flange", m.flange), f.required("width", m.width, kPositive),
                     f.required("length", m.length, kPositive), f("end_distance", m.end_distance, kNotNegative),
                     f("from", m.from_middles, kBondedSurfaces), f("like", m.like), f("density", m.density, kPositive),
                     f("youngs_modulus", m.youngs_modulus, kPositive), f("poissons_ratio", m.poissons_ratio, NumberLimits{0, 0.5}));
PRISMESH_JSON_OBJECT(mesh::document::RepairWelds, f("at", m.at, kWelds), f("gap", m.gap, kNotNegative),
                     f("max_move", m.max_move, kPositive));
PRISMESH_JSON_OBJECT(mesh::document::VariantMesh, f.required("nodes", m.nodes, kVariantNodes),
                     f.required("shells", m.shells, kVariantShells), f("thickness", m.thickness, kPositive));
PRISMESH_JSON_OBJECT(mesh::document::ReplacePart, f.required("part", m.part, kPartIds), f.required("deck", m.deck),
                     f("with", m.with, kPartIds), f("align", m.align), f("units", m.units), f("tolerance", m.tolerance, kPositive),
                     f("mesh", m.mesh));
PRISMESH_JSON_OBJECT(mesh::document::Undo, );
PRISMESH_JSON_OBJECT(mesh::document::Redo, );
PRISMESH_JSON_OBJECT(mesh::document::TakeBranch, f.required("number", m.number));

}  // namespace prismesh::json
