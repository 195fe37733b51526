#include "mesh/document/edit.h"

namespace prismesh::mesh::document {

Shaping* shaping_of(Edit& edit) {
  return std::visit(
      [](auto& each) -> Shaping* {
        if constexpr (requires { each.shaping; })
          return &each.shaping;
        else
          return nullptr;
      },
      edit);
}

const Shaping* shaping_of(const Edit& edit) { return shaping_of(const_cast<Edit&>(edit)); }

Displacement displacement_of(const Edit& edit) {
  Displacement displacement;
  if (const auto* translate = std::get_if<Translate>(&edit)) displacement.by = translate->by;
  if (const auto* slide = std::get_if<Slide>(&edit)) displacement.by = slide->by;
  if (const auto* lift = std::get_if<Lift>(&edit)) displacement.distance = lift->distance;
  if (const auto* rotate = std::get_if<Rotate>(&edit)) displacement.degrees = rotate->degrees;
  if (const auto* move = std::get_if<Move>(&edit)) {
    displacement.by = move->by;
    displacement.degrees = move->degrees;
  }
  return displacement;
}

void set_displacement(Edit& edit, const Displacement& displacement) {
  if (auto* translate = std::get_if<Translate>(&edit)) translate->by = displacement.by;
  if (auto* slide = std::get_if<Slide>(&edit)) slide->by = displacement.by;
  if (auto* lift = std::get_if<Lift>(&edit)) lift->distance = displacement.distance;
  if (auto* rotate = std::get_if<Rotate>(&edit)) rotate->degrees = displacement.degrees;
  if (auto* move = std::get_if<Move>(&edit)) {
    move->by = displacement.by;
    move->degrees = displacement.degrees;
  }
}

}  // namespace prismesh::mesh::document
