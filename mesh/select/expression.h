// Expressions of ids, sets and files: `1-100,205,!17,part:3,1-1000:10`, `set:"flange" & ~part:7`. Grammar: docs/selecting.md.
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

/// Evaluates an expression, its items from left to right, starting with nothing. Cost: the model's size once and for each operator, then
/// what each item names, never the width of a range; the reverse index once if a set is named.
/// Errors: file "expression", line the column (from 1). An item that names nothing is one, with the nearest id, set or file that exists; so
/// is what names everything again and again (kMaxTimesNamed); cancelled, which the progress is asked about in every few items.
Result<Chosen> evaluate(const Model& model, std::string_view expression, Kind kind, const Names& names = {}, const Progress& progress = {});

/// So many times may an expression name all of a model, or as many as that in all.
inline constexpr std::uint64_t kMaxTimesNamed = 1000;

/// The shortest expression of these ids in ascending ranges: "1-100,205". For tools that send what they picked.
std::string to_expression(std::vector<std::int64_t> ids);

}  // namespace prismesh::mesh::select
