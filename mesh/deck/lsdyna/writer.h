// Cards of nodes and shells rewritten, everything else about them kept.
#pragma once

#include <memory>
#include <string_view>

#include "mesh/deck/lsdyna/keyword.h"
#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck::lsdyna {

/// `line` is a node's card without its line end; see CardWriter::move_node.
WrittenCard rewrite_node_card(std::string_view line, Columns columns, const Vec3& from, const Vec3& to);

std::unique_ptr<const CardWriter> card_writer();

}  // namespace prismesh::mesh::deck::lsdyna
