// The settings of a document: its unit, and where what its elements are judged by came from.
#pragma once

#include "base/units.h"

namespace prismesh::mesh::document {

struct DocumentSettings {
  LengthUnit length_unit = LengthUnit::mm;
  bool length_unit_guessed = true;
  double target_size = 1;  ///< of shells that belong to no part, when the deck was opened; those of parts: Generation::judging
  bool target_size_guessed = true;
  bool has_file = false;        ///< there is a settings file beside the deck
  bool sizes_given = false;     ///< the user gave target sizes when the deck was opened, besides the settings file
  bool criteria_given = false;  ///< the same of criteria
};

}  // namespace prismesh::mesh::document
