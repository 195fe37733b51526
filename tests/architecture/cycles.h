// Cycles in a graph of names.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

namespace prismesh::architecture {

/// What each name leads to directly.
using Graph = std::map<std::string, std::set<std::string>>;

/// Each set of two or more names that lead to each other (a strongly connected component), ascending and joined by ", ". Method: Tarjan's.
std::vector<std::string> cycles(const Graph& graph);

}  // namespace prismesh::architecture
