// Id expressions: `1-100,205,!17,part:3,1-1000:10`, left to right. Grammar: docs/selecting.md.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::select {

enum class Kind : std::uint8_t { node, element, part };

/// What an expression names. Bare numbers are ids of the kind in hand; `node:`, `shell:`, `part:` and the other element
/// classes change it for one item.
struct Chosen {
  NodeSet nodes;                 ///< kind node: the nodes; element: the nodes of `shells`; part: of all the parts' elements
  ShellSet shells;               ///< kind element: the shells; part: the shells of `parts`; else empty
  std::vector<PartIndex> parts;  ///< kind part: the parts, ascending, also those without shells; else empty
};

/// Evaluates an expression from left to right, starting with nothing. Cost: the model's size once, then what each item names,
/// never the width of a range.
/// Errors: file "expression", line the column (from 1). An item that names nothing is one, with the nearest id that exists.
Result<Chosen> evaluate(const Model& model, std::string_view expression, Kind kind);

/// The shortest expression of these ids in ascending ranges: "1-100,205". For tools that send what they picked.
std::string to_expression(std::vector<std::int64_t> ids);

}  // namespace prismesh::mesh::select
