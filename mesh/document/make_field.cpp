#include "mesh/document/make_field.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "mesh/document/deck_relations.h"
#include "mesh/document/distance_fields.h"
#include "mesh/document/quality_fields.h"
#include "mesh/select/expression.h"

namespace prismesh::mesh::document {

Result<spatial::Shape> shape_named(const Generation& generation, const std::string& expression) {
  const Model& model = generation.model;
  const select::Names names = generation.relations ? generation.relations->names : select::Names{};
  Result<select::Chosen> nodes = select::evaluate(model, expression, select::EntityKind::node, names);
  if (!nodes) return fail(nodes.error());
  if (!nodes->of_surfaces) return spatial::Shape{std::move(nodes->nodes), {}};
  Result<select::Chosen> shells = select::evaluate(model, expression, select::EntityKind::element, names);
  if (!shells) return spatial::Shape{std::move(nodes->nodes), {}};  // a file without shells
  spatial::Shape shape;
  shape.shells = std::move(shells->shells);
  const NodeSet covered = nodes_of(model, shape.shells);
  std::set_difference(nodes->nodes.begin(), nodes->nodes.end(), covered.begin(), covered.end(), std::back_inserter(shape.nodes));
  return shape;
}

Result<Field> make_field(const FieldWish& wish, const Generation& generation, const Document& document, const Model* other,
                         const Progress& progress) {
  const LengthUnit unit = document.settings.length_unit;
  if (needs_other(wish) && other == nullptr) return fail(name(wish), "needs another state to be compared with");
  switch (wish.of) {
    case FieldWish::Of::displacement: return displacement_field(*other, generation.model, unit);
    case FieldWish::Of::surface_distance: return surface_distance_field(*other, generation.model, unit, progress);
    case FieldWish::Of::gap: {
      const Result<spatial::Shape> from = shape_named(generation, wish.from);
      if (!from) return fail(from.error());
      const Result<spatial::Shape> to = shape_named(generation, wish.to);
      if (!to) return fail(to.error());
      return gap_field(generation.model, *from, *to, unit, progress);
    }
    case FieldWish::Of::metric: return metric_field(generation.model, wish.metric, sized(*generation.judging), unit);
    case FieldWish::Of::composite: return composite_field(generation.model, sized(*generation.judging));
    case FieldWish::Of::time_step: break;
  }
  return time_step_field(generation.model, document.deck ? document.deck->time_step : TimeStepControl{});
}

}  // namespace prismesh::mesh::document
