// Evaluates expressions of ids, sets and files: `1-100,205,!17,part:3,1-1000:10`, `set:"flange" & ~part:7`. Grammar: docs/selecting.md.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "mesh/model/model.h"
#include "mesh/select/chosen.h"
#include "mesh/select/names.h"

namespace prismesh::mesh::select {

/// Evaluates an expression, its items from left to right, starting with the empty set. Cost: the model's size once and for each operator,
/// and the number of entities that each item names, never the width of a range; the reverse index once if a set is named.
/// Errors, with file "expression" and the column (from 1) as line: bad syntax; an item that names nothing (the nearest id, set or file that
/// exists is named); items that name more than kMaxTimesNamed allows; cancelled (`progress` is asked every few items).
Result<Chosen> evaluate(const Model& model, std::string_view expression, EntityKind kind, const Names& names = {},
                        const Progress& progress = {});

/// The items of one expression may together name this many times the entities of the model.
inline constexpr std::uint64_t kMaxTimesNamed = 1000;

/// Writes ids as an expression of ascending ranges: "1-100,205". For tools that send what they picked.
std::string to_expression(std::vector<std::int64_t> ids);

}  // namespace prismesh::mesh::select
