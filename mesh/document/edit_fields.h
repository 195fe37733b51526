// The fields of each edit, named once: reading and writing JSON both walk these lists. Private to mesh/document.
#pragma once

#include "mesh/document/edit.h"

namespace prismesh::mesh::document {

// A visitor has required(name, value), optional(name, value), direction(name, vector) and nested(name, object).
// Numbers carry their limits as a Limit argument, so that the error can name them.
struct Limit {
  double low;
  double high;
  bool low_open = false;  ///< low itself is refused
};

inline constexpr double kMax = 1e300;  ///< coordinates: finite, with room for arithmetic
inline constexpr Limit kAnyLength{-kMax, kMax};
inline constexpr Limit kTurns{-36000, 36000};  ///< degrees: a hundred turns either way

template <class Visitor>
void fields(Visitor& v, auto& edit, const Select*) {
  v.required("expr", edit.expr);
  v.optional("kind", edit.kind);
  v.optional("mode", edit.mode);
}
template <class Visitor>
void fields(Visitor& v, auto& edit, const SelectRegion*) {
  v.required("at", edit.at);
  v.optional("angle", edit.angle, Limit{0, 180});
  v.optional("by", edit.by);
  v.optional("across_welds", edit.across_welds);
  v.optional("mode", edit.mode);
}
template <class Visitor>
void fields(Visitor& v, auto& edit, const SelectLasso*) {
  v.required("outline", edit.outline);
  v.required("view", edit.view);
  v.optional("visible", edit.visible);
  v.optional("mode", edit.mode);
}
template <class Visitor>
void fields(Visitor& v, auto& edit, const Grow*) {
  v.optional("rings", edit.rings);
}
template <class Visitor>
void fields(Visitor& v, auto& edit, const Shrink*) {
  v.optional("rings", edit.rings);
}
template <class Visitor>
void fields(Visitor&, auto&, const Invert*) {}
template <class Visitor>
void fields(Visitor&, auto&, const Undo*) {}
template <class Visitor>
void fields(Visitor&, auto&, const Redo*) {}
template <class Visitor>
void fields(Visitor& v, auto& edit, const SetParts*) {
  v.optional("on", edit.on);
}
template <class Visitor>
void fields(Visitor& v, auto& falloff, const shape::Falloff*) {
  v.optional("profile", falloff.profile);
  v.optional("flat", falloff.flat, Limit{0, 1});
  v.optional("along", falloff.along);
}
template <class Visitor>
void fields(Visitor& v, auto& shaping, const Shaping*) {
  v.optional("on", shaping.on);
  v.optional("grab", shaping.grab);
  v.optional("grab_at", shaping.grab_at);
  v.nested("falloff", shaping.weights.falloff);
  v.optional("free_ends", shaping.weights.free_ends);
  v.optional("origin", shaping.weights.origin);
  v.optional("across_welds", shaping.weights.across_welds);
  v.nested("symmetry", shaping.symmetry);
  v.optional("max_move", shaping.max_move, Limit{0, kMax, true});
}
template <class Visitor>
void fields(Visitor& v, auto& edit, const Translate*) {
  v.required("by", edit.by);
  fields(v, edit.shaping, static_cast<const Shaping*>(nullptr));
}
template <class Visitor>
void fields(Visitor& v, auto& symmetry, const Symmetry*) {
  v.required("point", symmetry.point);
  v.direction("normal", symmetry.normal);
}
template <class Visitor>
void fields(Visitor& v, auto& edit, const Slide*) {
  v.required("by", edit.by);
  fields(v, edit.shaping, static_cast<const Shaping*>(nullptr));
}
template <class Visitor>
void fields(Visitor& v, auto& edit, const Rotate*) {
  v.required("point", edit.point);
  v.direction("axis", edit.axis);
  v.required("degrees", edit.degrees, kTurns);
  fields(v, edit.shaping, static_cast<const Shaping*>(nullptr));
}
template <class Visitor>
void fields(Visitor& v, auto& edit, const Lift*) {
  v.required("distance", edit.distance, kAnyLength);
  v.normals("normals", edit.each_normal);
  fields(v, edit.shaping, static_cast<const Shaping*>(nullptr));
}

template <class Visitor>
void fields(Visitor& v, auto& limits, const MoveLimits*) {
  v.optional("free", limits.free, Limit{0, kMax, true});
  v.optional("line", limits.line, Limit{0, kMax});
}
template <class Visitor>
void fields(Visitor& v, auto& edit, const Relax*) {
  v.optional("mode", edit.mode);
  v.optional("at", edit.at);
  v.optional("threshold", edit.threshold, Limit{0, kMax, true});
  v.optional("scope", edit.scope);
  v.optional("angle", edit.angle, Limit{0, 180});
  v.nested("max_move", edit.max_move);
}
template <class Visitor>
void fields(Visitor& v, auto& edit, const Repair*) {
  v.optional("scope", edit.scope);
  v.optional("angle", edit.angle, Limit{0, 180});
  v.nested("max_move", edit.max_move);
}
template <class Visitor>
void fields(Visitor& v, auto& edit, const Restructure*) {
  v.required("at", edit.at);
}

}  // namespace prismesh::mesh::document
