// One number for each node or shell of a model, to be seen as colour and told as figures: how far it has moved, how far it lies from a
// surface, how good it is. Definitions: docs/comparing.md.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/progress.h"
#include "mesh/document/document.h"
#include "mesh/quality/metrics.h"
#include "mesh/spatial/distance.h"

namespace prismesh::mesh::document {

/// Where a colour map begins and ends. What lies beyond `clear` keeps its own colour, what lies beyond `full` has the map's last one.
/// `full` < `clear`: small values are the worse ones.
struct FieldLimits {
  double clear = 0;
  double full = 1;
  bool operator==(const FieldLimits&) const = default;
};

/// Of the values that are numbers.
struct FieldFigures {
  std::size_t measured = 0;
  double min = 0, mean = 0, max = 0;
  std::uint32_t min_at = 0, max_at = 0;  ///< index of the node or shell; of equal ones the first
};

struct Field {
  std::string title;          ///< "displacement", "warpage", ..
  std::string unit;           ///< "mm", "deg", ..; empty: a pure number
  bool on_nodes = true;       ///< else on shells
  std::vector<float> values;  ///< by NodeIndex or ShellIndex, removed ones included; NaN: no value
  FieldFigures figures;       ///< of the values before they were rounded to floats
  FieldLimits limits;         ///< suggested
  std::size_t new_nodes = 0;  ///< have a value in a displacement, but count in no figure: a saved deck doesn't know where they come from
};

// All fields: the same bits whatever the number of threads. Nodes and shells that are removed, aren't finite or have no counterpart have
// no value. Errors: a sentence if nothing has a value.

/// How far each node lies from where the node of the same id is in `before`. The same for two generations and two decks. A node that was
/// added since, and whose origin is known, is measured from where it would have been made in `before`: between the nodes it comes from.
/// Costs the nodes; between generations, chunks that both share cost nothing. Suggested limits: 1 mm and 5 mm.
Result<Field> displacement_field(const Model& before, const Model& now, LengthUnit unit);

/// How far each node of a shell lies from the closest point of the other model's shells: exactly 0 for nodes that haven't moved. Suggested
/// limits: 0.05 mm and 1 mm. Errors: also cancelled.
Result<Field> surface_distance_field(const Model& surface, const Model& now, LengthUnit unit, const Progress& progress = {});

/// Of the nodes that one shape has: how far from the closest point of the other, both of one model. Suggested limits: all of it, the close
/// ones coloured.
Result<Field> gap_field(const Model& model, const spatial::Shape& from, const spatial::Shape& to, LengthUnit unit,
                        const Progress& progress = {});

/// A metric of each shell that it applies to. Suggested limits: where it warns and where it fails, for quads; else all of it.
Result<Field> metric_field(const Model& model, quality::Metric metric, const Settings& settings);

/// quality::composite of each shell. Suggested limits: halfway to failing, and failing.
Result<Field> composite_field(const Model& model, const Settings& settings);

/// The stable time step of each shell whose material is known, TSSFAC included, in the deck's time unit. Suggested limits: twice the
/// smallest, and the smallest.
Result<Field> time_step_field(const Model& model, const TimeStepControl& control);

/// What an expression names as a shape: shells, parts, sets of those and files count with their surfaces (and with the nodes of their
/// other elements); as soon as it names anything else, with all its nodes. Errors: those of select::evaluate.
Result<spatial::Shape> shape_named(const Generation& generation, const std::string& expression);

/// Which field is wanted.
struct FieldWish {
  enum class Of : std::uint8_t { displacement, surface_distance, gap, metric, composite, time_step };
  Of of = Of::displacement;
  quality::Metric metric = quality::Metric::warpage;
  std::string from, to;  ///< of a gap: expressions
};

/// "displacement", "distance-to-original", "distance", "metric:NAME", "composite", "time-step". Errors: names the nearest.
Result<FieldWish> field_wish(std::string_view name);
std::string name(const FieldWish& wish);
/// Shells that are there, but have no value of their own or at one of their corners: they keep their colour whatever the limits.
std::size_t shells_without_value(const Model& model, const Field& field);
/// Whether it compares with another state.
inline bool needs_other(const FieldWish& wish) {
  return wish.of == FieldWish::Of::displacement || wish.of == FieldWish::Of::surface_distance;
}

/// The wished field of a generation. `other`: what it is compared with; needed where needs_other says so.
Result<Field> make_field(const FieldWish& wish, const Generation& generation, const Document& document, const Model* other,
                         const Progress& progress = {});

}  // namespace prismesh::mesh::document
