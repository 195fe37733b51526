// The welds of a generation and what is wrong with them, in words. Rules: docs/welds.md.
#pragma once

#include <string>
#include <vector>

#include "mesh/connections/check_welds.h"
#include "mesh/document/document.h"

namespace prismesh::mesh::document {

struct WeldFinding {
  std::string kind;   ///< a stable word: "loose-end", "joins-nothing", "not-tied", "near-edge", "near-weld"
  std::string words;  ///< "beam:9: node:901 lies 8.1 from the nearest sheet"
  Vec3 at = Vec3::Zero();
};

struct WeldChecks {
  std::size_t welds = 0;
  std::vector<WeldFinding> findings;  ///< in the order of class and element
};

/// Checks all welds. Whether a contact ties them is told where cards name it by parts: then sheets that they don't name are "not-tied".
WeldChecks check_welds(const Document& document, const connections::WeldCheckOptions& options);

}  // namespace prismesh::mesh::document
