// The edits, as data. One definition for kiosk, command line, scripts and tests. The list of kinds is in edit_kinds.h, the JSON form in
// edit_json.h.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "mesh/contact/separation.h"
#include "mesh/document/judging.h"
#include "mesh/model/model.h"
#include "mesh/repair/operation.h"
#include "mesh/select/expression.h"
#include "mesh/shape/weights.h"

namespace prismesh::mesh::document {

enum class SelectMode : std::uint8_t { set, add, subtract, intersect };

/// A node by id, or by coordinates (the nearest node). Coordinates also hold for a remeshed variant of the deck.
using NodeReference = std::variant<std::int64_t, std::array<double, 3>>;

struct Select {
  std::string expr;
  select::EntityKind kind = select::EntityKind::node;
  SelectMode mode = SelectMode::set;
};
/// What bounds a region: features (creases and fillets that bend by more than `angle`, free edges, junctions); the same with single edges
/// only, without fillets; the part at the place; everything connected by shared edges; or the loop of free edges nearest to the place,
/// whose nodes it selects.
enum class RegionBy : std::uint8_t { features, creases, part, piece, free_edge };
struct SelectRegion {
  NodeReference at;
  double angle = 30;  ///< degrees
  RegionBy by = RegionBy::features;
  bool across_welds = false;  ///< continues on sheets that are welded to those reached
  SelectMode mode = SelectMode::set;
};
struct SelectLasso {
  std::vector<std::array<double, 2>> outline;  ///< normalised device coordinates
  std::array<double, 16> view{};               ///< deck coordinates to clip space, column-major
  bool visible = false;                        ///< only nodes that no visible part's shell hides in this view
  SelectMode mode = SelectMode::set;
};
/// The flange at a place, all its sheets; or the flanges of which at least two sheets are of the parts that `between` names (an expression
/// of kind part). One of the two is given. Lengths are in the deck's unit.
struct SelectFlange {
  std::optional<NodeReference> at;
  std::optional<std::string> between;
  double gap = 0;                   ///< sheets may be farther apart by this
  std::optional<double> max_width;  ///< absent: 40 times the thickness
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
/// Acts on the parts named by `on` (an expression of kind part), without it on the parts of the selection; show and unlock with nothing
/// selected act on all parts. `reverse` shows hidden parts and hides visible ones, among those named or all.
struct SetParts {
  VisibilityAction action = VisibilityAction::hide;
  std::optional<std::string> on;
};

/// Sets the target size that shells are judged by, of the parts named by `on` (an expression of kind part), without it of the parts of the
/// selection, with nothing selected of all.
struct SetTargetSize {
  TargetSize size = SizeGuess::part;
  std::optional<std::string> on;
};

/// Sets the criteria that shells are judged by, of the same parts.
struct SetCriteria {
  std::string criteria;  ///< built-in criteria, a file (a path relative to the deck's folder), or kDeckCriteria
  /// The file's content; without it the file is read. The journal has it, so that a replay doesn't depend on the file.
  std::optional<std::string> text;
  std::optional<std::string> on;
};
/// The word for which parts have no criteria of their own any more, but the deck's.
inline constexpr std::string_view kDeckCriteria = "deck";

/// The nodes that an edit acts on: an expression of kind node, or a recipe that selects, evaluated when the edit is applied; its mode is
/// ignored. A recipe of a region by coordinates finds the same region on a remeshed variant.
using TargetNodes = std::variant<std::string, Select, SelectRegion, SelectLasso, SelectFlange>;

/// Applies the edit mirrored as well: to the images of the nodes acted on, with mirrored displacements. A node on the plane stays on it.
struct Symmetry {
  Vec3 point = Vec3::Zero();    ///< on the plane, deck coordinates
  Vec3 normal = Vec3::UnitX();  ///< of any length but zero
};

/// What an edit that moves shells does where they would cross or come too close that didn't, or come closer (docs/contact.md).
enum class ContactRule : std::uint8_t {
  allow,      ///< it isn't looked for
  refuse,     ///< the edit is refused
  keep_apart  ///< a shaping edit goes a smaller share of its way; relaxing and repairing leave the nodes where they were
};

/// What a shaping edit acts on, and how its effect falls off.
struct Shaping {
  std::optional<TargetNodes> on;      ///< without it the selection
  std::optional<NodeReference> grab;  ///< coordinates: the nearest node of those acted on; absent: the node farthest from the border
  std::optional<std::array<double, 3>> grab_at;  ///< where the node `grab` was: used where no such node is acted on (a variant)
  shape::WeightOptions weights;
  std::optional<NodeReference> origin_at;  ///< origin free_edge: on this edge, or the edge nearest to it
  std::optional<Symmetry> symmetry;
  std::optional<double> max_move;  ///< of each node; deck's length unit
  std::optional<ContactRule> contact;
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
/// Moves nodes on the surface: each goes its share of `by` over the faces as they were. `by` holds at the grab and turns with the sheet.
struct Slide {
  Vec3 by = Vec3::Zero();
  Shaping shaping;
};
/// Rotates about an axis: every node on a circle by its weight's share of the angle.
struct Rotate {
  Vec3 point = Vec3::Zero();  ///< on the axis, deck coordinates
  Vec3 axis = Vec3::UnitZ();  ///< of any length but zero
  double degrees = 0;         ///< right-handed
  Shaping shaping;
};
/// A rigid motion, as a hand makes it with a pen: every node is turned about the axis by its weight's share of the angle, then moved by its
/// share of `by`.
struct Move {
  Vec3 by = Vec3::Zero();
  Vec3 point = Vec3::Zero();  ///< on the axis, deck coordinates
  Vec3 axis = Vec3::UnitZ();  ///< of any length but zero
  double degrees = 0;         ///< right-handed
  Shaping shaping;
};
/// The displacement of a shaping edit; each kind uses its own fields.
struct Displacement {
  Vec3 by = Vec3::Zero();  ///< translate, slide, move
  double distance = 0;     ///< lift
  double degrees = 0;      ///< rotate, move
};

/// Which shells are relaxed or repaired.
enum class Scope : std::uint8_t {
  selection,  ///< relax: the selected nodes; repair: the shells at them
  part,       ///< the parts of the selection
  all,
  damaged,  ///< shells that this document's edits made worse (damage.h)
  failed,   ///< shells that fail
};
enum class RelaxMode : std::uint8_t { full, from };
/// Max distances that nodes may move; deck's length unit. Absent: no limit.
struct MoveLimits {
  std::optional<double> free;  ///< inside a sheet
  std::optional<double> line;  ///< on a feature line
};
/// Moves nodes along their surface to improve the elements.
struct Relax {
  RelaxMode mode = RelaxMode::full;
  std::optional<NodeReference> at;  ///< mode from: the first node
  std::optional<double> threshold;  ///< mode from: a node that moves farther adds its neighbours; absent: 0.15 of the target size
  Scope scope = Scope::selection;
  double angle = 30;  ///< degrees; sharper edges are features
  MoveLimits max_move;
  std::optional<ContactRule> contact;
};
/// What becomes of what an edit has reached when it is cancelled.
enum class OnCancel : std::uint8_t { discard, keep };
/// Where a repair was stopped and kept. Replayed with it, the repair ends there again.
struct StopPoint {
  int attempt = 1;                   ///< to find changes that can be written
  std::vector<std::uint64_t> steps;  ///< of this attempt: repair::StoppedAt
};
/// Changes the structure locally until the bad shells are valid or nothing improves.
struct Repair {
  Scope scope = Scope::damaged;
  double angle = 30;
  MoveLimits max_move;
  OnCancel on_cancel = OnCancel::discard;  ///< of a cancel that doesn't say itself that it keeps
  std::optional<StopPoint> stop_at;        ///< the journal writes it
  std::optional<ContactRule> contact;
};
/// One operation, chosen by the user, on shells ("shell:12") or the edge between two nodes ("node:7").
struct Restructure {
  repair::Operation operation = repair::Operation::split;
  std::vector<std::string> at;
};

/// Which contacts are separated.
enum class ContactKind : std::uint8_t { perforation, penetration };
/// What follows a separation, about what it moved: relaxing or repairing that keeps apart (ContactRule).
enum class FollowUp : std::uint8_t { none, relax, repair };
/// Moves shells that cross or are too close apart (docs/contact.md). Lengths are in the deck's unit.
struct Separate {
  std::optional<std::string> on;  ///< an expression of kind element: one side of the regions; absent: all
  std::optional<std::string> against;
  std::optional<std::array<double, 3>> at;  ///< only the region that is nearest
  std::vector<ContactKind> kinds{ContactKind::perforation, ContactKind::penetration};
  bool joined = false;  ///< also regions between parts that are joined there
  double gap = 0;
  contact::MovingSide move = contact::MovingSide::both;
  std::optional<Vec3> direction;  ///< of any length but zero; absent: away from the other side
  std::optional<double> max_move;
  double allowed_depth = 0;
  FollowUp follow = FollowUp::none;
};

/// Joins the sheets that lie on each other at spots by welds (docs/welds.md). Where: one of `flange`, `along`, `points`, `points_file`.
/// Lengths are in the deck's unit.
struct Weld {
  std::optional<SelectFlange> flange;                        ///< along the middle of these flanges
  std::optional<std::vector<std::array<double, 3>>> along;   ///< along a line through these points
  std::optional<std::vector<std::array<double, 3>>> points;  ///< at these points
  std::optional<std::string> points_file;                    ///< at the points of a table (a path relative to the deck's folder)
  std::optional<double> pitch;                               ///< of `flange` and `along` (required); points: welds nearer than half are one
  std::optional<double> end_distance;                        ///< of the first and last weld from the ends; absent: half the pitch
  std::optional<double> edge_distance;                       ///< of `flange`: the least from its two sides; absent: any
  std::optional<int> sheets;                                 ///< how many of those that lie on each other are joined; absent: all
  std::optional<std::string> parts;                          ///< an expression of parts: only their sheets count
  double gap = 0;                                            ///< sheets may be farther apart than by their thickness by this
  std::optional<std::string> like;                           ///< "beam:9": an element whose part and card the new ones get; or "nearest"
  std::optional<double> diameter;                            ///< without `like`: of a new section
  // without `like`, of the new material, in the deck's units; absent: the least of the sheets'
  std::optional<double> density, youngs_modulus, poissons_ratio, yield_stress;
  std::optional<std::string> as;  ///< what a weld is: "beam"; absent: as `like`
};

/// Bonds the two sheets of a flange by a strip of hexahedra along its middle (docs/bonds.md). Lengths are in the deck's unit.
struct Bond {
  SelectFlange flange;              ///< the flange, or the flanges between parts; its mode is ignored
  double width = 0;                 ///< across
  double length = 0;                ///< of a hexahedron, about
  double end_distance = 0;          ///< of the strip from the flange's ends
  bool from_middles = false;        ///< "from": "middles": from middle surface to middle surface instead of from face to face
  std::optional<std::string> like;  ///< "solid:9": a hexahedron whose part and card the new ones get
  std::optional<double> density, youngs_modulus, poissons_ratio;  ///< without `like`: of the new material, in the deck's units
};

/// Puts the ends of welds back onto sheets: of those that have a loose end or join nothing (docs/welds.md). Lengths are in the deck's unit.
struct RepairWelds {
  std::optional<std::vector<std::string>> at;  ///< only these: "beam:9"; absent: all
  double gap = 0;                              ///< as Weld
  std::optional<double> max_move;              ///< of a node; absent: as long as a joint at the sheet may be
};

/// The mesh of one part of another deck, in that deck's order.
struct VariantMesh {
  struct Node {
    std::int64_t id = 0;
    std::array<double, 3> at{};
  };
  struct Shell {
    std::int64_t id = 0;
    std::array<std::int64_t, 4> node{};  ///< ids; a triangle repeats its third
  };
  std::vector<Node> nodes;
  std::vector<Shell> shells;
  std::optional<double> thickness;  ///< of its part
};
/// A rigid motion that brings three points of the variant onto three of the deck: the first onto the first, the second onto the line
/// through the second, the third into the plane. Node ids, or coordinates: points, not the nodes nearest to them. Empty: as it stands.
struct Alignment {
  std::vector<NodeReference> from;  ///< of the variant
  std::vector<NodeReference> to;    ///< of the deck
};
/// Gives a part the mesh of a part of another deck, the variant (docs/replacing.md). Its number, section and material stay.
struct ReplacePart {
  std::int64_t part = 0;
  std::string deck;                  ///< the variant (a path relative to the deck's folder)
  std::optional<std::int64_t> with;  ///< its part; absent: the only one with shells
  Alignment align;
  std::optional<std::string> units;  ///< of the variant's lengths: "same", "mm", "m", "in"; absent: guessed
  std::optional<double> tolerance;   ///< what was at a node is at the nearest new node within it; absent: 3/4 of a new shell's side
  /// The variant's mesh; without it the deck is read. The journal has it, so that a replay doesn't depend on the file.
  std::optional<VariantMesh> mesh;
};

struct Undo {};
struct Redo {};
/// Makes redo lead to a branch that leaves from the current state. What redo led to before becomes a branch.
struct TakeBranch {
  std::uint64_t number = 0;  ///< Branch::number
};

using Edit = std::variant<Select, SelectRegion, SelectLasso, SelectFlange, Grow, Shrink, Invert, SetParts, SetTargetSize, SetCriteria,
                          Translate, Lift, Slide, Rotate, Move, Relax, Repair, Restructure, Separate, Weld, Bond, RepairWelds, ReplacePart,
                          Undo, Redo, TakeBranch>;

/// The Shaping of a shaping edit; null for the others.
const Shaping* shaping_of(const Edit& edit);
Shaping* shaping_of(Edit& edit);
/// The displacement of a shaping edit; zero for the others.
Displacement displacement_of(const Edit& edit);
void set_displacement(Edit& edit, const Displacement& displacement);

}  // namespace prismesh::mesh::document
