// An edit is data: what to do, on what, from where. One definition for kiosk, pen, command line, scripts and tests. The list of kinds is
// in edit_kinds.h, the JSON form in edit_json.h.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/repair/operation.h"
#include "mesh/select/expression.h"
#include "mesh/shape/weights.h"

namespace prismesh::mesh::document {

enum class SelectMode : std::uint8_t { set, add, subtract, intersect };

/// A node by id, or by coordinates (the nearest node): coordinates survive a remeshed variant.
using Place = std::variant<std::int64_t, std::array<double, 3>>;

struct Select {
  std::string expr;
  select::EntityKind kind = select::EntityKind::node;
  SelectMode mode = SelectMode::set;
};
/// What bounds a region: feature edges (sharper than `angle`, free edges, junctions); the part at the place; everything connected by
/// shared edges; or the loop of free edges nearest to the place, whose nodes it selects.
enum class RegionBy : std::uint8_t { features, part, piece, free_edge };
struct SelectRegion {
  Place at;
  double angle = 30;  ///< degrees
  RegionBy by = RegionBy::features;
  bool across_welds = false;  ///< goes on over sheets that are welded to those it has reached
  SelectMode mode = SelectMode::set;
};
struct SelectLasso {
  std::vector<std::array<double, 2>> outline;  ///< normalised device coordinates
  std::array<double, 16> view{};               ///< deck coordinates to clip space, column-major
  bool visible = false;                        ///< only nodes that no shell in sight hides from this view
  SelectMode mode = SelectMode::set;
};
struct Grow {
  int rings = 1;
};
struct Shrink {
  int rings = 1;
};
struct Invert {};

enum class VisibilityAction : std::uint8_t { hide, show, only, reverse, lock, unlock };
/// Parts named by `on` (an expression of kind part); without it, the parts of the selection; show and unlock with nothing
/// selected: all parts. `reverse` shows what is hidden and hides the rest, of the parts named or of all.
struct SetParts {
  VisibilityAction action = VisibilityAction::hide;
  std::optional<std::string> on;
};

/// What an edit acts on: an expression of kind node, or a recipe, worked out on the model as it is when the edit is applied; its
/// mode is ignored. A recipe of a region by coordinates means the same place on a remeshed variant.
using Where = std::variant<std::string, Select, SelectRegion, SelectLasso>;

/// The same edit mirrored: on the images of the nodes acted on, with the images of the displacements. A node on the plane stays on it.
struct Symmetry {
  Vec3 point = Vec3::Zero();    ///< on the plane, deck coordinates
  Vec3 normal = Vec3::UnitX();  ///< of any length but zero
};

/// What a shaping edit acts on and how it fades out.
struct Shaping {
  std::optional<Where> on;    ///< without it the selection
  std::optional<Place> grab;  ///< coordinates: the nearest node of those acted on; absent: the node farthest from the border
  std::optional<std::array<double, 3>> grab_at;  ///< where the node `grab` was: used where no such node is acted on (a variant)
  shape::WeightOptions weights;
  std::optional<Symmetry> symmetry;
  std::optional<double> max_move;  ///< no node moves farther; deck's length unit
};
struct Translate {
  Vec3 by = Vec3::Zero();
  Shaping shaping;
};
struct Lift {
  double distance = 0;
  bool each_normal = false;  ///< "normals": "each": every node along its own normal
  Shaping shaping;
};
/// On the surface: nodes walk their share of `by` over the faces as they were; `by` is meant at the grab and turns with the sheet.
struct Slide {
  Vec3 by = Vec3::Zero();
  Shaping shaping;
};
/// About an axis: every node by its weight's share of the angle, on a circle.
struct Rotate {
  Vec3 point = Vec3::Zero();  ///< on the axis, deck coordinates
  Vec3 axis = Vec3::UnitZ();  ///< of any length but zero
  double degrees = 0;         ///< right-handed
  Shaping shaping;
};
/// How far a shaping edit goes; each kind reads its own.
struct Displacement {
  Vec3 by = Vec3::Zero();  ///< translate, slide
  double distance = 0;     ///< lift
  double degrees = 0;      ///< rotate
};

/// Which shells relaxing and repairing look at.
enum class Scope : std::uint8_t {
  selection,  ///< relax: the selected nodes; repair: the shells at them
  part,       ///< the parts of the selection
  all,
  damaged,  ///< what this document's edits made worse (damage.h)
  failed,   ///< whatever fails
};
enum class RelaxMode : std::uint8_t { full, from };
/// How far nodes may go, by what they are on; deck's length unit. Absent: as far as it takes.
struct MoveLimits {
  std::optional<double> free;  ///< inside a sheet
  std::optional<double> line;  ///< on a feature line
};
/// Nodes find better places on the surface they are on.
struct Relax {
  RelaxMode mode = RelaxMode::full;
  std::optional<Place> at;          ///< mode from: where it begins
  std::optional<double> threshold;  ///< mode from: neighbours join while a node is displaced farther; absent: 0.15 of the target size
  Scope scope = Scope::selection;
  double angle = 30;  ///< degrees; sharper edges are features
  MoveLimits max_move;
};
/// Local changes to the structure until what is bad is valid or nothing gets better.
struct Repair {
  Scope scope = Scope::damaged;
  double angle = 30;
  MoveLimits max_move;
};
/// One operation by hand, on shells ("shell:12") or the edge between two nodes ("node:7").
struct Restructure {
  repair::Operation operation = repair::Operation::split;
  std::vector<std::string> at;
};

struct Undo {};
struct Redo {};

using Edit = std::variant<Select, SelectRegion, SelectLasso, Grow, Shrink, Invert, SetParts, Translate, Lift, Slide, Rotate, Relax, Repair,
                          Restructure, Undo, Redo>;

/// What a shaping edit says of where and how; null for the others.
const Shaping* shaping_of(const Edit& edit);
Shaping* shaping_of(Edit& edit);
/// How far it goes; zero for the others. And the same edit going otherwise.
Displacement displacement_of(const Edit& edit);
void set_displacement(Edit& edit, const Displacement& displacement);

}  // namespace prismesh::mesh::document
