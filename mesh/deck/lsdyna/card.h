// Reads a card's fields as numbers.
#pragma once

#include <cstdint>
#include <optional>

#include "mesh/deck/lsdyna/card_fields.h"
#include "mesh/deck/lsdyna/parameters.h"

namespace prismesh::mesh::deck::lsdyna {

/// The fields of one line, with parameters replaced by their values. nullopt: no number, or an unknown parameter.
class Card : public CardFields {
 public:
  std::optional<double> real(std::size_t field, const Parameters& parameters) const { return parameters.real(text(field)); }
  std::optional<std::int64_t> integer(std::size_t field, const Parameters& parameters) const { return parameters.integer(text(field)); }
};

}  // namespace prismesh::mesh::deck::lsdyna
