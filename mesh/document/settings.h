// The settings of a document: the unit, and what its elements are judged by.
#pragma once

#include <optional>
#include <string>

#include "base/units.h"
#include "mesh/quality/criteria.h"

namespace prismesh::mesh::document {

struct DocumentSettings {
  LengthUnit length_unit = LengthUnit::mm;
  bool length_unit_guessed = true;
  double target_size = 1;  ///< of shells that belong to no part, when the deck was opened; those of parts: Generation::judging
  bool target_size_guessed = true;
  bool has_file = false;                     ///< there is a settings file beside the deck
  bool part_sizes_given = false;             ///< the user gave sizes of parts when the deck was opened
  quality::Criteria criteria;                ///< of the parts without criteria of their own
  std::optional<std::string> criteria_from;  ///< the name or file that the user gave
};

}  // namespace prismesh::mesh::document
