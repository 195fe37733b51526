// Target sizes of a model whose deck states none: guessed from the lengths of edges. The rules: docs/quality/criteria.md.
#pragma once

#include <cstddef>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/quality/criteria.h"

namespace prismesh::mesh::quality {

/// A part with fewer edges is judged by the deck's target size: its own median would say too little.
inline constexpr std::size_t kMinEdgesOfPart = 24;

/// The median edge length, rounded to two digits; 1 for a model without shells. Precondition: the model has its adjacency.
double guess_target_size(const Model& model);

/// The target size of each part, by PartIndex: the median length of its edges, rounded to two digits, or `deck_size` for a part with fewer
/// than kMinEdgesOfPart edges. Where the upper quartile is more than twice the lower one it is the geometric mean of the quartiles. An edge
/// between two parts counts for both. Criteria are the deck's. Precondition: the model has its adjacency.
std::vector<PartCriteria> guess_part_sizes(const Model& model, double deck_size);

/// The same criteria with an entry for each distinct one.
CriteriaByPart share_entries(const std::vector<PartCriteria>& of_parts);

}  // namespace prismesh::mesh::quality
