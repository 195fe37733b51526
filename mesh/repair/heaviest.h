// The nodes that a new node comes from, when it has more than can be written down.
#pragma once

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace prismesh::mesh::repair {

/// The four nodes of the largest weights, the largest first, of equal ones the lower node; with weights whose sum is 1.
template <class Node>
std::vector<std::pair<Node, double>> heaviest_four(const std::map<Node, double>& weights) {
  std::vector<std::pair<Node, double>> heaviest(weights.begin(), weights.end());
  std::stable_sort(heaviest.begin(), heaviest.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  if (heaviest.size() > 4) heaviest.resize(4);
  double sum = 0;
  for (const auto& [node, weight] : heaviest) sum += weight;
  for (auto& [node, weight] : heaviest) weight /= sum;
  return heaviest;
}

}  // namespace prismesh::mesh::repair
