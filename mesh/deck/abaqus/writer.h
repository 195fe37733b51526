// Writes Abaqus's data lines of nodes, elements and sets.
#pragma once

#include <memory>

#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck::abaqus {

std::unique_ptr<const CardWriter> card_writer();

}  // namespace prismesh::mesh::deck::abaqus
