// Weights as a function of the node, for tests.
#pragma once

#include <algorithm>
#include <functional>
#include <optional>

#include <gtest/gtest.h>

#include "mesh/connections/find_joined_sheets.h"
#include "mesh/shape/weights.h"

namespace prismesh::test {

inline mesh::NodeSet nodes_where(const mesh::Model& model, const std::function<bool(const mesh::Vec3&)>& chosen) {
  mesh::NodeSet nodes;
  for (std::size_t i = 0; i < model.node_count(); ++i)
    if (chosen(model.positions[i])) nodes.push_back(mesh::NodeIndex(i));
  return nodes;
}

/// 0 outside the selection. Without joined sheets these are the ones of the model.
class Weighed {
 public:
  Weighed(const mesh::Model& model, const mesh::NodeSet& selection, std::optional<mesh::NodeIndex> grab,
          const mesh::shape::WeightOptions& options)
      : Weighed(model, selection, grab, options,
                options.across_welds ? mesh::connections::find_joined_sheets(model, {}, {}) : mesh::connections::JoinedSheets()) {}
  Weighed(const mesh::Model& model, const mesh::NodeSet& selection, std::optional<mesh::NodeIndex> grab,
          const mesh::shape::WeightOptions& options, const mesh::connections::JoinedSheets& joined) {
    const Result<mesh::shape::Weights> result = mesh::shape::compute_weights(model, selection, grab, options, {{}, {}, &joined});
    EXPECT_TRUE(result.has_value()) << result.error().text();
    if (result) weights = *result;
  }
  double operator()(mesh::NodeIndex node) const {
    const auto found = std::lower_bound(weights.nodes.begin(), weights.nodes.end(), node);
    if (found == weights.nodes.end() || *found != node) return 0;
    return weights.weight[static_cast<std::size_t>(found - weights.nodes.begin())];
  }
  mesh::shape::Weights weights;
};

}  // namespace prismesh::test
