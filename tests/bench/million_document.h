// The document that benchmarks edit: the million quads, complete, and a patch of 10,000 nodes.
#pragma once

#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "mesh/document/document.h"
#include "mesh/document/open.h"
#include "mesh/model/adjacency.h"
#include "tests/bench/million_quads.h"

namespace prismesh::mesh::bench {

/// A model of positions, shells and parts with everything a document needs. Ids count from 1.
inline Model complete(Model model) {
  std::vector<std::int64_t> node_ids(model.node_count());
  std::vector<std::int64_t> shell_ids(model.shell_count());
  std::iota(node_ids.begin(), node_ids.end(), 1);
  std::iota(shell_ids.begin(), shell_ids.end(), 1);
  model.node_ids.resize(node_ids.size());
  model.shell_ids.resize(shell_ids.size());
  for (std::size_t i = 0; i < node_ids.size(); ++i) model.node_ids.set(i, node_ids[i]);
  for (std::size_t i = 0; i < shell_ids.size(); ++i) model.shell_ids.set(i, shell_ids[i]);
  model.node_holds = ChunkedArray<std::uint8_t>::filled(node_ids.size());
  model.node_index = std::make_shared<IdIndex>(node_ids);
  model.shell_index = std::make_shared<IdIndex>(shell_ids);
  model.midside = std::make_shared<std::vector<MidsideNodes>>();
  model.adjacency = std::make_shared<Adjacency>(build_adjacency(model));
  return model;
}

inline document::Document open_million() {
  auto deck = std::make_shared<deck::Deck>();
  document::OpenOptions options;
  options.target_size = 5.0;
  options.history_bytes = std::size_t{1} << 30;
  return document::open("million.k", {deck, complete(million_quads())}, options).value();
}

/// A patch of 100 x 100 nodes in the middle of the sheet, 1001 nodes a row.
inline std::string patch_expression() {
  std::string expression;
  for (int j = 450; j < 550; ++j) {
    const int first = 450 + 1001 * j;
    expression += (expression.empty() ? "" : ",") + std::to_string(first + 1) + "-" + std::to_string(first + 100);
  }
  return expression;
}

}  // namespace prismesh::mesh::bench
