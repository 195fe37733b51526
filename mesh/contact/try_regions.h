// Whether each region could be separated by itself.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "mesh/contact/separation.h"

namespace prismesh::mesh::contact {

struct RegionTrial {
  bool perforation = false;
  std::array<ShellSet, 2> shells;  ///< of each side, ascending
  std::string why;                 ///< why separate() would leave it; empty: it would remove it
};

/// Separates each region that the wish means, as if it were the only one, and keeps nothing of it. The regions in the order in which
/// separate() takes them, at most `limit` that aren't left beforehand; those beyond it are missing. The same bits whatever the number of
/// threads. Costs an edit a region. Errors: cancelled.
Result<std::vector<RegionTrial>> try_regions(const SeparationInput& input, const SeparationWish& wish, std::size_t limit,
                                             const Progress& progress = {});

}  // namespace prismesh::mesh::contact
