// An edit is data: what to do, on what, from where. One definition for kiosk, pen, command line, scripts and tests; the
// JSON form is in edit_json.h.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/select/expression.h"
#include "mesh/shape/weights.h"

namespace prismesh::mesh::document {

enum class SelectMode : std::uint8_t { set, add, subtract, intersect };

/// A node by id, or by coordinates (the nearest node): coordinates survive a remeshed variant.
using Place = std::variant<std::int64_t, std::array<double, 3>>;

struct Select {
  std::string expr;
  select::Kind kind = select::Kind::node;
  SelectMode mode = SelectMode::set;
};
struct SelectRegion {
  Place at;
  double angle = 30;  ///< degrees
  SelectMode mode = SelectMode::set;
};
struct SelectLasso {
  std::vector<std::array<double, 2>> outline;  ///< normalised device coordinates
  std::array<double, 16> view{};               ///< deck coordinates to clip space, column-major
  bool visible = false;                        ///< true is refused here: it takes a picture; views send the nodes they see
  SelectMode mode = SelectMode::set;
};
struct Grow {
  int rings = 1;
};
struct Shrink {
  int rings = 1;
};
struct Invert {};

enum class VisibilityAction : std::uint8_t { hide, show, only, lock, unlock };
/// Parts named by `on` (an expression of kind part); without it, the parts of the selection; show and unlock with nothing
/// selected: all parts.
struct SetParts {
  VisibilityAction action = VisibilityAction::hide;
  std::optional<std::string> on;
};

/// What an edit acts on: an expression of kind node, or a recipe, worked out on the model as it is when the edit is applied; its
/// mode is ignored. A recipe of a region by coordinates means the same place on a remeshed variant.
using Where = std::variant<std::string, Select, SelectRegion, SelectLasso>;

/// What a shaping edit acts on and how it fades out.
struct Shaping {
  std::optional<Where> on;    ///< without it the selection
  std::optional<Place> grab;  ///< coordinates: the nearest node of those acted on; absent: the node farthest from the border
  std::optional<std::array<double, 3>> grab_at;  ///< where the node `grab` was: used where no such node is acted on (a variant)
  shape::WeightOptions weights;
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
struct Undo {};
struct Redo {};

using Edit = std::variant<Select, SelectRegion, SelectLasso, Grow, Shrink, Invert, SetParts, Translate, Lift, Undo, Redo>;

/// The edit's name as in its JSON ("translate", "hide", ...).
std::string_view name(const Edit& edit);

}  // namespace prismesh::mesh::document
