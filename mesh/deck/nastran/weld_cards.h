// The cards of a part of spot welds: PWELD and the MAT1 that it needs.
#pragma once

#include <string>
#include <utility>

#include "base/error.h"
#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck::nastran {

/// As CardWriter::weld_part. One number, above all properties and materials of the deck, is that of both; small fields. Source: MSC Nastran
/// Quick Reference Guide, PWELD and MAT1.
Result<std::pair<Part, std::string>> weld_part(const Deck& deck, const Model& model, const CardWriter::WeldPart& wanted);

}  // namespace prismesh::mesh::deck::nastran
