// The settings of a document: the unit, and what its elements are judged by.
#pragma once

#include "base/units.h"
#include "mesh/quality/criteria.h"

namespace prismesh::mesh::document {

struct DocumentSettings {
  LengthUnit length_unit = LengthUnit::mm;
  bool length_unit_guessed = true;
  double target_size = 1;
  bool target_size_guessed = true;
  quality::Criteria criteria;
};

}  // namespace prismesh::mesh::document
