// Writes the cards of nodes and shells, and keeps everything else on them.
#pragma once

#include <memory>
#include <string_view>

#include "mesh/deck/lsdyna/keyword.h"
#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck::lsdyna {

/// As CardWriter::move_node. `line`: the node's card, without its line end.
WrittenCard rewrite_node_card(std::string_view line, Columns columns, const Vec3& from, const Vec3& to);

std::unique_ptr<const CardWriter> card_writer();

}  // namespace prismesh::mesh::deck::lsdyna
