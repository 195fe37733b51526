// Cards of nodes and shells rewritten, everything else about them kept.
#pragma once

#include <memory>

#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck::radioss {

std::unique_ptr<const CardWriter> card_writer();

}  // namespace prismesh::mesh::deck::radioss
