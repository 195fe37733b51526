// The models whose operations are counted: generated, in any size, the same on every machine.
#pragma once

#include <cstddef>
#include <string>

#include "mesh/model/model.h"

namespace prismesh::cost {

/// A flat sheet of about `shells` quads of 5 mm, as wide as long.
mesh::Model flat_sheet(std::size_t shells);

/// Two hat rails, each a part, of `shells` quads of 5 mm: flanges, walls and a top with fillets between them. More shells make them longer.
/// At one shell in kShellsOfDefect a corner lies next to the opposite one, so that its shells fail.
mesh::Model rails(std::size_t shells);
inline constexpr std::size_t kShellsOfDefect = 2'000;

/// The nodes of the middle half of the first rail's top, as an expression.
std::string top_of_first_rail(const mesh::Model& rails);
/// A node in the middle of that.
mesh::NodeIndex middle_of_top(const mesh::Model& rails);

}  // namespace prismesh::cost
